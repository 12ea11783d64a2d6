"""Spheres at random places, one after the other, none on another (random sequential addition)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.kernels.kernel import kernel
from mesokit.loops.cells import NOWHERE, Grid, cell_around, cell_of, cells_along
from mesokit.loops.neighbours import inverse_lengths, nearest_image
from mesokit.method.spheres.hard.engine.groups import World
from mesokit.method.spheres.hard.engine.motion import entries, put_entries
from mesokit.method.spheres.hard.engine.walls import outward
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, unit, words
from mesokit.scalar.vector import added_scaled, dot

Array = NDArray[np.float64]
PLACES = METHOD + np.uint64(71)  # purpose of the random numbers
TRIES = 100_000  # of one sphere


def scattered(
    size: Sequence[float], closed: Sequence[bool], diameters: Array, walls: Array, seed: int
) -> Array:
    """Places (n, d) for spheres of these diameters (n,). Raises CaseError where one finds none."""
    n, d = len(diameters), len(size)
    lengths = tuple(float(length) for length in size)
    world = World(lengths, inverse_lengths(size, closed), (0.0,) * d, 0.0, walls, 0.0, 0.0)
    most = max(1, int(4 * n ** (1 / d)))
    cells = tuple(min(int(max(1, x // diameters.max())), most) for x in lengths)
    head, following = np.full(cells, -1, np.int32).ravel(), np.zeros(n, np.int32)
    grid = Grid(cells, tuple(c / x for c, x in zip(cells, lengths, strict=True)))
    places = np.zeros((n, d))
    left = add_all(world, grid, head, following, 0.5 * diameters, places, np.uint64(seed))
    if left:
        raise CaseError(
            f"spheres: no room found for {left} of {n} at random places; expected fewer or smaller"
        )
    return places


@kernel
def add_all(world, grid, head, following, radii, places, seed):
    """Place all spheres; returns the number of those that find no place."""
    for i in range(len(radii)):
        found = False
        for attempt in range(TRIES):
            r = drawn(world, seed, i, attempt)
            if fits(world, grid, head, following, radii, places, r, radii[i]):
                put_entries(places, i, 0, r)
                cell = cell_of(grid, r)
                following[i] = head[cell]
                head[cell] = i
                found = True
                break
        if not found:
            return len(radii) - i
    return 0


@scalar
def drawn(world, seed, i, attempt):
    """A place anywhere in the box."""
    r = world.size
    for k in range(len(r)):
        a, b, _, _ = words(Counter(seed, np.uint64(attempt)), PLACES, i, k)
        r = with_item(r, k, unit(a, b) * world.size[k])
    return r


@scalar
def fits(world, grid, head, following, radii, places, r, radius):
    """Whether a sphere at r touches neither a wall nor another."""
    for w in range(len(world.walls)):
        distance, _ = outward(world, w, r)
        if distance < radius:
            return False
    # Cells are as long as the largest diameter, so all that may be touched are in those around.
    here = cells_along(grid, r)
    for n in range(3 ** len(r)):
        cell = cell_around(grid, world, r, here, 0.0, n)
        j = head[cell] if cell != NOWHERE else -1
        while j >= 0:
            apart = nearest_image(world, added_scaled(entries(places, j, 0, r), -1.0, r))
            reach = radius + radii[j]
            if dot(apart, apart) < reach * reach:
                return False
            j = following[j]
    return True
