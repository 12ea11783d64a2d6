"""A few sites in plain Python, on which moves can be listed one by one."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind

MISSING = -1  # in place of a neighbour beyond the end of a lattice


class Patch(NamedTuple):
    """States of some sites, and the neighbours of each, by direction; MISSING where there is none.

    >>> from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
    >>> patch_of(KINDS["chain"], (3,), (True,), [0, 1, 1]).near
    ((1, -1), (2, 0), (-1, 1))
    """

    states: tuple[int, ...]
    near: tuple[tuple[int, ...], ...]

    def around(self, i: int, missing: int) -> list[int]:
        """States of the neighbours of a site, by direction; `missing` where there is none."""
        return [missing if j == MISSING else self.states[j] for j in self.near[i]]

    def after(self, changes: Sequence[tuple[int, int]]) -> "Patch":
        """The patch after some sites have changed to new states."""
        states = list(self.states)
        for site, new in changes:
            states[site] = new
        return Patch(tuple(states), self.near)


def neighbours_of(
    kind: Kind, size: tuple[int, ...], closed: tuple[bool, ...], sites: np.ndarray
) -> np.ndarray:
    """Numbers (n, neighbours) of the sites beside those with some numbers (n,)."""
    r = np.array(np.unravel_index(sites, size)).T
    found = r[:, None, :] + kind.shifts[(r @ np.array(kind.parity)) % 2]
    outside = ((found < 0) | (found >= np.array(size))) & np.array(closed)
    found = np.ravel_multi_index(tuple(np.moveaxis(found, -1, 0)), size, mode="wrap")
    return np.where(outside.any(axis=-1), MISSING, found)


def patch_of(
    kind: Kind, size: tuple[int, ...], closed: tuple[bool, ...], states: Sequence[int]
) -> Patch:
    """A small lattice as a patch, with its states (n,) by number."""
    near = neighbours_of(kind, size, closed, np.arange(int(np.prod(size))))
    return Patch(tuple(map(int, states)), tuple(tuple(map(int, row)) for row in near))
