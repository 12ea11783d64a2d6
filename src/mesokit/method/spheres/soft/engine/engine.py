"""The engine of soft spheres, as a simulation and its observables know it."""

from collections.abc import Collection
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.moments import moments
from mesokit.method.spheres.common.start.protocol import Started
from mesokit.method.spheres.soft.engine import groups
from mesokit.method.spheres.soft.engine.system import System
from mesokit.method.spheres.soft.laws import given_of, surfaces_of
from mesokit.method.spheres.soft.scales import timestep_of
from mesokit.seam.engine import Array, Integers, State

UNSTABLE = 1000.0  # times the kT of a bath: no motion that a bath slows is so hot


class SoftEngine:
    """Engine of soft spheres (`mesokit.seam.engine.Engine`) on the threads of one machine."""

    def __init__(self, case: Case, threads: int = 1) -> None:
        box = case.box
        self.case, self.made = case, made(case)
        self.n, self.dimension = len(self.made.diameters), box.dimension
        self.box, self.timestep = np.array(box.size, float), timestep_of(case)
        self.system = System(given_of(case, self.made), threads)
        self.threads, self.step = threads, 0
        self.surfaces = surfaces_of(case)
        self.seconds = {"steps": 0.0}

    def start(self, placed: Started) -> None:
        """Put the spheres where they start from."""
        if placed.diameters is not None:
            self.made = self.made._replace(
                diameters=placed.diameters,
                inertia=self.made.inertia * (placed.diameters / self.made.diameters) ** 2,
            )
            self.system = System(given_of(self.case, self.made), self.threads)
        self.system.fill(placed.positions, placed.velocities, placed.spins)
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
        wanted, found = 0.5 * self.dimension * free * kT, self.energies()["translation"]
        if found > 0:
            self.system.bodies.velocity[:, :3] *= np.sqrt(wanted / found)

    def check(self) -> None:
        """Raise RunError if velocities are no numbers, or far beyond those that a bath holds."""
        bodies, bath = self.system.bodies, self.case.spheres.thermostat
        if not (np.isfinite(bodies.velocity).all() and np.isfinite(bodies.place).all()):
            raise RunError("velocities are no numbers any more; expected a shorter timestep")
        kT = 2 * self.energies()["translation"] / (self.dimension * self.n)
        if bath is not None and kT > UNSTABLE * max(bath.held_kT, self.case.spheres.kT):
            raise RunError(
                f"kT = {kT:.3g}, where the bath holds {bath.held_kT:.3g}: the motion is unstable; "
                "expected a shorter spheres.timestep"
            )

    def end_warmup(self) -> None:
        """Forget what walls have taken."""
        self.system.forget_taken()

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    # --- what observables may ask ---------------------------------------------------------------

    def _rows(self, name: str, ids: Integers | None, columns: int) -> NDArray[Any]:
        rows = self.system.by_number(getattr(self.system.bodies, name)[:, :columns])
        return rows if ids is None else rows[ids]

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        """Places (n, d), in the box or where the spheres have gone to."""
        places = self._rows("place", ids, self.dimension)
        return places + self.images(ids) * self.box if unwrapped else places

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        """Image counts (n, d) of the spheres."""
        return self._rows("images", ids, self.dimension)

    def velocities(self, ids: Integers | None = None) -> Array:
        """Velocities (n, d)."""
        return self._rows("velocity", ids, self.dimension)

    def spins(self, ids: Integers | None = None) -> Array:
        """Angular velocities, (n,) in 2D and (n, 3) in 3D."""
        found = self._rows("spin", ids, 3)
        return found[:, 2] if self.dimension == 2 else found

    def masses(self, ids: Integers | None = None) -> Array:
        """Masses (n,)."""
        return self.made.masses if ids is None else self.made.masses[ids]

    def diameters(self, ids: Integers | None = None) -> Array:
        """Diameters (n,)."""
        return self.made.diameters if ids is None else self.made.diameters[ids]

    def forces(self) -> Array:
        """Forces of pairs and walls (n, d), without gravity."""
        return self._rows("force", None, self.dimension) * self.system.given.law.quantum

    def torques(self) -> Array:
        """Torques of contacts, (n,) in 2D and (n, 3) in 3D."""
        found = self._rows("torque", None, 3) * self.system.given.law.quantum
        return found[:, 2] if self.dimension == 2 else found

    def energies(self) -> dict[str, float]:
        """Kinetic energy of translation and of rotation; "potential": of pairs, walls and gravity;
        "contact": of these the pairs and walls alone."""
        v, spins = self.velocities(), self.spins().reshape(self.n, -1)
        gravity = np.array(self.case.spheres.gravity or (0.0,) * self.dimension)
        places = self.positions(unwrapped=True)
        contact = self._told()[:, groups.ENERGY].sum() * 0.5
        return {
            "translation": 0.5 * float(self.made.masses @ (v * v).sum(axis=1)),
            "rotation": 0.5 * float(self.made.inertia @ (spins * spins).sum(axis=1)),
            "potential": float(contact) - float(self.made.masses @ (places @ gravity)),
            "contact": float(contact),
        }

    def _told(self) -> Array:
        """Of every sphere, by number (n, 8), in units of the case but for the last: a number."""
        readings = self.system.readings(self.time)
        found = readings * self.system.given.law.quantum
        found[:, groups.TOUCHING] = readings[:, groups.TOUCHING]
        return found

    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...], ids: Integers | None = None
    ) -> tuple[Array, Array, Array, Array]:
        """Number, mass, momentum and sum of m v^2 in equal bins of the box along `axes`."""
        return moments(self, axes, bins, ids)

    def totals(self) -> tuple[int, Array, float]:
        """Number, momentum (d,) and kinetic energy of translation."""
        v = self.velocities()
        kinetic = 0.5 * float(self.made.masses @ (v * v).sum(axis=1))
        return self.n, self.made.masses @ v, kinetic

    def potential_energy(self) -> float:
        """Energy of pairs and walls."""
        return self.energies()["contact"]

    def coordination(self) -> NDArray[np.int64]:
        """How many spheres and walls touch each one, (n,); 0 of a potential."""
        return self.system.readings(self.time)[:, groups.TOUCHING]

    @property
    def wall_impulse(self) -> Array:
        """Momentum that each surface has taken since the warm-up, (surfaces, d)."""
        taken = np.zeros((self.surfaces.number, self.dimension))
        rows = self.system.taken()[:, : self.dimension]
        np.add.at(taken, self.surfaces.place, rows * self.timestep)
        return taken

    @property
    def stress(self) -> dict[str, Array]:
        """Minus the momentum flux, (d, d): "kinetic" and "pair", sums over m v v and r F over the
        volume of the box."""
        d, volume = self.dimension, float(np.prod(self.box))
        v = self.velocities()
        xx, yy, zz, xy, xz, yz = 0.5 * self._told()[:, groups.VIRIAL : groups.TOUCHING].sum(axis=0)
        virial = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[:d, :d]
        return {
            "kinetic": -(self.made.masses[:, None] * v).T @ v / volume,
            "pair": -virial / volume,
        }

    # --- checkpoints ----------------------------------------------------------------------------

    def state(self) -> State:
        """Everything that the next step depends on, by particle number."""
        return {**self.system.state(), "step": np.array(self.step)}

    def restore(self, state: State) -> None:
        """Go on from a state."""
        self.system.restore({name: array for name, array in state.items() if name != "step"})
        self.step = int(state["step"])
