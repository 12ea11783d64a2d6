"""States of sites as numbers that are correlated or transformed: one field for each state."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.seam.estimate import Estimate

Array = NDArray[np.floating[Any]]


def states_of(case: Case, state: str | None) -> list[int]:
    """Numbers of the states whose sites count: one, or all; none of heights. Raises CaseError.

    Of two states one is enough: the other is what is left.
    """
    names = case.lattice.model.states()
    if state is None:
        return list(range(len(names)))[len(names) == 2 :]
    return [state_number(case, state)]


def state_number(case: Case, state: str) -> int:
    """The number of a state. Raises CaseError for a name that is none."""
    names = case.lattice.model.states()
    if not names:
        raise CaseError(f"state = {show(state)}: heights have no names; leave it out")
    if state not in names:
        raise CaseError(f"state = {show(state)}: expected {one_of(names)}{nearest(state, names)}")
    return int(names.index(state))


def fields_of(sites: NDArray[np.integer], states: list[int]) -> list[Array]:
    """1 where a site is in a state and 0 elsewhere, for each of the states; without any, heights
    from their mean."""
    if states:
        return [(sites == state).astype(float) for state in states]
    heights = sites.astype(float)
    return [heights - heights.mean()]


def relative(means: Estimate, rows: int, connected: bool) -> Estimate:
    """The first rows of a mean over the variance of a site; the others are parts p of the sites.

    The variance is the sum of p (1 - p). `connected`: the sum of p^2, which sites that are
    independent have together, is subtracted first.
    """
    value, p = means.value[:rows], means.value[rows:]
    together, variance = float((p**2).sum()), float((p * (1 - p)).sum())
    if not variance > 0:
        return means.part(slice(rows))._replace(value=np.full(rows, np.nan))
    found = (value - connected * together) / variance
    slope = np.zeros((rows, len(means.value)))
    slope[:, :rows] = np.eye(rows) / variance
    slope[:, rows:] = -(2 * connected * p + np.multiply.outer(found, 1 - 2 * p)) / variance
    return means.linear(slope)._replace(value=found)
