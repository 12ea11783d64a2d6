"""Positions to start from that lie outside of the box."""

import warnings
from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Box
from mesokit.case.component import show

ROUNDING = 1e-5  # of the box: files keep places as float32


def warn_outside(
    key: str, positions: NDArray[Any], box: Box, without: Collection[str] = (), first: int = 0
) -> None:
    """Warn of positions (n, d) outside of a box, whose images in it are taken.

    `without`: axes along which there are no images. `first` is the number of the first row.
    """
    size = np.array(box.size, float)
    beyond = (positions < -ROUNDING * size) | (positions > (1 + ROUNDING) * size)
    beyond[:, [axis in without for axis in box.axes]] = False
    outside = np.asarray(beyond.any(axis=1))
    if outside.any():
        row = int(np.argmax(outside))
        warnings.warn(
            f"{key}: {int(outside.sum())} of {len(outside)} lie outside of the box, such as row "
            f"{first + row} = {positions[row].tolist()} in {show(list(box.size))}; their images in "
            "it are taken",
            stacklevel=2,
        )
