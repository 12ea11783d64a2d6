"""The terms that reach into the box: of the many images of a solid, most do not."""

from __future__ import annotations

import math

import numpy as np

from mesokit.geometry import primitive
from mesokit.geometry.region import Room, Term
from mesokit.geometry.solids.bodies import REACH
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import seldom
from mesokit.scalar.pointer import address


def reaches(term: Term, room: Room) -> bool:
    """Whether a term is on the list of what is near any cell of the box."""
    clear = np.full(math.prod(room.size), -np.inf)
    size, nothing = tuple(float(length) for length in room.size), np.zeros(1)
    for part in term:
        numbers = np.array(part.numbers)
        samples = nothing if part.samples is None else part.samples
        farthest_out(part.code, part.sign, address(numbers), address(samples), size, clear)
    return bool(clear.min() <= 0.5 * math.sqrt(room.dimension) + REACH)


@seldom
def farthest_out(kind, sign, numbers, samples, size, clear):
    """Raise the clearance of the middle of each cell to that from a part."""
    for cell in range(len(clear)):
        r, rest = size, cell
        for k in range(len(size)):
            length = int(size[k])
            r = with_item(r, k, rest % length + 0.5)
            rest //= length
        clear[cell] = max(clear[cell], sign * primitive.distance(kind, numbers, samples, r))
