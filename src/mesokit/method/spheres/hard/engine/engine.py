"""The engine of event-driven dynamics, for a simulation and its observables."""

import math
from collections.abc import Collection, Sequence
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.engine import SphereEngine
from mesokit.method.spheres.common.start.first_state import Started
from mesokit.method.spheres.common.walls import room_of, surface_rows
from mesokit.method.spheres.hard.checks import wall_contacts
from mesokit.method.spheres.hard.engine import collide, groups
from mesokit.method.spheres.hard.engine.system import HardSetup, HardSystem
from mesokit.method.spheres.hard.heating.protocol import Heated
from mesokit.method.spheres.hard.window import flight_bins, instant, window
from mesokit.seam.engine import Array, Integers, Interrupted, State

FREE_TIMES = "free times"  # in `measures` of an observable that reads times between collisions


class EventDriven(SphereEngine):
    """Engine of event-driven dynamics (`mesokit.seam.engine.Engine`).

    One thread: events have an order. Places and velocities at the end of a step are computed from
    each sphere's last event; its state in memory stays at the time of that event.
    """

    system: HardSystem

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        super().__init__(case)
        self.measures, self.timestep = frozenset(measures), case.spheres.timestep
        self.walls = surface_rows(case)
        self.system = self._system()
        self.seconds = {"events": 0.0}
        self._now: tuple[Array, Array] | None = None  # places and velocities, once computed

    def _system(self) -> HardSystem:
        section, made = self.case.spheres, self.made
        pair = section.collision
        rules = collide.Rules(
            pair.kernel(),
            pair.tangential,
            math.inf if pair.friction is None else pair.friction,
            wall_contacts(self.case),
            np.uint64(self.case.run.seed),
        )
        return HardSystem(
            HardSetup(
                tuple(self.box),
                room_of(self.case).closed,
                section.gravity,
                made.diameters,
                made.masses,
                made.inertia,
                self.walls.rows,
                rules,
                pair.contact_time,
                window(self.case),
                instant=instant(self.case),
                reach=pair.reach,
                turn=self._heat if section.heating is not None else None,
                flights=flight_bins(self.case) if FREE_TIMES in self.measures else None,
            )
        )

    def _heat(self, velocities: Array, turn: int) -> None:
        heated = Heated(velocities, self.made.masses, self.case.run.seed, turn)
        self.case.spheres.heating.act(heated, self.system.window)

    def start(self, placed: Started) -> None:
        super().start(placed)
        self._now = None

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Do the events of some steps. Raises RunError for inelastic collapse, and Interrupted."""
        began, goal = perf_counter(), self.step + steps
        self._now = None
        try:
            self.system.run_to(*self._clock(goal))
        except Interrupted:
            self.step = self._steps_done(goal - 1)
            raise
        self.step = goal
        self.seconds["events"] += perf_counter() - began

    def _clock(self, step: int) -> tuple[int, float]:
        """The number of windows that are over after so many steps, and the time since the last."""
        time, length = step * self.timestep, self.system.window
        windows = math.floor(time / length)
        return windows, time - windows * length

    def _steps_done(self, most: int) -> int:
        """The last step whose events are all done."""
        system = self.system
        here = system.windows, system.now
        done = int((system.windows * system.window + system.now) / self.timestep) + 1
        while self._clock(done) > here:
            done -= 1
        return max(self.step, min(done, most))

    def check(self) -> None:
        """Raise RunError if a velocity is not finite."""
        if not np.isfinite(self._read()[1]).all():
            raise RunError("velocities are no numbers any more")

    def end_warmup(self) -> None:
        """Set counts of events and the momentum taken by walls to zero."""
        tally = self.system.tally
        tally.counts[: collide.IN_A_ROW] = 0
        for sums in (tally.sums, tally.impulse, *tally.flights[1:]):
            sums[:] = 0

    # --- readings of observables ----------------------------------------------------------------

    def _read(self, ids: Integers | None = None) -> tuple[Array, Array]:
        """Places outside the box too, and velocities, of some spheres (all unless said)."""
        if self._now is None:
            self._now = self.system.read()
        places, velocities = self._now
        return (places, velocities) if ids is None else (places[ids], velocities[ids])

    @property
    def _repeats(self) -> Array:
        return np.array([float(not shut) for shut in self.system.given.closed])

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        places = self._read(ids)[0]
        if unwrapped:
            return places.copy()
        inside = places - np.floor(places / self.box) * self._repeats * self.box
        return np.where((inside >= self.box) & (self._repeats > 0), 0.0, inside)

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        return (np.floor(self._read(ids)[0] / self.box) * self._repeats).astype(np.int32)

    def velocities(self, ids: Integers | None = None) -> Array:
        return self._read(ids)[1].copy()

    def spins(self, ids: Integers | None = None) -> Array:
        columns = slice(groups.SPIN, groups.SPIN + (1 if self.dimension == 2 else 3))
        found = self.system.by_number(self.system.spheres.body[:, columns])
        found = found[:, 0] if self.dimension == 2 else found
        return found if ids is None else found[ids]

    def potential_energy(self) -> float:
        """Energy of all pairs within the range of their potential."""
        pair = self.case.spheres.collision
        if pair.energy_within == 0.0:
            return 0.0
        diameters = self.diameters()
        most = pair.reach * float(diameters.max())
        one, other, distances = near_pairs(self.positions(), most, self._repeats * self.box)
        within = 0.5 * pair.reach * (diameters[one] + diameters[other])
        return pair.energy_within * int((distances < within).sum())

    @property
    def collisions(self) -> tuple[int, int, int]:
        """Collisions of pairs and with walls since the warm-up, and the number of both that the
        contact time has made elastic."""
        counts = self.system.tally.counts
        return int(counts[collide.PAIRS]), int(counts[collide.WALLS]), int(counts[collide.ELASTIC])

    def logged(self) -> dict[str, float]:
        pairs, walls, _ = self.collisions
        return {**self.energies(), "collisions": pairs, "wall collisions": walls}

    @property
    def wall_impulse(self) -> Array:
        """Momentum that each surface has taken since the warm-up, (surfaces, d)."""
        taken = np.zeros((len(self.walls.names), self.dimension))
        np.add.at(taken, self.walls.surface, self.system.tally.impulse)
        return taken

    @property
    def virial(self) -> float:
        """Sum of r.dp over collisions of pairs since the warm-up."""
        return float(self.system.tally.sums[collide.VIRIAL])

    @property
    def free_times(self) -> tuple[Array, NDArray[np.int64], Array]:
        """Times between successive collisions of a sphere since the warm-up: edges of bins
        (bins + 1,); counts (bins + 1,), the last of longer ones; sums of times and squares (2,)."""
        found = self.system.tally.flights
        edges = np.arange(len(found.counts)) / found.per_time
        return edges, found.counts.copy(), found.sums.copy()

    def restore(self, state: State) -> None:
        super().restore(state)
        self._now = None
