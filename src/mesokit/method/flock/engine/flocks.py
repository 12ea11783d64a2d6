"""The birds in memory: an engine on the threads of one machine."""

from collections.abc import Collection
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.none import Nothing
from mesokit.geometry.solids.solids import Solids, solids_of
from mesokit.kernels.group import Packing
from mesokit.loops.layout import by_number
from mesokit.loops.threads import Threads
from mesokit.method.flock.engine.memory import Physics, axes_of, make
from mesokit.method.flock.engine.step import step
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array, Integers, State

FEWEST = 2000  # birds for each thread: with fewer, barriers cost more than the work


class Flocks:
    """Engine of flocks (`mesokit.seam.engine.Engine`).

    `side` is the least length of a cell, the reach unless said. Results do not depend on it.
    """

    def __init__(self, case: Case, threads: int = 1, side: float | None = None) -> None:
        given, size = case.flock, case.box.size
        self.n, self.dimension = given.birds(case.box), case.box.dimension
        self.box, self.speed, self.timestep = np.array(size, float), given.speed, given.timestep
        self.solids: Solids | None = (
            solids_of(case) if case.walls else None
        )  # kernels hold only the address of its tables
        shut = closed_axes(case.walls)
        closed = [axis in shut for axis in case.box.axes]
        axes = axes_of(size, closed, max(side or 0.0, given.radius), self.n)
        self.threads = max(1, min(threads, self.n // FEWEST))
        cohesion = () if given.cohesion is None else (given.cohesion.kernel(),)
        self.physics = Physics(
            axes,
            np.float32(given.radius**2),
            given.speed * given.timestep,
            given.order == "original",
            given.noise.kernel(),
            cohesion,
            Nothing() if self.solids is None else self.solids.kernel,
        )
        self.flock = make(self.n, self.threads, axes, bool(cohesion))
        self.seed, self.step, self.current = case.run.seed, 0, 0  # which of two buffers is current
        self.worker, self._packing = Threads(self.threads), Packing()
        self.seconds = {"steps": 0.0}
        self.worker.compile_ahead(step, *self._arguments(0))

    def start(self, positions: Array, headings: Array) -> None:
        """Put birds at places (n, d), in or out of the box, with headings (n, d)."""
        periodic = np.array(self.physics.axes.inverse) > 0
        images = np.where(periodic, np.floor(positions / self.box), 0.0)
        places = positions - images * self.box
        over = periodic & (places >= self.box)  # a place just below 0 is rounded up
        self._fill(np.where(over, 0.0, places), headings, images)

    def _fill(self, places: Array, headings: Array, images: NDArray[Any]) -> None:
        birds = self.flock.birds
        birds.places[0], birds.headings[0] = places.T, headings.T
        birds.images[0], birds.numbers[0] = images.T, np.arange(self.n)
        self.current = 0

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps."""
        began = perf_counter()
        self.worker.run(step, *self._arguments(steps))
        self.step, self.current = self.step + steps, (self.current + steps) % 2
        self.seconds["steps"] += perf_counter() - began

    def _arguments(self, steps: int) -> tuple[Any, ...]:
        counter = Counter(np.uint64(self.seed), np.uint64(self.step))
        return counter, steps, self.current, *self._packing(self.physics, self.flock)

    def check(self) -> None:
        """Do nothing: speeds are constant, so no state can be invalid."""

    def end_warmup(self) -> None:
        """Do nothing: the engine has no sums since the start."""

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        """Places (n, d), in the box or where the birds have gone to."""
        places = self._by_number(self.flock.birds.places)
        if unwrapped:
            places += self._by_number(self.flock.birds.images) * self.box
        return places if ids is None else places[ids]

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        """Image counts (n, d) of the birds."""
        images = self._by_number(self.flock.birds.images)
        return images if ids is None else images[ids]

    def headings(self, ids: Integers | None = None) -> Array:
        """Unit vectors (n, d) along which the birds head."""
        headings = self._by_number(self.flock.birds.headings)
        return headings if ids is None else headings[ids]

    def velocities(self, ids: Integers | None = None) -> Array:
        """Heading times speed (n, d)."""
        return self.speed * self.headings(ids)

    def masses(self, ids: Integers | None = None) -> Array:
        """Masses (n,), all 1."""
        return np.ones(self.n if ids is None else len(ids))

    def totals(self) -> tuple[int, Array, float]:
        """Number, sum of the velocities (d,) and half the sum of their squares."""
        velocity = self.velocities().sum(axis=0)
        return self.n, velocity, 0.5 * self.n * self.speed**2

    def state(self) -> State:
        """Positions, image counts and headings in order of bird number, and the step."""
        names = ("places", "headings", "images")
        found = {name: self._by_number(getattr(self.flock.birds, name)) for name in names}
        return found | {"step": np.array(self.step)}

    def restore(self, state: State) -> None:
        """Go on from a state."""
        self._fill(state["places"], state["headings"], state["images"])
        self.step = int(state["step"])

    def _by_number(self, arrays: NDArray[Any]) -> NDArray[Any]:
        # (2, d, n) to (n, d)
        return by_number(self.flock.birds.numbers[self.current], arrays[self.current].T)
