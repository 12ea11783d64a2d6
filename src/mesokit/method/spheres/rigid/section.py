"""The section `[spheres]` of rigid grains."""

import math
from collections.abc import Collection
from typing import ClassVar

from mesokit.case.box import Box
from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.geometry.shape import Wall
from mesokit.method.spheres.common.section import Spheres
from mesokit.method.spheres.rigid.law.contact import RigidContact
from mesokit.method.spheres.rigid.solver import ContactSolver
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel

SKIN = 0.25  # of the largest diameter
FITS = 0.98  # of the largest skin with which a box has no sphere twice on a list


@component
class RigidSpheres(Spheres):
    """Rigid disks or spheres with friction: no stiffness, and no steps within a collision.

    A step finds the forces of all contacts for the velocities at its end. Overlaps, from the start
    or from forces that are not exact, stay as they are unless `push_back` is given.

    Examples
    --------
    >>> from mesokit import Box
    >>> RigidSpheres(packing_fraction=0.5).count(Box([40, 40]))
    1019
    """

    hard: ClassVar[bool] = False
    bytes_each: ClassVar[int] = 1200  # of memory: states twice, lists, contacts twice

    kT: float = param(0.0, doc="thermal energy of the start", unit="kT", ge=0, le=1e9)
    contact: RigidContact = param(RigidContact(), doc="what two of them do to one another")
    solver: ContactSolver = param(GaussSeidel(), doc="how forces of contacts are found")
    timestep: float | None = param(
        None,
        doc="time of a step (unless said a hundredth of the time in which a grain falls by its "
        "diameter, or a fiftieth of that in which it moves so far)",
        unit="time",
        gt=0,
        le=1e9,
    )
    push_back: float = param(
        0.0, doc="share of an overlap by which two are moved apart in a step", ge=0, le=0.5
    )
    skin: float | None = param(
        None,
        doc="how far lists of neighbours go beyond contact: changes the speed alone (a quarter of "
        "the largest diameter unless said)",
        unit="length",
        gt=0,
        le=1e6,
    )
    spin_kT: float | None = param(
        None, doc="thermal energy of rotation at the start (0 unless said)", unit="kT", ge=0, le=1e9
    )

    @property
    def touching(self) -> bool:
        return True

    @property
    def pair_friction(self) -> float:
        return self.contact.friction

    @property
    def turns(self) -> bool:
        """Whether friction turns grains."""
        return self.contact.turns

    @property
    def first_spin_kT(self) -> float:
        """Thermal energy of rotation at the start."""
        return self.spin_kT or 0.0

    def reach(self, box: Box) -> float:
        """The largest distance at which two touch."""
        return self.largest(box)

    def skin_of(self, box: Box, shut: Collection[str]) -> float:
        """Length of lists beyond contact, in a box whose axes `shut` are closed."""
        if self.skin is not None:
            return self.skin
        reach, pairs = self.reach(box), zip(box.axes, box.size, strict=True)
        free = min((length for axis, length in pairs if axis not in shut), default=math.inf)
        return min(SKIN * reach, FITS * (0.5 * free - reach))


class RigidSections:
    """Sections of a case of rigid grains beside those of every case."""

    spheres: RigidSpheres = param(RigidSpheres(), doc="the grains")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")
