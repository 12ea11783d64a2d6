"""A folder with a small case, and what starts ranks there."""

import sys

import pytest

from tests.helpers.rank_runs import CASE, MESOKIT, MPIEXEC, NOTES, Ranks

# run under mpiexec: they begin MPI
collect_ignore = [
    "program.py",
    "refused.py",
    "same_bits.py",
    "same_sums.py",
    "starts.py",
    "waits.py",
]


@pytest.fixture(scope="session", autouse=True)
def an_mpi():
    pytest.importorskip("mpi4py", reason="no mpi4py here")
    if MPIEXEC is None:
        pytest.skip("no mpiexec here")


def filled(folder):
    """A folder with the case, a longer one, and a module by which ranks note their processes."""
    (folder / "case.toml").write_text(CASE.format(steps=400, checkpoints=100))
    (folder / "long.toml").write_text(CASE.format(steps=6000, checkpoints=500))
    (folder / "endless.toml").write_text(CASE.format(steps=10**9, checkpoints=200))
    (folder / "notes.py").write_text(NOTES)
    return folder


@pytest.fixture
def folder(tmp_path):
    """A folder with cases, of this test."""
    return filled(tmp_path)


@pytest.fixture(scope="session")
def runs(once):
    """Fill a folder with cases and what some ranks make of them, once for all tests."""
    return lambda name, run: once(name, lambda folder: run(filled(folder)))


@pytest.fixture
def mpiexec(folder):
    """Start `mpiexec -n N` of some words, `mesokit` unless they begin with another program."""

    def start(n, *words, **environ):
        words = words if str(words[0]) == sys.executable else (*MESOKIT, *words)
        return Ranks([MPIEXEC, "-n", n, *words], folder, **environ)

    return start


@pytest.fixture
def mesokit(folder):
    """Start `mesokit`."""
    return lambda *words, **environ: Ranks([*MESOKIT, *words], folder, **environ)
