"""The loop over all bonds, angles and pairs of the molecules of a fluid: kicks or virials.

In registers some molecules lie side by side, so that a link is gone through once for all of them.
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
    """Apply `action` to all links, in the lanes that hold molecules; true if a bond is broken.

    `work` is memory in which beads are found by their numbers in a molecule.
    """
    bonds, angles, pairs = molecule.number
    broken, at = False, 0
    # Bonds, angles, pairs, in the order of one table. Each link is done for all lanes at once. A
    # lane has its own molecule, so the order of its sums of floats never depends on threads.
    for _ in range(bonds):
        one, other = word(molecule.links, at), word(molecule.links, at + 1)
        broken |= of_linked(action, molecule.bond, work, one, other, lanes, zero)
        at += 2
    for _ in range(angles):
        one, middle = word(molecule.links, at), word(molecule.links, at + 1)
        last = word(molecule.links, at + 2)
        of_angle(molecule.angle, action, work, one, middle, last, lanes, zero)
        at += 3
    for _ in range(pairs):
        one, other = word(molecule.links, at), word(molecule.links, at + 1)
        of_pair(molecule.pair, action, work, one, other, lanes, zero)
        at += 2
    return broken


@where(angle=len)
def of_angle(angle, action, work, one, middle, last, lanes, zero):
    """Apply `action` to the angle of three beads, if there is a potential."""
    (potential,) = angle
    of_angled(action, potential, work, one, middle, last, lanes, zero)


@where(pair=len)
def of_pair(pair, action, work, one, other, lanes, zero):
    """Apply `action` to a pair of beads, if there is a potential."""
    (potential,) = pair
    of_linked(action, potential, work, one, other, lanes, zero)


@generic
def of_linked(action, potential, work, one, other, lanes, zero):
    """Apply `action` to a bond or a pair; true if it is longer than its potential allows."""


@generic
def of_angled(action, potential, work, one, middle, last, lanes, zero):
    """Apply `action` to the angle between the bonds from one bead to the middle one and from
    there to the last."""


@scalar
def pair_kick(action, potential, separation):
    """Change of the velocity of a bead by its bond or pair with another, from which the separation
    leads to it; and whether a bond of that length is broken."""
    square = dot(separation, separation)
    _, force_over_r = central(potential, square)
    return scaled(action.factor * force_over_r, separation), breaks(potential, square)


@scalar
def angle_kick(action, potential, before, after):
    """Changes of the velocities of the first and the last bead by the angle of two bonds."""
    _, first, last = bend(potential, before, after)
    return scaled(action.factor, first), scaled(action.factor, last)


@of_linked.register(Kick)
def _(action, potential, work, one, other, lanes, zero):
    a, b, d, broken = work[bead_at(one, zero)], work[bead_at(other, zero)], len(zero), False
    for i in range(WIDTH):
        separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
        change, breaking = pair_kick(action, potential, separation)
        store_bead(a, i, d, added_scaled(load_bead(a, i, d, zero), -1.0, change))
        store_bead(b, i, d, added(load_bead(b, i, d, zero), change))
        broken |= breaking
    return broken


@of_angled.register(Kick)
def _(action, potential, work, one, middle, last, lanes, zero):
    a, b, c = work[bead_at(one, zero)], work[bead_at(middle, zero)], work[bead_at(last, zero)]
    d = len(zero)
    for i in range(WIDTH):
        between = load_bead(b, i, 0, zero)
        before = added_scaled(between, -1.0, load_bead(a, i, 0, zero))
        after = added_scaled(load_bead(c, i, 0, zero), -1.0, between)
        of_a, of_c = angle_kick(action, potential, before, after)
        store_bead(a, i, d, added(load_bead(a, i, d, zero), of_a))
        store_bead(b, i, d, added_scaled(load_bead(b, i, d, zero), -1.0, added(of_a, of_c)))
        store_bead(c, i, d, added(load_bead(c, i, d, zero), of_c))


@of_linked.register(Virial)
def _(action, potential, work, one, other, lanes, zero):
    a, b = work[bead_at(one, zero)], work[bead_at(other, zero)]
    for i in range(lanes):
        separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
        of_two(action, (), potential, separation, 0, 1)
    return False


@of_angled.register(Virial)
def _(action, potential, work, one, middle, last, lanes, zero):
    a, b, c = work[bead_at(one, zero)], work[bead_at(middle, zero)], work[bead_at(last, zero)]
    for i in range(lanes):
        between = load_bead(b, i, 0, zero)
        before = added_scaled(between, -1.0, load_bead(a, i, 0, zero))
        after = added_scaled(load_bead(c, i, 0, zero), -1.0, between)
        of_three(action, (), potential, before, after, 1)
