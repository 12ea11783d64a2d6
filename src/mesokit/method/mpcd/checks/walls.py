"""Walls that are fine alone and wrong together, or in this box: see `combinations`."""

from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import solids_of
from mesokit.geometry.walls import Walls, surfaces

WALLS = Walls(("no-slip", "slip", "diffuse"), moving=True, turning=True, virtual=True)


def walls(case: Case) -> Iterator[str]:
    """Checks of every method; one rule for virtual particles."""
    yield from WALLS.problems(case)
    for i, wall in enumerate(case.walls):
        if wall.virtual != case.walls[0].virtual:
            yield (
                f"wall[#{i + 1}].virtual = {show(wall.virtual)}: expected "
                f"{show(case.walls[0].virtual)} as for wall[#1]; all walls have one rule"
            )
    if case.fluid.mixed and any(wall.virtual == "top-up" for wall in case.walls):
        yield "wall[#1].virtual = 'top-up': not with species of different mass; use 'extrapolate'"


def moving_surfaces(case: Case) -> Iterator[str]:
    """Surfaces that move along themselves."""
    for key, surface, wall in surfaces(case):
        if isinstance(wall, Plates):
            if surface.rule == "slip" and any(surface.velocity or ()):
                said = show(surface.velocity)
                yield f"{key}.velocity = {said}: a slip plate drags nothing; leave it out"
        elif surface.rule == "slip" and surface.moves:
            name = "velocity" if any(surface.velocity or ()) else "rotation"
            yield f"{key}.{name}: a slip surface drags nothing; leave it out"
        if isinstance(surface.rotation, tuple) and (
            case.box.dimension == 2 or len(surface.rotation) != 3
        ):
            what = "one number in 2D" if case.box.dimension == 2 else "a number or three"
            yield f"{key}.rotation = {show(surface.rotation)}: expected {what}"
    if any(surface.moves and not isinstance(wall, Plates) for _, surface, wall in surfaces(case)):
        motion = solids_of(case).motion
        for i, wall in enumerate(case.walls):
            speed, across = motion.get(i, (0.0, 0.0))
            if not isinstance(wall, Plates) and across > 1e-6 * max(1.0, speed):
                yield (
                    f"wall[#{i + 1}].surface: its surface would move across itself, at "
                    f"{across:.3g}; expected a motion along the surface, such as the rotation "
                    "of something round"
                )
