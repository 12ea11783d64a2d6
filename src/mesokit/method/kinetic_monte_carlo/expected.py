"""What theory predicts of a run on a lattice: its model has the formulas, by name."""

import math

from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.model.protocol import Known

UNKNOWN: Known = (math.nan, "")


def known_mean(case: Case, name: str) -> Known:
    """A mean and a note on its theory, by a name of `Model.expected`; nan without theory."""
    return case.lattice.model.expected(case).get(name, UNKNOWN)


def coverages(case: Case) -> dict[str, Known]:
    """Part of the sites in each state, by its name."""
    return _named(case, "part ")


def event_rates(case: Case) -> dict[str, Known]:
    """Events of each process per site and unit of time, by its name."""
    return _named(case, "rate of ")


def _named(case: Case, begin: str) -> dict[str, Known]:
    found = case.lattice.model.expected(case)
    return {key[len(begin) :]: one for key, one in found.items() if key.startswith(begin)}


def width(case: Case, time: NDArray, first: float) -> tuple[NDArray | None, str]:
    """Width of a surface at times, None without theory; `first` is its square at the first."""
    return case.lattice.model.expected_width(case, time, first)


def growth_exponent(case: Case) -> Known:
    """Exponent of the width in time, while correlations are shorter than the lattice."""
    return known_mean(case, "growth exponent")
