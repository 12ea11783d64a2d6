"""A process whose mean, error and correlation are known exactly."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray


def _ar1(steps: int, replicas: int, phi: float, seed: int) -> NDArray[np.float64]:
    """Stationary x' = phi x + noise of unit variance: C(k) = phi^k. (steps, replicas)"""
    rng = np.random.default_rng(seed)
    series = rng.normal(size=(steps, replicas))
    for step in range(1, steps):
        series[step] = phi * series[step - 1] + np.sqrt(1 - phi**2) * series[step]
    return series


@pytest.fixture(scope="session")
def ar1() -> Callable[..., NDArray[np.float64]]:
    return _ar1
