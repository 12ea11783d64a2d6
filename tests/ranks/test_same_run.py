"""One run on several ranks writes what one on one rank does, however it is started."""

import json
import shutil
import sys

import pytest

import mesokit as mk
from tests.helpers.rank_runs import MESOKIT, MPIEXEC, Ranks, same_files

SCRIPT = """
from mesokit import Simulation, every
from mesokit.run.callbacks import StopRun

calls = []

def look(simulation):
    calls.append((simulation.step, len(simulation.engine.positions())))
    if STOP and simulation.ranks.root and simulation.step == 200:
        raise StopRun("enough")

simulation = Simulation("case.toml", output="out", callbacks=[every(100, look)])
simulation.run()
print(simulation.step, calls == [(n, 600) for n in range(0, simulation.step + 1, 100)], flush=True)
"""


@pytest.fixture(scope="module")
def one(runs):
    """The run on one rank."""
    return runs("case-on-one", run_alone) / "out"


def run_alone(folder):
    mk.Simulation(folder / "case.toml", output=folder / "out", threads=1).run()


@pytest.fixture(scope="module")
def stopped(runs):
    """A folder with the run of a script on two ranks that stops half way, and what it has said."""
    return runs("stopped-script", run_half)


def run_half(folder):
    (folder / "script.py").write_text(SCRIPT.replace("STOP", "True"))
    ranks = Ranks([MPIEXEC, "-n", "2", sys.executable, "script.py"], folder)
    assert ranks.end() == 0, ranks.err
    (folder / "said").write_text(ranks.out)


def test_the_same_files_by_mpiexec_and_by_an_option(folder, one, mpiexec, mesokit):
    runs = {2: mpiexec(2, "run", "case.toml", "--output", "two")}
    assert runs[2].end() == 0, runs[2].err
    runs[3] = mesokit("run", "case.toml", "--output", "three", "--ranks", "3")
    assert runs[3].end() == 0, runs[3].err
    for n, name in ((2, "two"), (3, "three")):
        same_files(one, folder / name)
        assert runs[n].err.count("running: 400 steps") == 1
        assert runs[n].out.count("picture: ") == 1
        assert f"{n} ranks: one had" in runs[n].out
        record = json.loads((folder / name / "provenance.json").read_text())
        assert record["ranks"] == n
        assert {"sweep", "wait"} < record["shared_work"]["stages"].keys()
        assert f"{n} ranks: one had" in repr(mk.open(folder / name))
    assert "ranks:" not in repr(mk.open(one))


def all_have_seen(said, step):
    """Two ranks speak at once, and their words may mix."""
    return said.count(f"{step}") == said.count("True") == 2


def test_a_script_is_run_by_all_ranks(folder, one, mpiexec):
    (folder / "script.py").write_text(SCRIPT.replace("STOP", "False"))
    ranks = mpiexec(2, sys.executable, "script.py")
    assert ranks.end() == 0, ranks.err
    assert all_have_seen(ranks.out, 400), ranks.out
    same_files(one, folder / "out")


def test_a_script_is_stopped_on_all_ranks(stopped):
    said = (stopped / "said").read_text()
    assert all_have_seen(said, 200), said


def test_a_script_that_uses_mpi_alone(folder):
    """MPI in a single process: nothing is different."""
    program = f"import mpi4py.MPI\n{SCRIPT.replace('STOP', 'False')}"
    (folder / "script.py").write_text(program)
    alone = Ranks([MESOKIT[0], "script.py"], folder)
    assert alone.end() == 0, alone.err


@pytest.mark.parametrize("ranks", [1, 3])
def test_a_run_goes_on_with_another_number_of_ranks(folder, one, stopped, mesokit, ranks):
    shutil.copytree(stopped / "out", folder / "out")
    again = mesokit("resume", "out", "--ranks", ranks)
    assert again.end() == 0, again.err
    same_files(one, folder / "out")
    record = json.loads((folder / "out" / "provenance.json").read_text())
    assert record["ranks"] == ranks and len(record["resumed"]) == 1


def test_a_run_becomes_longer(folder, one, mpiexec):
    (folder / "case.toml").write_text((folder / "case.toml").read_text().replace("400", "200"))
    run_alone(folder)
    again = mpiexec(2, "resume", "out", "--steps", "400")
    assert again.end() == 0, again.err
    same_files(one, folder / "out")


def test_one_process_does_what_is_not_for_ranks(folder, mpiexec):
    check = mpiexec(2, "check", "case.toml")
    assert check.end() == 0
    assert check.out.count("[run]") == 1


def test_what_ranks_run_is_compiled_by_ranks(folder, mesokit):
    for _ in range(2):
        ranks = mesokit("warm", "case.toml", "--ranks", "2", NUMBA_CACHE_DIR=str(folder / "store"))
        assert ranks.end() == 0, ranks.err
        assert ranks.out.count("case.toml: ") == 1
    assert ranks.out.startswith("case.toml: 0 kernels, 0 parts")
    alone = mesokit("warm", "case.toml", NUMBA_CACHE_DIR=str(folder / "store"))
    assert alone.end() == 0 and "case.toml: 0 kernels" not in alone.out  # its step is another
