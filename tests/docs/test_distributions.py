"""The wheel and the source distribution are whole, and work away from the sources."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

from mesokit.io.provenance import sources

pytest.importorskip("hatchling")
pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[2]
PARTS = "mesokit/kernels/shipped/"  # where `make parts` has been called


def python(*words: str | Path, cwd: Path, **environment: str) -> str:
    # bytecode beside the sources would be among the files of a folder that several tests read
    environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"} | environment
    done = subprocess.run(
        [sys.executable, *map(str, words)], cwd=cwd, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory) -> Path:
    """A folder with both distributions, and what is in them."""
    folder = tmp_path_factory.mktemp("dist")
    python("-m", "hatchling", "build", "-d", folder, cwd=ROOT)
    (wheel,), (source,) = folder.glob("*.whl"), folder.glob("*.tar.gz")
    shutil.unpack_archive(wheel, folder / "wheel", "zip")
    shutil.unpack_archive(source, folder / "source")
    return folder


def files(folder: Path) -> set[str]:
    return {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}


def test_a_wheel_works_by_itself(built: Path, tmp_path: Path) -> None:
    """Its code is that of the clone, to the digest; its templates and examples are there."""
    there = files(built / "wheel")
    assert {"mesokit/py.typed", "mesokit/__init__.pyi", "mesokit/examples/junction.png"} <= there
    assert "mesokit/theory/__init__.pyi" in there
    assert not [name for name in there if "__pycache__" in name or name.startswith("tests")]
    code = (
        "import mesokit; from mesokit.io.provenance import sources\n"
        "print(mesokit.__file__); print(sources()['digest']); print(sources()['commit'])"
    )
    place = {"PYTHONPATH": str(built / "wheel") + os.pathsep + os.environ.get("PYTHONPATH", "")}
    file, digest, commit = python("-c", code, cwd=tmp_path, **place).splitlines()
    assert Path(file).is_relative_to(built / "wheel")
    assert (digest, commit) == (sources()["digest"], "None")
    for name in ("bulk", "junction", "viscoelastic/fig_4_1", "studies/frequency_sweep"):
        python("-m", "mesokit", "new", name, cwd=tmp_path, **place)
    assert (tmp_path / "junction.png").exists()
    told = python("-m", "mesokit", "check", "bulk.toml", cwd=tmp_path, **place)
    assert "kinematic viscosity" in told


def test_a_source_distribution_has_all_and_makes_the_same_wheel(built: Path) -> None:
    (folder,) = (built / "source").iterdir()
    there = files(folder)
    for name in ("CHANGELOG.md", "docs/guide/index.md", "examples/sphere.toml",
                 "benchmarks/__main__.py", "tests/conftest.py", "LICENSE", "pyproject.toml",
                 "mkdocs.yml"):  # fmt: skip
        assert name in there, name
    left = (".pyc", ".npz", ".h5", ".log", ".nbi", ".tmp")
    assert not [name for name in there if name.endswith(left) or "__pycache__" in name]
    python("-m", "hatchling", "build", "-t", "wheel", "-d", built / "again", cwd=folder)
    (wheel,) = (built / "again").glob("*.whl")
    again = set(zipfile.ZipFile(wheel).namelist())
    assert again == {name for name in files(built / "wheel") if not name.startswith(PARTS)}


def test_a_wheel_has_the_parts_that_were_made_and_a_source_distribution_has_not(
    built: Path, tmp_path: Path
) -> None:
    (folder,) = (built / "source").iterdir()
    shutil.copytree(folder, tmp_path / "clone")
    file = tmp_path / "clone" / "src" / f"{PARTS}of-a-system.sqlite"
    file.parent.mkdir(exist_ok=True)
    file.touch()
    python("-m", "hatchling", "build", "-d", tmp_path, cwd=tmp_path / "clone")
    (wheel,), (source,) = tmp_path.glob("*.whl"), tmp_path.glob("*.tar.gz")
    assert f"{PARTS}of-a-system.sqlite" in zipfile.ZipFile(wheel).namelist()
    with tarfile.open(source) as packed:
        assert not [name for name in packed.getnames() if PARTS in name]
