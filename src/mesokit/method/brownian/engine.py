"""Engine: particles do not interact, so threads share them and need no barriers."""

from collections.abc import Callable, Collection
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.brownian.kernel import Motion, scatter, wander
from mesokit.scalar.random import Counter
from mesokit.seam.engine import Array, Integers, State


class Brownians:
    """Engine of Brownian motion (`mesokit.seam.engine.Engine`) on the threads of one machine."""

    def __init__(self, case: Case, threads: int = 1) -> None:
        given, size = case.brownian, tuple(float(length) for length in case.box.size)
        self.n, self.dimension = given.number(case.box), case.box.dimension
        self.box, self.seed, self.timestep = np.array(size), case.run.seed, given.timestep
        self.motion = Motion((2 * given.diffusion * given.timestep) ** 0.5, size)
        self.step = 0
        self.places = np.zeros((self.n, self.dimension))
        self.counts = np.zeros((self.n, self.dimension), np.int32)  # boxes away
        self.edges = np.linspace(0, self.n, threads + 1).astype(int)  # of what each thread has
        self.worker = ThreadPoolExecutor(threads)
        self.seconds = {"steps": 0.0}

    def start(self, positions: Array | None) -> None:
        """Put the particles at these places (n, d), or anywhere."""
        if positions is None:
            self._run(scatter, self.motion.size, self.places)
            return
        self.counts[:] = np.floor(positions / self.box)
        self.places[:] = positions - self.counts * self.box

    def advance(self, steps: int, measure: Collection[str] = ()) -> None:
        """Run some steps."""
        began = perf_counter()
        self._run(wander, steps, self.motion, self.places, self.counts)
        self.step += steps
        self.seconds["steps"] += perf_counter() - began

    def _run(self, loop: Callable, *arguments: Any) -> None:
        counter = Counter(np.uint64(self.seed), np.uint64(self.step))
        parts = pairwise(self.edges)
        jobs = [self.worker.submit(loop, first, last, counter, *arguments) for first, last in parts]
        for job in jobs:
            job.result()

    def check(self) -> None:
        """Do nothing: no state is invalid."""

    def end_warmup(self) -> None:
        """Do nothing: the engine has no sums since the start."""

    @property
    def time(self) -> float:
        """Time since the start of the warm-up."""
        return self.step * self.timestep

    def positions(self, ids: Integers | None = None, unwrapped: bool = False) -> Array:
        """Places (n, d), in the box or where the particles have gone to."""
        chosen = slice(None) if ids is None else ids
        return self.places[chosen] + (self.counts[chosen] * self.box if unwrapped else 0.0)

    def images(self, ids: Integers | None = None) -> NDArray[np.int32]:
        """Image counts (n, d) of the particles."""
        return self.counts[slice(None) if ids is None else ids].copy()

    def state(self) -> State:
        """Places by particle number, and the step."""
        return {"positions": self.places, "images": self.counts, "step": np.array(self.step)}

    def restore(self, state: State) -> None:
        """Go on from a state."""
        self.places[:], self.counts[:] = state["positions"], state["images"]
        self.step = int(state["step"])
