"""The engine of rigid grains, for a simulation and its observables."""

import math
from collections.abc import Collection, Sequence
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.geometry import walls
from mesokit.method.spheres.common.contacts.now import Contacts, in_order
from mesokit.method.spheres.common.engine import SphereEngine
from mesokit.method.spheres.common.walls import AXIS, KIND, PLANE, displaced, surfaces_of
from mesokit.method.spheres.rigid.engine.ended import Now, no_room, too_fast
from mesokit.method.spheres.rigid.engine.groups import PER_MASS, SHIFT, SPEED, SPIN
from mesokit.method.spheres.rigid.engine.system import RigidSystem
from mesokit.method.spheres.rigid.scales import timestep_of
from mesokit.method.spheres.rigid.setup import setup_of
from mesokit.seam.engine import Array, Integers, State

LOOKS = 1000  # steps between two looks at the room that plates leave


class Solved(NamedTuple):
    """Sweeps in the last step, and since the warm-up; residual: largest change of an impulse in the
    last sweep over the mean impulse; mean normal force of contacts with one; largest overlap."""

    sweeps: int
    so_far: int
    residual: float
    mean_force: float
    overlap: float


class RigidEngine(SphereEngine):
    """Engine of rigid grains (`mesokit.seam.engine.Engine`) on the threads of one machine."""

    system: RigidSystem

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        super().__init__(case)
        self.timestep, self.threads = timestep_of(case), threads
        self.system, self.surfaces = self._system(), surfaces_of(case)
        self.seconds = {"steps": 0.0}
        contacts = [surface.contact for _, surface, _ in walls.surfaces(case)]
        self._driven = any(contact is not None and contact.speed > 0 for contact in contacts)

    def _system(self) -> RigidSystem:
        return RigidSystem(setup_of(self.case, self.made), self.threads)

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps. Raises RunError for grains too fast for the timestep."""
        began = perf_counter()
        end = self.step + steps
        while True:
            some = min(end - self.step, LOOKS)
            done = self.system.run(self.step, some)
            self.step += done
            if done < some:
                raise RunError(too_fast(self.case, self._now()))
            self._require_room()
            if self.step >= end:
                break
        self.seconds["steps"] += perf_counter() - began

    def _now(self) -> Now:
        """What grains and plates do, for the message that ends a run."""
        volume = self.case.spheres.fraction(self.case.box) * self.case.box.volume
        pushed = np.zeros(self.surfaces[0])
        pushed[self.surfaces[1][: len(self.system.plates)]] = self.system.plates[:, SPEED]
        speeds, room = np.linalg.norm(self.velocities(), axis=1), self.room_between_plates
        filled = volume / float(np.prod(room)) if (room > 0).all() else math.inf
        return Now(self.time, speeds, pushed, filled)

    def check(self) -> None:
        """Raise RunError if a velocity or a place is not finite, or if plates leave no room."""
        bodies = self.system.bodies
        if not (np.isfinite(bodies.motion).all() and np.isfinite(bodies.place).all()):
            raise RunError("velocities are no numbers any more; expected a shorter timestep")
        self._require_room()

    def _require_room(self) -> None:
        """Raise RunError if plates of a given speed leave grains less room than they fill."""
        if self._driven and (squeezed := no_room(self.case, self._now())):
            raise RunError(squeezed)

    def end_warmup(self) -> None:
        """Set the momentum that walls have taken, and the energy lost, to zero."""
        self.system.forget_sums()

    def restore(self, state: State) -> None:
        """Continue from a state."""
        self.system.made_at = int(state["step"]) * self.timestep
        super().restore(state)

    # --- readings of observables ----------------------------------------------------------------

    def _rows(self, name: str, ids: Integers | None, columns: slice) -> NDArray[Any]:
        rows = self.system.by_number(getattr(self.system.bodies, name)[:, columns])
        return rows if ids is None else rows[ids]

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        places = self._rows("place", ids, slice(self.dimension))
        return places + self.images(ids) * self.box if unwrapped else places

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        return self._rows("images", ids, slice(self.dimension))

    def velocities(self, ids: Integers | None = None) -> Array:
        return self._rows("motion", ids, slice(self.dimension))

    def spins(self, ids: Integers | None = None) -> Array:
        d = self.dimension
        found = self._rows("motion", ids, slice(SPIN[d], SPIN[d] + (1 if d == 2 else 3)))
        spins = found / (0.5 * self.diameters(ids))[:, None]
        return spins[:, 0] if d == 2 else spins

    def potential_energy(self) -> float:
        """That of cohesion: minus its force times how far gaps lie within its range."""
        law = self.case.spheres.contact.cohesion
        if law is None:
            return 0.0
        return -law.force * math.fsum(np.maximum(law.range - self.contacts().gaps, 0.0))

    def contacts(self) -> Contacts:
        """All contacts that had a force in the last step, with places and normals of now."""
        pairs, values = self.system.contacts(self.time)
        at_walls = pairs[:, 1] < 0
        pairs[at_walls, 1] = -1 - self.surfaces[1][-1 - pairs[at_walls, 1]]
        return in_order(pairs, values, self.dimension, lambda places: self.system.inside(places)[0])

    def coordination(self) -> NDArray[np.int64]:
        """Number of spheres and walls with a force on each grain, (n,)."""
        pairs = self.contacts().pairs
        return np.bincount(pairs[pairs >= 0], minlength=self.n)

    @property
    def solved(self) -> Solved:
        """How well the forces of the last step are known."""
        sweeps, ratio, mean, so_far = self.system.last_solved()
        overlap = self.system.largest_overlap(self.time)
        return Solved(sweeps, so_far, ratio, mean / self.timestep, overlap)

    @property
    def stress(self) -> dict[str, Array]:
        """Minus the momentum flux, (d, d): "kinetic" and "pair", sums over m v v and r F over the
        volume of the box."""
        volume, v, found = float(np.prod(self.box)), self.velocities(), self.contacts()
        pairs = ~found.at_walls
        radii = 0.5 * self.diameters()[found.pairs[pairs]].sum(axis=1)
        branch = found.normals[pairs] * (radii + found.gaps[pairs])[:, None]
        return {
            "kinetic": -(self.made.masses[:, None] * v).T @ v / volume,
            "pair": -branch.T @ found.forces[pairs] / volume,
        }

    @property
    def plate_shifts(self) -> Array:
        """How far each surface has moved along its normal into the box, (surfaces,)."""
        number, places = self.surfaces
        found, rows = np.zeros(number), self.system.given.listed.rows
        pushed = self.system.given.drive[:, PER_MASS] > 0
        for w in range(len(rows)):
            given, _ = displaced(rows, w, self.time)
            found[places[w]] = self.system.plates[w, SHIFT] if pushed[w] else given
        return found

    @property
    def room_between_plates(self) -> Array:
        """Lengths of the box (d,) less the ways that plates have moved into it."""
        rows, (_, places) = self.system.given.listed.rows, self.surfaces
        left, shifts = self.box.copy(), self.plate_shifts
        for w in np.flatnonzero(rows[:, KIND] == PLANE):
            left -= shifts[places[w]] * np.abs(rows[w, AXIS : AXIS + self.dimension])
        return left

    @property
    def wall_impulse(self) -> Array:
        """Momentum that each surface has taken since the warm-up, (surfaces, d)."""
        number, places = self.surfaces
        taken = np.zeros((number, self.dimension))
        np.add.at(taken, places, self.system.taken()[:, : self.dimension])
        return taken

    @property
    def lost(self) -> dict[str, float]:
        """Energy that contacts have taken since the warm-up, by what took it."""
        return dict(
            zip(("impact", "friction", "rolling"), map(float, self.system.lost()), strict=True)
        )
