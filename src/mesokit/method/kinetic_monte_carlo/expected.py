"""What theory predicts of a run on a lattice: its model has the formulas, by name."""

import math

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.model.alone import rates_alone
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.start import sites_of
from mesokit.seam.result import NOT_STEADY

UNKNOWN: Known = (math.nan, "")
MOST = 64  # states of which coverages are followed in time
FAR = 4.0  # standard errors


def known_mean(case: Case, name: str) -> Known:
    """A mean and a note on its theory, by a name of `Model.expected`; nan without theory."""
    return case.lattice.model.expected(case).get(name, UNKNOWN)


def coverages(case: Case) -> dict[str, Known]:
    """Part of the sites in each state, by its name."""
    return _named(case, "part ")


def relaxation(
    case: Case, time: NDArray[np.float64], parts: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Part of the sites in each state (t, s) after the first sample of them, None without theory:
    that of sites alone, on which neighbours have no effect."""
    rates = rates_alone(case.lattice.model)
    if rates is None or len(rates) > MOST or not len(time):
        return None
    return theory.occupation(rates, parts[0], time - time[0])


def before_steady(case: Case, first: NDArray[np.float64]) -> str:
    """A note where the first sample of the part of the sites in each state is not steady."""
    rates = rates_alone(case.lattice.model)
    if rates is None:
        return ""
    steady = theory.steady_occupation(rates)
    error = np.sqrt(steady * (1 - steady) / sites_of(case))
    far = bool((abs(first - steady) > FAR * error + 0.5 / sites_of(case)).any())
    return f"{NOT_STEADY}: the first sample is not; see run.warmup" if far else ""


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
