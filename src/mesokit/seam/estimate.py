"""Numbers computed from block sums, with error bars that include all correlations.

A profile is measured together: neighbouring bins rise and fall with the same eddies, so the error
of a fitted number is not that of independent bins. What each block of time contributes to the
deviation of the profile is therefore carried through the (linearised) fit, and the blocking is
done on what comes out of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.statistics import (
    FEWEST_PIECES,
    Blocks,
    correlated,
    correlated_error,
    falling_error,
    independent_error,
)

Array = NDArray[np.floating]
SURE = 2.0  # standard errors from zero, within which nothing is divided by a number
SEEN = 1 / 16  # of the run: blocks of time, eight at least, hold two products that span it
DIVISOR = "its divisor is within two standard errors of zero"


class Estimate(NamedTuple):
    """`value` (*shape), what each block adds to its deviation (blocks, *shape), block weights, and
    whether one block may take back what another has added (see `falling_error`).

    Blocks are of time, or groups of particles. With groups, `in_time` is the same value in blocks
    of time: those see what all particles do together, groups see what outlasts the run. `spans`
    (*shape) of the latter are the parts of the run over which the products of each value reach."""

    value: Array
    residuals: Array
    weights: Array
    falling: bool = False
    in_time: Estimate | None = None
    spans: Array | None = None

    @property
    def error(self) -> Array:
        """Standard error, (*shape): of blocks, or the one of groups and time that counts."""
        if self.in_time is None:
            error = falling_error if self.falling else correlated_error
            return error(self.residuals, self.weights)
        groups = independent_error(self.residuals, self.weights)
        times, pieces = correlated(self.in_time.residuals, self.in_time.weights)
        known = pieces >= FEWEST_PIECES
        if self.in_time.spans is not None:
            known &= self.in_time.spans <= SEEN
        return of_both(groups, times, known)

    def part(self, use: slice) -> Estimate:
        """Some of the values (n,), of blocks alone."""
        return self._replace(value=self.value[use], residuals=self.residuals[:, use])

    def divided(self, number: float) -> Estimate:
        """The value divided by a number."""
        return self._replace(
            value=self.value / number,
            residuals=self.residuals / number,
            in_time=None if self.in_time is None else self.in_time.divided(number),
        )

    def linear(self, matrix: Array) -> Estimate:
        """The linear combinations `matrix` (p, n) of a value of shape (n,)."""
        spans = self.spans
        if spans is not None:  # (p,): each value is weighted by the scatter that it adds
            added = np.abs(matrix) * np.sqrt((self.residuals**2).sum(axis=0))
            total = added.sum(axis=1)
            spans = np.asarray(added @ spans / np.where(total > 0, total, 1.0))
        return self._replace(
            value=matrix @ self.value,
            residuals=self.residuals @ matrix.T,
            weights=per_block(self.weights),
            in_time=None if self.in_time is None else self.in_time.linear(matrix),
            spans=spans,
        )

    def scalar(
        self, value: float | Array, gradient: Array, over: tuple[float | Array, Array] | None = None
    ) -> tuple[float, float]:
        """A function of the value (n,), given what it is and its gradient: value and error.

        `over` is the number that a quotient divides by, and the gradient of that number. Within two
        standard errors of zero the quotient has neither value nor error: both are nan.
        """
        error = self.linear(gradient[None]).error[0]
        if over is not None:
            divisor, spread = self.scalar(*over)
            if abs(divisor) < SURE * spread:
                return np.nan, np.nan
        return float(value), float(error)


def of_both(groups: Array, times: Array, known: NDArray[np.bool_]) -> Array:
    """Standard error, given that of groups of particles and that of blocks of time.

    The larger counts. Where that of blocks of time is known and less than half of that of groups,
    groups are anticorrelated by what is conserved, and blocks of time count.

    >>> of_both(np.array([1.0, 1.0, 1.0]), np.array([2.0, 0.1, 0.1]), np.array([True, True, False]))
    array([2. , 0.1, 1. ])
    """
    return np.where(known & (times < groups / 2), times, np.fmax(groups, times))


def of_mean(blocks: Blocks, falling: bool = False) -> Estimate:
    """The mean of a series."""
    sums, samples = blocks.sums()
    mean = blocks.mean()
    residuals = (sums - np.multiply.outer(samples, mean)) / max(blocks.count, 1)
    return Estimate(mean, residuals, samples.astype(float), falling)


def of_ratio(above: Array, below: Array) -> Estimate:
    """Ratio of two block sums (blocks, *shape), as `statistics.ratio`; nan where never filled."""
    total = below.sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        value = np.where(total == 0, np.nan, above.sum(axis=0) / total)
        return Estimate(value, (above - value * below) / total, below)


def fit(estimate: Estimate, basis: Array, weight: Array) -> Estimate:
    """Least squares coefficients (p,) of the basis (n, p) with weights (n,)."""
    root = np.sqrt(weight)[:, None]
    return estimate.linear(np.linalg.pinv(basis * root) * root.T)


def noted(value: float, *notes: str) -> str:
    """The notes of a number as one, the first of which is the reason if a quotient has no value.

    >>> noted(0.7, "", "steady"), noted(np.nan, "steady")
    ('steady', 'its divisor is within two standard errors of zero; steady')
    """
    return "; ".join(filter(None, [DIVISOR * bool(np.isnan(value)), *notes]))


def per_block(weights: Array) -> Array:
    """One weight per block."""
    return weights.reshape(len(weights), -1).mean(axis=1)
