"""Numbers of pairs of neighbours by their states, of which energies are sums."""

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.method.kinetic_monte_carlo.lattice.grid import neighbour


@kernel
def count_pairs(sites, places, found):
    """Add up, for each site and each direction, the states of the site and of its neighbour;
    `found` (states, states + 1) has those without a neighbour last."""
    missing = found.shape[1] - 1
    for k in range(len(places)):
        i = places[k]
        state = np.int64(sites.states[i])
        for direction in range(sites.grid.neighbours):
            j = neighbour(sites.grid, i, direction)
            found[state, np.int64(sites.states[j]) if j >= 0 else missing] += 1
