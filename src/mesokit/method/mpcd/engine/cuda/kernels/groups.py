"""Addresses of a fluid in the memory of a device, as kernels take them.

Each row has a number for every particle. Rows are apart, so that a sort can put any of them in the
place of another. Sums and coefficients are records: all numbers of a cell lie side by side.
"""

from typing import Any, NamedTuple


class Kinds(NamedTuple):
    """Of particles that differ in mass: numbers where each kind ends (int64), masses (float64)."""

    ends: int
    masses: int


class DeviceFluid(NamedTuple):
    """A fluid's arrays. Bead k of molecule i lies at place i + k `molecules` of each row."""

    r: tuple  # rows of positions along each axis, float64
    v: tuple  # and of velocities
    image: tuple  # rows of the boxes that each particle is away, int32
    ident: int  # number of each particle, int32
    kinds: Any  # Kinds, or () where all masses are the same
    coefficients: int  # records of cells: what their particles need to collide, float64
    sums: int  # records of cells: fixed-point sums over their particles, int64
    adds: Any  # how particles add to the records of sums (see `devices.records`)
    neighbour_sums: tuple  # one of these sums in all cells, if the rule needs its gradient, or ()
    impulse: int  # momentum and angular momentum that surfaces took, int64
    listed: int  # particles whose flight may meet a surface, int32
    waiting: int  # how many are listed, int32
    doubtful: int  # cells whose thermostat must draw with care, int32, and how many they are
    doubts: int
    tensor: tuple  # terms of the stress before and after the collision, and of bonds, int64, if any
    molecules: int  # how many there are: as many as particles, if these are single
    faults: int  # step and beads of the first bond that tore (see `beads.interactions`), int64


class Planes(NamedTuple):
    """Planes of cut cells (see `virtual.particles.CellParticles`), so many entries."""

    entries: int
    normals: int  # float64, a row for each axis
    heights: int  # float64
    places: int  # float64, a row for each axis
    terms: int  # int64
    pieces: int  # int64


class DeviceWalls(NamedTuple):
    """Tables of virtual particles (see `virtual.particles.VirtualParticles`), and their memory."""

    density: float
    starts: int  # int64
    cells: int  # int64
    keys: int  # int64
    corners: int  # records of d, float64; only for particles one by one
    pieces: int  # int64, the same
    outward: int  # records of d, float64
    probes: int  # records of d, float64
    terms: int  # int64
    rates: int  # records of pieces, float64
    masses: int  # float64
    number_of_pieces: int
    planes: Any  # Planes, or () where particles come one by one
    records: int  # what a cell, or a particle, leaves where walls are measured, float64
    room: int  # how many records there may be
    held: int  # how many particles have left one, int32
