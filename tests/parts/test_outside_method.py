"""A method from outside the package, on a lattice without particles, as docs/extending.md has it.

Checked, run, drawn, filmed, resumed, made longer and swept, with nothing edited in mesokit.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import mesokit
from mesokit import open as opened
from mesokit.case.box import Box
from mesokit.case.case import case_class
from mesokit.case.checks import check
from mesokit.case.sites import SiteLattice
from mesokit.case.trajectory import Group, Kind, Trajectory
from mesokit.errors import CaseError, RunError
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.report.flow.kinds import usual

SOURCE = Path(mesokit.__file__).parents[1]
PAGE = Path(__file__).parents[2] / "docs" / "extending.md"


def block(language: str) -> str:
    """The one block of the page in a language."""
    found = re.findall(r"^```([^\n]*)\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    (text,) = [text for name, text in found if name == language]
    return text


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the file of the page as an installed package has it."""
    folder = tmp_path_factory.mktemp("site-packages")
    (folder / "ising.py").write_text(block("python method"))
    metadata = folder / "ising-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: ising\nVersion: 1.0\n")
    points = re.sub(r'\[project\.entry-points\."(.*)"\]', r"[\1]", block("toml method-entry-point"))
    (metadata / "entry_points.txt").write_text(points.replace('"', ""))
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the case of the page."""
    folder = tmp_path_factory.mktemp("ising")
    (folder / "case.toml").write_text(block("toml method-case"))
    return folder


@pytest.fixture
def command(folder: Path, installed: Path):
    """A function that runs a command of mesokit there."""

    def run(*arguments: str, status: int = 0) -> str:
        done = subprocess.run(
            [sys.executable, "-m", "mesokit", *arguments],
            cwd=folder,
            env={"PYTHONPATH": f"{SOURCE}:{installed}", "PATH": "/usr/bin", "HOME": str(folder)},
            capture_output=True,
            text=True,
        )
        assert done.returncode == status, done.stderr
        return done.stdout + done.stderr

    return run


def test_a_method_on_a_lattice_runs_and_is_drawn_and_swept(folder, command, installed, monkeypatch):
    assert "half the energy" in command("explain", "ising.coupling")
    command("check", "case.toml")
    told = command("run", "case.toml")
    assert "mean-spin" in told
    assert "mean-spin" in command("info", "case")  # its own entry point brings its parts
    command("plot", "case", "--kind", "sites")
    command("animate", "case", "--output", "film.gif")
    assert (folder / "film.gif").stat().st_size > 1000
    assert (folder / "case" / "mean-spin.png").exists()
    command("report", "case")
    monkeypatch.syspath_prepend(installed)
    try:
        files = opened(folder / "case")
        states = files.trajectory.read("site")
        assert states.shape == (9, 64 * 48) and set(np.unique(states)) == {0, 1}
        (found,) = files["mean-spin"].comparisons
        assert found.expected == pytest.approx((1 - np.sinh(1.0) ** -4) ** 0.125)
        assert abs(found.deviation) < 4 and found.error < 0.01
        # the same bits where the run was stopped and made longer
        command("run", "case.toml", "--output", "short", "--set", "run.steps=200")
        command("resume", "short", "--steps", "400")
        longer = opened(folder / "short")
        assert np.array_equal(longer.trajectory.read("site"), states)
        assert longer["mean-spin"].value == files["mean-spin"].value
    finally:
        case_class.cache_clear()
    study = command("study", "case.toml", "--vary", "ising.coupling=0.5,0.6", "--seeds", "2")
    assert "mean-spin" in study


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ('trajectory.fields=["position"]', "spins of method 'ising' have no 'position'"),
        ("box.shear_rate=0.1", "box.shear_rate = 0.1: not with method 'ising'"),
        ("box.open=true", "box.open"),
        ("box.size=[64,47]", "expected two even numbers of sites"),
    ],
)
def test_what_a_lattice_does_not_have_is_refused(command, change, words):
    told = command("check", "case.toml", "--set", change, status=2)
    assert words in told and "Traceback" not in told and len(told.strip().splitlines()) == 1


class ManyStates:
    """An engine of two sites, one in a state that 16 bits do not hold."""

    step, time = 0, 0.0

    def sites(self, ids):
        return np.array([3, 40_000])[ids]


def test_states_that_a_file_cannot_hold_are_refused(tmp_path):
    writer = TrajectoryWriter(Trajectory(every=1, fields=("site",)), tmp_path, 2)
    with pytest.raises(RunError, match="'site': states from 3 to 40000; expected -32768 to 32767"):
        writer.record(ManyStates())


def test_an_unknown_picture_of_a_group_names_the_method():
    rods = Group("rods", (Kind(1.0, 2),), picture="rodlike")
    case = SimpleNamespace(groups=(rods,), run=SimpleNamespace(method="rods"))
    with pytest.raises(CaseError, match="method 'rods': picture = 'rodlike': expected 'quiver'"):
        usual(case, [], "four", in_time=False)


@pytest.mark.parametrize(
    "size, sites, words",
    [
        ((8, 8), 60, "method 'flips': group 'spins' has 60 sites; expected 64, as its lattice"),
        ((64,), 64, r"method 'flips': group 'spins' has a lattice \(64,\); expected one of 2 axes"),
    ],
)
def test_a_lattice_that_is_not_that_of_its_group_is_refused_at_once(size, sites, words):
    spins = Group("spins", (Kind(1.0, sites),), has=("site",), lattice=SiteLattice(size))
    case = SimpleNamespace(
        run=SimpleNamespace(method="flips"),
        box=Box([8, 8]),
        observe=(),
        groups=(spins,),
        trajectory=None,
    )
    with pytest.raises(CaseError, match=words):
        check(case, SimpleNamespace(name="flips", observables=()))
