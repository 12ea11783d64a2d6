"""The sums over all bonds, angles, pairs and walls of a bead: forces, energies or virials.

Each bead has a sum of its own (see `interactions`), always added up in one order, so that threads
share the beads without sharing sums.
"""

from mesokit.method.mpcd.engine.beads.choice import (
    kind_of_angle,
    kind_of_bond,
    kind_of_pair,
    of_chosen,
    of_chosen_angle,
)
from mesokit.method.mpcd.engine.beads.interactions import of_wall
from mesokit.method.mpcd.engine.beads.neighbours import CROWDED, apart
from mesokit.method.mpcd.engine.beads.state import AROUND, bead_of, load_place, number_of
from mesokit.scalar.jit import by_type, elementwise, scalar
from mesokit.scalar.vector import added, added_scaled


@scalar
def each_on_bead(asked, total, beads, i, r, box):
    """Add all that acts on bead i at r to the total."""
    given = beads.potentials
    total = each_bond(given.bond, asked, total, beads, i, r)
    total = each_angle(given.angle, asked, total, beads, i, r)
    total = each_pair(given.pair, asked, total, beads, i, r, box)
    return at_wall(given.wall, asked, total, beads, r)


@elementwise
def nothing(total):
    """The sum of no parts."""
    return "0.0"


@by_type
def each_bond(bond, asked, total, beads, i, r):
    """Add all bonds of bead i."""
    return _each_bond if len(bond) else lambda bond, asked, total, beads, i, r: total


def _each_bond(bond, asked, total, beads, i, r):
    (potential,), part = bond, nothing(total)
    for n in range(beads.bond_starts[i], beads.bond_starts[i + 1]):
        j = beads.bonds[n]
        separation = added_scaled(r, -1.0, load_place(beads, j, r))
        kind = kind_of_bond(beads.kinds, n)
        part = of_chosen(potential, kind, asked, part, separation, i, j)
    return added(total, part)


@by_type
def each_angle(angle, asked, total, beads, i, r):
    """Add all angles with bead i."""
    return _each_angle if len(angle) else lambda angle, asked, total, beads, i, r: total


def _each_angle(angle, asked, total, beads, i, r):
    (potential,), part = angle, nothing(total)
    for n in range(beads.angle_starts[i], beads.angle_starts[i + 1]):
        a = load_place(beads, beads.angles[n, 0], r)
        b = load_place(beads, beads.angles[n, 1], r)
        c = load_place(beads, beads.angles[n, 2], r)
        before, after = added_scaled(b, -1.0, a), added_scaled(c, -1.0, b)
        kind, role = kind_of_angle(beads.kinds, n), beads.angles[n, 3]
        part = of_chosen_angle(potential, kind, asked, part, before, after, role)
    return added(total, part)


@by_type
def each_pair(pair, asked, total, beads, i, r, box):
    """Add all pairs of bead i: those on its list or, if the list is crowded, with all beads."""
    return _each_pair if len(pair) else lambda pair, asked, total, beads, i, r, box: total


def _each_pair(pair, asked, total, beads, i, r, box):
    (potential,), (lists,), part = pair, beads.neighbours, nothing(total)
    count, around = lists.count[i], number_of(beads.halo, len(lists.count), AROUND)
    for n in range(count if count != CROWDED else around):
        j = lists.near[i, n] if count != CROWDED else bead_of(beads.halo, AROUND, n)
        separation = apart(box, load_place(beads, j, r), r)
        kind = kind_of_pair(beads.kinds, i, j)
        part = of_chosen(potential, kind, asked, part, separation, i, j)
    return added(total, part)


@by_type
def at_wall(wall, asked, total, beads, r):
    """Add the nearest surface."""
    return _at_wall if len(wall) else lambda wall, asked, total, beads, r: total


def _at_wall(wall, asked, total, beads, r):
    (potential,) = wall
    return of_wall(asked, total, potential, beads.near_wall, r)
