"""A method from outside the package whose particles have orientations: Brownian needles.

Orientations reach the trajectory and the files for other programs because the group has them.
"""

import sys
from pathlib import Path

import gsd.hoomd
import h5py
import numpy as np
import pytest

from mesokit import CaseError, Simulation
from mesokit import open as opened
from mesokit.case.case import Case, case_class

NEEDLES = '''
from dataclasses import replace

import numpy as np

from mesokit.method.brownian.engine import Brownians
from mesokit.method.brownian.method import METHOD as BROWNIAN
from mesokit.method.brownian.method import groups


class Needles(Brownians):
    """Each turns about z by 0.01 radians times its number in a step."""

    def orientations(self, ids=None):
        turned = 0.01 * self.step * np.arange(self.n)[slice(None) if ids is None else ids]
        still = np.zeros_like(turned)
        return np.stack([np.cos(turned / 2), still, still, np.sin(turned / 2)], axis=1)


def needles(case):
    (group,) = groups(case)
    return (group._replace(has=(*group.has, "orientation")),)


METHOD = replace(
    BROWNIAN, name="needles", groups=needles, engine=lambda case, threads, measures: Needles(case)
)
'''
CASE = """
run = { steps = 30, method = "needles" }
box = { size = [6, 6] }
brownian = { density = 1, diffusion = 0.1, timestep = 0.1 }
trajectory = { every = 10, fields = ["position", "orientation"] }
"""


@pytest.fixture
def case(tmp_path, monkeypatch):
    """A case of needles, whose package is installed for this test."""
    (tmp_path / "needles.py").write_text(NEEDLES)
    metadata = tmp_path / "needles-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: needles\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text("[mesokit.methods]\nneedles = needles\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    Path("needles.toml").write_text(CASE)
    case_class.cache_clear()
    yield Case.from_toml("needles.toml")
    sys.modules.pop("needles", None)
    case_class.cache_clear()


def expected(step: int) -> np.ndarray:
    """Orientations (36, 4) at a step."""
    half = 0.005 * step * np.arange(36)
    return np.stack([np.cos(half), 0 * half, 0 * half, np.sin(half)], axis=1)


def test_orientations_are_in_trajectories_and_in_files_for_other_programs(case):
    Simulation(case, output="run").run()
    frames = opened("run").trajectory
    assert frames.fields == ("position", "orientation")
    turned = frames.read("orientation")
    assert turned.shape == (4, 36, 4) and turned.dtype == np.float32
    assert turned == pytest.approx(np.array([expected(step) for step in (0, 10, 20, 30)]), abs=1e-6)

    for ending in ("gsd", "lammpstrj", "xyz", "h5md"):
        opened("run").export(f"needles.{ending}")
    with gsd.hoomd.open("needles.gsd") as file:
        assert file[3].particles.orientation == pytest.approx(expected(30), abs=1e-6)
    with h5py.File("needles.h5md") as file:
        stored = file["particles/trajectory/orientation/value"][()]
    assert np.array_equal(stored, turned)
    lines = Path("needles.lammpstrj").read_text().splitlines()
    names = lines[8].split()[2:]
    columns = [names.index(f"quat{letter}") for letter in "wijk"]
    last = np.array([line.split() for line in lines[-36:]])[:, columns].astype(float)
    assert last == pytest.approx(expected(30), abs=1e-6)
    text = Path("needles.xyz").read_text().splitlines()
    assert ":orientation:R:4 " in text[1]
    last = np.array([line.split()[-4:] for line in text[-36:]], float)
    assert last == pytest.approx(np.roll(expected(30), -1, axis=1), abs=1e-6)


def test_orientations_of_particles_without_any_are_refused(case):
    Path("points.toml").write_text(CASE.replace('"needles"', '"brownian"'))
    with pytest.raises(CaseError, match="have no 'orientation'"):
        Case.from_toml("points.toml")
