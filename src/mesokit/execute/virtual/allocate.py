"""The tables and the memory of solids and their virtual particles, made when a case is built."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.execute.cpu.strips.layout import BLOCK, ROW, SCRATCH_ROW, blocks_for, zeros
from mesokit.execute.virtual.gradient import columns
from mesokit.execute.virtual.one_by_one import KINDS, SolidParticles
from mesokit.execute.virtual.per_cell import ROWS, CellParticles
from mesokit.geometry.solids.bodies import Bodies
from mesokit.geometry.solids.clearance import (
    clear_squares,
    cut_cells,
    cut_planes,
    free_planes,
    surface_pieces,
)
from mesokit.geometry.solids.contact import MARGIN
from mesokit.scalar.pointer import address

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.geometry.solids.solids import Solids


MANY_SIGMA = 4.5  # of the Maxwell distribution: one particle in 20,000 is faster


def with_clearance(case: Case, solids: Solids) -> tuple[Bodies, Any]:
    """The solids with the distances that are clear around each place; the tables that keep them."""
    bend = 0.125 * case.fluid.force.largest * case.fluid.timestep**2
    clear, parts = clear_squares(solids, bend)
    lightest = min(kind.mass for kind in case.fluid.kinds)
    stride = MANY_SIGMA * math.sqrt(case.fluid.kT / lightest) * case.fluid.timestep + bend
    plane_of, planes, reach = free_planes(solids, clear, stride, bend)
    gap = bend + MARGIN  # no parabola is further from its straight line than a t^2 / 8
    ends = list(zip(solids.room.closed, case.box.size, strict=True))
    kernel = solids.kernel._replace(
        clear=address(clear),
        parts=float(parts),
        plane_of=address(plane_of),
        planes=address(planes),
        reach=reach,
        stride=stride,
        lowest=tuple(gap if shut else -math.inf for shut, _ in ends),
        highest=tuple(length - gap if shut else math.inf for shut, length in ends),
    )
    return kernel, (clear, plane_of, planes)


def solid_particles(
    case: Case, solids: Solids, cells: tuple[int, ...], threads: int, rows: int, masses: Any
) -> SolidParticles:
    """Virtual particles of the bodies; `masses` are those of the fluid's particles."""
    density, d = case.fluid.density, case.box.dimension
    uniform = len(np.unique(masses)) == 1
    starts, numbers, corners = cut_cells(solids, cells)
    pieces, outward, probes, terms = surface_pieces(solids)
    most = int(np.diff(starts).max(initial=0)) * (int(density) + 2)
    at_once = uniform and "angular momentum" not in case.fluid.collision.conserves
    at_once = at_once and case.walls[0].virtual != "top-up"
    per_cell: CellParticles | tuple[()] = ()
    if at_once:
        most = 0
        normals, heights, places, cut_terms, where = cut_planes(solids, corners, starts)
        entries = int(np.diff(starts).max(initial=0)) // threads + 1
        per_cell = CellParticles(
            normals=np.ascontiguousarray(normals.T).ravel(),
            heights=heights,
            places=np.ascontiguousarray(places.T).ravel(),
            terms=cut_terms,
            pieces=pieces[where].astype(np.int64),
            work=zeros((threads, ROWS * SCRATCH_ROW)),
            state=np.zeros((threads, entries, 3 * d + 1)),
            entry=np.zeros((threads, entries), np.int64),
            filled=np.zeros(threads, np.int64),
        )
    blocks = blocks_for(most // threads + 1)
    kinds = masses[(np.arange(KINDS) * 7919) % len(masses)]
    return SolidParticles(
        density=density,
        first_number=len(masses),
        starts=starts,
        cells=numbers,
        corners=corners,
        pieces=pieces,
        outward=outward,
        probes=probes,
        terms=terms,
        rates=np.zeros((len(terms), columns(d))),
        masses=kinds,
        data=zeros((threads, blocks * rows * ROW)),
        cell=zeros((threads, blocks * BLOCK), np.int32),
        number=zeros((threads, blocks * BLOCK), np.int32),
        term=zeros((threads, blocks * BLOCK), np.int32),
        filled=np.zeros(threads, np.int64),
        per_cell=per_cell,
    )
