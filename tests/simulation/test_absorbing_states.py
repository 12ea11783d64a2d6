"""Runs in which nothing can happen any more: they say so, and the rest of their time counts."""

from __future__ import annotations

from io import StringIO

import numpy as np
import pytest

import mesokit
from mesokit import Simulation
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.observe.coverage import Coverage
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.report.progress import Reporter
from tests.helpers.lattices import lattice_case

SITES, STEPS = (64, 64), 40
FILLING = LatticeGas(
    species=("empty", "A"), process=(GasProcess(name="adsorb", site="empty -> A", rate=1.0),)
)


def case_of(steps, **given):
    observed = [Coverage(every=1)]
    return lattice_case(
        SITES, FILLING, steps=steps, observe=observed, start=UniformStart(), **given
    )


def test_a_full_lattice_says_so_and_its_time_counts(tmp_path, monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    told = StringIO()
    simulation = Simulation(case_of(STEPS), output=tmp_path / "run", threads=1)
    simulation.run(progress=Reporter(stream=told))
    files = mesokit.open(tmp_path / "run")
    time = files.provenance["absorbed"]
    words = f"after t = {time:.6g} nothing can happen any more"
    assert told.getvalue().count(words) == 1
    assert repr(files).count(words) == 1
    page = files.report().read_text()
    assert words in page
    assert "lattice of 64 x 64 sites, 40 steps" in page and "particles" not in page
    # each site is filled after a time with the mean 1: it is empty in a geometric number of samples
    parts = files["coverage"].value
    full = files["coverage"].x["time"][parts[:, 1] == 1.0]
    assert full[0] - 1 < time <= full[0] and full[-1] == STEPS
    filled = 1 - np.exp(-1.0)
    empty = parts[:, 0].sum()
    error = np.sqrt((1 - filled) / filled**2 / np.prod(SITES))
    assert abs(empty - 1 / filled) < 4 * error
    mean = next(c for c in files["coverage"].comparisons if c.what == "mean part empty")
    assert mean.measured == pytest.approx(empty / (STEPS + 1), rel=1e-9)


def test_what_goes_on_says_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    told = StringIO()
    simulation = Simulation(case_of(2), output=tmp_path / "run", threads=1)
    simulation.run(progress=Reporter(stream=told))
    assert "nothing can happen" not in told.getvalue()
    assert mesokit.open(tmp_path / "run").provenance["absorbed"] is None
    assert "nothing can happen" not in repr(mesokit.open(tmp_path / "run"))
