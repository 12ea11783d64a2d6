"""Theory of hard spheres: equilibrium, displacement, memory, neighbours and cooling."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.spheres.common.expected.cooling import Cooling, haff_time, uniform
from mesokit.method.spheres.common.expected.enskog import fluid_note
from mesokit.method.spheres.common.expected.equilibrium import (
    Equilibrium,
    of_start,
    still_walls,
    surfaces,
)
from mesokit.method.spheres.common.expected.neighbours import NeighboursOfSpheres
from mesokit.method.spheres.common.motion import SphereDisplacement, VelocityMemory
from mesokit.seam.engine import Array, Integers


def hard_equilibrium(case: Case) -> Equilibrium | None:
    """Equilibrium, None where collisions take energy or temperatures of baths and walls differ."""
    section = case.spheres
    if not (section.collision.elastic and still_walls(case) and _keep_energy(case)):
        return None
    heating, warm = section.heating, set()
    if heating is not None:
        if heating.bath_kT is None:
            return None
        warm.add(heating.bath_kT)
    for surface in surfaces(case):
        if surface.rule == "diffuse":
            given = surface.contact.temperature if surface.contact is not None else None
            warm.add(float(section.kT if given is None else given))
    if len(warm) > 1:
        return None
    if warm:
        return Equilibrium(warm.pop(), True)
    even = not section.collision.rough or section.first_spin_kT == section.kT
    kept = even and section.collision.hard and not section.gravity
    return Equilibrium(of_start(case) if kept else math.nan, True)


def _keep_energy(case: Case) -> bool:
    """Whether walls without a temperature of their own keep energy."""
    contacts = [s.contact for s in surfaces(case) if s.contact is not None and s.rule != "diffuse"]
    return all(
        contact.restitution in (None, 1.0)
        and contact.tangential in (None, -1.0, 1.0)
        and contact.friction is None
        for contact in contacts
    )


DECAYED = 5.0  # times of the velocity's memory after which motion is diffusive


class HardDisplacement(SphereDisplacement):
    """Ballistic at first, diffusive when the velocity is forgotten: 2 D (t - T + T exp(-t/T)) along
    each axis, T = m D/kT, with the D of Enskog."""

    def __init__(self, case: Case, observable: Any) -> None:
        super().__init__(case, observable)
        self.diffusion, self.memory = enskog(case)

    def expected(self, steps: Integers) -> Array | None:
        if not math.isfinite(self.diffusion):
            return None
        time = np.asarray(steps * self.timestep, float)
        flown: NDArray[np.float64] = time + self.memory * np.expm1(-time / self.memory)
        return 2 * len(self.axes) * self.diffusion * flown

    def coefficient(self) -> tuple[float, str]:
        return self.diffusion, NOTE if math.isfinite(self.diffusion) else ""

    def diffusive_from(self) -> float:
        return DECAYED * self.memory if math.isfinite(self.memory) else 0.0

    def _keeps_momentum(self) -> bool:
        return not (self.case.walls or self.case.spheres.heating)

    def legend(self) -> str:
        return "Enskog"


def enskog(case: Case) -> tuple[float, float]:
    """Diffusion coefficient and memory of the velocity, nan where there is no theory."""
    section, box = case.spheres, case.box
    kind, d = section.kinds[0], box.dimension
    alike = len(section.kinds) == 1 and kind.spread == 0 and case.particles > 1
    quiet = not (case.walls or section.gravity or section.heating) and section.kT > 0
    pair = section.collision
    if not (alike and quiet and pair.elastic and pair.hard) or pair.rough:
        return math.nan, math.nan
    kT_over_m = section.kT / kind.mean_mass(d)
    chi = theory.contact_value(section.fraction(box), d)
    density, diameter = case.particles / box.volume, kind.diameter * section.scale(box)
    found = theory.enskog_diffusion(density, diameter, kT_over_m, chi, d)
    return found, found / kT_over_m


COARSE = 0.5  # memories between two samples, beyond which the sum over them is no integral
NOTE = "approximate: Enskog: neglects velocity correlations"


class EnskogMemory(VelocityMemory):
    """exp(-t/T), T = m D/kT, with the D of Enskog. The energy is that of the start, exactly."""

    def __init__(self, case: Case, observable: Any) -> None:
        super().__init__(case, observable)
        self.coefficient, self.time = enskog(case)
        self.timestep = float(case.spheres.timestep)
        # Velocities add up to zero, so a component has n - 1 of n degrees of freedom.
        self.square = self.coefficient / self.time * (1 - 1 / case.particles)

    def expected(self, steps: Integers) -> Array | None:
        if math.isnan(self.time):
            return None
        return np.asarray(self.square * np.exp(-steps * self.timestep / self.time))

    def legend(self) -> str:
        return "Enskog"

    def level(self, error: float, runs: int) -> tuple[float, float] | None:
        return self.square, error

    def share(self, every: int) -> str | None:
        return None if math.isnan(self.time) else NOTE

    def diffusion(self, every: int) -> tuple[float, str] | None:
        coarse = every * self.timestep > COARSE * self.time  # false for nan
        return None if coarse else (self.coefficient, "" if math.isnan(self.time) else NOTE)


class HardNeighbours(NeighboursOfSpheres):
    """g at contact from the equation of state: Z - 1 is 2^(d-1) times the packing fraction and g;
    nan for unlike spheres and for those that lose energy. `diameter` is nan for unlike spheres."""

    def __init__(self, case: Case, observable: Any) -> None:
        super().__init__(case, observable)
        section, box = case.spheres, case.box
        kind, d = section.kinds[0], box.dimension
        alike = len(section.kinds) == 1 and kind.spread == 0
        if alike:
            self.diameter = kind.diameter * section.scale(box)
        phi = section.fraction(box)
        plain = section.collision.elastic and section.collision.hard
        if alike and plain and not section.heating:
            self.note = fluid_note(case)
            self.value = (theory.compressibility(phi, d) - 1) / (2 ** (d - 1) * phi)


class HardCooling:
    """A bath or warm walls of one temperature, or Haff's law."""

    answers = "granular-temperature"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, section = case, case.spheres
        collision, state = section.collision, hard_equilibrium(case)
        self.known = Cooling(collision.rough)
        warm = section.heating is not None or case.walls
        if warm and state is not None and not math.isnan(state.kT):
            heated = section.heating is not None
            heated |= any(surface.rule == "diffuse" for surface in surfaces(case))
            held = state.kT if heated else math.nan
            self.known = self.known._replace(held=held, fluctuates=True)
        constant = collision.constant_restitution
        smooth = not collision.rough and section.heating is None
        if constant is not None and uniform(case) and smooth:
            self.known = self.known._replace(restitution=constant)

    def haff_time(self, kT: float) -> float:
        """The time of Haff's law, from a temperature."""
        return haff_time(self.case, self.known.restitution, kT)
