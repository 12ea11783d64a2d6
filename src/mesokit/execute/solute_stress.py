"""What beads of solutes add to the stress: momentum that they carry, and that forces hand over."""

import numpy as np

from mesokit.box import fold, peculiar
from mesokit.execute.forces import add_product
from mesokit.execute.neighbours import CROWDED, apart
from mesokit.execute.rows import fetch
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central
from mesokit.scalar import added, added_scaled, by_type, dot, scalar, scaled


@scalar
def add_flux(solutes, i, box, shift, tensor, like):
    """Sums of m c c (c relative to the imposed flow) and of m v r (r relative to the cell)."""
    at, d, m = np.uint64(i * len(like)), len(like), solutes.mass
    none = scaled(0.0, like)
    r, v, _ = fold(box, fetch(solutes.r, at, like), fetch(solutes.v, at, like), none)
    place, u, _ = fold(box, r, v, shift)
    c, x = peculiar(box, r, v), added(place, shift)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += m * c[j] * c[k]
            tensor[d * d + j * d + k] += m * u[j] * (x[k] - np.floor(x[k]))


@scalar
def add_bead_virial(solutes, i, box, time, tensor, like):
    """The vector between two beads times the impulse on the second in that time, summed over the
    forces that are bead i's to count."""
    r = fetch(solutes.r, np.uint64(i * len(like)), like)
    add_bonds(solutes.potentials.bond, solutes, i, r, time, tensor, like)
    add_angles(solutes.potentials.angle, solutes, i, time, tensor, like)
    add_pairs(solutes.potentials.pair, solutes, i, box, r, time, tensor, like)


@by_type
def add_bonds(bond, solutes, i, r, time, tensor, like):
    """Bonds with beads after it."""
    return _add_bonds if len(bond) else lambda *_: None


def _add_bonds(bond, solutes, i, r, time, tensor, like):
    for n in range(solutes.bond_starts[i], solutes.bond_starts[i + 1]):
        j = solutes.bonds[n]
        if j > i:
            way = added_scaled(fetch(solutes.r, np.uint64(j * len(like)), like), -1.0, r)
            _, push = central(bond[0], dot(way, way))
            add_product(tensor, time * push, way, way)


@by_type
def add_angles(angle, solutes, i, time, tensor, like):
    """Angles in the middle of which it is."""
    return _add_angles if len(angle) else lambda *_: None


def _add_angles(angle, solutes, i, time, tensor, like):
    d = len(like)
    for n in range(solutes.angle_starts[i], solutes.angle_starts[i + 1]):
        if solutes.angles[n, 3] == 1:
            a = fetch(solutes.r, np.uint64(solutes.angles[n, 0] * d), like)
            b = fetch(solutes.r, np.uint64(solutes.angles[n, 1] * d), like)
            c = fetch(solutes.r, np.uint64(solutes.angles[n, 2] * d), like)
            before, after = added_scaled(b, -1.0, a), added_scaled(c, -1.0, b)
            _, first, last = bend(angle[0], before, after)
            add_product(tensor, -time, before, first)
            add_product(tensor, time, after, last)


@by_type
def add_pairs(pair, solutes, i, box, r, time, tensor, like):
    """Pairs with beads after it."""
    return _add_pairs if len(pair) else lambda *_: None


def _add_pairs(pair, solutes, i, box, r, time, tensor, like):
    lists, d = solutes.neighbours[0], len(like)
    count = lists.count[i]
    for n in range(count if count != CROWDED else len(lists.count)):
        j = lists.near[i, n] if count != CROWDED else n
        if j > i:
            way = apart(box, r, fetch(solutes.r, np.uint64(j * d), like))
            _, push = central(pair[0], dot(way, way))
            add_product(tensor, time * push, way, way)
