"""Starts from files: the bits of one process; no rank but the first reads the whole."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rank_runs import CASE, MPIEXEC
from starts import SOURCES, make_sources

PROGRAM = Path(__file__).with_name("starts.py")
PARTICLES = 600
SLICED = {"bulk npy", "bulk half"}  # what each rank reads its share of


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """A folder with files to start from, and what one process makes of them."""
    pytest.importorskip("gsd.hoomd")
    pytest.importorskip("MDAnalysis")
    folder = tmp_path_factory.mktemp("sources")
    make_sources(folder)
    begin(folder, 1)
    return folder


def begin(folder, ranks):
    start = [MPIEXEC, "-n", str(ranks)] if ranks > 1 else []
    command = [*start, sys.executable, PROGRAM, folder]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("ranks", [2, 3])
def test_every_source_gives_the_bits_of_one_process(sources, ranks):
    begin(sources, ranks)
    for kind, name in SOURCES:
        one, some = (sources / f"{kind}-{name}-{n}" / "checkpoint.npz" for n in (1, ranks))
        assert one.read_bytes() == some.read_bytes(), (kind, name)
    read = json.loads((sources / f"read-{ranks}.json").read_text())
    assert {name for name, rows in read.items() if not any(rows)} == {"bulk given"}
    for name, rows in read.items():
        if name in SLICED:
            assert rows == [PARTICLES // ranks] * ranks, name
        elif name == "bulk npz":  # the other array is one of them
            assert rows == [PARTICLES] + [PARTICLES // ranks] * (ranks - 1)
        elif name != "bulk given":
            assert rows == [PARTICLES] + [0] * (ranks - 1), name


def test_one_process_reads_all(sources):
    read = json.loads((sources / "read-1.json").read_text())
    assert {tuple(rows) for name, rows in read.items() if name != "bulk given"} == {(PARTICLES,)}


def write_rows(path, last=1.0, rows=PARTICLES):
    array = np.ones((rows, 2))
    array[-1] = last
    (np.savez if path.suffix == ".npz" else np.save)(path, array)


@pytest.mark.parametrize(
    ("key", "file", "write", "said"),
    [
        ("positions", "r.npy", lambda path: write_rows(path, np.nan), "row 599 is not finite"),
        ("positions", "r.npy", lambda path: write_rows(path, 1e300), "2^30 boxes away or more"),
        ("positions", "r.npy", lambda path: write_rows(path, rows=7), "shape (7, 2): expected"),
        ("positions", "r.npz", lambda path: write_rows(path, np.nan), "row 599 is not finite"),
        ("positions", "r.npy", lambda path: path.write_text("a"), "expected a .npy or .npz file"),
        ("file", "r.gsd", lambda path: path.write_text("a"), "cannot be read as a GSD file"),
        ("run", "earlier", lambda path: path.mkdir(), "earlier': "),
    ],
)
def test_what_is_wrong_is_said_once(folder, mpiexec, key, file, write, said):
    write(folder / file)
    (folder / "case.toml").write_text(CASE.format(steps=4, checkpoints=4))
    ranks = mpiexec(3, "run", "case.toml", "--output", "out", "--set", f"fluid.start.{key}={file}")
    assert ranks.end() == 2, ranks.err
    [line] = [line for line in ranks.err.splitlines() if line.startswith("mesokit: ")]
    assert line.startswith(f"mesokit: error: case.toml: fluid.start.{key}") and said in line
    assert not (folder / "out").exists()
