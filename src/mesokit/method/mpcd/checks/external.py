"""Checks of external forces on beads: pulls, traps, magnetic fields."""

from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.molecule import UNSTABLE
from mesokit.method.mpcd.solutes import Solutes


def external(case: Case, given: Solutes) -> Iterator[str]:
    """Errors: unknown beads, vectors of a wrong length, traps in a sheared box or too stiff."""
    d, lists = case.box.dimension, ("pulls", "traps", "magnetic")
    for name in lists:
        for i, part in enumerate(getattr(given, name)):
            key = f"solutes.{name}[#{i + 1}]"
            try:
                part.beads(given)
            except CaseError as error:
                yield f"{key}.{error}"
            for vector in ("force", "centre"):
                value = getattr(part, vector, None)
                if value is not None and len(value) != d:
                    yield f"{key}.{vector} = {show(value)}: expected {d} numbers, one for each axis"
            centre = getattr(part, "centre", ())
            for axis, place, length in zip(case.box.axes, centre, case.box.size, strict=False):
                if axis not in case.box.open and not 0 <= place <= length:
                    yield (
                        f"{key}.centre = {show(centre)}: outside the box along {axis}; expected 0 "
                        f"to {length:g}"
                    )
            if name != "pulls" and case.box.sheared:
                yield f"{key}: not in a sheared box, whose images move"
            if given.coupling == "potential":
                yield f"{key}: not with solutes.coupling = 'potential'"
    for i, field in enumerate(given.magnetic):
        if d == 2 and any(field.field[:2]):
            yield (
                f"solutes.magnetic[#{i + 1}].field = {show(field.field)}: expected [0, 0, B] in 2D"
            )
    for i, trap in enumerate(given.traps):
        time = case.fluid.timestep / given.number_of_substeps(d, case.fluid)
        phase = (trap.k / min(given.masses)) ** 0.5 * time
        if phase >= UNSTABLE:
            yield (
                f"solutes.traps[#{i + 1}].k = {show(trap.k)}: it turns by {phase:.3g} rad in a "
                f"sub-step and is unstable from {UNSTABLE:g} on; take more solutes.substeps"
            )
