"""Order of disks, compared with a triangular lattice."""

from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks


@component
class HexaticOrder(Observable):
    """psi_6: the mean over Voronoi neighbours of exp(6 i angle), of each disk and of all.

    "local" is the mean size of a disk's own psi_6, "global" the size of the mean over all disks.
    That falls with the number of disks in a fluid, and stays in a hexatic or a crystal.
    """

    quantity: Literal["hexatic-order"] = tag("hexatic-order")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres", "contact-dynamics")
    value_label = r"hexatic order $|\psi_6|$"
    units: ClassVar[dict[str, str]] = {"order": ""}
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError in 3D, beside walls and with few disks."""
        if case.box.dimension != 2:
            raise CaseError("hexatic-order: expected disks in 2D")
        if case.walls:
            raise CaseError("hexatic-order: not with walls; expected a periodic box")
        if case.particles < 4:
            raise CaseError(f"hexatic-order: {case.particles} disks; expected 4 at least")


@accumulator_of(HexaticOrder)
class HexaticOrderAccumulator(BlockAccumulator):
    """Block averages of both."""

    def prepare(self) -> None:
        self.blocks = Blocks((2,))

    def observe(self, spheres: RunningSpheres) -> None:
        psi = psi_6(spheres.positions(), spheres.box)
        self.blocks.add([np.abs(psi).mean(), abs(psi.mean())])

    def result(self) -> Result:
        names, value, error = ("local", "global"), self.blocks.mean(), self.blocks.error()
        found = (Comparison(f"{name} psi_6", value[k], error[k]) for k, name in enumerate(names))
        return self.report({"order": names}, self.blocks, found)


def psi_6(places: Array, box: Array) -> NDArray[np.complex128]:
    """psi_6 of each disk in a periodic box, by its Voronoi neighbours.

    >>> x, y = np.meshgrid(np.arange(4.0), np.arange(4.0))
    >>> rows = np.stack([x + 0.5 * (y % 2), y * 3**0.5 / 2], -1).reshape(-1, 2)
    >>> bool(np.allclose(np.abs(psi_6(rows, np.array([4, 2 * 3**0.5]))), 1))
    True
    """
    from scipy.spatial import Delaunay

    n = len(places)
    shifts = np.array([(i, j) for i in (0, -1, 1) for j in (0, -1, 1)], float)
    everywhere = (places + (shifts * box)[:, None]).reshape(-1, 2)
    # images farther away than a few mean distances are neighbours of none
    margin = 6.0 * np.sqrt(box.prod() / n)
    near = ((everywhere > -margin) & (everywhere < box + margin)).all(axis=1)
    near[:n] = True
    points = everywhere[near]
    starts, others = Delaunay(points).vertex_neighbor_vertices
    owner = np.repeat(np.arange(len(points)), np.diff(starts))
    own = owner < n
    separation = points[others[own]] - points[owner[own]]
    phase = np.exp(6j * np.arctan2(separation[:, 1], separation[:, 0]))
    count = np.bincount(owner[own], minlength=n)[:n]
    real, imaginary = (np.bincount(owner[own], part, n)[:n] for part in (phase.real, phase.imag))
    return np.asarray((real + 1j * imaginary) / count)
