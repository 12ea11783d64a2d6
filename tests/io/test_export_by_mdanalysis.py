"""Exports that MDAnalysis writes, universes, and the recipes of the guide."""

from __future__ import annotations

import re
import shutil
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest

import mesokit
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import Trajectory
from mesokit.io import h5md
from mesokit.method.mpcd.fluid import Fluid
from mesokit.run.simulation import Simulation
from tests.helpers.exports import EVERYONE

pytestmark = pytest.mark.usefixtures("no_figures")


def test_a_universe_has_all_that_the_run_has(mixed):
    universe = mesokit.open(mixed.directory.path).universe()
    assert [universe.trajectory.n_frames, *(now.time for now in universe.trajectory)] == [
        3,
        0,
        1,
        2,
    ]
    assert universe.dimensions.tolist() == [6, 6, 1, 90, 90, 90]
    assert universe.residues.resnames.tolist() == ["fluid", "polymer-1", "polymer-1", "polymer-2"]
    assert [len(residue.atoms) for residue in universe.residues] == [72, 3, 3, 1]
    beads = universe.select_atoms("name polymer-1")
    assert beads.masses.tolist() == [5.0] * 6 and beads.radii.tolist() == [0.25] * 6
    assert universe.bonds.to_indices().tolist() == [[72, 73], [73, 74], [75, 76], [76, 77]]
    universe.trajectory[-1]
    np.testing.assert_allclose(
        universe.atoms.positions[:, :2], mixed.engine.positions(EVERYONE), atol=1e-5
    )
    found = universe.atoms.velocities[:, :2]
    np.testing.assert_allclose(found, mixed.engine.velocities(EVERYONE), atol=1e-5)


@pytest.mark.parametrize("warmup, every, steps", [(7, 3, 9), (5, 4, 8), (11, 20, 15)])
def test_times_of_a_dcd(warmup, every, steps, tmp_path):
    """Also where frames do not begin at a multiple of the steps between them, and of one alone."""
    import MDAnalysis

    case = Case(
        run=Run(steps, warmup=warmup),
        box=Box([6, 6]),
        fluid=Fluid(density=2, timestep=0.3),
        trajectory=Trajectory(every=every),
    )
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run()
    files = mesokit.open(tmp_path / "run")
    wanted = [0.3 * step for step in range(warmup, warmup + steps + 1, every)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        top, path = (str(files.export(tmp_path / f"a.{end}")) for end in ("gsd", "dcd"))
        times = [float(now.time) for now in MDAnalysis.Universe(top, path).trajectory]
    assert times == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("ending", ["h5md", "dcd", "xtc", "trr", "data"])
def test_files_of_mdanalysis(ending, mixed, tmp_path):
    """Read again by themselves, or beside a GSD file that says what the particles are."""
    import MDAnalysis

    files = mesokit.open(mixed.directory.path)
    path = str(files.export(tmp_path / f"run.{ending}"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if ending in ("h5md", "data"):
            unit = {"convert_units": False} if ending == "data" else {}  # LAMMPS has fs
            universe = MDAnalysis.Universe(path, **unit)
        else:
            top = str(files.export(tmp_path / "run.gsd"))
            universe = MDAnalysis.Universe(top, path)
        times = [float(now.time) for now in universe.trajectory]
        universe.trajectory[-1]
    assert times == ([0.0] if ending == "data" else pytest.approx([0.0, 1.0, 2.0]))
    near = 0.0051 if ending == "xtc" else 1e-5
    found = universe.atoms.positions[:, :2]
    np.testing.assert_allclose(found, mixed.engine.positions(EVERYONE), atol=near)
    assert universe.dimensions.tolist() == [6, 6, 1, 90, 90, 90]
    if ending == "data":
        assert universe.bonds.to_indices().tolist() == [[72, 73], [73, 74], [75, 76], [76, 77]]
        assert universe.atoms.masses.tolist() == [1.0] * 72 + [5.0] * 7
    if ending in ("h5md", "trr", "data"):
        found = universe.atoms.velocities[:, :2]
        np.testing.assert_allclose(found, mixed.engine.velocities(EVERYONE), atol=1e-5)


def test_a_data_file_is_as_lammps_reads_it(mixed, tmp_path):
    """Numbers as they stand in the file: velocities of the last frame, molecules from 1."""
    path = mesokit.open(mixed.directory.path).export(tmp_path / "run.data")
    sections = re.split(r"\n+([A-Z][a-z]+)\n+", path.read_text())
    rows = {
        name: np.array([line.split() for line in text.splitlines()], float)
        for name, text in zip(sections[1::2], sections[2::2], strict=True)
    }
    assert rows["Atoms"][:, 1].tolist() == [0] * 72 + [1] * 3 + [2] * 3 + [0]
    speeds = rows["Velocities"][:, 1:]
    np.testing.assert_allclose(speeds[:, :2], mixed.engine.velocities(EVERYONE), atol=1e-5)
    assert (speeds[:, 2] == 0).all()


def recipe(word):
    """The block of the guide that has the word."""
    guide = Path(__file__).parents[2] / "docs" / "guide"
    page = (guide / "keep-trajectories.md").read_text("utf-8")
    blocks = re.findall(r"^```text\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    (found,) = [block for block in blocks if word in block]
    return found


@pytest.fixture
def melt(mixed, tmp_path, monkeypatch):
    """A working directory with the run that the guide speaks of."""
    shutil.copytree(mixed.directory.path, tmp_path / "melt")
    monkeypatch.chdir(tmp_path)
    mesokit.open("melt").export("melt.gsd")


@pytest.fixture
def folded(mixed, melt):
    """The run of the guide, moved until the first chain lies over the edge; where beads are."""
    whole = mixed.engine.positions(EVERYONE, unwrapped=True)
    aside = whole[72:74].mean(axis=0)  # the middle of a bond becomes the corner
    with h5py.File("melt/run.h5", "r+") as file:
        particles = h5md.particles_of(file)
        place, image = particles["position/value"], particles["image/value"]
        moved = place[..., :2] - aside
        place[..., :2] = moved % 6
        image[..., :2] += np.floor(moved / 6).astype(int)
        ends = place[-1, 72:74, :2]
    assert np.ptp(ends, axis=0).max() > 3
    return whole - aside


def gyration(beads):
    """The root of the mean squared distance from the middle."""
    return np.sqrt(((beads - beads.mean(axis=0)) ** 2).sum(axis=1).mean())


def test_the_recipe_for_mdanalysis(folded, capsys):
    """Chains over the edge have their true size."""
    exec(recipe(".universe()"), {"mesokit": mesokit})
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [float(time) for time, _ in rows] == [0.0, 1.0, 2.0]
    size = np.mean([gyration(folded[72:75]), gyration(folded[75:78])])
    assert float(rows[-1][1]) == pytest.approx(size, rel=1e-5)


def test_the_recipe_with_images(folded):
    space = {"mesokit": mesokit}
    exec(recipe("unfolded ="), space)
    np.testing.assert_allclose(space["unfolded"][-1], folded, atol=1e-5)


def test_the_recipe_for_freud(melt):
    pytest.importorskip("freud")
    space = {}
    exec(recipe("freud"), space)
    assert space["rdf"].rdf.max() > 0
