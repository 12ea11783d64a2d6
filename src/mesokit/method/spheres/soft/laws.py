"""Parameters of the loops of soft spheres from the section of a case."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import Solids
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.checks import rubs
from mesokit.method.spheres.common.contacts.listed import Others
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.walls import opening, other_walls, room_of, surface_rows
from mesokit.method.spheres.soft.engine.central import Central
from mesokit.method.spheres.soft.engine.contact.force import OWN, Contact
from mesokit.method.spheres.soft.engine.groups import Motion
from mesokit.method.spheres.soft.engine.system import SoftSetup
from mesokit.method.spheres.soft.pair.protocol import ContactLaw, damping_ratio
from mesokit.method.spheres.soft.scales import fastest_followed, speed_of_collision, timestep_of
from mesokit.potential.protocol import central

PARTS = 2.0**50  # quanta in the force at an overlap of a diameter; sums may be 2^11 times larger
FINEST = 2.0**34  # quanta in the usual force of a potential
ROOM = 2.0**50  # largest number of quanta in one term of a vector loop


def given_of(case: Case, made: Made) -> SoftSetup:
    """All parameters of a run."""
    section, box, law = case.spheres, case.box, case.spheres.pair
    touching, walls = isinstance(law, ContactLaw), surface_rows(case, other_walls(case))
    bath, step, d = section.thermostat, timestep_of(case), box.dimension
    if touching:
        reach, width, nearest = made.diameters / 2, law.width(rubs(case)), 0.0
        forces: Any = contact_of(law, law.largest_force(case), _ahead(case))
    else:
        reach, width = np.full(len(made.masses), 0.5 * law.reach), 0
        forces, nearest = central_of(law), least_distance(law)
    turns = (float(d == 3), float(d == 3), 1.0) if section.turns else (0.0, 0.0, 0.0)
    motion = Motion(
        float(step),
        three_axes(section.gravity),
        1.0 if bath is None else bath.decay(step),
        0.0 if bath is None else bath.held_kT,
        (1.0, 1.0, float(d == 3)),
        turns,
    )
    return SoftSetup(
        tuple(float(length) for length in box.size),
        tuple(room_of(case).closed),
        reach,
        made.masses,
        made.inertia,
        forces,
        touching,
        width,
        nearest,
        motion,
        walls.rows,
        np.array([_own(case, i, s) for i, s in walls.surfaces]).reshape(-1, OWN),
        case.run.seed,
        section.skin_of(box, closed_axes(case.walls)),
        others_of(case, made),
        fastest_followed(case),
    )


def contact_of(law: ContactLaw, largest: float, ahead: float) -> Contact:
    """A law of contact; largest: force at an overlap of a diameter; ahead: approach of spheres in
    half a step."""
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
    """The largest approach of two spheres in half a step."""
    path = 0.5 * timestep_of(case) * speed_of_collision(case)
    return min(path, 0.25 * case.spheres.skin_of(case.box, closed_axes(case.walls)))


def central_of(law: Any) -> Central:
    """A potential; forces are counted in parts of that at the distance of a diameter."""
    scale = 2.0 ** np.floor(np.log2(FINEST / usual_force(law)))
    return Central(law.kernel(), float(1 / scale), float(scale))


def usual_force(law: Any) -> float:
    """A force of the potential that is usual in a fluid: at 0.95 of the diameter."""
    _, force_over_r = central(law.kernel(), (0.95 * law.diameter) ** 2)
    return abs(force_over_r) * law.diameter or 1.0


def least_distance(law: Any) -> float:
    """The distance below which a force is too large for one term of a vector loop."""
    kernel, most = law.kernel(), usual_force(law) * ROOM / FINEST
    for distance in np.linspace(1.0, 0.0, 1001)[:-1] * law.diameter:
        _, force_over_r = central(kernel, float(distance) ** 2)
        if not abs(force_over_r) * distance < most:
            return float(distance)
    return 0.0


def three_axes(gravity: Sequence[float]) -> tuple[float, float, float]:
    """An acceleration along three axes; () is none."""
    x, y, z = [*map(float, gravity), 0.0, 0.0, 0.0][:3]
    return x, y, z


def others_of(case: Case, made: Made) -> Others | None:
    """Walls that are no rows, as solids in tables that reach as far as the largest sphere."""
    if not (which := other_walls(case)):
        return None
    solids = Solids(case.walls, case.box, only=which)
    away = float(made.diameters.max()) / 2 + _ahead(case)
    pairs = zip(solids.walls, solids.bodies, strict=True)
    own = np.array([_own(case, i, body.surface) for i, body in pairs])
    return Others(solids.reaching(away), solids.pattern, own, solids)


def _own(case: Case, i: int, surface: Surface) -> tuple[float, float, float]:
    """Damping ratio (-1: as of pairs) and friction of a surface of wall number i, and the time at
    which it is taken away."""
    contact, law = surface.contact, case.spheres.pair
    restitution = None if contact is None else contact.restitution
    friction = None if contact is None else contact.friction
    usual = law.friction if isinstance(law, ContactLaw) else 0.0
    return (
        -1.0 if restitution is None else damping_ratio(restitution),
        0.0 if surface.rule == "slip" else usual if friction is None else friction,
        opening(case, i),
    )
