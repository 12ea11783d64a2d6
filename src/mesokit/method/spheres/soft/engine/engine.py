"""The engine of soft spheres, for a simulation and its observables."""

from collections.abc import Collection, Sequence
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.method.spheres.common.contacts.now import Contacts, in_order
from mesokit.method.spheres.common.engine import SphereEngine
from mesokit.method.spheres.common.start.first_state import Started
from mesokit.method.spheres.common.walls import surfaces_of
from mesokit.method.spheres.soft.engine import groups
from mesokit.method.spheres.soft.engine.system import SoftSystem
from mesokit.method.spheres.soft.laws import given_of
from mesokit.method.spheres.soft.scales import timestep_of
from mesokit.seam.engine import Array, Integers

UNSTABLE = 1000.0  # times the kT of a bath: no motion that a bath slows is so hot


class SoftEngine(SphereEngine):
    """Engine of soft spheres (`mesokit.seam.engine.Engine`) on the threads of one machine."""

    system: SoftSystem

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        super().__init__(case)
        self.timestep, self.threads = timestep_of(case), threads
        self.system, self.surfaces = self._system(), surfaces_of(case)
        self.seconds = {"steps": 0.0}

    def _system(self) -> SoftSystem:
        return SoftSystem(given_of(self.case, self.made), self.threads)

    def start(self, placed: Started) -> None:
        super().start(placed)
        self.system.find_forces(self.time)

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps. Raises RunError where forces are beyond all bounds."""
        began, left = perf_counter(), steps
        bath = self.case.spheres.thermostat
        every = 0 if bath is None else bath.scaled_every
        if steps == 0:
            self.system.run(self.step, 0)
        while left:
            some = min(left, every - self.step % every) if every else left
            self.system.run(self.step, some)
            self.step, left = self.step + some, left - some
            if every and self.step % every == 0:
                self._scale(bath.held_kT)
        self.seconds["steps"] += perf_counter() - began

    def _scale(self, kT: float) -> None:
        """Scale velocities to (n - 1) d kT/2, or n d kT/2 where walls take momentum."""
        free = self.n if self.case.walls or self.n == 1 else self.n - 1
        wanted, found = 0.5 * self.dimension * free * kT, self.totals()[2]
        if found > 0:
            self.system.bodies.velocity[:, :3] *= np.sqrt(wanted / found)

    def check(self) -> None:
        """Raise RunError if a velocity is not finite, or far above those that a bath holds."""
        bodies, bath = self.system.bodies, self.case.spheres.thermostat
        if not (np.isfinite(bodies.velocity).all() and np.isfinite(bodies.place).all()):
            raise RunError("velocities are no numbers any more; expected a shorter timestep")
        kT = 2 * self.totals()[2] / (self.dimension * self.n)
        if bath is not None and kT > UNSTABLE * max(bath.held_kT, self.case.spheres.kT):
            raise RunError(
                f"kT = {kT:.3g}, where the bath holds {bath.held_kT:.3g}: the motion is unstable; "
                "expected a shorter spheres.timestep"
            )

    def end_warmup(self) -> None:
        """Set the momentum that walls have taken to zero."""
        self.system.forget_taken()

    # --- readings of observables ----------------------------------------------------------------

    def _rows(self, name: str, ids: Integers | None, columns: int) -> NDArray[Any]:
        rows = self.system.by_number(getattr(self.system.bodies, name)[:, :columns])
        return rows if ids is None else rows[ids]

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        places = self._rows("place", ids, self.dimension)
        return places + self.images(ids) * self.box if unwrapped else places

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        return self._rows("images", ids, self.dimension)

    def velocities(self, ids: Integers | None = None) -> Array:
        return self._rows("velocity", ids, self.dimension)

    def spins(self, ids: Integers | None = None) -> Array:
        found = self._rows("spin", ids, 3)
        return found[:, 2] if self.dimension == 2 else found

    def forces(self) -> Array:
        """Forces of pairs and walls (n, d), without gravity."""
        return self._rows("force", None, self.dimension) * self.system.given.law.quantum

    def torques(self) -> Array:
        """Torques of contacts, (n,) in 2D and (n, 3) in 3D."""
        found = self._rows("torque", None, 3) * self.system.given.law.quantum
        return found[:, 2] if self.dimension == 2 else found

    def _readings(self) -> Array:
        """Energies and virials of each sphere by number (n, 8), in units of the case."""
        return self.system.readings(self.time) * self.system.given.law.quantum

    def potential_energy(self) -> float:
        return float(self._readings()[:, groups.ENERGY].sum() * 0.5)

    def coordination(self) -> NDArray[np.int64]:
        """Number of spheres and walls that touch each sphere, (n,); 0 with a potential."""
        return self.system.readings(self.time)[:, groups.TOUCHING]

    def contacts(self) -> Contacts:
        """All contacts as they are now; none with a potential.

        Forces are those of the present places, velocities and springs. Dashpots make them differ
        from `forces`, which steps have taken from velocities of the half step.
        """
        pairs, values = self.system.contacts(self.time)
        walls = pairs[:, 1] < 0
        pairs[walls, 1] = -1 - self.surfaces[1][-1 - pairs[walls, 1]]
        return in_order(pairs, values, self.dimension, lambda places: self.system.inside(places)[0])

    @property
    def wall_impulse(self) -> Array:
        """Momentum that each surface has taken since the warm-up, (surfaces, d)."""
        number, places = self.surfaces
        taken, rows = np.zeros((number, self.dimension)), self.system.taken()[:, : self.dimension]
        np.add.at(taken, places, rows * self.timestep)
        return taken

    @property
    def stress(self) -> dict[str, Array]:
        """Minus the momentum flux, (d, d): "kinetic" and "pair", sums over m v v and r F over the
        volume of the box."""
        d, volume, v = self.dimension, float(np.prod(self.box)), self.velocities()
        columns = slice(groups.VIRIAL, groups.TOUCHING)
        xx, yy, zz, xy, xz, yz = 0.5 * self._readings()[:, columns].sum(axis=0)
        virial = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[:d, :d]
        return {
            "kinetic": -(self.made.masses[:, None] * v).T @ v / volume,
            "pair": -virial / volume,
        }
