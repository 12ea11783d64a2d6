"""The sections of a case of soft spheres."""

import math
from collections.abc import Collection
from typing import ClassVar

from mesokit.case.box import Box
from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.geometry.shape import Wall
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.common.section import Spheres
from mesokit.method.spheres.soft.pair import PairLaw
from mesokit.method.spheres.soft.pair.protocol import ContactLaw
from mesokit.method.spheres.soft.pair.spring_dashpot import SpringDashpot
from mesokit.method.spheres.soft.thermostat import SoftThermostat

CONTACT_SKIN, POTENTIAL_SKIN, WIDEST_SKIN = 0.1, 0.16, 1.0  # of the largest reach of two
FITS = 0.98  # of the largest skin with which a box has no sphere twice on a list
ALONE = 0.1  # others within reach and skin: where there are so few, a wide skin costs nothing


@component
class SoftSpheres(Spheres):
    """Disks or spheres with forces: of grains that touch, or of atoms with a potential.

    A step is a step of the integrator, velocity Verlet.

    Examples
    --------
    >>> from mesokit import Box
    >>> SoftSpheres(packing_fraction=0.5).count(Box([40, 40]))
    1019
    """

    hard: ClassVar[bool] = False
    deforms: ClassVar[bool] = True
    bytes_each: ClassVar[int] = 600  # of memory: states twice, lists

    pair: PairLaw = param(SpringDashpot(), doc="what two spheres do to one another")
    thermostat: SoftThermostat | None = param(
        None, doc="what holds the temperature (nothing unless said)"
    )
    timestep: float | None = param(
        None,
        doc="time of a step (unless said a fiftieth of a contact, or 0.005 of the time in which a "
        "sphere flies its diameter)",
        unit="time",
        gt=0,
        le=1e9,
    )
    speed: float | None = param(
        None,
        doc="how fast two may meet, from which the time of a step follows (unless said from the "
        "velocities of the start, kT, gravity and walls that move)",
        unit="length/time",
        gt=0,
        le=1e9,
    )
    skin: float | None = param(
        None,
        doc="how far lists of neighbours go beyond the reach: changes the speed alone (0.1 of the "
        "reach of contacts, up to 1 where spheres are few; 0.16 of that of potentials unless said)",
        unit="length",
        gt=0,
        le=1e6,
    )
    spin_kT: float | None = param(
        None,
        doc="thermal energy of rotation at the start (kT where friction turns spheres, else 0)",
        unit="kT",
        ge=0,
        le=1e9,
    )

    @property
    def touching(self) -> bool:
        return isinstance(self.pair, ContactLaw)

    @property
    def pair_friction(self) -> float:
        return self.pair.friction if isinstance(self.pair, ContactLaw) else 0.0

    @property
    def thermostatted(self) -> bool:
        return self.thermostat is not None

    @property
    def usual_diameter(self) -> float:
        touching = isinstance(self.pair, ContactLaw)
        return 1.0 if touching else float(self.pair.diameter)  # type: ignore[attr-defined]

    @property
    def turns(self) -> bool:
        """Whether friction turns spheres."""
        law = self.pair
        return isinstance(law, ContactLaw) and (law.friction > 0 or law.rolling > 0)

    @property
    def first_spin_kT(self) -> float:
        """Thermal energy of rotation at the start."""
        if self.spin_kT is not None:
            return self.spin_kT
        return self.kT if self.turns else 0.0

    def reach(self, box: Box) -> float:
        """The largest distance at which two spheres interact."""
        if isinstance(self.pair, ContactLaw):
            largest = max(kind.diameter * (1 + kind.spread) for kind in self.kinds)
            return float(largest * self.scale(box))
        return float(self.pair.reach)  # type: ignore[attr-defined]

    def skin_of(self, box: Box, shut: Collection[str]) -> float:
        """Length of lists beyond the reach, in a box whose axes `shut` are closed."""
        if self.skin is not None:
            return self.skin
        reach = self.reach(box)
        pairs = zip(box.axes, box.size, strict=True)
        free = min((length for axis, length in pairs if axis not in shut), default=math.inf)
        usual = POTENTIAL_SKIN * reach
        if isinstance(self.pair, ContactLaw):
            d = box.dimension
            within = self.count(box) / box.volume * ball_volume(d, 2 * reach)
            wanted = ((ALONE / within) ** (1 / d) - 1) * reach
            widest = min(WIDEST_SKIN * reach, 0.49 * min(box.size) - reach)  # none twice on a list
            usual = float(max(min(wanted, widest), CONTACT_SKIN * reach))
        return min(usual, FITS * (0.5 * free - reach))


class SoftSections:
    """Sections of a case of soft spheres beside those of every case."""

    spheres: SoftSpheres = param(SoftSpheres(), doc="the spheres")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")
