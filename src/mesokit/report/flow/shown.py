"""Disks and spheres at one time, as a picture shows them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class Spheres:
    """Spheres at one time.

    Parameters
    ----------
    places: (n, 2) along the axes of the picture.
    depth: (n,) towards the eye, None of disks.
    room: the least and the largest depth.
    diameters: (n,).
    values: (n,) numbers that colours stand for.
    counted: whether these are whole numbers from 0.
    scale: of colours, for the largest number; None where all are alike.
    repeats: vectors (2,) by which all of it repeats, the first of them 0.
    time: of the frame.
    note: what of the box is shown.
    tells: what colours do not show of this time.
    plates: that are not where they are at rest, see `moving_plates`.
    """

    places: Array
    depth: Array | None
    room: tuple[float, float]
    diameters: Array
    values: Array
    counted: bool
    scale: Callable[[float], Any] | None
    repeats: tuple[tuple[float, float], ...]
    time: float
    note: str = ""
    plates: tuple[Any, ...] = ()
    tells: str = ""

    def seen(
        self, low: tuple[float, float], high: tuple[float, float]
    ) -> tuple[NDArray[np.int64], Array]:
        """Rows and places (m, 2) of all that can be seen between two corners, images included."""
        radius = 0.5 * self.diameters[:, None]
        rows, places = [], []
        for shift in self.repeats:
            here = self.places + shift
            inside = ((here + radius > low) & (here - radius < high)).all(axis=1)
            rows.append(np.flatnonzero(inside))
            places.append(here[inside])
        return np.concatenate(rows), np.concatenate(places)
