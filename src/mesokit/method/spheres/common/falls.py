"""Spheres in gravity: along which axes walls end the fall, and along which nothing does."""

from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError


def _open_falls(case: Case) -> list[str]:
    """Axes along which gravity pulls and no plates are; none where there are round walls."""
    if any(not wall.closed_axes for wall in case.walls):
        return []
    shut = {axis for wall in case.walls for axis in wall.closed_axes}
    pulls = zip(case.box.axes, case.spheres.gravity, strict=False)
    return [axis for axis, g in pulls if g and axis not in shut]


def check_floor(case: Case) -> None:
    """Raise CaseError where no wall is below: spheres would fall for ever, faster and faster."""
    gravity, falls = case.spheres.gravity, _open_falls(case)
    if falls and len(falls) == sum(1 for g in gravity if g):
        raise CaseError(
            f"spheres.gravity = {show(list(gravity))}: nothing ends the fall along {falls[0]}; "
            "expected a wall"
        )


def warnings(case: Case, rough: bool) -> Iterator[str]:
    """Of spheres that fall along plates which do not hold them; `rough`: friction may."""
    for axis in _open_falls(case):
        if not rough:
            yield (
                f"spheres.gravity: nothing holds what falls along {axis}: no wall is there, and "
                "plates and spheres are smooth"
            )
