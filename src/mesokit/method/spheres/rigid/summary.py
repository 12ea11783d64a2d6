"""Derived numbers of a case of rigid grains, its cost, and warnings."""

from mesokit.case.amounts import number
from mesokit.case.case import Case
from mesokit.method.spheres.common import cost
from mesokit.method.spheres.rigid import scales
from mesokit.seam.method import Summary


def rigid_summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    step, phi = scales.timestep_of(case), section.fraction(box)
    rows = [("timestep", number(step, "time"), "" if section.timestep else "unless said")]
    numbers = {"packing_fraction": phi, "timestep": step, "seconds": 1.0}
    return cost.summary_of(case, rows, (), numbers, "estimate", ())
