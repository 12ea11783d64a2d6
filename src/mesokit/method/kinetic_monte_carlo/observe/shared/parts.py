"""Parts of a lattice along x, whose scatter is the error of what is measured of all of them."""

import math

import numpy as np

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import Array

PARTS = 16
FEWEST = 10  # points of a fit
DECADE = 10.0  # the last times of a run, over which an exponent is fitted


def check_parts(case: Case) -> None:
    """Raise CaseError for a lattice that is too short for parts."""
    if case.box.size[0] < PARTS:
        raise CaseError(f"box.size: expected at least {PARTS} sites along x")


def in_parts(rows: Array) -> Array:
    """Sums (PARTS,) of values by their place along x, each over the mean length of a part: the
    mean of all parts is that of all rows."""
    edges = np.linspace(0, len(rows), PARTS + 1).astype(int)
    return np.asarray(np.add.reduceat(rows, edges[:-1]) * (PARTS / len(rows)))


def of_parts(parts: Array) -> tuple[Array, Array]:
    """Mean over the last axis, that of the parts, and its standard error."""
    return parts.mean(axis=-1), parts.std(axis=-1, ddof=1) / math.sqrt(parts.shape[-1])


def late_exponent(
    time: Array, parts: Array, power: float, below: float = 0.0
) -> tuple[float, float] | None:
    """Exponent in time of (mean of the parts - below)^power over the last decade of a run.

    Parameters: `time` (n,); `parts` (n, PARTS). The error is that of leaving out one part each
    (jackknife). None where too few points are positive.
    """
    late = time > time[-1] / DECADE
    excess, count = parts[late] - below, parts.shape[1]
    means = [excess.mean(axis=1)]
    means += [np.delete(excess, k, axis=1).mean(axis=1) for k in range(count)]
    if late.sum() < FEWEST or not np.min(means) > 0:
        return None
    x = np.log(time[late])
    weight = np.sqrt(np.gradient(x))  # equal weights of equal ratios of times
    slopes = power * np.polyfit(x, np.log(means).T, 1, w=weight)[0]
    return float(slopes[0]), math.sqrt((count - 1) * float(np.var(slopes[1:])))
