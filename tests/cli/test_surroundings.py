"""Shells, terminals and settings of libraries that are not as one would have them."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

SOURCE = str(Path(__file__).parents[2] / "src")
SMALL = """
run = { steps = 20 }
box = { size = [8, 8] }
fluid = { force = { rule = "uniform", acceleration = [0, 0] } }
[[observe]]
quantity = "conservation"
every = 2
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path) -> Path:
    (tmp_path / "case.toml").write_text(SMALL)
    return tmp_path


def process(folder: Path, command: str, **environment: str) -> subprocess.CompletedProcess:
    """A shell's command, with `mesokit` for that of this source."""
    command = command.replace("mesokit", f"{sys.executable} -m mesokit", 1)
    return subprocess.run(
        command, shell=True, cwd=folder, env=os.environ | {"PYTHONPATH": SOURCE} | environment,
        capture_output=True, check=False,
    )  # fmt: skip


def test_a_run_minds_no_setting(folder: Path) -> None:
    (folder / "matplotlibrc").write_text("text.usetex: True\n")
    given = {"MPLBACKEND": "nonsense", "NUMBA_DISABLE_JIT": "1", "NUMBA_NUM_THREADS": "0"}
    ended = process(folder, "mesokit run case.toml", PYTHONIOENCODING="ascii", PATH="", **given)
    assert ended.returncode == 0, ended.stderr.decode()
    assert (folder / "case" / "conservation.png").exists()


@pytest.mark.parametrize("command", ["theory", "check templates/bulk.toml"])
def test_a_terminal_with_few_letters(folder: Path, command: str) -> None:
    command = command.replace("templates", f"{SOURCE}/mesokit/method/mpcd/templates")
    ended = process(folder, f"mesokit {command}", PYTHONIOENCODING="latin-1")
    assert ended.returncode == 0, ended.stderr.decode()


@pytest.mark.parametrize("streams", ["2>/dev/full", ">&- 2>&-"])
def test_nobody_listens(folder: Path, streams: str) -> None:
    """The run goes on, and the folder knows why one failed."""
    assert process(folder, f"mesokit run case.toml {streams}").returncode == 0
    hot = "--set fluid.force.acceleration=[1e5,0] --set run.steps=500"
    ended = process(folder, f"mesokit run case.toml --output hot {hot} {streams}")
    assert ended.returncode == 1
    assert "heats up" in json.loads((folder / "hot" / "provenance.json").read_text())["failed"]


def test_output_that_cannot_be_written(folder: Path) -> None:
    ended = process(folder, "mesokit check case.toml >/dev/full")
    assert ended.returncode == 2
    assert ended.stderr.endswith(b"mesokit: error: no space left on the disk\n")


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a case and a run of it."""
    place = tmp_path_factory.mktemp("done")
    (place / "case.toml").write_text(SMALL)
    assert process(place, "mesokit run case.toml --output old --quiet").returncode == 0
    return place


@pytest.mark.parametrize(
    ("command", "status", "made"),
    [
        ("run case.toml", 0, "case/conservation.png"),
        ("study case.toml --vary fluid.density=5,6 --output few", 0, "few/table.csv"),
        ("check case.toml", 0, ""),
        ("explain", 0, ""),
        ("explain run.seed", 0, ""),
        ("info old", 0, ""),
        ("schema", 0, ""),
        ("--help", 0, ""),
        ("info none", 2, ""),
    ],
)
@pytest.mark.parametrize("both", [False, True], ids=["output", "all"])
def test_the_reader_has_left(command: str, status: int, made: str, both: bool, done: Path) -> None:
    """The work goes on, with its own status."""
    reading, writing = os.pipe()
    os.close(reading)
    ended = subprocess.run(
        [sys.executable, "-m", "mesokit", *command.split()], cwd=done, stdout=writing,
        stderr=writing if both else subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": SOURCE, "PYTHONUNBUFFERED": "1" if both else ""},
        check=False,
    )  # fmt: skip
    os.close(writing)
    said = b"" if both else ended.stderr
    assert ended.returncode == status, said
    assert b"Broken pipe" not in said and b"Exception" not in said
    if made:
        place = done / made
        assert place.exists()
        shutil.rmtree(place.parent)


def test_ranks_without_mpi4py(folder: Path) -> None:
    """It is as if it were not installed."""
    (folder / "sitecustomize.py").write_text("import sys\nsys.modules['mpi4py'] = None\n")
    path = f"{SOURCE}{os.pathsep}{folder}"
    ended = process(folder, "mesokit run case.toml --ranks 2", PYTHONPATH=path)
    assert ended.returncode == 1
    said = ended.stderr.decode().splitlines()
    assert said == ["mesokit: error: --ranks: needs mpi4py: pip install 'mesokit[mpi]'"]
    assert not (folder / "case").exists()


def test_names_that_are_not_text(folder: Path) -> None:
    place = os.fsdecode(os.fsencode(folder) + b"/\xff")
    os.mkdir(place)
    picture = Image.new("L", (32, 32), 255)
    picture.paste(0, (10, 10, 22, 22))
    with open(f"{place}/solid.png", "wb") as file:
        picture.save(file, format="png")
    wall = '[[wall]]\nshape = "picture"\nfile = "solid.png"\nsize = [8, 8]\norigin = [0, 0]\n'
    (Path(place) / "case.toml").write_text(SMALL + wall)
    ended = process(Path(place), "mesokit check case.toml")
    assert ended.returncode == 0, ended.stderr.decode()


def test_a_folder_whose_name_is_no_text(folder: Path) -> None:
    """Its figures and its report say so with a question mark."""
    place = os.fsdecode(os.fsencode(folder) + b"/named\xfe")
    os.mkdir(place)
    (Path(place) / "case.toml").write_text(SMALL)
    for command in ("run case.toml --output .out --quiet", "report .out"):
        arguments = [word.replace(".out", os.fsdecode(b"out\xff")) for word in command.split()]
        ended = process(Path(place), "mesokit " + shlex.join(arguments))
        assert ended.returncode == 0, ended.stderr.decode()
    page = Path(place, os.fsdecode(b"out\xff"), "report.html").read_text(encoding="utf-8")
    assert "out?" in page
