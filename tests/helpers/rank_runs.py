"""One small case, for which kernels are compiled once, and how ranks are started."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np

import mesokit

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src"
PROGRAMS = ROOT / "tests" / "ranks"
MPIEXEC = shutil.which("mpiexec", path=str(Path(sys.executable).parent)) or shutil.which("mpiexec")
PATIENCE = 300.0  # seconds: kernels may have to be compiled, on a busy machine
CASE = """
[run]
steps = {steps}
checkpoint_every = {checkpoints}
[box]
size = [12, 10]
[fluid]
density = 5
[[observe]]
quantity = "conservation"
every = 20
[trajectory]
every = 100
[log]
every = 100
"""


class Ranks:
    """A program on several ranks: how it ended, and what it said."""

    def __init__(self, command, folder, **environ):
        path = [str(place) for place in (SOURCE, folder) if place is not None]
        known = {"PYTHONPATH": os.pathsep.join(path), "OPENBLAS_NUM_THREADS": "1"}
        self.folder = folder
        self.process = subprocess.Popen(
            [str(word) for word in command],
            cwd=folder,
            env=os.environ | known | environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def end(self):
        """Wait; the status, and both streams."""
        self.out, self.err = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode

    def until(self, path, newer_than=0):
        """Wait until a file was written after a time."""
        path, last = Path(path), time.monotonic() + PATIENCE
        while not path.exists() or path.stat().st_mtime_ns <= newer_than:
            assert self.process.poll() is None, self.process.communicate()
            assert time.monotonic() < last
            time.sleep(0.01)

    def pids(self):
        """The process of each rank, as each of them has written it."""
        files = sorted(self.folder.glob("pid-*"))
        return [int(file.read_text()) for file in files]


MESOKIT = [sys.executable, "-m", "mesokit"]
NOTES = """
import os
rank = int(os.environ.get("PMI_RANK", os.environ.get("OMPI_COMM_WORLD_RANK", 0)))
with open(f"pid-{rank}", "w") as file:
    file.write(str(os.getpid()))
"""


def on_ranks(n, program, *words, folder=None):
    """What a program of `PROGRAMS` says on so many ranks; a failure of one ends all of them."""
    command = [MPIEXEC, "-n", n, sys.executable, "-m", "mpi4py", PROGRAMS / program, *words]
    ranks = Ranks(command, folder)
    assert ranks.end() == 0, ranks.out + ranks.err
    return ranks.out


def same_files(one, two):
    """Whether two runs have written the same."""
    assert (one / "log.csv").read_text() == (two / "log.csv").read_text()
    assert mesokit.open(one).fingerprint == mesokit.open(two).fingerprint != ""
    with np.load(one / "checkpoint.npz") as a, np.load(two / "checkpoint.npz") as b:
        assert a.files == b.files
        for name in set(a.files) - {"meta"}:
            assert np.array_equal(a[name], b[name]), name
    with h5py.File(one / "run.h5") as a, h5py.File(two / "run.h5") as b:
        theirs = dict(datasets(b))
        mine = dict(datasets(a))
        assert mine.keys() == theirs.keys()
        for name in mine.keys() - {"parameters/provenance"}:
            assert mine[name].tobytes() == theirs[name].tobytes(), name


def datasets(file):
    found = []
    file.visititems(
        lambda name, item: (
            found.append((name, np.asarray(item[()]))) if isinstance(item, h5py.Dataset) else None
        )
    )
    return [(name, array) for name, array in found if array.dtype != object]
