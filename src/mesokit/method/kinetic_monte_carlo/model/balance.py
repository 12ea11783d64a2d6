"""Detailed balance: are the rates of a model in equilibrium with its energy?

On a small patch with random states each move has the rate k(A -> B), summed over all moves from A
to B. In equilibrium k(A -> B)/k(B -> A) is exp(-(E(B) - E(A))/kT).
"""

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch, patch_of
from mesokit.method.kinetic_monte_carlo.model.protocol import Moves

SIDES = {1: 8, 2: 4, 3: 4}  # of a patch, unless the lattice is smaller
SITES = 48  # in all patches together, but at least two patches
TRIED = 2  # moves of each process in a patch
HEIGHTS = 3  # different heights in a patch
CLOSE = 1e-9  # of exponents: rounding


def detailed_balance(case: Case) -> str | None:
    """The process that breaks it, an empty text where it holds, None where it has no meaning:
    without an energy, at kT = 0, or where moves cannot be listed."""
    model, kT = case.lattice.model, getattr(case.lattice.model, "kT", 1.0)
    moves, energy = model.list_moves(case.lattice.lattice), model.energy()
    if kT == 0 or moves is None or energy is None:
        return None
    random = np.random.default_rng(1)
    states = len(model.states()) or HEIGHTS
    size = tuple(min(int(length), SIDES[len(case.box.size)]) for length in case.box.size)
    closed = tuple(axis in case.lattice.ends for axis in case.box.axes)
    sites = int(np.prod(size))
    for _ in range(max(2, SITES // sites)):
        drawn = random.integers(states, size=sites).tolist()
        patch = patch_of(case.lattice.lattice, size, closed, drawn)
        for broken in _broken(energy, moves, patch, kT, random):
            return broken
    return ""


def _broken(
    energy: Callable[[Patch], float], moves: Moves, patch: Patch, kT: float, random: Any
) -> Iterator[str]:
    """Processes whose moves from a patch are not in balance."""
    tried: dict[str, int] = {}
    before = energy(patch)
    for i in random.permutation(len(patch.states)).tolist():
        for name, _, changes in moves.at(patch, i):
            other = patch.after(changes)
            tried[name] = tried.get(name, 0) + 1
            if tried[name] > TRIED or other == patch:
                continue
            forward, back = _rate(moves, patch, other), _rate(moves, other, patch)
            change = (energy(other) - before) / kT
            if back <= 0 or abs(math.log(forward / back) + change) > CLOSE * (1 + abs(change)):
                yield name


def _rate(moves: Moves, patch: Patch, other: Patch) -> float:
    """Rate of all moves from a patch to another."""
    pairs = enumerate(zip(patch.states, other.states, strict=True))
    changed = [i for i, (before, after) in pairs if before != after]
    where = {j for i in changed for j in (i, *patch.near[i]) if j >= 0}
    return sum(
        rate
        for i in sorted(where)
        for _, rate, changes in moves.at(patch, i)
        if patch.after(changes) == other
    )
