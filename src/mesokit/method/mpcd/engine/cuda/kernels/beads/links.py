"""Bonds, angles and pairs of one molecule, whose beads lie in the rows of a device."""

from typing import NamedTuple

from mesokit.method.mpcd.engine.beads.interactions import Virial, note_broken, of_three, of_two
from mesokit.method.mpcd.engine.beads.links import Kick, angle_kick, of_angled, of_linked, pair_kick
from mesokit.method.mpcd.engine.cuda.kernels.groups import DeviceFluid
from mesokit.method.mpcd.engine.cuda.kernels.rows import from_rows, to_rows
from mesokit.potential.protocol import breaks
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.vector import added, added_scaled, dot


class OneMolecule(NamedTuple):
    """A molecule by its number in memory; `each_link` takes it for the memory of beads."""

    fluid: DeviceFluid
    number: int


class KickInRows(NamedTuple):
    """`Kick` of the beads of a molecule."""

    kick: Kick


class VirialInRows(NamedTuple):
    """`Virial` of the beads of a molecule."""

    virial: Virial


@scalar
def place_of(molecule, bead):
    """Where a bead lies in each row."""
    return molecule.number + bead * molecule.fluid.molecules


@scalar
def separation_of(molecule, one, other, zero):
    """The vector from one bead to another."""
    r = from_rows(molecule.fluid.r, place_of(molecule, other), zero)
    return added_scaled(r, -1.0, from_rows(molecule.fluid.r, place_of(molecule, one), zero))


@scalar
def change_velocity(molecule, bead, factor, change):
    """Add a factor times a vector to the velocity of a bead."""
    place, rows = place_of(molecule, bead), molecule.fluid.v
    to_rows(rows, place, added_scaled(from_rows(rows, place, change), factor, change))


@of_linked.register(KickInRows)
def _(action, potential, work, one, other, lanes, zero):
    change, broken = pair_kick(action.kick, potential, separation_of(work, one, other, zero))
    change_velocity(work, one, -1.0, change)
    change_velocity(work, other, 1.0, change)
    return broken


@of_angled.register(KickInRows)
def _(action, potential, work, one, middle, last, lanes, zero):
    before = separation_of(work, one, middle, zero)
    after = separation_of(work, middle, last, zero)
    first_kick, last_kick = angle_kick(action.kick, potential, before, after)
    change_velocity(work, one, 1.0, first_kick)
    change_velocity(work, middle, -1.0, added(first_kick, last_kick))
    change_velocity(work, last, 1.0, last_kick)


@of_linked.register(VirialInRows)
def _(action, potential, work, one, other, lanes, zero):
    of_two(action.virial, (), potential, separation_of(work, one, other, zero), 0, 1)
    return False


@of_angled.register(VirialInRows)
def _(action, potential, work, one, middle, last, lanes, zero):
    before = separation_of(work, one, middle, zero)
    after = separation_of(work, middle, last, zero)
    of_three(action.virial, (), potential, before, after, 1)


@scalar
def note_broken_links(molecule, step, springs, zero):
    """Find the bonds that are longer than their potential allows (seldom called)."""
    ident, (bonds, _, _) = molecule.fluid.ident, springs.number
    for n in range(bonds):
        one, other = word(springs.links, 2 * n), word(springs.links, 2 * n + 1)
        separation = separation_of(molecule, one, other, zero)
        if breaks(springs.bond, dot(separation, separation)):
            first = whole(ident, place_of(molecule, one))
            second = whole(ident, place_of(molecule, other))
            note_broken(molecule.fluid.faults, step, first, second)
