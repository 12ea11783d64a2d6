"""Spheres in memory, and the verbs on them: run to a time, read, keep, restore."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.kernels.packing import Packing
from mesokit.loops.layout import by_number, zeros
from mesokit.loops.neighbours import inverse_lengths
from mesokit.method.spheres.common.wall.rows import FREQUENCY, PHASE
from mesokit.method.spheres.hard.engine import groups
from mesokit.method.spheres.hard.engine.collide import Rules
from mesokit.method.spheres.hard.engine.flights import no_flights
from mesokit.method.spheres.hard.engine.groups import Lists, Queue, SphereMemory, Tally, World
from mesokit.method.spheres.hard.engine.run import AT_ONCE, advance, read, rebuild, synchronise
from mesokit.processes.signals import heard
from mesokit.seam.engine import Interrupted, State

Array = NDArray[np.float64]
WANTED = {2: 10.0, 3: 14.0}  # spheres on a list: more are looked at longer, fewer are made anew
CLOSEST = 0.1  # of the largest diameter: the smallest shell
ROOM = 24  # entries of a list, at first; a multiple of eight
PER_BIN = 4.0  # events
KEPT = ("state", "body", "boxes", "hits")


class Given(NamedTuple):
    """What a system is made of.

    size, closed, gravity (d,): lengths of the box, which axes walls close, acceleration; diameters,
    masses, inertia (n,); walls (walls, 14); rules; lasting: a collision sooner than this after
    another loses nothing; window: the length of one; instant: a time that is none; growth of
    diameters, relative per time; reach: how far spheres feel one another, in diameters; turn: what
    changes velocities (n, d) by particle number at the end of a window; flights: width and number
    of the bins in which times between collisions are counted, None: not at all; most: events
    of a sphere that there may be in a unit of time.
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


class System:
    """Hard spheres in a box, and what happens next to each of them."""

    def __init__(self, given: Given) -> None:
        self._packing = Packing()
        self.given = given
        self.n, self.d = len(given.diameters), len(given.size)
        self.window, self.windows = given.window, 0
        self.now = 0.0  # since the start of the window
        n, d = self.n, self.d
        self.spheres = SphereMemory(
            zeros((n, groups.WIDTH)),
            np.zeros((n, groups.BODY_WIDTH)),
            np.zeros((n, d), np.int32),
            np.arange(n, dtype=np.int64),
            np.zeros(n, np.int64),
        )
        walls = len(given.walls)
        self.tally = Tally(
            np.zeros(groups.COUNTS, np.int64),
            np.zeros(groups.SUMS),
            np.zeros((walls, d)),
            () if given.flights is None else no_flights(*given.flights),
        )
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
        advance.compile_ahead(*self._arguments(0.0))
        synchronise(self.world, self.spheres, 0.0)
        self.begin_window(0)

    def begin_window(self, windows: int) -> None:
        """Sort the spheres in memory and predict everything, in the window after so many."""
        self.windows = windows
        self.walls[:, PHASE] = self.walls[:, FREQUENCY] * (windows * self.window)
        self.sort()
        self.prepare()

    @property
    def growth(self) -> float:
        """Relative growth of diameters per time, at the start of this window."""
        rate, before = self.given.growth, self.windows * self.window
        return rate / (1.0 + rate * before)

    @property
    def world(self) -> World:
        """What does not change during a window."""
        given = self.given
        size = tuple(float(length) for length in given.size)
        inverse = inverse_lengths(size, given.closed)
        gravity = tuple(float(g) for g in given.gravity) or (0.0,) * self.d
        lasting, instant = given.lasting, given.instant
        return World(size, inverse, gravity, self.growth, self.walls, lasting, instant)

    def sort(self) -> None:
        """Neighbours in space become neighbours in memory; changes no bit of the motion."""
        places = self.spheres.state[:, : self.d]
        side = np.maximum(1, np.array(self.given.size) // self.widest(0.0)).astype(int)
        cell = np.minimum((places * (side / np.array(self.given.size))).astype(int), side - 1)
        code = np.ravel_multi_index(tuple(np.clip(cell, 0, None).T), tuple(side))
        order = np.lexsort((self.spheres.number, code))
        for array in self.spheres:
            array[:] = array[order]

    def widest(self, shell: float) -> float:
        """The longest distance of the centres of neighbours."""
        largest = 2.0 * float(self.spheres.state[:, groups.RADIUS].max())
        return largest * self.swelling + 2.0 * shell

    @property
    def swelling(self) -> float:
        """How far two spheres feel one another at the end of a window, in diameters of now."""
        return self.given.reach * (1.0 + self.growth * self.window)

    def prepare(self) -> None:
        """Lists and queue for the spheres as they are; larger ones where they did not suffice."""
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
            if self._rebuild():
                break
            self.room *= 2

    def _rebuild(self) -> bool:
        rules, spheres = self.given.rules, self.spheres
        return bool(rebuild(self.world, rules, spheres, self.lists, self.queue, self.now))

    def _lists(self) -> Lists:
        n, d, size = self.n, self.d, np.array(self.given.size, float)
        ball = math.pi if d == 2 else 4 * math.pi / 3
        reach = (WANTED[d] * size.prod() / (n * ball)) ** (1 / d)
        diameter = self.widest(0.0)
        shell = max(0.5 * (reach - diameter), CLOSEST * diameter)
        open_lengths = size[~np.array(self.given.closed, bool)]
        if len(open_lengths):  # an image and its original cannot both be neighbours
            shell = min(shell, 0.249 * (open_lengths.min() - 2 * diameter) + 0.001 * diameter)
        cells = tuple(int(c) for c in np.maximum(1, np.floor(size / self.widest(shell))))
        cells = tuple(min(c, max(1, int(4 * n ** (1 / d)))) for c in cells)
        return Lists(
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
        """Do all events up to a time within a window. Raises RunError for inelastic collapse, and
        Interrupted on a signal; `windows` and `now` then say how far it has come."""
        while self.windows < windows:
            if heard():
                raise Interrupted
            self._run(self.window)
            synchronise(self.world, self.spheres, self.window)
            self.now = 0.0
            if self.given.turn is not None:
                self._turn(self.given.turn)
            self.begin_window(self.windows + 1)
        self._run(now)
        self.now = now

    def _turn(self, turn: Callable[[Array, int], None]) -> None:
        columns = slice(groups.VELOCITY, groups.VELOCITY + self.d)
        velocities = self.by_number(self.spheres.state[:, columns])
        turn(velocities, self.windows)
        self.spheres.state[:, columns] = velocities[self.spheres.number]

    def _run(self, end: float) -> None:
        began = self.now
        while True:
            ended = advance(*self._arguments(end))
            if ended == groups.DONE:
                return
            if ended == groups.COLLAPSED:
                raise RunError(self._collapse())
            if ended == groups.FAILED:
                raise RunError(self._failure())
            if ended == groups.PAUSED:
                began = self._paused(began)
                if heard():
                    self.now = max(self.now, began)
                    raise Interrupted
                continue
            self.room *= 2
            self.now = float(self.queue.time[self.queue.heap[0]])
            self.prepare()

    def _arguments(self, end: float) -> tuple[Any, ...]:
        moving = self.spheres, self.lists, self.queue, self.tally
        return *self._packing(self.world, self.given.rules, *moving), end

    def _paused(self, began: float) -> float:
        """The time now. Raises RunError where too many events have come since it began."""
        now = float(self.spheres.state[:, groups.TIME].max())
        if self.given.most * self.n * (now - began) < AT_ONCE:
            raise RunError(f"more than {self.given.most:.3g} events of a sphere in a unit of time")
        return now

    def _failure(self) -> str:
        """Which sphere lost a wall, and when."""
        i = int(self.queue.heap[0])
        now = self.windows * self.window + float(self.queue.time[i])
        number = int(self.spheres.number[i])
        return (
            f"sphere {number} at time {now:.6g}: no time found at which it meets a wall; "
            "expected walls that vibrate more slowly, or fewer turns of them in a flight"
        )

    def _collapse(self) -> str:
        """The spheres that collide without end, and the time."""
        i = int(self.queue.heap[0])
        now = self.windows * self.window + float(self.queue.time[i])
        many = np.argsort(-self.spheres.hits, kind="stable")[:2]
        numbers = " and ".join(str(number) for number in sorted(self.spheres.number[many]))
        return (
            f"inelastic collapse at t = {now:.9g}: spheres {numbers} collide without end; set "
            "spheres.collision.contact_time"
        )

    def read(self) -> tuple[Array, Array]:
        """Places, not brought into the box, and velocities (n, d) now, by particle number."""
        places, velocities = np.empty((self.n, self.d)), np.empty((self.n, self.d))
        read(self.world, self.spheres, self.now, places, velocities)
        boxes = self.by_number(self.spheres.boxes)
        return places + boxes * np.array(self.given.size, float), velocities

    def by_number(self, values: NDArray[Any]) -> NDArray[Any]:
        """Rows in the order of particle numbers."""
        return by_number(self.spheres.number, values)

    # --- checkpoints ----------------------------------------------------------------------------

    def _tallied(self) -> Iterator[tuple[str, NDArray[Any]]]:
        """All counts and sums, by name."""
        tally = self.tally
        yield from (("counts", tally.counts), ("sums", tally.sums), ("impulse", tally.impulse))
        if self.given.flights is not None:
            yield "flights", tally.flights.counts
            yield "flights/sums", tally.flights.sums

    def state(self) -> State:
        """All that the next event depends on, by particle number."""
        kept = {name: self.by_number(getattr(self.spheres, name)) for name in KEPT}
        tally = {f"tally/{name}": array.copy() for name, array in self._tallied()}
        clock = {"windows": np.array(self.windows), "now": np.array(self.now)}
        return {**kept, **tally, **clock}

    def restore(self, state: State) -> None:
        """Go on from a state."""
        for name in KEPT:
            getattr(self.spheres, name)[:] = state[name]
        self.spheres.number[:] = np.arange(self.n)
        for name, array in self._tallied():
            array[:] = state[f"tally/{name}"]
        self.now = float(state["now"])
        self.begin_window(int(state["windows"]))
