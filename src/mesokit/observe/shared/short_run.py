"""Whether a run is too short for its blocks of time: then error bars are lower bounds."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, plateau

FEWEST = 32  # blocks: of fewer chance alone may make errors grow to the end
MOST = 0.5  # of the means of an observable that may have no plateau
NOTE = "error bar is a lower bound: it still grows with the length of blocks of time"
CHI_SQUARE = "chi-square"  # in the name of a number that is one
SAMPLES = 128  # of fewer in a row, blocks of time hardly tell how long they are correlated


def bounded(result: Result, accumulator: Any) -> Result:
    """A result whose comparisons say where blocks of time are shorter than what they average
    remembers, or samples are few, unless their notes have a lower bound already."""
    blocks = getattr(accumulator, "blocks", None)
    if not isinstance(blocks, Blocks):
        return result
    note, few = NOTE if unresolved(blocks) else "", _few(blocks)
    return dataclasses.replace(
        result,
        comparisons=tuple(
            _noted(c, note or (few if CHI_SQUARE in c.what else "")) for c in result.comparisons
        ),
    )


def _noted(comparison: Comparison, note: str) -> Comparison:
    """With a caveat of its error bar, where it has one and no such caveat."""
    if not note or "lower bound" in comparison.note or not comparison.error > 0:
        return comparison
    return dataclasses.replace(comparison, note="; ".join(filter(None, [comparison.note, note])))


def _few(blocks: Blocks) -> str:
    """What to say of a sum over samples that are few, nothing if there are many."""
    if blocks.count >= SAMPLES:
        return ""
    return f"error bar is a lower bound: of {blocks.count} samples, which may be correlated"


def unresolved(blocks: Blocks) -> bool:
    """Whether the errors of most means rise each time that blocks are joined in pairs.

    >>> noise = np.random.default_rng(1).normal(size=1024)
    >>> series = Blocks(), Blocks()
    >>> for one, other in zip(noise, noise.cumsum()):
    ...     _ = series[0].add(one), series[1].add(other)
    >>> [unresolved(one) for one in series]
    [False, True]
    """
    sums, samples = blocks.sums()
    if len(samples) < FEWEST:
        return False
    residuals = (sums - np.multiply.outer(samples, blocks.mean())) / blocks.count
    error, reached = plateau(residuals, samples)
    known = error > 0
    return bool(known.any()) and float((~reached[known]).mean()) > MOST
