"""The tables and the memory of solids and their virtual particles, made when a case is built."""

import math
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.geometry.solids import clearance
from mesokit.geometry.solids.bodies import Bodies
from mesokit.geometry.solids.clearance import Held
from mesokit.geometry.solids.contact import MARGIN
from mesokit.geometry.solids.cut_cells import cut_cells, cut_planes
from mesokit.geometry.solids.solids import Solids
from mesokit.loops.layout import BLOCK, LANES, ROW, SCRATCH_ROW, blocks_for, zeros
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.virtual import plates
from mesokit.method.mpcd.engine.virtual.gradient import numbers_of_piece
from mesokit.method.mpcd.engine.virtual.particles import KINDS, CellParticles, VirtualParticles
from mesokit.method.mpcd.engine.virtual.per_cell import ROWS
from mesokit.scalar.pointer import address

MANY_SIGMA = 4.5  # of the Maxwell distribution: one particle in 20,000 is faster
MANY_DEVIATIONS = 12.0  # of a Poisson number: no more will ever come


def with_clearance(case: Case, solids: Solids, held: Held | None = None) -> tuple[Bodies, Any]:
    """The solids with the distances that are clear around each place, or around those held; the
    tables that keep them."""
    held = held or clearance.whole(solids)
    bend = 0.125 * case.fluid.force.largest_in(case.box.size) * case.fluid.timestep**2
    clear, parts = clearance.clear_squares(solids, bend, held)
    lightest = min(kind.mass for kind in case.fluid.kinds)
    stride = MANY_SIGMA * math.sqrt(case.fluid.kT / lightest) * case.fluid.timestep + bend
    plane_of, planes, reach = clearance.free_planes(solids, clear, stride, bend, held)
    gap = bend + MARGIN  # no parabola is further from its straight line than a t^2 / 8
    ends = list(zip(solids.room.closed, case.box.size, strict=True))
    kernel = solids.kernel._replace(
        parts=float(parts),
        first=tuple(float(parts * (a % n)) for a, n in zip(held.first, solids.size, strict=True)),
        held=tuple(float(parts * n) for n in held.cells),
        clear=address(clear),
        plane_of=address(plane_of),
        planes=address(planes),
        reach=reach,
        stride=stride,
        lowest=tuple(gap if shut else -math.inf for shut, _ in ends),
        highest=tuple(length - gap if shut else math.inf for shut, length in ends),
    )
    return kernel, (clear, plane_of, planes)


def tables_of(numbers: Numbers, domain: Any = None) -> tuple[dict[str, Any], dict[str, Any]]:
    """The tables of VirtualParticles by name, and those of CellParticles.

    The latter are {} where virtual particles come one by one.
    """
    solids, d, slit = numbers.solids, numbers.dimension, numbers.slit
    assert solids is not None
    size, block = numbers.case.box.size, None if domain is None else domain.block
    if slit is not None:
        starts, keys, corners = plates.cut_cells(slit, size, numbers.cells, block)
        pieces, outward, probes, terms = plates.surface_pieces(slit, size)
    else:
        starts, keys, corners = cut_cells(solids, numbers.cells, block)
        pieces, outward, probes, terms = clearance.surface_pieces(solids)
    tables = {
        "starts": starts,
        "cells": np.pad(keys if domain is None else domain.known(keys), (0, LANES)),
        "keys": np.pad(keys, (0, LANES)),
        "corners": corners,
        "pieces": pieces,
        "outward": outward,
        "probes": probes,
        "terms": terms,
        "rates": np.zeros((len(terms), numbers_of_piece(d))),
        "masses": numbers.masses_of((np.arange(KINDS) * 7919) % max(numbers.n, 1)),
    }
    rule = numbers.case.fluid.collision
    if "angular momentum" in rule.conserves or not numbers.uniform or numbers.virtual == "top-up":
        return tables, {}
    if slit is not None:
        planes = plates.cut_planes(slit, size, corners)
    else:
        planes = cut_planes(solids, numbers.cells, block)
    normals, heights, places, surfaces, where = planes
    return tables, {
        "normals": np.ascontiguousarray(normals.T).ravel(),
        "heights": heights,
        "places": np.ascontiguousarray(places.T).ravel(),
        "terms": surfaces,
        "pieces": pieces[where].astype(np.int64),
    }


def most_particles(density: float, entries: int) -> int:
    """More virtual particles than so many cut cells will ever have."""
    mean = density * entries
    return int(mean + MANY_DEVIATIONS * math.sqrt(mean)) + LANES


def virtual_particles(
    numbers: Numbers, threads: int, rows: int, domain: Any = None
) -> VirtualParticles:
    """Virtual particles of the walls of a case; those of one rank's cells, if they are shared."""
    d, density = numbers.dimension, numbers.case.fluid.density
    tables, planes = tables_of(numbers, domain)
    entries = int(np.diff(tables["starts"]).max(initial=0)) // threads + 1  # at most, of a thread
    per_cell: CellParticles | tuple[()] = ()
    room = 0 if planes else most_particles(density, entries)
    if planes:
        per_cell = CellParticles(
            **planes,
            work=zeros((threads, ROWS * SCRATCH_ROW)),
            state=np.zeros((threads, entries, 3 * d + 1)),
            entry=np.zeros((threads, entries), np.int64),
            filled=np.zeros(threads, np.int64),
        )
    blocks = blocks_for(room)
    return VirtualParticles(
        density=density,
        **tables,
        data=zeros((threads, blocks * rows * ROW)),
        cell=zeros((threads, blocks * BLOCK), np.int32),
        number=zeros((threads, blocks * BLOCK), np.int64),
        term=zeros((threads, blocks * BLOCK), np.int32),
        filled=np.zeros(threads, np.int64),
        per_cell=per_cell,
        seen=() if domain is None else domain.seen(tables["probes"]),
    )
