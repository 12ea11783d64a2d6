"""Colours of the states of sites."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray


def colours(number: int) -> Any:
    """A map of so many colours, from light to dark: they differ in grey too."""
    from matplotlib import colormaps

    return colormaps["cividis_r"].resampled(number)


def named_bar(figure: Any, drawn: Any, ax: Any, names: Sequence[str]) -> None:
    """A bar of the colours of states, with their names."""
    bar = figure.colorbar(drawn, ax=ax, ticks=range(len(names)), aspect=30)
    bar.ax.set_yticklabels(names)
    bar.ax.minorticks_off()
    bar.set_label("state")


def deviations(heights: NDArray[np.int64]) -> tuple[NDArray[np.float64], float]:
    """Heights (frames, ...) less the mean of each frame, and the largest size of them, at least 1.

    >>> deviations(np.array([[0, 2], [5, 5]]))[0].tolist()
    [[-1.0, 1.0], [0.0, 0.0]]
    """
    away = heights - heights.mean(axis=tuple(range(1, heights.ndim)), keepdims=True)
    return away, max(1.0, float(abs(away).max()))
