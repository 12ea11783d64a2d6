"""The first places and velocities of the beads of solutes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.start.conformation import nearest_of
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.growth import grown
from mesokit.method.mpcd.start.room import periods, stays_out
from mesokit.scalar.random import FIRST_BEAD, INITIAL_VELOCITY

if TYPE_CHECKING:
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers
    from mesokit.method.mpcd.solutes import Solutes


def first_beads(
    numbers: Numbers, solutes: Solutes, places: Any, velocities: Any, fluid_is_drawn: bool
) -> tuple[Any, Any, Any]:
    """Places and velocities (beads, d), drawn where there are none, and the drift (d,) to take off.

    Beads are grown where there is room, with thermal velocities. The fluid, if its velocities are
    drawn too, takes part of their momentum, so that the whole is at rest.
    """
    case, drift = numbers.case, np.zeros(numbers.dimension)
    kT = case.fluid.kT
    if places is None:
        clear = nearest_of(solutes.wall.kernel(), kT) if solutes.wall else MARGIN
        room = stays_out(numbers, clear)
        places = grown(solutes, kT, numbers.box, periods(numbers), case.run.seed, room)
    if velocities is None:
        who = np.arange(FIRST_BEAD, FIRST_BEAD + solutes.beads)
        random = Draws(case.run.seed, INITIAL_VELOCITY, who)
        mass = solutes.mass_per_bead()
        velocities = random.normals(numbers.dimension)
        velocities *= np.sqrt(kT / np.asarray(mass))[..., None]
        if fluid_is_drawn:
            one = isinstance(mass, float)
            momentum = mass * velocities.sum(axis=0) if one else mass @ velocities
            drift = momentum / (solutes.total_mass + numbers.total_mass)
            velocities -= drift
            velocities[:, 0] += case.box.first_rate * (places[:, 1] - 0.5 * numbers.box[1])
    return places, velocities, drift
