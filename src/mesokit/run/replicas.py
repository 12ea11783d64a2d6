"""Independent copies of a case that run side by side, each from a seed of its own."""

import copy
import dataclasses
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.errors import RunError
from mesokit.observe.shared.build_up import result_of
from mesokit.run.schedule import Leg
from mesokit.seam.method import method_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.pooled import pool
from mesokit.seam.result import Result

ALIKE = (
    "run.replicas: the first two move alike: neither their start nor what moves them knows of the "
    "seed; expected velocities or places that are drawn"
)


class Replica:
    """One copy: its case, which has a seed of its own, its engine and what it has measured."""

    def __init__(self, case: Case, threads: int) -> None:
        measures = {name for observable in case.observe for name in observable.measures}
        self.case = case
        self.engine = method_of(case).engine(case, threads, sorted(measures))
        self.accumulators: dict[str, Accumulator] = {
            observable.label: observable.accumulator(case) for observable in case.observe
        }
        self.seconds = dict.fromkeys(self.accumulators, 0.0)  # that samples have taken

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


class Replicas:
    """All copies of a case: the same steps at the same time, each on one thread or some.

    Which of them a thread takes changes no bit. What they have measured is pooled: blocks of time
    of all stand in a row, so that error bars see how copies scatter.
    """

    def __init__(self, case: Case, threads: int) -> None:
        number = case.run.replicas
        each = max(1, threads // number)
        self.all = [Replica(one, each) for one in copies(case)]
        self.workers = ThreadPoolExecutor(min(number, threads)) if number > 1 else None
        self.looked = False  # whether the state that the run begins with has been sampled

    @property
    def first(self) -> Replica:
        """The one whose frames and log are written."""
        return self.all[0]

    @property
    def step(self) -> int:
        """The step at which all of them are."""
        return self.first.engine.step

    def each(self, work: Callable[[Replica], Any]) -> None:
        """Do something with each of them. Raises the first of their errors, with its seed."""
        if self.workers is None:
            return work(self.first)
        done = [self.workers.submit(work, one) for one in self.all]
        for one, future in zip(self.all, done, strict=True):
            try:
                future.result()
            except RunError as error:
                raise RunError(f"replica of seed {one.case.run.seed}: {error}") from None

    def start(self, arrays: Mapping[str, Any]) -> None:
        """Put the particles of each where they start from."""
        for one in self.all:
            method = method_of(one.case)
            method.initial.fill(one.engine, method.initial.read(one.case, arrays))

    def go(self, legs: Iterable[Leg]) -> None:
        """Steps and samples of all: they wait for one another at the end alone."""
        self.each(lambda one: one.go(legs))
        self.looked = self.step >= self.first.case.run.warmup

    def check(self) -> None:
        """Raise RunError for numbers that are none, and for copies that are the same run twice."""
        self.each(lambda one: one.engine.check())
        if len(self.all) > 1:
            one, two = (copy.engine.state() for copy in self.all[:2])
            if all(np.array_equal(array, two[name]) for name, array in one.items()):
                raise RunError(ALIKE)

    def result(self, name: str) -> Result:
        """What all of them say of an observable."""
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
