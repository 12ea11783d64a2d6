"""Caveats of runs that are too short for their blocks of time: error bars are lower bounds."""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from mesokit.observe.shared.caveats import FEW_SAMPLES, LOWER_BOUND
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import FEWEST_BLOCKS, FEWEST_PIECES, Blocks, TimeSeries, correlated

NO_ERROR = "no error bar"
MOST = 0.5  # of the means of an observable that may have few independent pieces
NOTE = f"{LOWER_BOUND}: samples amount to less than {FEWEST_PIECES} independent ones"
CHI_SQUARE = "chi-square"  # in the name of a number that is one
SAMPLES = 128  # of fewer in a row, blocks of time hardly tell how long they are correlated
# Relaxation times of a flow, or of molecules, from which on blocks of time give an error. Measured
# with 300 series that decay as an exponential: error bars are 40, 18, 8 and 3 % too small on
# average in 5, 10, 20 and 30 of these times. In 186 channels of 12 cells and 30 such times those of
# flow rates are right within 5 %. Those of viscosities from the curvature are 15 +- 5 % too small,
# so that these ask for more.
ENOUGH, ENOUGH_FOR_CURVATURE = 30.0, 100.0
VERY_FEW = 8  # samples: of fewer no error bar is known to within its half


def bounded(result: Result, accumulator: Any) -> Result:
    """A result whose comparisons say where its samples amount to few independent ones, unless
    their notes have a lower bound already."""
    blocks = getattr(accumulator, "blocks", None)
    if not isinstance(blocks, Blocks):
        return result
    note = NOTE if unresolved(blocks) else ""
    few = f"{LOWER_BOUND}: of {blocks.count} {FEW_SAMPLES}" if blocks.count < SAMPLES else ""

    def caveat(c: Comparison) -> str:
        if c.lower_bound or not c.error > 0:
            return ""
        return note or (few if CHI_SQUARE in c.what or blocks.count < VERY_FEW else "")

    return _noted(result, caveat)


def without_error(result: Result, accumulator: Any) -> Result:
    """A result whose comparisons say why they have no error bar; counts need none."""
    blocks, rows = getattr(accumulator, "blocks", None), getattr(accumulator, "series", None)
    note = NO_ERROR
    if isinstance(blocks, Blocks):
        if blocks.count < FEWEST_BLOCKS:
            note += f": of {blocks.count} sample{'s' * (blocks.count != 1)}"
    elif isinstance(rows, TimeSeries) and rows.series < FEWEST_BLOCKS:
        runs = "one run" if rows.series == 1 else f"{rows.series} runs"
        note += f": {runs}; --seeds {FEWEST_BLOCKS} or more give one"

    def caveat(c: Comparison) -> str:
        unknown = np.isnan(c.error) and np.isfinite(c.measured) and c.measured % 1 != 0
        return note if unknown else ""

    return _noted(result, caveat)


def _noted(result: Result, caveat: Callable[[Comparison], str]) -> Result:
    """With a caveat behind the note of each comparison; "" adds none."""
    noted = (
        dataclasses.replace(c, note="; ".join(filter(None, [c.note, caveat(c)])))
        for c in result.comparisons
    )
    return dataclasses.replace(result, comparisons=tuple(noted))


def of_relaxations(times: float, runs: int = 1, of: str = "relaxation times") -> str:
    """The caveat of a run of so many relaxation times of what it measures, or of several runs that
    have as many each.

    >>> of_relaxations(2.345)
    'error bar is a lower bound: the run has 2.3 relaxation times'
    >>> of_relaxations(12.0, 8, "stress times")
    'error bar is a lower bound: each run has 12 stress times'
    """
    return f"{LOWER_BOUND}: {'each' if runs > 1 else 'the'} run has {times:.2g} {of}"


def unresolved(blocks: Blocks) -> bool:
    """True if most of the means have few independent pieces.

    >>> noise = np.random.default_rng(1).normal(size=1024)
    >>> series = Blocks(), Blocks()
    >>> for one, other in zip(noise, noise.cumsum()):
    ...     _ = series[0].add(one), series[1].add(other)
    >>> [unresolved(one) for one in series]
    [False, True]
    """
    sums, samples = blocks.sums()
    if len(samples) < 2 * FEWEST_PIECES:
        return False
    residuals = (sums - np.multiply.outer(samples, blocks.mean())) / blocks.count
    error, pieces = correlated(residuals, samples)
    known = error > 0
    return bool(known.any()) and float((pieces[known] < FEWEST_PIECES).mean()) > MOST
