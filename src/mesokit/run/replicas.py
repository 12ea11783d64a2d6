"""Independent copies of a case that run side by side, each with its own seed."""

import copy
import dataclasses
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.devices.device import Device
from mesokit.errors import RunError
from mesokit.observe.shared.build_up import result_of
from mesokit.run.schedule import Leg
from mesokit.seam.method import method_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.pooled import pool
from mesokit.seam.result import Result

ALIKE = (
    "run.replicas: the first two move alike: neither their start nor what moves them depends on "
    "the seed; expected velocities or places that are drawn"
)


class Replica:
    """One copy: its case with its own seed, its engine and its accumulators."""

    def __init__(self, case: Case, threads: int, device: Device | None) -> None:
        measures = sorted({name for one in case.observe for name in one.measures})
        self.case, method = case, method_of(case)
        if device is None:
            self.engine = method.engine(case, threads, measures)
        else:
            assert method.on_devices is not None
            self.engine = method.on_devices.engine(case, device, measures)
        self.accumulators: dict[str, Accumulator] = {
            observable.label: observable.accumulator(case) for observable in case.observe
        }
        self.seconds = dict.fromkeys(self.accumulators, 0.0)  # spent on samples
        self._absorbed: float | None = None

    def go(self, legs: Iterable[Leg]) -> None:
        """Do steps and take samples."""
        for leg in legs:
            if leg.steps:
                self.engine.advance(leg.steps, leg.measure)
            if leg.ends_warmup:
                self.engine.end_warmup()
            for name in leg.samples:
                began = perf_counter()
                self.accumulators[name].observe(self.engine)
                self.seconds[name] += perf_counter() - began

    @property
    def absorbed(self) -> float | None:
        """The time after which nothing can happen any more, as it was first seen, or None."""
        if self._absorbed is None:
            self._absorbed = method_of(self.case).absorbed(self.engine)
        return self._absorbed


class Replicas:
    """All copies of a case, which do the same steps at the same time on one or more threads each.

    Those on a device do their steps in turn. Bits do not depend on the threads. Results are pooled:
    blocks of time of all copies stand in a row, so error bars contain the scatter of copies.
    """

    def __init__(self, case: Case, threads: int, device: Device | None = None) -> None:
        number = case.run.replicas
        each = max(1, threads // number)
        self.all = [Replica(one, each, device) for one in copies(case)]
        together = 1 if device is not None else min(number, threads)
        self.workers = ThreadPoolExecutor(together) if number > 1 else None
        self.looked = False  # true once the first state of the run has been sampled

    @property
    def first(self) -> Replica:
        """The replica whose frames and log are written."""
        return self.all[0]

    @property
    def step(self) -> int:
        """The step of all replicas."""
        return self.first.engine.step

    @property
    def absorbed(self) -> float | None:
        """The time after which nothing can happen any more in any replica, or None."""
        times = [one.absorbed for one in self.all]
        known = [time for time in times if time is not None]
        return max(known) if len(known) == len(times) else None

    def each(self, work: Callable[[Replica], Any]) -> None:
        """Call a function of each replica. Raises the first of their errors, with its seed."""
        if self.workers is None:
            return work(self.first)
        done = [self.workers.submit(work, one) for one in self.all]
        for one, future in zip(self.all, done, strict=True):
            try:
                future.result()
            except RunError as error:
                raise RunError(f"replica of seed {one.case.run.seed}: {error}") from None

    def start(self, arrays: Mapping[str, Any]) -> None:
        """Put each replica in its first state."""
        for one in self.all:
            method = method_of(one.case)
            method.initial.fill(one.engine, method.initial.read(one.case, arrays))

    def go(self, legs: Iterable[Leg]) -> None:
        """Do steps and samples of all replicas, which wait for one another at the end only."""
        self.each(lambda one: one.go(legs))
        self.looked = self.step >= self.first.case.run.warmup

    def check(self) -> None:
        """Raise RunError for numbers that are not finite, and for two copies that are equal."""
        self.each(lambda one: one.engine.check())
        if len(self.all) > 1:
            one, two = (copy.engine.state() for copy in self.all[:2])
            if all(np.array_equal(array, two[name]) for name, array in one.items()):
                raise RunError(ALIKE)

    def result(self, name: str) -> Result:
        """The pooled result of an observable."""
        pooled = self.first.accumulators[name]
        if len(self.all) > 1:
            pooled = copy.deepcopy(pooled)
            for other in self.all[1:]:
                pool(name, pooled, other.accumulators[name])
        return result_of(pooled, self.first.case)


def copies(case: Case) -> list[Case]:
    """The case once for each replica, with one seed after another."""
    if case.run.replicas == 1:
        return [case]
    run = dataclasses.replace(case.run, replicas=1)
    runs = [dataclasses.replace(run, seed=seed) for seed in case.run.seeds]
    return [dataclasses.replace(case, run=run) for run in runs]
