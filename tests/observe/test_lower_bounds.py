"""Error bars of runs that last for a few memories are said to be lower bounds."""

import dataclasses

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    CellOccupancy,
    Run,
    Simulation,
    TemperatureProfile,
    VelocityDistribution,
)
from mesokit.observe.shared.short_run import NOTE, bounded
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


class Mean:
    """The mean of a few series that remember for so many samples."""

    def __init__(self, memory, samples, seed, width=3):
        rng, share = np.random.default_rng(seed), np.exp(-1 / memory)
        self.blocks, now = Blocks(width), rng.normal(size=width)
        for _ in range(samples):
            now = share * now + np.sqrt(1 - share**2) * rng.normal(size=width)
            self.blocks.add(now)

    def result(self, note=""):
        found = Comparison("mean", float(self.blocks.mean()[0]), float(self.blocks.error()[0]), 0.0)
        found = dataclasses.replace(found, note=note)
        return bounded(
            Result("mean", "mean", {}, 1.0, 0.1, "mean", {}, comparisons=(found,)), self
        ).comparisons[0]


@pytest.mark.parametrize(("lengths", "least", "most"), [(4, 0.8, 1.0), (300, 0.0, 0.1)])
def test_they_are_said_to_be_by_the_length_of_the_run(lengths, least, most):
    said = ["lower bound" in str(Mean(40.0, 40 * lengths, seed).result()) for seed in range(30)]
    assert least <= np.mean(said) <= most


def test_a_note_is_kept_and_no_second_bound_is_added():
    slow = Mean(1.0, 0, seed=1)
    for step in range(2000):  # a drift, of which no block tells the end
        slow.blocks.add(np.full(3, 0.01 * step))
    assert slow.result("approximate: chaos").note == f"approximate: chaos; {NOTE}"
    assert slow.result("error bar is a lower bound: so").note == "error bar is a lower bound: so"


@pytest.mark.parametrize(("samples", "few"), [(40, True), (90, True), (600, False)])
def test_chi_square_of_few_samples_says_so(samples, few):
    mean = Mean(0.1, samples, seed=4)
    plain, chi = (dataclasses.replace(mean.result(), what=what) for what in ("mean", "chi-square"))
    result = Result("c", "c", {}, 1.0, 0.1, "c", {}, comparisons=(plain, chi))
    plain, chi = bounded(result, mean).comparisons
    assert plain.note == "" and (f"of {samples} samples" in str(chi)) is few
    for other in range(3):  # many runs are many samples
        mean.blocks.pool(Mean(0.1, 50, seed=other).blocks)
    assert (f"of {samples + 150} samples" in str(bounded(result, mean).comparisons[1])) is False


def test_chi_squares_of_observables_are_those():
    observed = [VelocityDistribution(every=4), CellOccupancy(every=4), TemperatureProfile("y")]
    simulation = Simulation(Case(run=Run(steps=120), box=Box([16, 16]), observe=observed))
    simulation.run()
    found = [c for one in simulation.results.values() for c in one.comparisons]
    chi = [c for c in found if "chi-square" in c.what]
    assert len(chi) >= 4 and all("samples, which may be correlated" in str(c) for c in chi)
