"""Parameters of the loops of rigid grains from the section of a case."""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.case.case import Case
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import Solids
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.contacts.groups import IN_ALL
from mesokit.method.spheres.common.contacts.listed import Listed, Others
from mesokit.method.spheres.common.made import INERTIA, Made
from mesokit.method.spheres.common.walls import opening, other_walls, room_of, surface_rows
from mesokit.method.spheres.rigid import scales
from mesokit.method.spheres.rigid.engine.groups import Law, Motion
from mesokit.method.spheres.rigid.engine.sliding import AtRest, Sliding
from mesokit.method.spheres.rigid.solver.protocol import Sweeping
from mesokit.seam.engine import Array

FINE = 2.0**40  # quanta in a usual impulse and in a usual energy


class RigidSetup(NamedTuple):
    """Parameters of a system of rigid grains: lists; masses, inertia (n,); law, solver; drive of
    plates, see `Plates`; motion; shear of the box; seed."""

    listed: Listed
    masses: Array
    inertia: Array
    law: Law
    solver: Sweeping
    drive: Array
    motion: Motion
    shear: Any
    seed: int


def setup_of(case: Case, made: Made) -> RigidSetup:
    """All parameters of a run."""
    section, box, contact = case.spheres, case.box, case.spheres.contact
    walls, history = surface_rows(case, other_walls(case)), box.history
    own = np.array([_own(case, i, s) for i, s in walls.surfaces], float).reshape(-1, 3)
    listed = Listed(
        tuple(float(length) for length in box.size),
        tuple(room_of(case).closed),
        made.diameters / 2,
        section.skin_of(box, closed_axes(case.walls)),
        IN_ALL,
        6 if contact.rolling > 0 else 3,
        walls.rows,
        own,
        _others(case, made),
    )
    others = () if listed.others is None else tuple(listed.others.own[:, 1])
    bounces = max(contact.restitution, *own[:, 1], *others, 0.0)
    shear: Any = AtRest() if history is None else Sliding(history.kernel(float(box.size[1])))
    return RigidSetup(
        listed,
        made.masses,
        made.inertia,
        _law(case, float(bounces)),
        section.solver.kernel(),
        np.array([_drive(case, made, s) for _, s in walls.surfaces], float).reshape(-1, 3),
        Motion(
            scales.timestep_of(case),
            tuple(map(float, section.gravity or (0.0,) * box.dimension)),
            scales.closing_speed(case),
            0.0,
        ),
        shear,
        case.run.seed,
    )


def _law(case: Case, bounces: float) -> Law:
    contact, step = case.spheres.contact, scales.timestep_of(case)
    turns, speed = 4 * INERTIA[case.box.dimension], scales.largest_speed(case)
    mass = scales.heaviest(case)
    impulse = mass * max(speed, scales.strength_of_gravity(case) * step) or mass
    scale = 2.0 ** math.floor(math.log2(FINE / impulse))
    energy_scale = 2.0 ** math.floor(math.log2(FINE * mass / impulse**2))
    cohesion = contact.cohesion
    return Law(
        contact.friction,
        contact.restitution,
        contact.rolling,
        0.0 if cohesion is None else cohesion.force,
        0.0 if cohesion is None else cohesion.range,
        turns,
        turns / (1 + turns),
        1 / turns,
        case.spheres.push_back,
        bounces,
        1 / scale,
        scale,
        1 / energy_scale,
        energy_scale,
    )


def _others(case: Case, made: Made) -> Others | None:
    """Walls that are no rows, as solids in tables that reach as far as the largest grain."""
    if not (which := other_walls(case)):
        return None
    solids = Solids(case.walls, case.box, only=which)
    skin = case.spheres.skin_of(case.box, closed_axes(case.walls))
    away = float(made.diameters.max()) / 2 + skin
    pairs = zip(solids.walls, solids.bodies, strict=True)
    own = np.array([_own(case, i, body.surface) for i, body in pairs])
    return Others(solids.reaching(away), solids.pattern, own, solids)


def _drive(case: Case, made: Made, surface: Surface) -> tuple[float, float, float]:
    """Inverse mass of a plate that is pushed, 0 of others, its force and its pressure."""
    contact = surface.contact
    if contact is None or (contact.force is None and contact.pressure is None):
        return 0.0, 0.0, 0.0
    mass = float(made.masses.sum()) if contact.mass is None else contact.mass
    return 1 / mass, contact.force or 0.0, contact.pressure or 0.0


def _own(case: Case, i: int, surface: Surface) -> tuple[float, float, float]:
    """Friction and restitution of a surface of wall number i, and the time at which it is taken
    away."""
    contact, law = surface.contact, case.spheres.contact
    restitution = None if contact is None else contact.restitution
    friction = None if contact is None else contact.friction
    return (
        0.0 if surface.rule == "slip" else law.friction if friction is None else friction,
        law.restitution if restitution is None else restitution,
        opening(case, i),
    )
