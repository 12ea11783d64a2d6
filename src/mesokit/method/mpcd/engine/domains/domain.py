"""The cells of one rank: its block, its halo, its partners and the memory of its messages."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry.solids.clearance import Held
from mesokit.loops.layout import LANES, record_length, sums_length, zeros
from mesokit.method.mpcd.engine.cpu.grid import Part
from mesokit.method.mpcd.engine.cpu.memory import Memory
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.domains.beads.halo_memory import halo_of, reach_of_beads
from mesokit.method.mpcd.engine.domains.blocks import region
from mesokit.method.mpcd.engine.domains.blocks.region import Space, region_of
from mesokit.method.mpcd.engine.domains.blocks.tree import Block, Tree
from mesokit.method.mpcd.engine.domains.messages.bodies import body_messages
from mesokit.method.mpcd.engine.domains.messages.mpi import post
from mesokit.method.mpcd.engine.domains.messages.shared import METER_SIZE, Shared
from mesokit.method.mpcd.engine.virtual.gradient import PROBES
from mesokit.method.mpcd.engine.virtual.particles import FlowAtSurface
from mesokit.method.mpcd.solutes import Solutes
from mesokit.potential.thermal import mean_square

HALO = 2  # cells around a block
STRAY = 0.4  # cells that a particle of thermal speed flies between two migrations
SPARE = 1.03  # times as many molecules as there are now, for which there is room
FAST = 9.0  # thermal speeds: no particle is faster
FEW = 512  # rows to a partner that are always there


def axes_to_cut(numbers: Numbers) -> tuple[float, ...]:
    """Weights of lengths, by which axes are cut: where images slide, x and y better stay whole."""
    d = numbers.dimension
    return (1.0,) * d if not numbers.case.box.sheared else (0.5, 0.25, 1.0)[:d]


class Domain:
    """The cells of one rank, and those that it shares with partners.

    `tree` has the block of each rank, `molecules` is the approximate number that this rank will
    hold, `crowded` is true if ranks share cores.
    """

    def __init__(
        self, numbers: Numbers, comm: Any, tree: Tree, threads: int, molecules: int, crowded: bool
    ) -> None:
        self.crowded = crowded
        self.numbers, self.comm, self.tree, self.threads = numbers, comm, tree, threads
        wraps, self.rank = tuple(not shut for shut in numbers.closed), comm.rank
        self.space = Space(tuple(numbers.cells), wraps, numbers.case.box.sheared)
        self.block = tree.blocks[self.rank]
        self.region = region_of(self.block, self.space, HALO)
        self.regions = [region_of(block, self.space, HALO) for block in tree.blocks]
        self.every = every_of(numbers)
        solutes = numbers.case.solutes
        self.beads = 0 if solutes is None else solutes.beads
        self.reach = HALO + 1 + math.ceil(farthest(numbers))
        if solutes is not None:
            self.reach = max(self.reach, 1 + math.ceil(reach_of_beads(numbers, solutes)))
        self.partners = region.partners(self.rank, tree.blocks, self.space, self.reach)
        self.ghosts = [self._ghosts_of(p) for p in self.partners]
        self.movers = [FEW // 2 + int(0.25 * self._crowd(p)) for p in self.partners]
        beads = numbers.beads
        each = 16 + -(-sum(self.ghosts) // threads)
        self.ghosts_of_thread = each
        self.ghost_slots = each * threads
        self.slots = self.ghost_slots + beads * sum(1 + n for n in self.movers) + self.beads
        self.room = int(SPARE * molecules) + 64 + sum(1 + n for n in self.movers)

    def _crowd(self, other: int) -> float:
        """Particles in a layer of cells that this rank and another have in common."""
        mine, _ = region.shared(
            self.region, self.regions[other], self.space, self.tree.blocks[other]
        )
        theirs, _ = region.shared(self.regions[other], self.region, self.space, self.block)
        return self.numbers.density * max(len(mine), len(theirs)) / HALO

    def _ghosts_of(self, other: int) -> int:
        """Room for rows of ghosts between two ranks, the same on both."""
        crowd, numbers = self._crowd(other), self.numbers
        number = FEW + 0.05 * crowd
        if numbers.beads > 1:
            number += 0.5 * crowd * min(extent(numbers), 4.0)
        if self.space.slides:
            faces = [
                math.prod(n for k, n in enumerate(block.lengths) if k != 1)
                for block in (self.block, self.tree.blocks[other])
            ]
            number += 1.5 * numbers.density * min(faces)
        return int(number)

    # --- cells ----------------------------------------------------------------------------------

    def grid(self, whole: Any) -> Part:
        """The cells of the box as this rank numbers them."""
        first, known = (tuple(float(n) for n in numbers) for numbers in self.region)
        return Part(whole.shift, whole.origin, whole.cells, whole.inverse, first, known)

    @property
    def held(self) -> Held:
        """Cells without a shift that particles of this rank can reach."""
        near = region_of(self.block, self.space, 1 + math.ceil(farthest(self.numbers)))
        size = [math.ceil(length) for length in self.numbers.case.box.size]
        known = zip(*near, size, self.space.wraps, strict=True)
        return Held(near.first, tuple(n if on else min(n, all_ - a) for a, n, all_, on in known))

    def known(self, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        """Numbers here of held cells, by their numbers in the box."""
        number, stride = np.zeros(len(cells), np.int64), 1
        for k, whole in enumerate(self.space.cells):
            i = (cells % whole - self.region.first[k]) % whole
            cells = cells // whole
            number += i * stride
            stride *= self.region.known[k]
        return number

    def owners(self, positions: NDArray[np.float64]) -> NDArray[np.int64]:
        """The owner (n,) of each place (n, d), by the cells without a shift."""
        return owners(self.tree.blocks, self.numbers, positions)

    # --- memory ---------------------------------------------------------------------------------

    def shared(self, memory: Memory) -> Shared:
        """The lists and the memory of messages."""
        width = sums_length(len(memory.physics.terms))
        numbers, d, q = self.numbers, self.numbers.dimension, len(self.partners)
        threads = self.threads
        mine, theirs, given = [], [], []
        for p in self.partners:
            here, there = region.shared(
                self.region, self.regions[p], self.space, self.tree.blocks[p]
            )
            mine.append(here)
            theirs.append(there)
            given.append(region.shared(self.regions[p], self.region, self.space, self.block)[1])
        twice = 2 if numbers.virtual == "extrapolate" else 1  # also the flow at surfaces
        more = [1 + ghosts + self.beads for ghosts in self.ghosts]
        out_at = _starts(twice * len(m) + n for m, n in zip(mine, more, strict=True))
        in_at = _starts(twice * len(m) + n for m, n in zip(given, more, strict=True))
        moved_at = _starts(1 + n for n in self.movers)
        length = max(record_length(numbers.coefficient_count), 3 + d)
        record = numbers.beads * (1 + memory.rows + d + numbers.coefficient_count)
        blocks = [self.tree.blocks[p] for p in self.partners]
        regions = [self.regions[p] for p in self.partners]
        gradient = numbers.case.fluid.collision.gradient_of is not None
        mixed = np.zeros(-(-self.region.number // LANES) * LANES, bool)
        mixed[region.own(self.region, self.space, self.block)] = True
        return Shared(
            post=post(self.comm, 4 * q, self.crowded),
            keys=np.pad(region.keys(self.region, self.space), (0, LANES)),
            mixed=mixed.reshape(-1, LANES).any(axis=1),
            cells=np.array(self.space.cells, np.int64),
            limits=self._limits,
            closed=tuple(float(shut) for shut in numbers.closed),
            ranks=np.array(self.partners, np.int64),
            blocks=np.array(blocks, np.int64).reshape(q, 2, d),
            regions=np.array(regions, np.int64).reshape(q, 2, d),
            starts=_starts(map(len, mine)),
            mine=_joined(mine),
            theirs=_joined(theirs),
            given_starts=_starts(map(len, given)),
            given=_joined(given),
            out_at=out_at,
            in_at=in_at,
            sums_out=zeros((out_at[-1], 1 + width), np.int64),
            sums_in=zeros((in_at[-1], 1 + width), np.int64),
            coefficients_out=zeros((in_at[-1], length)),
            coefficients_in=zeros((out_at[-1], length)),
            records=zeros(int(out_at[-1]), np.int64),
            counting=zeros((threads, max(q, 1)), np.int64),
            sent=zeros(max(q, 1), np.int64),
            field_out=zeros((sum(map(len, given)) if gradient else 0, 1)),
            field_in=zeros((sum(map(len, mine)) if gradient else 0, 1)),
            ghost_place=zeros((threads, self.ghosts_of_thread), np.int64),
            ghost_cell=zeros((threads, self.ghosts_of_thread), np.int64),
            ghost_owner=zeros((threads, self.ghosts_of_thread), np.int64),
            ghost_terms=zeros((threads, self.ghosts_of_thread, width), np.int64),
            ghosts=zeros((threads, 8), np.int64),
            leaving=zeros((threads, 1 + int(moved_at[-1])), np.int64),
            owner=zeros((threads, 1 + int(moved_at[-1])), np.int64),
            left=zeros((threads, 8), np.int64),
            moved_at=moved_at,
            moved_out=zeros((int(moved_at[-1]), record), np.int64),
            moved_in=zeros((int(moved_at[-1]), record), np.int64),
            noted=zeros(8, np.int64),
            meter=zeros(METER_SIZE, np.int64),
            every=self.every,
            slots=self.ghost_slots,
            room=self.room,
        )

    @property
    def _limits(self) -> tuple[tuple[float, ...], ...]:
        """The first cell of the block, and the first beyond it, along each axis."""
        return tuple(tuple(float(n) for n in side) for side in self.block)

    def halo(self, given: Solutes, terms: int) -> Any:
        """Memory for the halo of beads of solutes."""
        return halo_of(self, given, terms)

    def body_messages(self, bodies: int, width: int) -> Any:
        """Memory for messages about bodies."""
        return body_messages(self.comm, bodies, width, self.crowded)

    def seen(self, probes: NDArray[np.float64]) -> FlowAtSurface:
        """The pieces of surface near this rank's block, and near those of its partners."""
        given = [self._pieces(probes, p) for p in self.partners]
        return FlowAtSurface(
            limits=self._limits,
            here=self._pieces(probes, self.rank),
            step=np.full((len(probes), PROBES), -1, np.int64),
            values=np.zeros((len(probes), PROBES, self.numbers.dimension + 1)),
            given_starts=_starts(map(len, given)),
            given=_joined(given),
        )

    def _pieces(self, probes: NDArray[np.float64], rank: int) -> NDArray[np.int64]:
        near = np.ones(len(probes), bool)
        for k, (low, high) in enumerate(zip(*self.tree.blocks[rank], strict=True)):
            whole = self.space.cells[k]
            middle, half = 0.5 * (low + high), 0.5 * (high - low) + NEAR
            away = np.abs(probes[:, k] - middle)
            if self.space.wraps[k]:
                away = np.abs((probes[:, k] - middle + 0.5 * whole) % whole - 0.5 * whole)
            near &= away <= half
        return np.flatnonzero(near)


def owners(
    blocks: Sequence[Block], numbers: Numbers, positions: NDArray[np.float64]
) -> NDArray[np.int64]:
    """The owner (n,) of each place (n, d), by the cells without a shift."""
    found = np.full(len(positions), -1, np.int64)
    cells, whole = np.floor(positions).astype(np.int64), np.array(numbers.cells)
    cells %= np.where(numbers.closed, whole - 1, whole)
    for rank, block in enumerate(blocks):
        found[((cells >= block.low) & (cells < block.high)).all(axis=1)] = rank
    return found


NEAR = 4.0  # cells from a block: a piece of surface so far away may matter in it


def every_of(numbers: Numbers) -> int:
    """Steps from one migration to the next."""
    return int(min(max(STRAY / flight(numbers), 1), 10))


def flight(numbers: Numbers) -> float:
    """Length of the flight in a timestep at thermal speed, of the lightest species."""
    fluid = numbers.case.fluid
    return math.sqrt(fluid.kT / min(kind.mass for kind in fluid.kinds)) * fluid.timestep


def farthest(numbers: Numbers) -> float:
    """Distance from its block, in cells, at which a rank may have particles."""
    return FAST * flight(numbers) * math.sqrt(every_of(numbers)) + 4.0 * extent(numbers)


def extent(numbers: Numbers) -> float:
    """Approximate distance of the last bead of a molecule of the fluid from its first."""
    molecule, kT = numbers.case.fluid.molecule, numbers.case.fluid.kT
    if molecule is None:
        return 0.0
    bond = molecule.bond_potentials, numbers.dimension, kT, molecule.bond.longest
    return math.sqrt(molecule.length * mean_square(*bond))


def _starts(lengths: Any) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum(list(lengths), dtype=np.int64)]).astype(np.int64)


def _joined(lists: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    return np.concatenate([np.zeros(0, np.int64), *lists]).astype(np.int64)
