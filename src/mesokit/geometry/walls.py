"""The section `[[wall]]` of a case: what every method checks of it, and what each takes."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from mesokit.case.case import Case
from mesokit.case.component import name_of, one_of, show, tag_of
from mesokit.geometry import shape_protocol
from mesokit.geometry.shape.intersection import Intersection
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import Solids, labels, solids_of
from mesokit.geometry.surface import Surface, SurfaceContact

VIBRATION = ("amplitude", "frequency")
MOTION, PUSHED = ("speed", "travel"), ("force", "pressure", "mass")
OF_COLLISION = ("temperature", "tangential", "restitution", "friction")
CONTACT = (*OF_COLLISION, *VIBRATION, *MOTION, *PUSHED)


class Walls(NamedTuple):
    """Keys of walls, beside their shapes, that a method takes; all others are refused.

    rules: of surfaces. moving, turning: whether surfaces may have a velocity and a rotation.
    virtual: whether virtual particles fill solids. opens: whether walls may be taken away. contact:
    keys of `surface.contact`.
    """

    rules: tuple[str, ...] = ("no-slip", "slip")
    moving: bool = False
    turning: bool = False
    virtual: bool = False
    opens: bool = False
    contact: tuple[str, ...] = ()

    def problems(self, case: Case) -> Iterator[str]:
        """Faults of the walls of a case, key first."""
        yield from _shapes(case)
        for i, wall in enumerate(case.walls):
            if wall.virtual != "extrapolate" and not self.virtual:
                yield _not_taken(f"wall[#{i + 1}].virtual", wall.virtual, case)
            if wall.opens is not None and not self.opens:
                yield _not_taken(f"wall[#{i + 1}].opens", wall.opens, case)
        for key, surface, wall in surfaces(case):
            yield from self._surface(key, surface, case, wall)
            if isinstance(wall, Plates):
                if surface.rotation is not None:
                    yield f"{key}.rotation = {show(surface.rotation)}: a plate does not turn"
                velocity = surface.velocity or ()
                if any(velocity["xyz".index(wall.axis) :][:1]):
                    yield (
                        f"{key}.velocity = {show(list(velocity))}: a plate across {wall.axis} "
                        f"moves only along itself; expected 0 for {wall.axis}"
                    )

    def _surface(self, key: str, surface: Surface, case: Case, wall: Any) -> Iterator[str]:
        if surface.rule not in self.rules:
            yield (
                f"{key}.rule = {show(surface.rule)}: not with method {show(case.run.method)}; "
                f"expected {one_of(self.rules)}"
            )
        for name, taken in (("velocity", self.moving), ("rotation", self.turning)):
            value = getattr(surface, name)
            if value is not None and not taken and surface.moves:
                yield _not_taken(f"{key}.{name}", value, case)
        d, velocity, contact = case.box.dimension, surface.velocity, surface.contact
        if velocity is not None and len(velocity) != d:
            yield f"{key}.velocity = {show(list(velocity))}: expected {d} numbers"
        if contact is None:
            return
        usual = SurfaceContact()
        for name in CONTACT:
            value = getattr(contact, name)
            if name not in self.contact and value != getattr(usual, name):
                yield _not_taken(f"{key}.contact.{name}", value, case)
        if not self.contact:
            yield f"{key}.contact: not with method {show(case.run.method)}; leave it out"
        for here, other in (VIBRATION, VIBRATION[::-1]):
            if (given := getattr(contact, here)) > 0 and getattr(contact, other) == 0:
                yield (
                    f"{key}.contact.{here} = {show(given)}: a vibration has an amplitude and a "
                    f"frequency; expected {key}.contact.{other} as well"
                )
        yield from _motion(key, contact, wall)


def _motion(key: str, contact: SurfaceContact, wall: Any) -> Iterator[str]:
    """Faults of the motion of a plate along its normal."""
    moved = [name for name in ("speed", "force", "pressure") if getattr(contact, name)]
    if moved and not isinstance(wall, Plates):
        value = getattr(contact, moved[0])
        yield f"{key}.contact.{moved[0]} = {show(value)}: only plates move along their normal"
    if moved and (contact.amplitude or len(moved) > 1):
        other = "amplitude" if contact.amplitude else moved[1]
        yield f"{key}.contact.{moved[0]}: not with {key}.contact.{other}; expected one of both"
    if contact.travel is not None and not contact.speed:
        yield f"{key}.contact.travel = {show(contact.travel)}: expected {key}.contact.speed as well"
    if contact.mass is not None and contact.force is None and contact.pressure is None:
        yield (
            f"{key}.contact.mass = {show(contact.mass)}: expected {key}.contact.force or "
            f"{key}.contact.pressure as well"
        )


def surfaces(case: Case) -> Iterator[tuple[str, Surface, Any]]:
    """All surfaces of the walls of a case: the key of each, and the wall that it is of."""
    for i, wall in enumerate(case.walls):
        for name, surface in wall.surfaces().items():
            yield f"wall[#{i + 1}].{name}", surface, wall


def closed_axes(case: Case) -> set[int]:
    """Numbers of the axes that walls close."""
    return {case.box.axes.index(axis) for axis in shape_protocol.closed_axes(case.walls)}


def solids(case: Case) -> Solids | None:
    """The solids that pictures show, None without any."""
    return solids_of(case) if case.walls else None


def room(case: Case, left_to: str) -> Iterator[str]:
    """Solids other than plates leave room, and fit the periodic box."""
    if all(isinstance(wall, Plates) for wall in case.walls):
        return
    found = solids_of(case)
    for i, axis in enumerate(case.box.axes):
        gap = found.misfit(i)
        if gap > 1e-6:
            yield (
                f"wall: the solids do not fit the periodic box along {axis}: at its two ends they "
                f"differ by {gap:.2g} cells; close it with plates, or repeat the shape"
            )
    if found.free_volume < 1:
        yield f"wall: the solids leave {found.free_volume:.3g} cells to the {left_to}"
    for i in found.without_surface():
        yield f"wall[#{i + 1}].{_absent(case.walls[i], case.box.size)}"


def _not_taken(key: str, value: Any, case: Case) -> str:
    said = list(value) if isinstance(value, tuple) else value
    return f"{key} = {show(said)}: not with method {show(case.run.method)}; leave it out"


def _shapes(case: Case) -> Iterator[str]:
    """Shapes of this dimension; plates once for each axis; names once, by which forces are kept."""
    d, closed, named = case.box.dimension, dict[str, int](), dict[str, int]()
    for i, (wall, label) in enumerate(zip(case.walls, labels(case.walls), strict=True)):
        key = f"wall[#{i + 1}]"
        if d not in wall.dimensions:
            from mesokit.geometry.shape import SHAPES

            usable = [shape for shape in SHAPES if d in getattr(shape, "dimensions", ())]
            known = [found[1] for shape in usable if (found := tag_of(shape))]
            yield f"{key}.shape = {show(name_of(wall))}: not in {d}D; expected {one_of(known)}"
        for name, vector in wall.vectors().items():
            if len(vector) != d:
                yield (
                    f"{key}.{name} = {show(vector)}: expected {d} numbers, one for each axis of "
                    f"the {d}D box"
                )
        for axis in wall.closed_axes:
            if axis not in case.box.axes:
                yield f"{key}.axis = {show(axis)}: a 2D box has only 'x' and 'y'"
            if axis in closed:
                yield f"{key}.axis = {show(axis)}: wall[#{closed[axis]}] closes it already"
            closed[axis] = i + 1
        if label in named:
            first = f"wall[#{named[label]}]"
            yield f"{key}.name: {show(label)} is also the name of {first}; rename one"
        named[label] = i + 1


def _absent(wall: Any, box: tuple[int, ...]) -> str:
    """The fault of a solid of which no surface is in the box, key first."""
    known = ("radius", "size", "width", "parts", "of", "file")
    inside = wall.fluid == "inside"
    keys = known if inside else ("file", "parts", "of", *wall.vectors(), *known)
    key = next(key for key in keys if hasattr(wall, key))
    value = getattr(wall, key)
    text = f"{key} = {show(value)}" if key not in ("parts", "of") else key
    if inside:
        why = "with fluid = 'inside', what is to surround the fluid lies beyond its ends"
    elif isinstance(wall, Intersection):
        why = "the parts have nothing in common there"
    else:
        why = "expected it to reach into the box"
    return f"{text}: no surface in the box {show(box)}; {why}"
