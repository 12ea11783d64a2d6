"""The beads of solutes in memory, and what holds them."""

from typing import Any, NamedTuple

import numpy as np
from numba import types

from mesokit.case.box import fold
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values, store_values
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import element

GROUP = 64  # beads whose part in the stress is added up by itself


class Beads(NamedTuple):
    """Beads, what holds them, and memory for a step: arrays, or addresses on a device.

    number: how many there are.
    mass: of a bead, or (beads,) where they differ; potentials: of type `Potentials`; neighbours:
    (Neighbours,) or ().
    kinds: which of several potentials act, see `KindsOfLinks`; () where there is one of each.
    r, v (beads * d,): places, whole molecules in one image, and velocities there.
    bond_starts (beads + 1,), bonds: the beads to which each bead is linked.
    angle_starts (beads + 1,), angles (n, 4): the angles that each bead is in, and as which bead.
    near_wall: (solid, distance) for the potential of walls, or ().
    faults (threads, 8): step and beads of the first bond that tore.
    cell (beads,): of the grid; head (cells,), following (beads,): the beads of each cell.
    given: what each bead adds to the sums of its cell, as long as `terms`, side by side.
    answers: coefficients of the cells of beads; leads (beads,): whether they are at this bead.
    solvent: (mean number, mass of a particle) for random solvent, or ().
    tensor (3, groups, 2 d d): what groups of beads add to the stress: before
    and after the collision, and by forces; whole numbers.
    embedded: (Embedded,) for beads that do not collide but act by a potential, or ().
    external: (External,) for beads that are pulled, trapped or in a magnetic field, or ().
    halo: owners and copies of beads where ranks share them (`domains.beads.halo.Halo`), or ().
    """

    number: int
    mass: Any
    potentials: tuple
    kinds: tuple
    neighbours: tuple
    r: Any
    v: Any
    bond_starts: Any
    bonds: Any
    angle_starts: Any
    angles: Any
    near_wall: tuple
    faults: Any
    cell: Any
    head: Any
    following: Any
    given: Any
    terms: tuple[float, ...]
    answers: Any
    leads: Any
    solvent: tuple
    tensor: Any
    embedded: tuple
    external: tuple
    halo: Any


class KindsOfLinks(NamedTuple):
    """The kinds of solutes, from 0, by which several potentials are chosen.

    bonds, angles: kind of each entry of `Beads.bonds` and `Beads.angles`; beads (beads,): of each
    bead; number: how many kinds there are.
    """

    bonds: Any
    angles: Any
    beads: Any
    number: int


# Places in `Halo.count`: own beads, own beads and copies, beads in own cells.
OWN, AROUND, PRESENT = 0, 1, 2


def has_halo(beads: Any) -> bool:
    """Whether ranks share beads, from the numba type of `Beads` or of ()."""
    return len(beads) > 0 and len(field_of(beads, "halo")) > 0


@where("every", halo=len)
def number_of(halo, every, which):
    """Number of beads that a rank owns, or has with copies, or in its cells (`which`); all beads
    without ranks."""
    return halo.count[which]


@where("n", halo=len)
def bead_of(halo, which, n):
    """Id of the nth of these."""
    return halo.numbers[which, n]


@by_type
def mass_of(beads, i):
    """Mass of bead i."""
    if field_of(beads, "mass") == types.float64:
        return lambda beads, i: beads.mass
    return lambda beads, i: element(beads.mass, i)


@by_type
def inverse_mass_of(beads, i):
    """One over the mass of bead i."""
    if field_of(beads, "mass") == types.float64:
        return lambda beads, i: beads.potentials.inverse_mass
    return lambda beads, i: 1.0 / element(beads.mass, i)


@scalar
def load_place(beads, i, zero):
    """The place of bead i, in the image in which it started."""
    return load_values(beads.r, np.uint64(i * len(zero)), zero)


@scalar
def load_velocity(beads, i, zero):
    """Its velocity there."""
    return load_values(beads.v, np.uint64(i * len(zero)), zero)


@scalar
def store_place(beads, i, r):
    """Move bead i to r."""
    store_values(beads.r, np.uint64(i * len(r)), r)


@scalar
def store_velocity(beads, i, v):
    """Give bead i the velocity v."""
    store_values(beads.v, np.uint64(i * len(v)), v)


@scalar
def load_folded(beads, i, box, shift):
    """Place, velocity and boxes crossed of the image of bead i in the box (see `fold`)."""
    return fold(box, load_place(beads, i, shift), load_velocity(beads, i, shift), shift)
