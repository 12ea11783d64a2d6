"""Dense, disordered starts: spheres grow while they move (Lubachevsky and Stillinger 1990)."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError, RunError
from mesokit.method.spheres.hard.collision.hard import Constant
from mesokit.method.spheres.hard.engine.collide import Rules
from mesokit.method.spheres.hard.engine.groups import VELOCITY
from mesokit.method.spheres.hard.engine.scatter import scattered
from mesokit.method.spheres.hard.engine.system import Given, System

Array = NDArray[np.float64]
DILUTE = {2: 0.20, 3: 0.10}  # packing fraction of the spheres that begin to grow
SPEED = 0.05  # of growth of a mean diameter, in thermal velocities
IN_WINDOW = 0.05  # relative growth
INSTANT = 1e-12  # of a window
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

    They are put in small, at random, and grow while they fly and collide until they have their
    size. Raises CaseError where there is no room for them.
    """
    d, n = len(size), len(diameters)
    small = min(1.0, (DILUTE[d] / fraction) ** (1 / d))
    places = scattered(size, closed, small * diameters, walls, seed)
    if small == 1.0:
        return places
    growth = SPEED / (small * float(diameters.mean()))
    wall_rules = np.tile([1.0, -1.0, 0.0, 0.0], (len(walls), 1))
    rules = Rules(Constant(1.0), -1.0, 0.0, wall_rules, np.uint64(seed))
    inertia = np.ones(n)
    window = IN_WINDOW / growth
    given = Given(
        size,
        closed,
        (),
        small * diameters,
        np.ones(n),
        inertia,
        walls,
        rules,
        lasting=0.0,
        window=window,
        instant=INSTANT * window,
        growth=growth,
        most=JAMMED / float(diameters.mean()),
    )
    system = System(given)
    v = np.random.default_rng(seed).normal(size=(n, d))
    system.fill(places, v / math.sqrt((v * v).mean()), np.zeros((n, 1 if d == 2 else 3)))
    until = (1 / small - 1) / growth
    windows = math.floor(until / window)
    # Lubachevsky and Stillinger: diameters grow at a constant rate while spheres collide.
    # Collisions with growing spheres add energy, so velocities are scaled back after each window.
    try:
        for k in range(windows):
            system.run_to(k + 1, 0.0)
            _cool(system)
        system.run_to(windows, until - windows * window)
    except RunError:
        raise CaseError(
            f"spheres: they jam before they fill {fraction:.3g} of the box; expected fewer"
        ) from None
    return system.read()[0]


def _cool(system: System) -> None:
    """What growing puts in is taken out."""
    columns = slice(VELOCITY, VELOCITY + system.d)
    v = system.spheres.state[:, columns]
    v /= math.sqrt((v * v).mean())
    system.prepare()
