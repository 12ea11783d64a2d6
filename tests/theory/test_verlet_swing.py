"""How far a spring swings in sub-steps."""

import numpy as np
import pytest

from mesokit import theory


def test_swing_is_that_of_verlet_with_collisions():
    """A spring of which w h = 0.8, moved as in the loops, each flight from a new velocity."""
    h, k, m = 0.4, 12.0, 3.0
    rng = np.random.default_rng(1)
    x, squares = np.zeros(20_000), []
    for flight in range(120):
        v = rng.normal(size=len(x)) / m**0.5
        for _ in range(3):
            v = v - 0.5 * h * k * x / m
            x = x + h * v
            v = v - 0.5 * h * k * x / m
        if flight >= 20:
            squares.append((x**2).mean())
    found = k * np.mean(squares)
    assert theory.verlet_swing(k, h, m) == pytest.approx(1 / 0.84)
    assert found == pytest.approx(1 / 0.84, abs=0.01)
    with pytest.raises(ValueError, match="substep"):
        theory.verlet_swing(k, 1.0, m)
