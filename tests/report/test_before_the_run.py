"""A case can be looked at before it runs: solids, molecules and particles where they start."""

from __future__ import annotations

import json

import numpy as np
import pytest

from mesokit import FENE, WCA, Box, Case, Disk, Fluid, Polymer, Run, RunError, Simulation, Solutes
from mesokit.cli import main
from mesokit.report.flow import State, state
from mesokit.report.flow.source import sources

CASE = """
[run]
steps = 10
[box]
size = [20, 10]
[fluid]
density = 5
[[wall]]
shape = "disk"
centre = [10, 5]
radius = 3
"""


def command(*words):
    with pytest.raises(SystemExit) as status:
        main([str(word) for word in words])
    return status.value.code


@pytest.fixture(scope="module")
def in_solution():
    solutes = Solutes((Polymer(2, length=6),), bond=FENE(), pair=WCA())
    case = Case(run=Run(10), box=Box([20, 20]), fluid=Fluid(density=5), solutes=solutes)
    return Simulation(case)


def test_particles_are_drawn_where_they_are(in_solution):
    figure = in_solution.flow("particles")
    (ax,) = figure.axes
    drawn = max((line.get_xydata() for line in ax.lines), key=len)
    np.testing.assert_array_equal(drawn, in_solution.engine.positions()[: len(drawn)])
    assert len(drawn) == in_solution.case.particles == 2000
    beads = in_solution.engine.positions(2000 + np.arange(12))
    found = np.concatenate([line.get_xydata() for line in ax.lines]) % 20
    for bead in beads:
        assert np.abs(found - bead).max(axis=1).min() < 1e-9
    assert r"solutes at $t=0\,\tau$" in " ".join(text.get_text() for text in reversed(figure.texts))


def test_of_many_particles_some_are_drawn_and_that_is_said(in_solution, monkeypatch):
    monkeypatch.setattr(state, "MOST", 100)
    now = State(in_solution.case, in_solution.engine)
    assert len(now.id) == 112 and (np.diff(now.id[:100]) == 20).all()
    (source,) = sources(in_solution.case, {}, now)
    assert source.gives == {"particles"}
    figure = in_solution.flow("particles")
    assert any("100 of 2000 particles" in text.get_text() for text in figure.texts)


def test_a_flow_is_not_drawn_from_one_moment(in_solution):
    with pytest.raises(RunError, match="flow-frames"):
        in_solution.flow("speed")


def test_a_projection_is_called_one():
    simulation = Simulation(run=Run(10), box=Box([6, 6, 6]), fluid=Fluid(density=2))
    figure = simulation.flow("particles", axes=("x", "z"))
    assert any("projection along $y$" in text.get_text() for text in figure.texts)


def test_no_particle_is_drawn_in_a_solid():
    disk = Disk([10, 5], 3)
    case = Case(run=Run(10), box=Box([20, 10]), fluid=Fluid(density=5), walls=[disk])
    (ax,) = Simulation(case).flow("particles").axes
    drawn = max((line.get_xydata() for line in ax.lines), key=len)
    assert len(drawn) == case.particles
    assert np.hypot(*(drawn - (10, 5)).T).min() > 3


def test_check_draws_it(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "disk.toml").write_text(CASE)
    assert command("check", "disk.toml", "--picture") == 0
    assert "picture: disk-start.png" in capsys.readouterr().out
    assert (tmp_path / "disk-start.png").read_bytes()[:4] == b"\x89PNG"
    assert command("check", "disk.toml", "--picture", "start.pdf", "--json") == 0
    assert json.loads(capsys.readouterr().out)["picture"] == "start.pdf"
    assert (tmp_path / "start.pdf").read_bytes()[:4] == b"%PDF"
    assert command("check", "disk.toml", "--axes", "x,y") == 2
    assert "add --picture" in capsys.readouterr().err
    assert command("check", "disk.toml", "--picture", "--axes", "x,w") == 2
    assert "expected two of x, y" in capsys.readouterr().err
