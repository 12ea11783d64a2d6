"""The loop over all bonds, angles and pairs of the molecules of a fluid: kicks or virials.

WIDTH molecules lie side by side (see `registers`), so that a link is gone through once for all.
"""

from typing import NamedTuple

from mesokit.method.mpcd.engine.beads.interactions import Virial, of_three, of_two
from mesokit.method.mpcd.engine.beads.registers import WIDTH, bead_at, load_bead, store_bead
from mesokit.method.mpcd.engine.where import where
from mesokit.potential.angle import bend
from mesokit.potential.protocol import breaks, central
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.pointer import word
from mesokit.scalar.vector import added, added_scaled, dot, scaled


class Kick(NamedTuple):
    """Change of the velocities of the beads by the forces between them, kept for a time."""

    factor: float  # time over the mass of a bead


@scalar
def each_link(action, molecule, work, lanes, zero):
    """Apply `action` to all links, in the lanes that hold molecules; true if a bond is broken."""
    bonds, angles, pairs = molecule.number
    broken, at = False, 0
    # Bonds, angles, pairs, in the order of one table. Each link is done for all lanes at once. A
    # lane has its own molecule, so the order of its sums of floats never depends on threads.
    for _ in range(bonds):
        a, b = work[linked(molecule, at, zero)], work[linked(molecule, at + 1, zero)]
        broken |= of_linked(action, molecule.bond, a, b, lanes, zero)
        at += 2
    for _ in range(angles):
        a, b = work[linked(molecule, at, zero)], work[linked(molecule, at + 1, zero)]
        of_angle(molecule.angle, action, a, b, work[linked(molecule, at + 2, zero)], lanes, zero)
        at += 3
    for _ in range(pairs):
        a, b = work[linked(molecule, at, zero)], work[linked(molecule, at + 1, zero)]
        of_pair(molecule.pair, action, a, b, lanes, zero)
        at += 2
    return broken


@scalar
def linked(molecule, at, zero):
    """The slice of the rows of a bead, by its place in the table of links."""
    return bead_at(word(molecule.links, at), zero)


@where(angle=len)
def of_angle(angle, action, a, b, c, lanes, zero):
    """Apply `action` to the angle of beads a, b and c, if there is a potential."""
    (potential,) = angle
    of_angled(action, potential, a, b, c, lanes, zero)


@where(pair=len)
def of_pair(pair, action, a, b, lanes, zero):
    """Apply `action` to the pair of beads a and b, if there is a potential."""
    (potential,) = pair
    of_linked(action, potential, a, b, lanes, zero)


@generic
def of_linked(action, potential, a, b, lanes, zero):
    """Apply `action` to a bond or a pair; true if it is longer than its potential allows."""


@generic
def of_angled(action, potential, a, b, c, lanes, zero):
    """Apply `action` to the angle between the bonds from bead a to b and from b to c."""


@of_linked.register(Kick)
def _(action, potential, a, b, lanes, zero):
    d, broken = len(zero), False
    for i in range(WIDTH):
        separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
        square = dot(separation, separation)
        _, force_over_r = central(potential, square)
        change = scaled(action.factor * force_over_r, separation)
        store_bead(a, i, d, added_scaled(load_bead(a, i, d, zero), -1.0, change))
        store_bead(b, i, d, added(load_bead(b, i, d, zero), change))
        broken |= breaks(potential, square)
    return broken


@of_angled.register(Kick)
def _(action, potential, a, b, c, lanes, zero):
    d = len(zero)
    for i in range(WIDTH):
        middle = load_bead(b, i, 0, zero)
        before = added_scaled(middle, -1.0, load_bead(a, i, 0, zero))
        after = added_scaled(load_bead(c, i, 0, zero), -1.0, middle)
        _, first, last = bend(potential, before, after)
        first, last = scaled(action.factor, first), scaled(action.factor, last)
        store_bead(a, i, d, added(load_bead(a, i, d, zero), first))
        store_bead(b, i, d, added_scaled(load_bead(b, i, d, zero), -1.0, added(first, last)))
        store_bead(c, i, d, added(load_bead(c, i, d, zero), last))


@of_linked.register(Virial)
def _(action, potential, a, b, lanes, zero):
    for i in range(lanes):
        separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
        of_two(action, (), potential, separation, 0, 1)
    return False


@of_angled.register(Virial)
def _(action, potential, a, b, c, lanes, zero):
    for i in range(lanes):
        middle = load_bead(b, i, 0, zero)
        before = added_scaled(middle, -1.0, load_bead(a, i, 0, zero))
        after = added_scaled(load_bead(c, i, 0, zero), -1.0, middle)
        of_three(action, (), potential, before, after, 1)
