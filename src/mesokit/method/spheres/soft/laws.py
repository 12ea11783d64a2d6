"""From the section of a case to the numbers that the loops work with."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import Solids
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.wall.surfaces import other_walls, room_of, surface_rows
from mesokit.method.spheres.soft.checks import rubs
from mesokit.method.spheres.soft.engine.central import Central
from mesokit.method.spheres.soft.engine.contact.force import OWN, Contact
from mesokit.method.spheres.soft.engine.groups import Motion
from mesokit.method.spheres.soft.engine.system import Given, Others
from mesokit.method.spheres.soft.pair.protocol import ContactLaw, damping_ratio
from mesokit.method.spheres.soft.scales import fastest_followed, speed_of_collision, timestep_of
from mesokit.potential.protocol import central

Array = NDArray[np.float64]
PARTS = 2.0**50  # quanta in the force of an overlap of a diameter: beyond it there is room for 2^11
FINEST = 2.0**34  # quanta in the unit of force of a potential
ROOM = 2.0**50  # quanta that one term of a vector loop may be


def given_of(case: Case, made: Made) -> Given:
    """All that does not change in a run."""
    section, box, law = case.spheres, case.box, case.spheres.pair
    touching = isinstance(law, ContactLaw)
    rows, own = _walls(case)
    return Given(
        tuple(float(length) for length in box.size),
        tuple(room_of(case).closed),
        made.diameters / 2 if touching else np.full(len(made.masses), 0.5 * law.reach),
        made.masses,
        made.inertia,
        contact_of(law, law.largest_force(case), _ahead(case))
        if touching
        else central_of(case, law),
        touching,
        law.width(rubs(case)) if touching else 0,
        0.0 if touching else least_distance(law),
        _motion(case),
        rows,
        own,
        case.run.seed,
        section.skin_of(box, closed_axes(case.walls)),
        others_of(case, made),
        fastest_followed(case),
    )


def contact_of(law: ContactLaw, largest: float, ahead: float) -> Contact:
    """A law of contact, from the force of an overlap of a diameter and how far spheres come in half
    a step."""
    scale = 2.0 ** np.floor(np.log2(PARTS / largest))
    return Contact(
        law.normal(),
        law.tangential_stiffness,
        law.tangential_damping,
        law.friction,
        float(law.tangential == "history"),
        law.rolling,
        float(ahead),
        float(1 / scale),
        float(scale),
    )


def _ahead(case: Case) -> float:
    """How far spheres may come nearer in half a step."""
    path = 0.5 * timestep_of(case) * speed_of_collision(case)
    return min(path, 0.25 * case.spheres.skin_of(case.box, closed_axes(case.walls)))


def central_of(case: Case, law: Any) -> Central:
    """A potential; forces are counted in parts of that at the distance of a diameter."""
    scale = 2.0 ** np.floor(np.log2(FINEST / usual_force(law)))
    return Central(law.kernel(), float(1 / scale), float(scale))


def usual_force(law: Any) -> float:
    """A force of the potential that is met everywhere: at 0.95 of the diameter."""
    square = (0.95 * law.diameter) ** 2
    _, force_over_r = central(law.kernel(), square)
    return abs(force_over_r) * law.diameter or 1.0


def least_distance(law: Any) -> float:
    """The distance below which a force has no room in one term of a vector loop."""
    kernel, most = law.kernel(), usual_force(law) * ROOM / FINEST
    distances = np.linspace(1.0, 0.0, 1001)[:-1] * law.diameter
    for distance in distances:
        _, force_over_r = central(kernel, float(distance) ** 2)
        if not abs(force_over_r) * distance < most:
            return float(distance)
    return 0.0


def _motion(case: Case) -> Motion:
    section, box = case.spheres, case.box
    d, step = box.dimension, timestep_of(case)
    gravity = [*section.gravity, 0.0, 0.0, 0.0][:3] if section.gravity else [0.0, 0.0, 0.0]
    bath = section.thermostat
    return Motion(
        float(step),
        (float(gravity[0]), float(gravity[1]), float(gravity[2])),
        1.0 if bath is None else bath.decay(step),
        0.0 if bath is None else bath.held_kT,
        (1.0, 1.0, 1.0 if d == 3 else 0.0),
        (0.0, 0.0, 0.0) if not section.turns else (float(d == 3), float(d == 3), 1.0),
    )


def _walls(case: Case) -> tuple[Array, Array]:
    """Rows of walls, and damping ratio and friction of each: -1, and as of pairs, unless said."""
    found = surface_rows(case, other_walls(case))
    return found.rows, np.array([_own(case, s) for _, s in found.surfaces]).reshape(-1, OWN)


def others_of(case: Case, made: Made) -> Others | None:
    """Walls that are no rows, as solids in tables that reach as far as the largest sphere."""
    if not (which := other_walls(case)):
        return None
    solids = Solids(case.walls, case.box, only=which)
    away = float(made.diameters.max()) / 2 + _ahead(case)
    own = np.array([_own(case, body.surface) for body in solids.bodies])
    return Others(solids.reaching(away), solids.pattern, own, solids)


class SurfacesTaken(NamedTuple):
    """How many surfaces there are, wall by wall, and which of them each row of walls, and then each
    body of the other walls, is (rows + bodies,)."""

    number: int
    place: NDArray[np.int64]


def surfaces_of(case: Case) -> SurfacesTaken:
    """The surfaces of a case."""
    which = other_walls(case)
    rows = surface_rows(case, which)
    wall_of_row = np.array([i for i, _ in rows.surfaces], np.int64)
    walls = np.zeros(len(rows.names), np.int64)
    walls[rows.surface] = wall_of_row
    others = Solids(case.walls, case.box, only=which).walls if which else []
    bodies = np.concatenate([walls, np.array(others, np.int64)])
    rank = np.empty(len(bodies), np.int64)
    rank[np.argsort(bodies, kind="stable")] = np.arange(len(bodies))
    return SurfacesTaken(len(bodies), np.concatenate([rank[rows.surface], rank[len(walls) :]]))


def _own(case: Case, surface: Surface) -> tuple[float, float]:
    contact, law = surface.contact, case.spheres.pair
    restitution = None if contact is None else contact.restitution
    friction = None if contact is None else contact.friction
    usual = law.friction if isinstance(law, ContactLaw) else 0.0
    return (
        -1.0 if restitution is None else damping_ratio(restitution),
        0.0 if surface.rule == "slip" else usual if friction is None else friction,
    )
