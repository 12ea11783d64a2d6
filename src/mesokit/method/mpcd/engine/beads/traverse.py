"""The sums over all bonds, angles, pairs and walls of a bead: forces, energies or virials.

Each bead has a sum of its own (see `interactions`), always added up in one order, so that threads
share the beads without sharing sums. Potentials are chosen by kind only where kinds of solutes
differ: with one potential for all nothing is looked up, and none of that is compiled.
"""

from mesokit.method.mpcd.engine.beads.interactions import of_three, of_two, of_wall
from mesokit.method.mpcd.engine.beads.neighbours import CROWDED, apart
from mesokit.method.mpcd.engine.beads.state import AROUND, bead_of, load_place, number_of
from mesokit.method.mpcd.engine.where import where
from mesokit.potential.several import Several, potential_at, row_of
from mesokit.scalar.jit import by_type, elementwise, scalar
from mesokit.scalar.pointer import cell_of_table, entry
from mesokit.scalar.vector import added, added_scaled


@where("0", kinds=len)
def kind_of_bond(kinds, n):
    """The kind of solutes that entry n of `Beads.bonds` belongs to."""
    return entry(kinds.bonds, n)


@where("0", kinds=len)
def kind_of_angle(kinds, n):
    """The same of entry n of `Beads.angles`."""
    return entry(kinds.angles, n)


@where("0", kinds=len)
def kind_of_pair(kinds, i, j):
    """The number of the pair of the kinds of two beads: all with the first, with the second, ..."""
    return entry(kinds.beads, i) * kinds.number + entry(kinds.beads, j)


@by_type
def of_chosen(potential, kind, action, total, separation, i, j):
    """`of_two`, of the potential of that kind."""
    if potential.instance_class is Several:
        return _of_several
    return lambda potential, kind, action, total, separation, i, j: of_two(
        action, total, potential, separation, i, j
    )


def _of_several(potential, kind, action, total, separation, i, j):
    row = row_of(potential, kind)
    if row >= 0:
        return of_two(action, total, potential_at(potential, row), separation, i, j)
    return of_others(potential.others, kind, action, total, separation, i, j)


@where("total", others=len)
def of_others(others, kind, action, total, separation, i, j):
    """`of_chosen`, of the potentials of the other classes; no force where there are none."""
    return of_chosen(others[0], kind, action, total, separation, i, j)


@by_type
def of_chosen_angle(potential, kind, action, total, before, after, role):
    """`of_three`, of the potential of that kind."""
    if potential.instance_class is Several:
        return _of_several_angles
    return lambda potential, kind, action, total, before, after, role: of_three(
        action, total, potential, before, after, role
    )


def _of_several_angles(potential, kind, action, total, before, after, role):
    row = row_of(potential, kind)
    if row >= 0:
        return of_three(action, total, potential_at(potential, row), before, after, role)
    return of_other_angles(potential.others, kind, action, total, before, after, role)


@where("total", others=len)
def of_other_angles(others, kind, action, total, before, after, role):
    """`of_chosen_angle`, of the potentials of the other classes."""
    return of_chosen_angle(others[0], kind, action, total, before, after, role)


@scalar
def each_on_bead(action, total, beads, i, r, box):
    """Add all that acts on bead i at r to the total."""
    given = beads.potentials
    total = each_bond(given.bond, action, total, beads, i, r)
    total = each_angle(given.angle, action, total, beads, i, r)
    total = each_pair(given.pair, action, total, beads, i, r, box)
    return at_wall(given.wall, action, total, beads, r)


@elementwise
def nothing(total):
    """The sum of no parts."""
    return "0.0"


@where("total", bond=len)
def each_bond(bond, action, total, beads, i, r):
    """Add all bonds of bead i."""
    (potential,), part = bond, nothing(total)
    for n in range(entry(beads.bond_starts, i), entry(beads.bond_starts, i + 1)):
        j = entry(beads.bonds, n)
        separation = added_scaled(r, -1.0, load_place(beads, j, r))
        kind = kind_of_bond(beads.kinds, n)
        part = of_chosen(potential, kind, action, part, separation, i, j)
    return added(total, part)


@where("total", angle=len)
def each_angle(angle, action, total, beads, i, r):
    """Add all angles with bead i."""
    (potential,), part = angle, nothing(total)
    for n in range(entry(beads.angle_starts, i), entry(beads.angle_starts, i + 1)):
        a = load_place(beads, cell_of_table(beads.angles, n, 0, 4), r)
        b = load_place(beads, cell_of_table(beads.angles, n, 1, 4), r)
        c = load_place(beads, cell_of_table(beads.angles, n, 2, 4), r)
        before, after = added_scaled(b, -1.0, a), added_scaled(c, -1.0, b)
        kind, role = kind_of_angle(beads.kinds, n), cell_of_table(beads.angles, n, 3, 4)
        part = of_chosen_angle(potential, kind, action, part, before, after, role)
    return added(total, part)


@where("total", pair=len)
def each_pair(pair, action, total, beads, i, r, box):
    """Add all pairs of bead i: those on its list or, if the list is crowded, with all beads."""
    (potential,), (lists,), part = pair, beads.neighbours, nothing(total)
    count, around = entry(lists.count, i), number_of(beads.halo, beads.number, AROUND)
    for n in range(count if count != CROWDED else around):
        j = bead_of(beads.halo, AROUND, n)
        if count != CROWDED:
            j = cell_of_table(lists.near, i, n, lists.most)
        separation = apart(box, load_place(beads, j, r), r)
        kind = kind_of_pair(beads.kinds, i, j)
        part = of_chosen(potential, kind, action, part, separation, i, j)
    return added(total, part)


@where("total", wall=len)
def at_wall(wall, action, total, beads, r):
    """Add the nearest surface."""
    (potential,) = wall
    return of_wall(action, total, potential, beads.near_wall, r)
