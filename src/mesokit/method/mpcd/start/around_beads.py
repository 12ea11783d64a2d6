"""The fluid about solutes that act on it by a potential, as it is in equilibrium with them.

An ideal gas has the density exp(-U/kT) about beads at rest: so a particle that was put near a bead
stays with that chance, and is put elsewhere otherwise. Of a well it knows nothing: there the fluid
starts as dense as far away.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.geometry.solids.contact import MARGIN
from mesokit.method.mpcd.start.draws import Draws
from mesokit.method.mpcd.start.room import periods
from mesokit.potential.protocol import Pair
from mesokit.potential.thermal import energies
from mesokit.scalar.random import INITIAL_POSITION

if TYPE_CHECKING:
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers

Floats = NDArray[np.float64]
FIRST_AGAIN = 2**20  # draws of this number and on are of those that were put elsewhere
TRIES = 1000


def out_of_beads(numbers: Numbers, who: NDArray[np.int64], places: Floats, beads: Floats) -> Floats:
    """Places (n, d) of particles with these numbers, those that beads push away drawn again.

    Raises RunError where beads leave no room.
    """
    solutes = numbers.case.solutes
    if solutes is None or solutes.solvent_pair is None or not len(places):
        return places
    random = Draws(numbers.case.run.seed, INITIAL_POSITION, who, FIRST_AGAIN)
    left, kT = np.arange(len(places)), numbers.case.fluid.kT
    for _ in range(TRIES):
        energy = _energy(numbers, places[left], beads, solutes.solvent_pair)
        pushed = random.units(1)[:, 0] >= np.exp(-np.clip(energy / kT, 0.0, None))
        if numbers.solids is not None and numbers.slit is None:
            pushed |= numbers.solids.distance(places[left]) < MARGIN
        if not pushed.any():
            return places
        left, random = left[pushed], random.of(pushed)
        places[left] = random.units(numbers.dimension) * numbers.box
    raise RunError("solutes.solvent_pair: the beads leave no room to the fluid; expected fewer")


def _energy(numbers: Numbers, places: Floats, beads: Floats, pair: Pair) -> Floats:
    """Of each place, by all beads near it."""
    from scipy.spatial import cKDTree

    period = periods(numbers)
    boxes = np.where(np.isfinite(period), period, 0.0)
    inside = [
        np.where(boxes > 0.0, x % np.where(boxes > 0.0, boxes, 1.0), x) for x in (places, beads)
    ]
    trees = [cKDTree(x, boxsize=boxes) for x in inside]
    near = trees[1].sparse_distance_matrix(trees[0], pair.reach, output_type="ndarray")
    near = near[np.lexsort((near["i"], near["j"]))]  # one order, whoever else is asked for
    total = np.zeros(len(places))
    np.add.at(total, near["j"], energies((pair.kernel(),), near["v"]))
    return total
