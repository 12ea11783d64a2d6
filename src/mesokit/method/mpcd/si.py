"""A case in SI units: what its numbers mean for the real fluid, and how far the two are alike."""

import math
from dataclasses import dataclass
from typing import Any

from mesokit.case.case import Case
from mesokit.case.similarity import Flow, Number, Properties, compare
from mesokit.case.units import BOLTZMANN, MATCHES, Units
from mesokit.errors import CaseError
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.expected import setting

QUANTITIES = {  # of SI: reduced unit, SI unit
    "length": ("a", "m"),
    "time": ("tau", "s"),
    "mass": ("m", "kg"),
    "velocity": ("a/tau", "m/s"),
    "acceleration": ("a/tau^2", "m/s^2"),
    "force": ("m a/tau^2", "N"),
    "energy": ("m a^2/tau^2", "J"),
    "temperature": ("m a^2/tau^2, over k_B", "K"),
    "pressure": ("m/(a^(d-2) tau^2)", "Pa"),
    "density": ("m/a^d", "kg/m^3"),
    "viscosity": ("a^2/tau, kinematic", "m^2/s"),
    "dynamic_viscosity": ("m/(a^(d-2) tau)", "Pa s"),
}
WORDS = {
    "density": "mass density",
    "dynamic_viscosity": "viscosity",
    "kT": "thermal energy",
    "sound_speed": "speed of sound",
}


@dataclass(frozen=True)
class SI:
    """Reduced units in SI: a number of the simulation times that is the number in SI.

    `length` (m), `mass` (kg) and `time` (s) are the units. In 2D the box stands for a slice of the
    real fluid, `depth` (m) deep, and masses, forces and energies are those of the slice; in 3D the
    depth is a cell. `duration` is the whole run in s, `speed` and `size` are the steady flow in m/s
    and m (None where there is none, or no theory), `numbers` the comparison with the real fluid.
    """

    units: Units
    length: float
    depth: float
    mass: float
    time: float
    duration: float
    speed: float | None
    size: float | None
    numbers: tuple[Number, ...]

    @property
    def velocity(self) -> float:
        """m/s for a/tau."""
        return self.length / self.time

    @property
    def acceleration(self) -> float:
        """m/s^2 for a/tau^2."""
        return self.velocity / self.time

    @property
    def force(self) -> float:
        """N for m a/tau^2."""
        return self.mass * self.acceleration

    @property
    def energy(self) -> float:
        """J for m a^2/tau^2."""
        return self.force * self.length

    @property
    def temperature(self) -> float:
        """K for m a^2/tau^2, over k_B."""
        return self.energy / BOLTZMANN

    @property
    def pressure(self) -> float:
        """Pa for the unit of stress: force by area, in 2D by a length of the slice."""
        return self.force / (self.length * self.depth)

    @property
    def density(self) -> float:
        """kg/m^3 for the unit of mass density."""
        return self.mass / (self.length**2 * self.depth)

    @property
    def viscosity(self) -> float:
        """m^2/s for a^2/tau: kinematic viscosity and diffusion."""
        return self.length * self.velocity

    @property
    def dynamic_viscosity(self) -> float:
        """Pa s for the unit of dynamic viscosity."""
        return self.pressure * self.time

    def __getitem__(self, name: str) -> Number:
        """The dimensionless number of that name; KeyError names those that there are."""
        known = {number.name: number for number in self.numbers}
        if name not in known:
            raise KeyError(f"no number {name!r}; there are {', '.join(known)}")
        return known[name]

    def record(self) -> dict[str, Any]:
        """All of it as plain numbers, to be stored with a run."""
        scales = {name: getattr(self, name) for name in (*QUANTITIES, "depth", "duration")}
        return scales | {"numbers": {number.name: number._asdict() for number in self.numbers}}

    def __str__(self) -> str:
        fluid = self.units.fluid
        matched = " and ".join(WORDS[name] for name in MATCHES[self.units.match])
        deep = "" if self.depth == self.length else f"; a slice {self.depth:g} m deep"
        title = f"in SI units: {fluid.title} at {fluid.temperature:g} K by its {matched}{deep}"
        scales = [
            (name.replace("_", " "), f"{getattr(self, name):.4g} {si}", f"for 1 {reduced}")
            for name, (reduced, si) in QUANTITIES.items()
        ]
        scales.append(("whole run", f"{self.duration:.4g} s", ""))
        if self.speed is not None:
            scales.append(("flow", f"{self.speed:.4g} m/s", f"across {self.size:.4g} m"))
        numbers: list[tuple[str, ...]] = [("", "simulated", "real", "", "")]
        for n in self.numbers:
            values = ("-" if x is None else f"{x:.3g}" for x in (n.simulated, n.real))
            numbers.append((n.name, *values, n.verdict, n.meaning))
        lines = [title]
        for table in (scales, numbers):  # in columns
            widths = [max(map(len, column)) for column in zip(*table, strict=True)]
            rows = (zip(row, widths, strict=True) for row in table)
            lines += [f"  {'  '.join(t.ljust(w) for t, w in row)}".rstrip() for row in rows]
        return "\n".join(lines)


def convert(case: Case) -> SI:
    """A case in SI units, by its section `units`.

    Parameters
    ----------
    case : Case
        A case with a section `units`.

    Raises
    ------
    CaseError
        If it has none.

    Notes
    -----
    Which numbers a coarse fluid can keep: J. T. Padding and A. A. Louis, Phys. Rev. E 74, 031402
    (2006). With the cell a, the depth h of a slice (in 3D h = a) and values of the simulated fluid,
    in reduced units, marked ', the units of mass and time are::

        "reynolds"   m = rho a^2 h/rho'             tau = a^2 nu'/nu
        "mach"       m = rho a^2 h/rho'             tau = a c'/c
        "thermal"    m = rho a^2 h/rho'             tau = a (m kT'/(k_B T))^(1/2)
        "peclet"     m = k_B T tau^2/(kT' a^2)      tau = eta a^3 kT'/(eta' k_B T)

    nu', eta' and c' are those of `mesokit.theory.transport`.

    Examples
    --------
    >>> from mesokit import Box, Case, Run, Units
    >>> case = Case(run=Run(1000), box=Box([20, 20, 20]), units=Units(1e-6, "reynolds"))
    >>> si = convert(case)
    >>> print(f"{si.time:.3g} s, {si.velocity:.3g} m/s, Schmidt {si['Schmidt'].verdict}")
    9.75e-07 s, 1.03 m/s, Schmidt not matched (factor 23)
    """
    given = case.units
    if given is None:
        raise CaseError("units: missing; expected what a cell and the fluid are in SI units")
    fluid, known, real = case.fluid, setting.transport(case), given.fluid.properties()
    reduced = Properties(
        setting.mass_density(case),
        known.dynamic_viscosity if known else math.nan,
        fluid.kT,
        known.diffusion if known else math.nan,
        known.sound_speed if known else math.nan,
        setting.mean_free_path(case),
    )
    depth = given.cell if given.depth is None else given.depth
    mass, time = _mass_and_time(given, reduced, real, depth)
    found, velocity = derive(case), given.cell / time
    flows = bool(found.flow_speed)
    flow = Flow(found.flow_speed or 1.0, found.flow_size, 1.0, 1.0)
    same = Flow(
        flow.speed * velocity, flow.size * given.cell, given.cell, given.cell**2 * depth
    )  # in SI units
    return SI(
        units=given,
        length=given.cell,
        depth=depth,
        mass=mass,
        time=time,
        duration=(case.run.warmup + case.run.steps) * fluid.timestep * time,
        speed=same.speed if flows else None,
        size=same.size if flows else None,
        numbers=compare((flow, reduced), (same, real), case.box.dimension, flows),
    )


def _mass_and_time(
    given: Units, reduced: Properties, real: Properties, depth: float
) -> tuple[float, float]:
    """The units of mass and time, in kg and s."""
    a, energy = given.cell, real.kT / reduced.kT
    if given.match == "peclet":
        time = a**2 * depth * real.dynamic_viscosity / reduced.dynamic_viscosity / energy
        return energy * time**2 / a**2, time
    mass = a**2 * depth * real.density / reduced.density
    if given.match == "reynolds":
        return mass, mass / depth * reduced.dynamic_viscosity / real.dynamic_viscosity
    if given.match == "mach":
        return mass, a * reduced.sound_speed / real.sound_speed
    return mass, a * math.sqrt(mass / energy)
