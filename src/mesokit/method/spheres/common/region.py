"""A part of the box: from where to where along each axis."""

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError

Region = tuple[tuple[float, float], ...]  # [from, to] along each axis


def check_region(region: Region | None, case: Case) -> None:
    """Raise CaseError unless a region has [from, to] in the box along each axis."""
    if region is None:
        return
    box = case.box
    if len(region) != box.dimension:
        raise CaseError(
            f"region = {show(region)}: expected [from, to] along each of the {box.dimension} axes"
        )
    for axis, (low, high), length in zip(box.axes, region, box.size, strict=True):
        if not 0 <= low < high <= length:
            raise CaseError(
                f"region = {show(region)}: expected 0 <= from < to <= {length:g} along {axis}; not "
                f"[{low:g}, {high:g}]"
            )
