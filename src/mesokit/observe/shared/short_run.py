"""Whether a run is too short for its blocks of time: then error bars are lower bounds."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from mesokit.seam.result import Result
from mesokit.statistics import Blocks, plateau

FEWEST = 32  # blocks: of fewer chance alone may make errors grow to the end
MOST = 0.5  # of the means of an observable that may have no plateau
NOTE = "error bar is a lower bound: it still grows with the length of blocks of time"


def bounded(result: Result, accumulator: Any) -> Result:
    """A result whose comparisons say where blocks of time are shorter than what they average
    remembers, unless their notes have a lower bound already."""
    blocks = getattr(accumulator, "blocks", None)
    if not isinstance(blocks, Blocks) or not unresolved(blocks):
        return result
    comparisons = tuple(
        c
        if "lower bound" in c.note or not c.error > 0
        else dataclasses.replace(c, note="; ".join(filter(None, [c.note, NOTE])))
        for c in result.comparisons
    )
    return dataclasses.replace(result, comparisons=comparisons)


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
