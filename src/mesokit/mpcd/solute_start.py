"""The first places and velocities of the beads of solutes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.geometry.contact import MARGIN
from mesokit.mpcd.conformation import nearest_of
from mesokit.mpcd.growth import grown
from mesokit.random import INITIAL_SOLUTES

if TYPE_CHECKING:
    from mesokit.execute.cpu import CPU
    from mesokit.mpcd.solutes import Solutes


def start_solutes(
    cpu: CPU, solutes: Solutes, places: Any, velocities: Any, fluid_is_drawn: bool
) -> None:
    """Give beads the places and velocities (beads, d) or, where there are none, draw them.

    They are grown where there is room, with thermal velocities. The fluid, if its velocities are
    drawn too, takes part of their momentum, so that the whole is at rest.
    """
    assert cpu.dissolved is not None
    case, d, beads = cpu.case, cpu.dimension, cpu.dissolved
    random = np.random.Generator(np.random.Philox(key=(case.run.seed, int(INITIAL_SOLUTES))))
    kT = case.fluid.kT
    if places is None:
        from mesokit.mpcd.initial import periods, stays_out

        clear = nearest_of(solutes.wall.kernel(), kT) if solutes.wall else MARGIN
        room = stays_out(cpu, clear)
        places = grown(solutes, kT, cpu.box, periods(cpu), random, room)
    beads.places[:] = places
    if velocities is None:
        velocities = np.sqrt(kT / solutes.mass) * random.standard_normal(beads.shape)
        if fluid_is_drawn:
            momentum = solutes.mass * velocities.sum(axis=0)
            drift = momentum / (solutes.mass * len(velocities) + cpu.masses().sum())
            velocities -= drift
            for k in range(d):
                cpu.row(d + k)[...] -= drift[k]
            velocities[:, 0] += case.box.shear_rate * (beads.places[:, 1] - 0.5 * cpu.box[1])
    beads.velocities[:] = velocities
    beads.forget_lists()
