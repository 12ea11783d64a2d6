"""The engine of event-driven dynamics, as a simulation and its observables know it."""

import math
from collections.abc import Collection, Sequence
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.moments import moments
from mesokit.method.spheres.common.start.protocol import Started
from mesokit.method.spheres.common.wall.surfaces import room_of
from mesokit.method.spheres.hard.engine import groups
from mesokit.method.spheres.hard.engine.collide import Rules
from mesokit.method.spheres.hard.engine.system import Given, System
from mesokit.method.spheres.hard.heating.protocol import Motion
from mesokit.method.spheres.hard.walls import wall_rows
from mesokit.method.spheres.hard.window import flight_bins, instant, window
from mesokit.seam.engine import Integers, Interrupted, State

Array = NDArray[np.float64]

FREE_TIMES = "free times"  # what an observable says that it needs


class EventDriven:
    """Engine of event-driven dynamics (`mesokit.seam.engine.Engine`).

    One thread: events have an order. Places and velocities at the end of a step are read off,
    nothing is brought there.
    """

    def __init__(self, case: Case, threads: int = 1, measures: Sequence[str] = ()) -> None:
        section, box = case.spheres, case.box
        self.measures = frozenset(measures)
        self.case, self.made = case, made(case)
        self.n, self.dimension = len(self.made.diameters), box.dimension
        self.box, self.timestep = np.array(box.size, float), section.timestep
        self.walls, self.step = wall_rows(case), 0
        self.system = self._system(self.made.diameters)
        self.seconds = {"events": 0.0}
        self._seen: tuple[Array, Array] | None = None

    def _system(self, diameters: Array) -> System:
        section, own = self.case.spheres, self.made
        pair = section.collision
        friction = math.inf if pair.friction is None else pair.friction
        rules = Rules(
            pair.kernel(),
            pair.tangential,
            friction,
            self.walls.contacts,
            np.uint64(self.case.run.seed),
        )
        return System(
            Given(
                tuple(self.box),
                room_of(self.case).closed,
                section.gravity,
                diameters,
                own.masses,
                own.inertia * (diameters / own.diameters) ** 2,
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
        motion = Motion(velocities, self.made.masses, self.case.run.seed, turn)
        self.case.spheres.heating.act(motion, self.system.window)

    def start(self, placed: Started) -> None:
        """Put the spheres where they start from."""
        if placed.diameters is not None:
            self.system = self._system(placed.diameters)
        self.system.fill(placed.positions, placed.velocities, placed.spins)
        self._seen = None

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Do the events of some steps. Raises RunError for inelastic collapse, and Interrupted."""
        began, goal = perf_counter(), self.step + steps
        self._seen = None
        try:
            self.system.run_to(*self._clock(goal))
        except Interrupted:
            self.step = self._steps_done(goal - 1)
            raise
        self.step = goal
        self.seconds["events"] += perf_counter() - began

    def _clock(self, step: int) -> tuple[int, float]:
        """How many windows are over after so many steps, and the time since the last of them."""
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
        """Raise RunError if numbers are none any more."""
        if not np.isfinite(self._read()[1]).all():
            raise RunError("velocities are no numbers any more")

    def end_warmup(self) -> None:
        """Forget counts of events, and what walls have taken."""
        tally = self.system.tally
        tally.counts[: groups.IN_A_ROW] = 0
        tally.sums[:] = 0
        tally.impulse[:] = 0
        if FREE_TIMES in self.measures:
            tally.flights.counts[:] = 0
            tally.flights.sums[:] = 0

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    # --- what observables may ask ---------------------------------------------------------------

    def _read(self) -> tuple[Array, Array]:
        if self._seen is None:
            self._seen = self.system.read()
        return self._seen

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        """Places (n, d), in the box or where the spheres have gone to."""
        places = self._read()[0][_chosen(ids)]
        return places.copy() if unwrapped else self._inside(places)

    def _inside(self, places: Array) -> Array:
        inside = places - np.floor(places / self.box) * self._repeats * self.box
        return np.where((inside >= self.box) & (self._repeats > 0), 0.0, inside)

    @property
    def _repeats(self) -> Array:
        return np.array([float(not shut) for shut in self.system.given.closed])

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        """Image counts (n, d) of the spheres."""
        places = self._read()[0][_chosen(ids)]
        return (np.floor(places / self.box) * self._repeats).astype(np.int32)

    def velocities(self, ids: Integers | None = None) -> Array:
        """Velocities (n, d)."""
        return self._read()[1][_chosen(ids)].copy()

    def masses(self, ids: Integers | None = None) -> Array:
        """Masses (n,)."""
        return self.made.masses[_chosen(ids)]

    def diameters(self, ids: Integers | None = None) -> Array:
        """Diameters (n,)."""
        return self.system.given.diameters[_chosen(ids)]

    def spins(self, ids: Integers | None = None) -> Array:
        """Angular velocities, (n,) in 2D and (n, 3) in 3D."""
        columns = slice(groups.SPIN, groups.SPIN + (1 if self.dimension == 2 else 3))
        found = self.system.by_number(self.system.spheres.body[:, columns])[_chosen(ids)]
        return found[:, 0] if self.dimension == 2 else found

    def energies(self) -> dict[str, float]:
        """Kinetic energy of translation and of rotation, and potential energy: of pairs, and in
        gravity."""
        v, spins = self._read()[1], self.spins().reshape(self.n, -1)
        gravity = np.array(self.case.spheres.gravity or (0.0,) * self.dimension)
        places = self.positions(unwrapped=True)
        return {
            "translation": 0.5 * float(self.made.masses @ (v * v).sum(axis=1)),
            "rotation": 0.5 * float(self.system.given.inertia @ (spins * spins).sum(axis=1)),
            "potential": self._energy_of_pairs() - float(self.made.masses @ (places @ gravity)),
        }

    def _energy_of_pairs(self) -> float:
        """Of all pairs that feel one another."""
        pair = self.case.spheres.collision
        if pair.energy_within == 0.0:
            return 0.0
        diameters = self.diameters()
        period = np.where(self._repeats > 0, self.box, 0.0)
        one, two, distance = near_pairs(
            self.positions(), pair.reach * float(diameters.max()), period
        )
        within = 0.5 * pair.reach * (diameters[one] + diameters[two])
        return pair.energy_within * int((distance < within).sum())

    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...], ids: Integers | None = None
    ) -> tuple[Array, Array, Array, Array]:
        """Number, mass, momentum and sum of m v^2 in equal bins of the box along `axes`."""
        return moments(self, axes, bins, ids)

    def totals(self) -> tuple[int, Array, float]:
        """Number, momentum (d,) and kinetic energy of translation."""
        v = self._read()[1]
        return self.n, self.made.masses @ v, self.energies()["translation"]

    @property
    def collisions(self) -> tuple[int, int, int]:
        """Collisions of pairs and with walls since the warm-up, and how many of both the contact
        time has made elastic."""
        counts = self.system.tally.counts
        return int(counts[groups.PAIRS]), int(counts[groups.WALLS]), int(counts[groups.ELASTIC])

    @property
    def wall_impulse(self) -> Array:
        """Momentum that each surface has taken since the warm-up, (surfaces, d)."""
        taken = np.zeros((len(self.walls.names), self.dimension))
        np.add.at(taken, self.walls.surface, self.system.tally.impulse)
        return taken

    @property
    def virial(self) -> float:
        """Sum of r.dp over collisions of pairs since the warm-up."""
        return float(self.system.tally.sums[groups.VIRIAL])

    @property
    def free_times(self) -> tuple[Array, NDArray[np.int64], Array]:
        """Of the times between successive collisions of a sphere since the warm-up: edges of bins
        (bins + 1,); how many there are in each, and last longer ones (bins + 1,); and the sums of
        times and squares (2,)."""
        found = self.system.tally.flights
        edges = np.arange(len(found.counts)) / found.per_time
        return edges, found.counts.copy(), found.sums.copy()

    # --- checkpoints ----------------------------------------------------------------------------

    def state(self) -> State:
        """Everything that the next event depends on, by particle number."""
        return {**self.system.state(), "step": np.array(self.step)}

    def restore(self, state: State) -> None:
        """Go on from a state."""
        self.system.restore({name: array for name, array in state.items() if name != "step"})
        self.step = int(state["step"])
        self._seen = None


def _chosen(ids: Integers | None) -> Any:
    return slice(None) if ids is None else ids
