"""Hard spheres in memory: run to a time, read, store and restore."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.kernels.packing import Packing
from mesokit.loops.layout import by_number, zeros
from mesokit.loops.neighbours import inverse_lengths
from mesokit.method.spheres.common.walls import FREQUENCY, PHASE
from mesokit.method.spheres.hard.engine import groups, run
from mesokit.method.spheres.hard.engine.collide import COUNTS, SUMS, Flights, Rules, Tally
from mesokit.method.spheres.hard.engine.groups import HardLists, HardWorld, Queue, SphereMemory
from mesokit.processes.signals import heard
from mesokit.seam.engine import Array, Interrupted, State

WANTED = {2: 10.0, 3: 14.0}  # spheres on a list: longer ones cost more, shorter ones last less
CLOSEST = 0.1  # of the largest diameter: the smallest shell
ROOM = 24  # entries of a list, at first; a multiple of eight
PER_BIN = 4.0  # events
KEPT = ("state", "body", "boxes", "hits")


class HardSetup(NamedTuple):
    """Parameters of a system of hard spheres.

    size, closed, gravity (d,): lengths of the box, axes closed by walls, acceleration; diameters,
    masses, inertia (n,); walls (walls, 14); rules; lasting: a collision sooner than this after
    another loses no energy; window: time of a window; instant: a time that counts as none; growth
    of diameters, relative per time; reach: range of the potential in diameters; turn: function that
    changes velocities (n, d) by particle number at the end of a window; flights: width and number
    of the bins for times between collisions, None without; most: largest allowed number of events
    of a sphere in a unit of time.
    """

    size: Sequence[float]
    closed: Sequence[bool]
    gravity: Sequence[float]
    diameters: Array
    masses: Array
    inertia: Array
    walls: Array
    rules: Rules
    lasting: float
    window: float
    instant: float = 0.0
    growth: float = 0.0
    reach: float = 1.0
    turn: Callable[[Array, int], None] | None = None
    flights: tuple[float, int] | None = None
    most: float = math.inf


class Collapse(RunError):
    """Spheres that collide without end."""


class HardSystem:
    """Hard spheres in a box, their neighbour lists and the queue of their events."""

    def __init__(self, given: HardSetup) -> None:
        n, d = len(given.diameters), len(given.size)
        self.given, self.n, self.d, self._packing = given, n, d, Packing()
        self.window, self.windows = given.window, 0
        self.now = 0.0  # since the start of the window
        self.spheres = SphereMemory(
            zeros((n, groups.WIDTH)),
            np.zeros((n, groups.BODY_WIDTH)),
            np.zeros((n, d), np.int32),
            np.arange(n, dtype=np.int64),
            np.zeros(n, np.int64),
        )
        flights: Any = ()
        if given.flights is not None:
            width, bins = given.flights
            flights = Flights(1 / width, np.zeros(bins + 1, np.int64), np.zeros(2))
        counts, sums = np.zeros(COUNTS, np.int64), np.zeros(SUMS)
        self.tally = Tally(counts, sums, np.zeros((len(given.walls), d)), flights)
        self.room, self.per_time = ROOM, 1.0
        self.walls = given.walls.copy()

    # --- in and out -----------------------------------------------------------------------------

    def fill(self, positions: Array, velocities: Array, spins: Array) -> None:
        """Put the spheres at these places (n, d), with velocities (n, d) and spins."""
        state, body, d = self.spheres.state, self.spheres.body, self.d
        state[:, :d] = positions
        state[:, groups.TIME] = 0.0
        state[:, groups.VELOCITY : groups.VELOCITY + d] = velocities
        state[:, groups.RADIUS] = 0.5 * self.given.diameters
        body[:, groups.MASS], body[:, groups.INERTIA] = self.given.masses, self.given.inertia
        body[:, groups.LAST] = -np.inf
        spins = np.asarray(spins).reshape(self.n, -1)
        body[:, groups.SPIN : groups.SPIN + spins.shape[1]] = spins
        self.lists, self.queue = self._lists(), self._queue()
        run.run_events.compile_ahead(*self._arguments(0.0))
        run.synchronise(self.world, self.spheres, 0.0)
        self.begin_window(0)

    def begin_window(self, windows: int) -> None:
        """Sort the spheres in memory and predict everything, in the window after so many."""
        self.windows = windows
        self.walls[:, PHASE] = self.walls[:, FREQUENCY] * (windows * self.window)
        # Neighbours in space become neighbours in memory; this changes no bit of the motion.
        places, size = self.spheres.state[:, : self.d], np.array(self.given.size)
        side = np.maximum(1, size // self.widest(0.0)).astype(int)
        cell = np.minimum((places * (side / size)).astype(int), side - 1)
        code = np.ravel_multi_index(tuple(np.clip(cell, 0, None).T), tuple(side))
        order = np.lexsort((self.spheres.number, code))
        for array in self.spheres:
            array[:] = array[order]
        self.prepare()

    @property
    def growth(self) -> float:
        """Relative growth of diameters per time, at the start of this window."""
        return self.given.growth / (1.0 + self.given.growth * (self.windows * self.window))

    @property
    def world(self) -> HardWorld:
        """The constants of this window."""
        given, size = self.given, tuple(float(length) for length in self.given.size)
        gravity = tuple(float(g) for g in given.gravity) or (0.0,) * self.d
        rest = self.growth, self.walls, given.lasting, given.instant
        return HardWorld(size, inverse_lengths(size, given.closed), gravity, *rest)

    def widest(self, shell: float) -> float:
        """The longest distance of the centres of neighbours."""
        largest = 2.0 * float(self.spheres.state[:, groups.RADIUS].max())
        return largest * self.swelling + 2.0 * shell

    @property
    def swelling(self) -> float:
        """Range of the interaction at the end of a window, in diameters at its start."""
        return self.given.reach * (1.0 + self.growth * self.window)

    def prepare(self) -> None:
        """Make lists and queue anew, with larger lists and other bins where these are better."""
        self._predict_all()
        waits = np.sort(self.queue.time) - self.now
        if (middle := float(waits[self.n // 2])) > 0 and math.isfinite(middle):
            per_time = 0.5 * self.n / (PER_BIN * middle)
            if not 0.5 < self.per_time / per_time < 2.0:
                self.per_time = per_time
                self._predict_all()

    def _predict_all(self) -> None:
        while True:
            self.lists, self.queue = self._lists(), self._queue()
            rules, spheres = self.given.rules, self.spheres
            if run.rebuild(self.world, rules, spheres, self.lists, self.queue, self.now):
                break
            self.room *= 2

    def _lists(self) -> HardLists:
        n, d, size = self.n, self.d, np.array(self.given.size, float)
        ball = math.pi if d == 2 else 4 * math.pi / 3
        reach = (WANTED[d] * size.prod() / (n * ball)) ** (1 / d)
        diameter = self.widest(0.0)
        shell = max(0.5 * (reach - diameter), CLOSEST * diameter)
        open_lengths = size[~np.array(self.given.closed, bool)]
        if len(open_lengths):  # so that a sphere and its image are not both neighbours
            shell = min(shell, 0.249 * (open_lengths.min() - 2 * diameter) + 0.001 * diameter)
        cells = tuple(int(c) for c in np.maximum(1, np.floor(size / self.widest(shell))))
        cells = tuple(min(c, max(1, int(4 * n ** (1 / d)))) for c in cells)
        return HardLists(
            float(shell),
            self.swelling,
            cells,
            tuple(c / length for c, length in zip(cells, size, strict=True)),
            np.zeros((n, 4)),
            np.zeros(n, np.int32),
            np.full(math.prod(cells), -1, np.int32),
            np.zeros(n, np.int32),
            np.zeros(n, np.int32),
            np.zeros(n, np.int32),
            np.zeros((n, self.room), np.uint32),
            np.zeros((groups.WIDTH, self.room)),
            np.zeros(self.room),
        )

    def _queue(self) -> Queue:
        n = self.n
        bins = 1 << max(4, math.ceil(math.log2(n)))
        return Queue(
            self.per_time,
            np.zeros(n),
            zeros((n, groups.EVENT_WIDTH), np.int32),
            np.zeros(bins, np.int32),
            np.zeros(n, np.int32),
            np.zeros(2, np.int64),
        )

    # --- running --------------------------------------------------------------------------------

    def run_to(self, windows: int, now: float) -> None:
        """Do all events up to the time `now` within the window after `windows` others.

        Raises RunError for inelastic collapse, and Interrupted on a signal: attributes `windows`
        and `now` then have the time up to which events are done.
        """
        # Window after window. At the end of each, all spheres are brought to one time, heated, and
        # sorted in memory; this time is the zero of the next, so rounding errors do not grow.
        while self.windows < windows:
            if heard():
                raise Interrupted
            self._run(self.window)
            run.synchronise(self.world, self.spheres, self.window)
            self.now = 0.0
            if self.given.turn is not None:
                columns = slice(groups.VELOCITY, groups.VELOCITY + self.d)
                velocities = self.by_number(self.spheres.state[:, columns])
                self.given.turn(velocities, self.windows)
                self.spheres.state[:, columns] = velocities[self.spheres.number]
            self.begin_window(self.windows + 1)
        self._run(now)
        self.now = now

    def _run(self, end: float) -> None:
        began = self.now
        while (ended := run.run_events(*self._arguments(end))) != run.DONE:
            first = int(self.queue.heap[0])
            if ended in (run.COLLAPSED, run.FAILED):
                raise Collapse(self._failure(ended, first))
            if ended == run.PAUSED:
                now = float(self.spheres.state[:, groups.TIME].max())
                if self.given.most * self.n * (now - began) < run.AT_ONCE:
                    most = self.given.most
                    raise RunError(f"more than {most:.3g} events of a sphere in a unit of time")
                began = now
                if heard():
                    self.now = max(self.now, began)
                    raise Interrupted
            else:  # a list is full
                self.room *= 2
                self.now = float(self.queue.time[first])
                self.prepare()

    def _arguments(self, end: float) -> tuple[Any, ...]:
        moving = self.spheres, self.lists, self.queue, self.tally
        return *self._packing(self.world, self.given.rules, *moving), end

    def _failure(self, ended: int, i: int) -> str:
        """The message for an event of sphere i (its place in memory) that ends the run."""
        now, number = self.windows * self.window + float(self.queue.time[i]), self.spheres.number
        if ended == run.FAILED:
            return (
                f"sphere {number[i]} at time {now:.6g}: no time found at which it meets a wall; "
                "expected walls that vibrate more slowly, or fewer turns of them in a flight"
            )
        many = np.argsort(-self.spheres.hits, kind="stable")[:2]
        numbers = " and ".join(map(str, sorted(number[many])))
        return (
            f"inelastic collapse at t = {now:.9g}: spheres {numbers} collide without end; set "
            "spheres.collision.contact_time"
        )

    def read(self) -> tuple[Array, Array]:
        """Places, not brought into the box, and velocities (n, d) now, by particle number."""
        places, velocities = np.empty((self.n, self.d)), np.empty((self.n, self.d))
        run.read(self.world, self.spheres, self.now, places, velocities)
        boxes = self.by_number(self.spheres.boxes)
        return places + boxes * np.array(self.given.size, float), velocities

    def by_number(self, values: NDArray[Any]) -> NDArray[Any]:
        """Rows in the order of particle numbers."""
        return by_number(self.spheres.number, values)

    # --- checkpoints ----------------------------------------------------------------------------

    def _tallied(self) -> State:
        """All counts and sums by their names in checkpoints."""
        tally = self.tally
        found = {"counts": tally.counts, "sums": tally.sums, "impulse": tally.impulse}
        if self.given.flights is not None:
            found |= {"flights": tally.flights.counts, "flights/sums": tally.flights.sums}
        return {f"tally/{name}": array for name, array in found.items()}

    def state(self) -> State:
        """All arrays that the next event depends on, by particle number."""
        kept = {name: self.by_number(getattr(self.spheres, name)) for name in KEPT}
        tally = {name: array.copy() for name, array in self._tallied().items()}
        clock = {"windows": np.array(self.windows), "now": np.array(self.now)}
        return {**kept, **tally, **clock}

    def restore(self, state: State) -> None:
        """Continue from a state."""
        for name in KEPT:
            getattr(self.spheres, name)[:] = state[name]
        self.spheres.number[:] = np.arange(self.n)
        for name, array in self._tallied().items():
            array[:] = state[name]
        self.now = float(state["now"])
        self.begin_window(int(state["windows"]))
