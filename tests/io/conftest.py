"""Runs whose trajectories are exported."""

from __future__ import annotations

import pytest

from mesokit import Harmonic
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import Trajectory
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.run.simulation import Simulation
from tests.helpers.exports import ALL, run_of


@pytest.fixture
def no_figures(monkeypatch):
    """Runs draw nothing at their ends."""
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """A run of trimers in a box whose lengths differ."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        folder = tmp_path_factory.mktemp("runs") / "run"
        return run_of(folder, (6, 5, 7))


@pytest.fixture(scope="session")
def mixed(tmp_path_factory):
    """A run of a fluid with polymers and a monomer."""
    solutes = Solutes((Polymer(2, length=3), Polymer()), mass=5.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(density=2), solutes=solutes,
        trajectory=Trajectory(every=10, fields=ALL),
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        folder = tmp_path_factory.mktemp("runs") / "mixed"
        simulation = Simulation(case, output=folder, threads=1)
        simulation.run()
    return simulation
