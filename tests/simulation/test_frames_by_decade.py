"""Frames of a trajectory at steps whose ratios are alike, in whole and in resumed runs."""

import numpy as np
import pytest

import mesokit
from mesokit import Simulation, Trajectory
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from tests.helpers.lattices import lattice_case

# twice the rounded up powers 10^(m/4), up to 80
PASSED = [0, 2, 4, 8, 12, 20, 36, 64]


@pytest.fixture(autouse=True)
def no_figures(monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])


def case_of(steps):
    kept = Trajectory(every=2, fields=("site",), per_decade=4)
    return lattice_case((8, 6), Ising(kT=2.0), steps=steps, warmup=3, trajectory=kept)


def test_frames_are_those_of_each_decade(tmp_path):
    Simulation(case_of(80), output=tmp_path / "whole", threads=1).run()
    whole = mesokit.open(tmp_path / "whole").trajectory
    assert whole.step.tolist() == [3 + passed for passed in PASSED]
    Simulation(case_of(80), output=tmp_path / "parts", threads=1).run(30)
    Simulation.resume(tmp_path / "parts", threads=1).run()
    parts = mesokit.open(tmp_path / "parts").trajectory
    assert parts.step.tolist() == whole.step.tolist()
    np.testing.assert_array_equal(parts.read("site"), whole.read("site"))


def test_a_longer_run_adds_frames(tmp_path):
    Simulation(case_of(14), output=tmp_path / "run", threads=1).run()
    assert mesokit.open(tmp_path / "run").trajectory.step.tolist() == [3, 5, 7, 11, 15]
    Simulation.resume(tmp_path / "run", threads=1, steps=80).run()
    steps = mesokit.open(tmp_path / "run").trajectory.step
    assert steps.tolist() == [3 + passed for passed in PASSED]
