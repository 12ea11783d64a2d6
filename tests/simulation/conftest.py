"""One small case that uses every safety feature, and its uninterrupted run."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import mesokit
from mesokit.case.case import Case
from mesokit.report.progress import Reporter
from mesokit.run.simulation import Simulation

CASE = """
[run]
steps = 400
warmup = 37
seed = 3
checkpoint_every = 20

[box]
size = [12, 9]

[fluid]
density = 9.52
collision = { rule = "srd", angle = 90 }
thermostat = { rule = "maxwell-boltzmann" }
force = { rule = "uniform", acceleration = [0.02, 0] }

[[wall]]
axis = "y"
shape = "plates"
upper = { velocity = [0.1, 0] }

[[observe]]
quantity = "velocity-profile"
axis = "y"
every = 3

[[observe]]
quantity = "wall-stress"
every = 7

[[observe]]
quantity = "conservation"
every = 10

[[observe]]
quantity = "mean-square-displacement"
components = ["x"]
max_lag = 60
every = 5

[[observe]]
quantity = "transverse-modes"
every = 4

[[observe]]
quantity = "flow-frames"
window = 30
particles = 50

[trajectory]
every = 25
fields = ["position", "velocity", "image"]
"""


class Crash(BaseException):
    """What ends a run at once, as a loss of power would."""


class CrashAt(Reporter):
    """A reporter that lets a run get so far and no further."""

    def __init__(self, step: int) -> None:
        super().__init__(quiet=True)
        self.at = step

    def update(self, step: int) -> None:
        """Crash, if it is time."""
        if step >= self.at:
            raise Crash


@contextmanager
def without_figures():
    """Figures take most of the time of so small a run; other tests look at them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        yield


@pytest.fixture(autouse=True)
def no_figures():
    """For these tests alone: those of other folders may come next."""
    with without_figures():
        yield


@pytest.fixture(scope="session")
def crash_at():
    """`crash_at(step)` is a reporter; `crash_at.error` what it raises."""

    def make(step):
        return CrashAt(step)

    make.error = Crash
    return make


@pytest.fixture(scope="session")
def case_file(tmp_path_factory) -> Path:
    """The case, as a file."""
    path = tmp_path_factory.mktemp("case") / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture(scope="session")
def case(case_file) -> Case:
    """The case."""
    return Case.from_toml(case_file)


@pytest.fixture(scope="session")
def uninterrupted(case, tmp_path_factory) -> Simulation:
    """The run that was never stopped, with its folder."""
    simulation = Simulation(case, output=tmp_path_factory.mktemp("runs") / "whole", threads=1)
    with without_figures():
        simulation.run()
    return simulation


@pytest.fixture(scope="session")
def ends_alike(uninterrupted):
    """Asserts that a run ended with the bits of the uninterrupted one: state, results, frames."""

    def check(simulation: Simulation, files: bool = True) -> None:
        same_state(simulation, uninterrupted)
        if files:
            same_files(simulation.directory.path, uninterrupted.directory.path)

    return check


def same_state(one: Simulation, other: Simulation) -> None:
    assert one.step == other.step
    for name in ("positions", "velocities", "images"):
        np.testing.assert_array_equal(getattr(one.engine, name)(), getattr(other.engine, name)())
    assert one.results == other.results


def same_files(one: Path, other: Path) -> None:
    a, b = mesokit.open(one), mesokit.open(other)
    assert a.results == b.results
    assert a.fingerprint == b.fingerprint != ""
    assert sorted(p.name for p in one.iterdir()) == sorted(p.name for p in other.iterdir())
    import h5py

    with h5py.File(one / "run.h5") as f, h5py.File(other / "run.h5") as g:
        frames: list[str] = []
        g["particles"].visititems(
            lambda name, item: frames.append(name) if isinstance(item, h5py.Dataset) else None
        )
        assert any("position" in name for name in frames)
        for name in frames:
            np.testing.assert_array_equal(f["particles"][name][()], g["particles"][name][()])
