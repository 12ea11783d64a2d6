"""Dense, disordered starts: small spheres at random places grow while they move.

Random sequential addition, then the algorithm of Lubachevsky and Stillinger (1990).
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mesokit.errors import CaseError, RunError
from mesokit.kernels.kernel import kernel
from mesokit.loops.cells import NOWHERE, Grid, cell_after, cell_of, cells_along, row_around
from mesokit.loops.neighbours import inverse_lengths, nearest_image
from mesokit.method.spheres.common.walls import entries, outward
from mesokit.method.spheres.hard.collision.hard import Constant
from mesokit.method.spheres.hard.engine.collide import Rules
from mesokit.method.spheres.hard.engine.groups import VELOCITY, HardWorld
from mesokit.method.spheres.hard.engine.motion import put_entries
from mesokit.method.spheres.hard.engine.system import Collapse, HardSetup, HardSystem
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, unit, words
from mesokit.scalar.vector import added_scaled, dot
from mesokit.seam.engine import Array

PLACES = METHOD + np.uint64(71)  # purpose of the random numbers
TRIES = 100_000  # places that are drawn for one sphere
DILUTE = {2: 0.20, 3: 0.10}  # packing fraction of the spheres that begin to grow
SPEED = 0.05  # of growth of a mean diameter, in thermal velocities
IN_WINDOW = 0.05  # relative growth
INSTANT = 1e-12  # of a window
ATTEMPTS = 4  # with other velocities
JAMMED = 1e5  # events of each in the time in which it flies a diameter


def grown(
    size: Sequence[float],
    closed: Sequence[bool],
    diameters: Array,
    walls: Array,
    fraction: float,
    seed: int,
) -> Array:
    """Places (n, d) of spheres of these diameters (n,), none on another.

    Small spheres are placed at random and grow while they fly and collide. Raises CaseError where
    there is no room for them.
    """
    d = len(size)
    small = min(1.0, (DILUTE[d] / fraction) ** (1 / d))
    places = scattered(size, closed, small * diameters, walls, seed)
    if small == 1.0:
        return places
    # Rounding may make two that grow in touch collide without end; other velocities part them.
    for attempt in range(ATTEMPTS):
        random = np.random.default_rng(seed if attempt == 0 else [seed, attempt])
        try:
            return _grow(size, closed, diameters, walls, small, places, seed, random)
        except Collapse:
            pass
        except RunError:
            break
    raise CaseError(f"spheres: they jam before they fill {fraction:.3g} of the box; expected fewer")


def _grow(
    size: Sequence[float],
    closed: Sequence[bool],
    diameters: Array,
    walls: Array,
    small: float,
    places: Array,
    seed: int,
    random: np.random.Generator,
) -> Array:
    """Places of spheres that have grown from `small` diameters, and collided. Raises RunError."""
    n, d = places.shape
    growth = SPEED / (small * float(diameters.mean()))
    window, ones = IN_WINDOW / growth, np.ones(n)
    smooth = np.tile([1.0, -1.0, 0.0, 0.0], (len(walls), 1))
    rules = Rules(Constant(1.0), -1.0, 0.0, smooth, np.uint64(seed))
    most = JAMMED / float(diameters.mean())
    bodies = small * diameters, ones, ones
    times: dict[str, Any] = {"lasting": 0.0, "window": window, "instant": INSTANT * window}
    setup = HardSetup(size, closed, (), *bodies, walls, rules, **times, growth=growth, most=most)
    system, v = HardSystem(setup), random.normal(size=(n, d))
    system.fill(places, v / math.sqrt((v * v).mean()), np.zeros((n, 1 if d == 2 else 3)))
    until = (1 / small - 1) / growth
    windows = math.floor(until / window)
    # Diameters grow at a constant rate while spheres collide, window after window. Collisions of
    # growing spheres add energy, so velocities are scaled back after each window.
    for k in range(windows):
        system.run_to(k + 1, 0.0)
        v = system.spheres.state[:, VELOCITY : VELOCITY + d]
        v /= math.sqrt((v * v).mean())
        system.prepare()
    system.run_to(windows, until - windows * window)
    return system.read()[0]


def scattered(
    size: Sequence[float], closed: Sequence[bool], diameters: Array, walls: Array, seed: int
) -> Array:
    """Places (n, d) for spheres of these diameters (n,). Raises CaseError where one finds none."""
    n, d = len(diameters), len(size)
    lengths = tuple(float(length) for length in size)
    world = HardWorld(lengths, inverse_lengths(size, closed), (0.0,) * d, 0.0, walls, 0.0, 0.0)
    most = max(1, int(4 * n ** (1 / d)))
    cells = tuple(min(int(max(1, x // diameters.max())), most) for x in lengths)
    grid = Grid(cells, tuple(c / x for c, x in zip(cells, lengths, strict=True)))
    head, following = np.full(cells, -1, np.int32).ravel(), np.zeros(n, np.int32)
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
    # Random sequential addition: each sphere draws places until one is free of all before it, which
    # are linked in cells at least as long as the largest diameter.
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
        distance, _ = outward(world.walls, w, world, r)
        if distance < radius:
            return False
    # Cells are as long as the largest diameter, so a sphere touches only those in cells around it.
    here = cells_along(grid, r)
    for n in range(3 ** (len(r) - 1)):
        row, middle = row_around(grid, world, r, here, 0.0, n)
        for a in range(-1, 2 if row != NOWHERE else -1):
            along_x = cell_after(grid, world, 0, middle, a)
            j = head[row + along_x] if along_x != NOWHERE else -1
            while j >= 0:
                apart = nearest_image(world, added_scaled(entries(places, j, 0, r), -1.0, r))
                reach = radius + radii[j]
                if dot(apart, apart) < reach * reach:
                    return False
                j = following[j]
    return True
