"""The sections of a case of event-driven dynamics."""

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.geometry.shape import Wall
from mesokit.method.spheres.common.section import Spheres
from mesokit.method.spheres.hard.collision import SphereCollision
from mesokit.method.spheres.hard.collision.hard import HardCollision
from mesokit.method.spheres.hard.heating import Heating


@component
class HardSpheres(Spheres):
    """Hard disks or spheres, which fly freely between collisions that take no time.

    All events within a step are exact: its length is when one looks, and changes no bit.

    Examples
    --------
    >>> from mesokit import Box
    >>> HardSpheres(packing_fraction=0.5).count(Box([40, 40]))
    1019
    """

    timestep: float = param(0.1, doc="time of a step", unit="time", gt=0, le=1e9)
    collision: SphereCollision = param(
        HardCollision(), doc="what two spheres do to one another when they touch"
    )
    heating: Heating | None = param(
        None, doc="what puts energy in, or takes it out, at fixed times (nothing unless said)"
    )
    spin_kT: float | None = param(
        None,
        doc="thermal energy of rotation at the start (kT where collisions turn spheres, else 0)",
        unit="kT",
        ge=0,
        le=1e9,
    )

    @property
    def instant_collision(self) -> SphereCollision:
        return self.collision

    @property
    def energy_source(self) -> Heating | None:
        return self.heating

    @property
    def first_spin_kT(self) -> float:
        """Thermal energy of rotation at the start."""
        if self.spin_kT is not None:
            return self.spin_kT
        return self.kT if self.collision.rough else 0.0


class HardSections:
    """Sections of a case of event-driven dynamics beside those of every case."""

    spheres: HardSpheres = param(HardSpheres(), doc="the spheres")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")
