"""The memory of a halo of beads, and the reach of solutes beyond a block."""

import math
from typing import Any

import numpy as np

from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.domains.beads.halo import Halo
from mesokit.method.mpcd.engine.domains.messages.mpi import post
from mesokit.method.mpcd.solutes import Solutes
from mesokit.potential.thermal import mean_square

FAST = 9.0  # thermal speeds: no bead is faster
WIDE = 3.5  # root-mean-square lengths: no bond that has no longest one is longer
LEAST = 0.5  # cells that a bead may always go in a step


def path_in_a_step(numbers: Numbers, given: Solutes) -> float:
    """The longest path of a bead in a timestep."""
    fluid = numbers.case.fluid
    lightest = min(given.mass_of(kind) for kind in range(len(given.polymers)))
    return max(FAST * math.sqrt(fluid.kT / lightest) * fluid.timestep, LEAST)


def reach_of_beads(numbers: Numbers, given: Solutes) -> float:
    """The distance from a block within which beads act on those in it."""
    reach = max((pair.reach + given.skin for pair in given.different_pairs), default=0.0)
    for kind in range(len(given.polymers)):
        molecule = given.molecule(kind)
        if molecule is not None:
            longest, d = molecule.bond.longest, numbers.dimension
            kernels = molecule.bond_potentials
            size = math.sqrt(mean_square(kernels, d, numbers.case.fluid.kT, longest))
            bonds = 2.0 if molecule.bending is not None else 1.0
            reach = max(reach, bonds * min(longest, WIDE * size))
    return reach + 2.0 * path_in_a_step(numbers, given)


def halo_of(domain: Any, given: Solutes, terms: int) -> Halo:
    """A halo without beads, with room for all; `domain` is the `Domain` of the rank."""
    numbers, q, beads = domain.numbers, max(len(domain.partners), 1), given.beads
    d = numbers.dimension

    def whole(*shape: int) -> Any:
        return np.zeros(shape, np.int64)

    return Halo(
        post=post(domain.comm, 2 * q, domain.crowded),
        ranks=np.array(domain.partners, np.int64),
        count=whole(8),
        numbers=whole(3, beads),
        seen=np.full(beads, -9, np.int64),
        began=np.zeros(beads * d),
        reach=reach_of_beads(numbers, given),
        most=path_in_a_step(numbers, given) ** 2,
        copies_out=whole(q),
        copies_in=whole(q),
        ids_out=whole(q, beads),
        ids_in=whole(q, beads),
        remote=whole(q),
        remote_ids=whole(q, beads),
        remote_cells=whole(q, beads),
        out=np.zeros((q, 1 + beads, 1 + 2 * d)),
        into=np.zeros((q, 1 + beads, 1 + 2 * d)),
        terms_out=np.zeros((q, 1 + beads, 2 + terms)),
        terms_in=np.zeros((q, 1 + beads, 2 + terms)),
        slot=domain.region.number + 1 + domain.slots - beads,
        slides=float(domain.space.slides),
        wraps=tuple(float(wraps) for wraps in domain.space.wraps),
    )
