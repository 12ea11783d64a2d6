"""Spheres on a lattice that fills the box."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.spheres.start.protocol import Array, Placed, SphereStart

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.spheres.made import Made

Integers = NDArray[np.int64]
# places within a unit cell, in units of its sides, and how long these are relative to one another
CELLS: dict[tuple[str, int], tuple[Sequence[Sequence[float]], Sequence[float]]] = {
    ("close-packed", 2): ([(0.25, 0.25), (0.75, 0.75)], (1.0, math.sqrt(3.0))),
    ("close-packed", 3): (
        [(0.25, 0.25, 0.25), (0.75, 0.75, 0.25), (0.75, 0.25, 0.75), (0.25, 0.75, 0.75)],
        (1.0, 1.0, 1.0),
    ),
    ("square", 2): ([(0.5, 0.5)], (1.0, 1.0)),
    ("square", 3): ([(0.5, 0.5, 0.5)], (1.0, 1.0, 1.0)),
}


@component
class LatticeStart(SphereStart):
    """Evenly spread over the box, on sites of a lattice stretched to fit it.

    Where there are more sites than spheres, those left empty are spread evenly too. Kinds of
    spheres are mixed at random over the sites.
    """

    rule: Literal["lattice"] = tag("lattice")
    lattice: Literal["close-packed", "square"] = param(
        "close-packed",
        doc="'close-packed': triangular in 2D, face-centred cubic in 3D; 'square': square or cubic",
    )

    def place(self, case: Case, made: Made) -> Placed:
        """Sites for all. Raises CaseError where neighbours would overlap."""
        size, n = np.array(case.box.size, float), len(made.diameters)
        cells, sites = unit_cells(self.lattice, size, n), CELLS[self.lattice, len(size)][0]
        corners = np.stack(np.meshgrid(*map(np.arange, cells), indexing="ij"), -1)
        every = (corners.reshape(-1, 1, len(size)) + np.array(sites)).reshape(-1, len(size))
        chosen = np.linspace(0, len(every), n, endpoint=False).astype(int)
        places = (every[chosen] * (size / cells))[mixed(case.run.seed, n, len(case.spheres.kinds))]
        gap = nearest(places, size) - made.diameters.max()
        if gap < 0:
            raise CaseError(
                f"spheres.start.rule = {show(self.rule)}: neighbours on this lattice would overlap "
                f"by {-gap:.3g}; expected fewer or smaller spheres, or rule 'random'"
            )
        return Placed(places)


def unit_cells(lattice: str, size: Array, n: int) -> Integers:
    """How many unit cells along each axis hold n sites, as little stretched as may be."""
    sites, sides = CELLS[lattice, len(size)]
    relative = size / np.array(sides)
    edge = (relative.prod() * len(sites) / n) ** (1 / len(size))
    found = np.maximum(1, np.round(relative / edge)).astype(int)
    while found.prod() * len(sites) < n:
        found[np.argmax(relative / found)] += 1
    return found


def mixed(seed: int, n: int, kinds: int) -> Integers:
    """The order in which spheres take sites: as they are numbered, unless kinds are to be mixed."""
    return np.arange(n) if kinds == 1 else np.random.default_rng(seed).permutation(n)


def nearest(places: Array, size: Array) -> float:
    """The shortest distance of two places in a periodic box."""
    from scipy.spatial import cKDTree

    if len(places) == 1:
        return float(size.min())
    tree = cKDTree(np.mod(places, size), boxsize=size)
    distance, _ = tree.query(np.mod(places, size), k=2)
    return float(distance[:, 1].min())
