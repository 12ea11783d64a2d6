"""Where there is room for particles at the start: not in solids, and within the box."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.engine.cpu.numbers import Numbers

Floats = NDArray[np.float64]


def stays_out(numbers: Numbers, clear: float = 0.0) -> Callable[[Floats], NDArray[np.bool_]]:
    """Which of places (..., d) are in the fluid, so far from its surfaces."""
    if numbers.solids is None:
        return lambda places: np.ones(places.shape[:-1], bool)
    if numbers.slit is not None:
        axis, length = AXES.index(numbers.slit.axis), numbers.box[AXES.index(numbers.slit.axis)]
        return lambda places: (places[..., axis] > clear) & (places[..., axis] < length - clear)
    solids, d = numbers.solids, numbers.dimension

    def outside(places: Floats) -> NDArray[np.bool_]:
        inside_box = places.reshape(-1, d).copy()
        good = np.ones(len(inside_box), bool)
        for k, shut in enumerate(numbers.closed):
            x = inside_box[:, k]
            if shut:
                good &= (x > clear) & (x < numbers.box[k] - clear)
            else:
                x -= np.floor(x / numbers.box[k]) * numbers.box[k]
        good[good] = solids.distance(inside_box[good]) >= max(clear, MARGIN)
        return good.reshape(places.shape[:-1])

    return outside


def periods(numbers: Numbers) -> Floats:
    """Lengths of the box, infinite where walls close it."""
    return np.where(numbers.closed, np.inf, numbers.box)
