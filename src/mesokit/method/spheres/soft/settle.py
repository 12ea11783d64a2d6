"""Poured starts: spheres fall, collide and come to rest."""

import math

import numpy as np

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import Solids
from mesokit.method.spheres.common.contacts.groups import INVERSE
from mesokit.method.spheres.common.contacts.listed import Others
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.walls import (
    AMPLITUDE,
    MOVES,
    SPEED,
    other_walls,
    room_of,
    surface_rows,
)
from mesokit.method.spheres.soft.engine.groups import Motion
from mesokit.method.spheres.soft.engine.system import SoftSetup, SoftSystem
from mesokit.method.spheres.soft.laws import contact_of, three_axes
from mesokit.method.spheres.soft.pair.spring_dashpot import SpringDashpot
from mesokit.seam.engine import Array

RESTITUTION = 0.3  # low, so that they soon lie
SOFT = 1e-3  # overlap of the lowest, in diameters, under a column as high as the box
IN_CONTACT = 20  # steps: single collisions do not matter
SKIN = 0.15  # of the largest diameter
LOOK = 2000  # steps between two checks of rest
QUIET = 1e-5  # kinetic energy of the fastest over its weight times a diameter: at rest
MOST_FALLS = 400  # times that a fall through the box takes


def settled(case: Case, made: Made, places: Array, friction: float) -> Array:
    """Places (n, d) of spheres that have fallen from places (n, d) and lie still.

    Contacts are springs and dashpots of the stiffness of the case, or stiff ones. Walls are rough
    and at rest. Raises CaseError where spheres do not come to rest.
    """
    size, gravity = case.box.size, case.spheres.gravity
    walls, (n, d) = surface_rows(case, other_walls(case)).rows, places.shape
    others = _others(case, made, friction)
    g = math.hypot(*gravity)
    height = math.fsum(abs(a) / g * length for a, length in zip(gravity, size, strict=True))
    largest, mass = float(made.diameters.max()), float(made.masses.max())
    pair = getattr(case.spheres, "pair", None)
    if isinstance(pair, SpringDashpot):
        stiffness, _ = pair.constants(0.5 * mass)
    else:
        stiffness = mass * g * (height / largest) / (SOFT * largest)
    law = SpringDashpot(restitution=RESTITUTION, stiffness=stiffness, friction=friction)
    step = law.contact_time_of(0.5 * float(made.masses.min()), 1.0) / IN_CONTACT
    still = walls.copy()
    still[:, AMPLITUDE] = still[:, SPEED] = still[:, MOVES : MOVES + 3] = 0.0
    own = np.tile([-1.0, friction, math.inf], (len(walls), 1))
    turns = (float(d == 3), float(d == 3), 1.0)
    setup = SoftSetup(
        tuple(float(length) for length in size),
        tuple(room_of(case).closed),
        made.diameters / 2,
        made.masses,
        made.inertia,
        contact_of(law, stiffness * largest, 0.0),
        True,
        law.width(rubs=friction > 0),
        0.0,
        Motion(step, three_axes(gravity), 1.0, 0.0, (1.0, 1.0, float(d == 3)), turns),
        still,
        own,
        0,
        SKIN * largest,
        others,
    )
    system = SoftSystem(setup, threads=1)
    system.fill(places, np.zeros((n, d)), np.zeros(n if d == 2 else (n, 3)))
    system.find_forces(0.0)
    done, fall = 0, math.sqrt(2 * height / g)
    # Steps of the dissipative dynamics until the largest kinetic energy is below a small part of
    # m g d, but not before the time of a free fall through the box: at the top all are slow.
    while done * step < MOST_FALLS * fall:
        system.run(done, LOOK)
        done += LOOK
        v = system.bodies.velocity
        fastest = float(((v[:, :3] ** 2).sum(axis=1) / v[:, INVERSE]).max())
        if done * step > fall and 0.5 * fastest < QUIET * mass * g * largest:
            found = system.by_number(system.bodies.place[:, :d])
            return found + system.by_number(system.bodies.images[:, :d]) * np.array(size)
    raise CaseError(
        "spheres.start: rule = 'poured': they do not come to rest; expected walls that hold them"
    )


def _others(case: Case, made: Made, friction: float) -> Others | None:
    """Walls that are no rows, rough and at rest."""
    if not (which := other_walls(case)):
        return None
    solids = Solids(case.walls, case.box, only=which)
    own = np.tile([-1.0, friction, math.inf], (len(solids.bodies), 1))
    away = (0.5 + SKIN) * float(made.diameters.max())
    return Others(solids.reaching(away), solids.pattern, own, solids)
