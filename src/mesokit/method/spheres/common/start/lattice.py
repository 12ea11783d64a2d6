"""Spheres on a lattice that fills the box."""

import itertools
import math
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.protocol import Array, Placed, SphereStart

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

    def check(self, case: Case) -> None:
        """Raise CaseError where neighbours would overlap, or solids are in the way."""
        if any(not wall.closed_axes for wall in case.walls):
            raise CaseError(
                f"spheres.start.rule = {show(self.rule)}: not with solids other than plates; "
                "expected 'random'"
            )
        largest, number = case.spheres.largest(case.box), case.spheres.count(case.box)
        free = self.free(case, largest)
        if free.min() <= 0:
            raise CaseError(f"spheres: no room for a diameter of {largest:.4g} between the walls")
        if self.spacing(number, free) >= largest:
            return
        sites = self.sites(number, free, shut(case))  # of which some may be left empty
        gap = shortest_distance(sites, free, shut(case)) - largest if len(sites) > 1 else 0.0
        if gap < 0:
            raise CaseError(
                f"spheres.start.rule = {show(self.rule)}: neighbours on this lattice would overlap "
                f"by {-gap:.3g}; expected fewer or smaller spheres, or rule 'random'"
            )

    def free(self, case: Case, largest: float) -> Array:
        """Lengths of the box that centres may be in."""
        return np.array(case.box.size, float) - largest * shut(case)

    def place(self, case: Case, made: Made) -> Placed:
        largest, n = case.spheres.largest(case.box), len(made.diameters)
        sites = self.sites(n, self.free(case, largest), shut(case)) + 0.5 * largest * shut(case)
        mixed = len(case.spheres.kinds) > 1
        order = np.random.default_rng(case.run.seed).permutation(n) if mixed else np.arange(n)
        return Placed(sites[order])

    def spacing(self, n: int, size: Array) -> float:
        """The shortest distance of two sites of a lattice for n spheres."""
        within = np.array(CELLS[self.lattice, len(size)][0])
        cells = np.array(list(itertools.product((-1, 0, 1), repeat=len(size))))
        separations = (within[:, None, None] - within[None, :, None] + cells).reshape(-1, len(size))
        found = np.linalg.norm(separations * (size / unit_cells(self.lattice, size, n)), axis=1)
        return float(found[found > 0].min())

    def sites(self, n: int, size: Array, shut: NDArray[np.bool_]) -> Array:
        """Places (n, d) on the lattice in a room of lengths `size`."""
        cells, within = unit_cells(self.lattice, size, n), CELLS[self.lattice, len(size)][0]
        corners = np.stack(np.meshgrid(*map(np.arange, cells), indexing="ij"), -1)
        every = (corners.reshape(-1, 1, len(size)) + np.array(within)).reshape(-1, len(size))
        chosen = np.linspace(0, len(every), n, endpoint=False).astype(int)
        return np.asarray(every[chosen] * (size / cells))


def shut(case: Case) -> NDArray[np.bool_]:
    """Which axes plates close."""
    closed = closed_axes(case.walls)
    return np.array([axis in closed for axis in case.box.axes])


def unit_cells(lattice: str, size: Array, n: int) -> Integers:
    """Numbers of unit cells along the axes that hold n sites and are stretched least."""
    sites, sides = CELLS[lattice, len(size)]
    relative = size / np.array(sides)
    edge = (relative.prod() * len(sites) / n) ** (1 / len(size))
    found = np.maximum(1, np.round(relative / edge)).astype(int)
    while found.prod() * len(sites) < n:
        found[np.argmax(relative / found)] += 1
    return found


def shortest_distance(places: Array, size: Array, shut: NDArray[np.bool_]) -> float:
    """The shortest distance of two places, in a box that is periodic but along shut axes."""
    from scipy.spatial import cKDTree

    around = np.where(shut, 3 * size, size)  # images far away
    distance, _ = cKDTree(places, boxsize=around).query(places, k=2)
    return float(distance[:, 1].min())
