"""Bonds that are longer than they can be: noted where they are found, refused after the steps."""

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.scalar.jit import scalar

STEP, FIRST, SECOND = 0, 1, 2  # what is noted, of each thread: its step, or 0, and two beads


@scalar
def note_broken(faults, step, one, other):
    """Note step and beads of the first bond that is longer than it can be (seldom called)."""
    step, one = np.int64(step), np.int64(one)
    earlier = faults[STEP] == 0 or step < faults[STEP]
    if earlier or (step == faults[STEP] and one < faults[FIRST]):
        faults[STEP], faults[FIRST], faults[SECOND] = step, one, np.int64(other)


def first_fault(faults: NDArray[np.int64]) -> tuple[int, int, int] | None:
    """The first of what the threads noted in the last steps: step, and two numbers; else None."""
    noted = faults[faults[:, STEP] > 0]
    return min(map(tuple, noted[:, :3].tolist()), default=None)


def refuse_broken(faults: NDArray[np.int64], longest: float, name: str, advice: str) -> None:
    """Raise RunError if a bond of those, as they are called, was broken in the last steps.

    `faults` has a row for each thread, `longest` is what no bond can reach.
    """
    if found := first_fault(faults):
        step, first, second = found
        raise RunError(
            f"step {step}: the bond of {name} {first} and {second} is longer than the "
            f"{longest:g} that it can be; {advice}"
        )
