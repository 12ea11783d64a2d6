"""The energy of solutes in the fluid that they act on, and the faults of their sub-steps."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import lanes_in, share, strip_at, strips_in
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.engine.beads.interactions import first_fault
from mesokit.method.mpcd.engine.beads.neighbours import apart
from mesokit.method.mpcd.engine.beads.state import load_place
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle
from mesokit.method.mpcd.engine.embedded.near import find_beads
from mesokit.method.mpcd.engine.embedded.state import TOO_FAR, TOO_HARD
from mesokit.potential.protocol import central
from mesokit.scalar.fixed_point import quanta, total
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import dot

MOST = 2.0**60  # units of energy of one pair: of particles that overlap it is not exact


def energy_in_fluid(memory: Any) -> float:
    """Potential energy of all beads and particles of the fluid."""
    scale, sums = memory.numbers.units["energy"], np.zeros((memory.strips, 1), np.int64)
    alone = Worker(0, 1, np.zeros(1, np.int64), np.zeros(1, np.int64))
    given = memory.box, memory.solutes, memory.fluid.particles, memory.physics.zero
    sum_energies(alone, np.int64(-1 - memory.step), *given, scale, sums)
    return float(total(sums, scale)[0])


@kernel
def sum_energies(worker, stamp, box, beads, particles, zero, scale, sums):
    """Energy of the particles of each strip, as whole numbers: sums (strips, 1)."""
    (embedded,) = beads.embedded
    find_beads(worker, stamp, box, beads, zero)
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    for s in range(first, last):
        strip = particles.data[strip_at(s, particles.rows)]
        for i in range(lanes_in(particles.filling, s)):
            r = load_particle(strip, i, 0, zero)
            if embedded.marked[cell_index(r, embedded.grid)] == stamp:
                for j in range(len(beads.cell)):
                    sums[s, 0] += energy_units(embedded, beads, box, r, j, scale)


@scalar
def energy_units(embedded, beads, box, r, j, scale):
    """Energy of a particle at r and bead j, in whole units."""
    separation = apart(box, load_place(beads, j, r), r)
    energy, _ = central(embedded.potential, dot(separation, separation))
    return quanta(min(energy, MOST / scale), scale)


def refuse_faults(faults: NDArray[np.int64], skin: float, substeps: int) -> None:
    """Raise RunError if a bead or a particle near one went beyond what sub-steps can follow."""
    if (found := first_fault(faults)) is None:
        return
    step, what, which = found
    if what == TOO_FAR:
        raise RunError(
            f"step {step}: bead {which} went farther than solutes.skin = {skin:g} in a timestep; "
            "expected a larger solutes.skin, heavier beads or a shorter fluid.timestep"
        )
    if what == TOO_HARD:
        raise RunError(
            f"step {step}: a particle of the fluid hit bead {which} too hard for a sub-step; take "
            f"more sub-steps than {substeps} (solutes.substeps), or start without overlaps"
        )
    raise RunError(
        f"step {step}: three times as many particles near the beads as there are in equilibrium; "
        "expected a weaker solutes.solvent_pair, or a fluid that is not so dense there"
    )
