"""What observables of flocks share."""

from __future__ import annotations

import math
from abc import ABC
from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from mesokit.case.component import component
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.seam.observable import Observable

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.flock.noise import Noise
    from mesokit.seam.engine import Array


@component
class FlockObservable(Observable, ABC):
    """Something measured of birds."""

    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError for a case without birds."""
        if not hasattr(case, "flock"):
            raise CaseError("there are no birds; it is for method 'flock'")


def blind(noise: Noise, dimension: int) -> bool:
    """Whether birds fly at random, whatever the others do."""
    if noise.memory(dimension) >= 1e-12:
        return False
    crowd = noise.crowd(dimension, 1)
    return crowd is not None and crowd.many < 1e-12


def all_see_all(case: Case) -> bool:
    """Whether every bird is in reach of every other, wherever they are."""
    shut = closed_axes(case.walls)
    ways = [
        length if axis in shut else 0.5 * length
        for axis, length in zip(case.box.axes, case.box.size, strict=True)
    ]
    return bool(math.hypot(*ways) < case.flock.radius)


def mean_heading(headings: Array) -> tuple[float, Array]:
    """Polar order and the sum of headings (n, d) over their number, (d,)."""
    mean = headings.mean(axis=0)
    return float(np.linalg.norm(mean)), mean


def open_box(case: Case, key: str) -> None:
    """Raise CaseError where solids make the mean density uneven."""
    if case.walls:
        raise CaseError(f"{key}: not among walls, which make the mean density uneven")


def within(values: Sequence[float], least: float, most: float, key: str) -> None:
    """Raise CaseError for a value that is out of range, or said twice."""
    for value in values:
        if not least <= value <= most:
            raise CaseError(f"{key} = {list(values)}: expected from {least:.4g} to {most:.4g}")
    if len(set(values)) < len(values):
        raise CaseError(f"{key} = {list(values)}: expected each once")
