"""Grains in a row that touch one another and are hit: Newton's law for all contacts at once."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import all_positive


def touching_chain(
    velocity: ArrayLike, restitution: float, mass: ArrayLike | None = None
) -> NDArray[np.float64]:
    """Velocities of grains in a row, all touching, after all contacts have acted at once.

    Impulses push only, a contact opens at least e times as fast as it closed before, and one that
    opens faster has no impulse (Moreau 1988): a linear complementarity problem, solved exactly. Of
    N equal grains at rest that one hits at speed 1, it becomes (1 + e)/N - e and all others
    (1 + e)/N: at e = 1, -(N - 2)/N and 2/N. Energy is conserved at e = 1. Real balls collide one
    pair after the other, and only the last flies off: a known artefact of this law.

    Parameters: `velocity` (N,) before, from left to right; `restitution` e from 0 to 1; `mass` of
    each grain, None for equal ones. Raises ValueError for numbers out of range. Source:
    J. J. Moreau, in Nonsmooth Mechanics and Applications (1988); the solution derived here.

    >>> touching_chain([1.0, 0.0, 0.0, 0.0, 0.0], 1.0).round(6).tolist()
    [-0.6, 0.4, 0.4, 0.4, 0.4]
    >>> touching_chain([1.0, 0.0, 0.0, 0.0], 0.0).tolist()
    [0.25, 0.25, 0.25, 0.25]
    """
    before = np.asarray(velocity, float)
    if before.ndim != 1 or before.size < 1 or not np.all(np.isfinite(before)):
        raise ValueError(f"velocity = {velocity!r}: expected finite numbers, one for each grain")
    if not 0 <= restitution <= 1:
        raise ValueError(f"restitution = {restitution!r}: expected a number from 0 to 1")
    weight = np.ones_like(before) if mass is None else np.asarray(mass, float)
    all_positive(mass=weight)
    if weight.shape != before.shape:
        raise ValueError(f"mass of {weight.size} grains: expected {before.size}")
    # Least velocity of each grain to its left neighbour, summed up: without it velocities may not
    # fall to the right.
    least = restitution * np.maximum(-np.diff(before), 0.0)
    offset = np.concatenate([[0.0], np.cumsum(least)])
    return _not_falling(before - offset, weight) + offset


def _not_falling(values: NDArray[np.float64], weight: NDArray[np.float64]) -> NDArray[np.float64]:
    """The nearest sequence that does not fall, in the norm of the weights.

    Impulses between neighbours make the step of least kinetic energy. Grains that press on one
    another move together, with the mean of their values: groups are merged from the left until
    their means rise (the algorithm of pooled adjacent violators).
    """
    groups: list[tuple[float, float, int]] = []
    for value, own in zip(values.tolist(), weight.tolist(), strict=True):
        mean, total, count = value, own, 1
        while groups and groups[-1][0] >= mean:
            left, more, others = groups.pop()
            mean = (mean * total + left * more) / (total + more)
            total, count = total + more, count + others
        groups.append((mean, total, count))
    return np.concatenate([np.full(count, mean) for mean, _, count in groups])
