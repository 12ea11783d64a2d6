"""A run goes on with the solid that it began with, whatever becomes of the file and the folder."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

import mesokit
from mesokit import (
    Box,
    Case,
    CaseError,
    Fluid,
    MaxwellBoltzmann,
    Mesh,
    Picture,
    Plates,
    Run,
    Sampled,
    Simulation,
    Uniform,
)
from mesokit.cli import main

STEPS = 60


def picture(file: Path, radius: float) -> str:
    x, y = np.meshgrid((np.arange(80) + 0.5) / 8 - 5, (np.arange(80) + 0.5) / 8 - 5)
    Image.fromarray(np.where(np.hypot(x, y) > radius, 255, 0).astype(np.uint8)).save(file)
    return str(file)


def array(file: Path) -> Sampled:
    x, y = np.meshgrid(np.arange(-3, 3.1, 0.25), np.arange(-3, 3.1, 0.25), indexing="ij")
    return Sampled.from_array(np.hypot(x, y) - 2, file, spacing=0.25, origin=(2, 2), name="post")


def section(file: Path) -> Mesh:
    trimesh.creation.icosphere(subdivisions=3, radius=2).export(file)
    return Mesh(str(file), position=(5, 4), fluid="inside")


MAKE = {
    "picture": lambda folder: (Picture(picture(folder / "a.png", 2.0)),),
    "picture between plates": lambda folder: (Plates("y"), Picture(picture(folder / "a.png", 2.0))),
    "array": lambda folder: (array(folder / "a.npy"),),
    "mesh": lambda folder: (section(folder / "a.stl"),),
}


@pytest.fixture(params=MAKE)
def case(request: pytest.FixtureRequest, tmp_path: Path) -> Case:
    (tmp_path / "files").mkdir()
    walls = MAKE[request.param](tmp_path / "files")
    return Case(
        run=Run(steps=STEPS, seed=3), box=Box([10, 10]), walls=walls,
        fluid=Fluid(density=5, thermostat=MaxwellBoltzmann(), force=Uniform((0.01, 0.0))),
        observe=[mesokit.Conservation(every=10)],
    )  # fmt: skip


def test_resumed_after_the_file_is_gone_and_the_folder_moved(case: Case, tmp_path: Path) -> None:
    whole = Simulation(case, threads=1)
    whole.run()
    begun = Simulation(case, output=tmp_path / "run", threads=1)
    begun.engine.advance(STEPS // 2)
    begun.checkpoint()
    shutil.rmtree(tmp_path / "files")
    (tmp_path / "run").rename(tmp_path / "moved")
    resumed = Simulation.resume(tmp_path / "moved", threads=1)
    assert resumed.step == STEPS // 2
    resumed.run()
    np.testing.assert_array_equal(resumed.engine.positions(), whole.engine.positions())
    assert mesokit.open(tmp_path / "moved").case.particles == case.particles
    assert resumed.engine.numbers.solids.names == whole.engine.numbers.solids.names


def test_run_anew_from_its_own_folder(case: Case, tmp_path: Path) -> None:
    """The command that the run itself proposes, though it clears the folder."""
    first = Simulation(case, output=tmp_path / "run", threads=1)
    first.run()
    shutil.rmtree(tmp_path / "files")
    command = ["run", str(tmp_path / "run" / "case.toml"), "--output", str(tmp_path / "run")]
    with pytest.raises(SystemExit) as end:
        main([*command, "--overwrite", "--quiet"])
    assert end.value.code == 0
    again = Simulation.resume(tmp_path / "run", threads=1)
    np.testing.assert_array_equal(again.engine.positions(), first.engine.positions())


def test_names_are_relative_to_the_case(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    picture(tmp_path / "parts" / "a.png", 2.0)
    text = '[run]\nsteps = 1\n[box]\nsize = [10, 10]\n[[wall]]\nshape = "picture"\n'
    (tmp_path / "c.toml").write_text(text + 'file = "parts/a.png"\n')
    case = Case.from_toml(tmp_path / "c.toml")
    assert case.walls[0].file == str((tmp_path / "parts" / "a.png").resolve())
    (tmp_path / "again.toml").write_text(case.to_toml())
    assert Case.from_toml(tmp_path / "again.toml") == case


def test_a_kept_file_that_is_lost_is_one_line(tmp_path: Path) -> None:
    file = picture(tmp_path / "a.png", 2.0)
    case = Case(run=Run(1), box=Box([10, 10]), walls=(Picture(file),))
    Simulation(case, output=tmp_path / "run", threads=1)
    (tmp_path / "run" / "wall-1.npy").unlink()
    with pytest.raises(CaseError, match=r"case\.toml: wall\[#1\]\.file = '.*wall-1\.npy'"):
        Simulation.resume(tmp_path / "run")


def test_a_start_that_fails_leaves_nothing(tmp_path: Path, monkeypatch) -> None:
    from mesokit.io import run_directory

    case = Case(run=Run(1), box=Box([10, 10]), walls=(Picture(picture(tmp_path / "a.png", 2.0)),))

    def fails(path: Path, text: str) -> None:
        raise CaseError("no")

    with monkeypatch.context() as patch:
        patch.setattr(run_directory, "write_text", fails)
        (tmp_path / "there").mkdir()
        for name in ("new", "there"):
            with pytest.raises(CaseError):
                Simulation(case, output=tmp_path / name, threads=1)
    assert not (tmp_path / "new").exists()
    assert list((tmp_path / "there").iterdir()) == []
    Simulation(case, output=tmp_path / "there", threads=1)
