"""Theory of the velocities of spheres: their distribution and its fourth cumulant."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.spheres.common.expected.cooling import rate
from mesokit.method.spheres.common.expected.slices import Find
from mesokit.method.spheres.common.groups import ids_of_kind
from mesokit.method.spheres.common.made import made
from mesokit.seam.engine import RunningSpheres

Array = NDArray[np.float64]
FEW = 0.01  # of the collisions, made elastic by a contact time: they do not change the law


def cumulant(find: Find, case: Case) -> tuple[float, str]:
    """a_2 and the name of its law, of spheres that keep energy, and of smooth ones of constant
    restitution without walls; nan of others."""
    section = case.spheres
    if find(case) is not None:
        return 0.0, "Maxwell"
    collision = section.instant_collision
    if collision is None or case.walls or section.gravity:
        return math.nan, ""
    if collision.elastic:
        return 0.0, "Maxwell"
    constant, heating = collision.constant_restitution, section.energy_source
    kicked = heating is not None and heating.white_noise
    mixed = len(section.kinds) > 1 or section.kinds[0].spread
    if mixed or constant is None or collision.rough or (heating and not kicked):
        return math.nan, ""
    if theory.elastic_share(rate(case, section.kT), collision.contact_time) > FEW:
        return math.nan, ""
    known = theory.fourth_cumulant(constant, case.box.dimension, heated=kicked)
    return known, "van Noije and Ernst"


class Cumulant:
    """Fourth cumulant of the velocities: `value`, nan without a theory, and the `law`."""

    answers = "velocity-cumulant"

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        self.value, self.law = cumulant(find, case)
        self.exact = self.value == 0.0


class VelocitiesOfSpheres:
    """Maxwell's distribution, or that with the first Sonine polynomial; of all spheres or a kind.

    Each sample is about the mean velocity and scaled by the temperature of those that count: on the
    mean a histogram loses what both would take.
    """

    answers = "velocity-distribution"

    def __init__(self, find: Find, case: Case, observable: Any) -> None:
        self.dimension = case.box.dimension
        self.axis = case.box.index(observable.component or "x", "component")
        self.group = ids_of_kind(case, observable.kind)
        if len(self.group) < 3:
            raise CaseError(
                f"velocity-distribution: {len(self.group)} spheres; expected 3 at least"
            )
        chosen = np.unique(np.linspace(0, len(self.group) - 1, observable.particles).astype(int))
        self.chosen = chosen if observable.particles < len(self.group) else slice(None)
        part = min(1.0, observable.particles / len(self.group))
        roots = np.sqrt(made(case).masses[self.group])
        alike = float(roots.sum() ** 2 / (len(roots) * (roots**2).sum()))
        self.taken_by_mean, self.taken_by_energy, self.kept_energy = part * alike, part, 0.0
        self.ids = self.group[self.chosen]
        self.cumulant, self.law = cumulant(find, case)
        self.known = (not math.isnan(self.cumulant),) * 2

    def numbers(self, spheres: RunningSpheres) -> Array:
        """Velocities (n, d) over sqrt(kT/m), with the temperature at this moment."""
        v, mass = spheres.velocities(self.group), spheres.masses(self.group)
        u = (v - mass @ v / mass.sum()) * np.sqrt(mass)[:, None]
        kT = float((u * u).sum()) / u.size
        return np.asarray(u[self.chosen] / math.sqrt(kT) if kT > 0 else u[self.chosen])

    def warm(self, runs: int) -> float:
        return 0.0

    def legend(self) -> str:
        return "Maxwell" if self.cumulant == 0 else "first Sonine polynomial"

    def note(self, classes: int) -> str:
        if self.cumulant == 0:
            return f"Maxwell, {classes} classes"
        return f"approximate: first order in a_2 = {self.cumulant:.3g}, dilute uniform gas"
