"""The choice of the potential of a bond, an angle or a pair where kinds of solutes differ.

Where there is one potential for all nothing is looked up, and none of this is compiled.
"""

from mesokit.method.mpcd.engine.beads.interactions import of_three, of_two
from mesokit.potential.several import Several, potential_at, row_of
from mesokit.scalar.jit import by_type


@by_type
def kind_of_bond(kinds, n):
    """The kind of solutes that entry n of `Beads.bonds` belongs to."""
    return (lambda kinds, n: kinds.bonds[n]) if len(kinds) else (lambda kinds, n: 0)


@by_type
def kind_of_angle(kinds, n):
    """The same of entry n of `Beads.angles`."""
    return (lambda kinds, n: kinds.angles[n]) if len(kinds) else (lambda kinds, n: 0)


@by_type
def kind_of_pair(kinds, i, j):
    """The number of the pair of the kinds of two beads: all with the first, with the second, ..."""
    if len(kinds) == 0:
        return lambda kinds, i, j: 0
    return lambda kinds, i, j: kinds.beads[i] * kinds.number + kinds.beads[j]


@by_type
def of_chosen(potential, kind, asked, total, separation, i, j):
    """`of_two`, of the potential of that kind."""
    if potential.instance_class is Several:
        return _of_several
    return lambda potential, kind, asked, total, separation, i, j: of_two(
        asked, total, potential, separation, i, j
    )


def _of_several(potential, kind, asked, total, separation, i, j):
    row = row_of(potential, kind)
    if row >= 0:
        return of_two(asked, total, potential_at(potential, row), separation, i, j)
    return of_others(potential.others, kind, asked, total, separation, i, j)


@by_type
def of_others(others, kind, asked, total, separation, i, j):
    """`of_chosen`, of the potentials of the other classes; no force where there are none."""
    if len(others) == 0:
        return lambda others, kind, asked, total, separation, i, j: total
    return lambda others, kind, asked, total, separation, i, j: of_chosen(
        others[0], kind, asked, total, separation, i, j
    )


@by_type
def of_chosen_angle(potential, kind, asked, total, before, after, role):
    """`of_three`, of the potential of that kind."""
    if potential.instance_class is Several:
        return _of_several_angles
    return lambda potential, kind, asked, total, before, after, role: of_three(
        asked, total, potential, before, after, role
    )


def _of_several_angles(potential, kind, asked, total, before, after, role):
    row = row_of(potential, kind)
    if row >= 0:
        return of_three(asked, total, potential_at(potential, row), before, after, role)
    return of_other_angles(potential.others, kind, asked, total, before, after, role)


@by_type
def of_other_angles(others, kind, asked, total, before, after, role):
    """`of_chosen_angle`, of the potentials of the other classes."""
    if len(others) == 0:
        return lambda others, kind, asked, total, before, after, role: total
    return lambda others, kind, asked, total, before, after, role: of_chosen_angle(
        others[0], kind, asked, total, before, after, role
    )
