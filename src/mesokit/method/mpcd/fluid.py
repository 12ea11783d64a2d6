"""The fluid: how dense it is, how it collides, what drives it."""

import math

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.collision import CollisionRule
from mesokit.method.mpcd.collision.srd import SRD
from mesokit.method.mpcd.field import Force
from mesokit.method.mpcd.field.none import NoForce
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.section import Start
from mesokit.method.mpcd.thermostat import Thermostat
from mesokit.method.mpcd.thermostat.none import NoThermostat


@component
class Species:
    """Particles of one mass in a mixture."""

    mass: float = param(doc="mass of each particle", unit="m", ge=1e-3, le=1e3)
    density: float = param(doc="particles of this kind per cell", unit="1/a^d", gt=0, le=1e12)


NOT_GIVEN = 0.0  # no valid density or mass


@component
class Fluid:
    """An MPCD fluid.

    With `species`, `density` becomes their total density and `mass` their mean mass; leave them
    out, or give those values.
    """

    density: float = param(
        NOT_GIVEN,
        doc="particles per cell (10 unless said)",
        symbol="n",
        unit="1/a^d",
        gt=0,
        le=1e12,
        validate_default=False,
        unless_said=10.0,
    )
    timestep: float = param(
        0.1, doc="time between two collisions", symbol=r"\Delta t", ge=1e-6, le=1e3
    )
    kT: float = param(1.0, doc="thermal energy", ge=1e-6, le=1e6)
    mass: float = param(
        NOT_GIVEN,
        doc="mass of a particle (1 unless said)",
        unit="m",
        ge=1e-3,
        le=1e3,
        validate_default=False,
        unless_said=1.0,
    )
    collision: CollisionRule = param(SRD(), doc="collision rule")
    thermostat: Thermostat = param(NoThermostat(), doc="thermostat")
    force: Force = param(NoForce(), doc="body force")
    grid_shift: float = param(
        1.0, doc="strength of the random shift of the cells: 1 full, 0 none", ge=0, le=1
    )
    species: Many[Species] = param((), doc="kinds of particles of different mass")
    molecule: Molecule | None = param(
        None, doc="what every particle is a bead of (single particles unless said)"
    )
    start: Start = param(Start(), doc="initial positions and velocities")

    @property
    def kinds(self) -> tuple[Species, ...]:
        """Its kinds of particles: the species, or the only one."""
        return self.species or (Species(self.mass, self.density),)

    @property
    def mixed(self) -> bool:
        """Whether its particles have several masses."""
        return len({kind.mass for kind in self.species}) > 1

    def __post_init__(self) -> None:
        density, mass = 10.0, 1.0
        if self.species:
            density = math.fsum(kind.density for kind in self.species)
            mass = math.fsum(kind.density * kind.mass for kind in self.species) / density
        for name, value in (("density", density), ("mass", mass)):
            given = getattr(self, name)
            if given == NOT_GIVEN:
                object.__setattr__(self, name, value)
            elif self.species and not math.isclose(given, value, rel_tol=1e-9):
                kind = "total density" if name == "density" else "mean mass"
                raise ValueError(
                    f"{name} = {given:g} contradicts the {kind} of the species, {value:g}; "
                    f"leave {name} out"
                )
