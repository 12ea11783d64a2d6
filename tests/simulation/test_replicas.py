"""Replicas: independent copies of a case in one run, to the bits of runs of their own."""

import pytest

import mesokit
from mesokit import (
    Box,
    Case,
    EquationOfState,
    HardSpheres,
    RandomStart,
    Run,
    Simulation,
    VelocityProfile,
)
from mesokit.errors import CaseError, RunError


def gas(steps=40, seed=5, replicas=1):
    return Case(
        run=Run(steps, warmup=5, seed=seed, replicas=replicas, method="event-driven"),
        box=Box([12.5, 12.5]),
        spheres=HardSpheres(packing_fraction=0.3, timestep=0.5, start=RandomStart()),
        observe=[EquationOfState()],
    )


def fluid(seed=5, replicas=1):
    run = Run(40, seed=seed, replicas=replicas)
    return Case(run=run, box=Box([8, 8]), observe=[VelocityProfile(axis="y", every=2)])


@pytest.mark.parametrize("make", [gas, fluid])
def test_results_are_those_of_runs_of_their_own(make, tmp_path):
    for seed in (5, 6, 7):
        Simulation(make(seed=seed), output=tmp_path / str(seed), threads=1).run()
    merged = mesokit.merge([tmp_path / seed for seed in "567"], tmp_path / "merged")
    for threads in (1, 2):
        together = Simulation(make(replicas=3), threads=threads)
        together.run()
        assert together.results == merged.results


def test_an_error_bar_sees_them_all():
    one, many = Simulation(gas(200)), Simulation(gas(200, replicas=8))
    for simulation in (one, many):
        simulation.run()
    name = "equation-of-state"
    assert many[name].samples == 8 * one[name].samples
    first, second = (s[name].comparisons[0] for s in (one, many))
    assert second.error < 0.7 * first.error
    assert abs(second.measured - second.expected) < 4 * second.error


def test_runs_with_replicas_of_a_seed_are_not_merged_twice(tmp_path):
    Simulation(gas(replicas=3), output=tmp_path / "a").run()
    Simulation(gas(seed=7), output=tmp_path / "b").run()
    with pytest.raises(RunError, match=r"run\.seed = 7, as in .*a"):
        mesokit.merge([tmp_path / "a", tmp_path / "b"], tmp_path / "both")


def test_copies_of_one_motion_are_refused():
    case = gas(replicas=2)
    first = Simulation(gas()).engine
    same = {"positions": first.positions(), "velocities": first.velocities()}
    with pytest.raises(RunError, match=r"run\.replicas: the first two move alike"):
        Simulation(case, **same).run()


@pytest.mark.parametrize("replicas", [0, -1, 1.5, 5000])
def test_numbers_that_are_none(replicas):
    with pytest.raises(CaseError, match="replicas"):
        Run(10, replicas=replicas)
