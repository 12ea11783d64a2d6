"""Whatever ends a rank ends all of them soon, with one message; the last checkpoint is whole."""

import contextlib
import json
import os
import random
import re
import signal
import sys
import time
from pathlib import Path

import pytest

import mesokit as mk
from mesokit.io import checkpoint
from mesokit.processes import end
from tests.helpers.rank_runs import MESOKIT, MPIEXEC, SOURCE, Ranks, same_files

pytestmark = pytest.mark.skipif(os.name == "nt", reason="no signals can be sent to a process")
SOON = 30.0  # seconds; on a quiet machine it is one
KILLS = 2  # of rank 1, and of rank 0

# what goes wrong on one rank alone, as a module that is imported first
FAULTS = """
import notes
from mesokit.errors import RunError
from mesokit.processes import end
{imports}
end.PATIENCE = {patience}

def fail(original):
    def wrapped(*given, **named):
        if notes.rank == {rank} and wrapped.left == 0:
            {fault}
        wrapped.left -= 1
        return original(*given, **named)
    wrapped.left = 2
    return wrapped

{where} = fail({where})
"""
ENGINE = "from mesokit.method.mpcd.engine.domains.engine import Ranks", "Ranks.totals"


def faulty(folder, rank, fault, imports, where, patience=0.2):
    """Where all fail, they are given the seconds that the product gives them."""
    (folder / "faulty.py").write_text(
        FAULTS.format(rank=rank, fault=fault, imports=imports, where=where, patience=patience)
    )


def one_message(ranks, pattern):
    """That is all that ranks have said, apart from the launcher."""
    said = [line for line in ranks.err.splitlines() if line.startswith("mesokit: ")]
    assert len(said) == 1, ranks.err
    assert re.fullmatch(pattern, said[0]), said
    return said[0]


def failed(folder, run="out"):
    """Why the run failed, as its record has it."""
    return json.loads((folder / run / "provenance.json").read_text())["failed"]


def ended_within(ranks, seconds):
    began = time.monotonic()
    status = ranks.end()
    assert time.monotonic() - began < seconds
    return status


def begun(ranks, folder):
    """The processes of a run that has written a checkpoint."""
    ranks.until(folder / "out" / "checkpoint.npz")
    return ranks.pids()


@pytest.fixture(scope="module")
def long_run(runs):
    """The long case on one process, to its end."""
    return runs("long-on-one", run_long) / "out"


def run_long(folder):
    mk.Simulation(folder / "long.toml", output=folder / "out", threads=1).run()


@pytest.mark.parametrize("seed", range(KILLS))
def test_a_rank_is_killed(folder, mesokit, seed, long_run):
    draw = random.Random(seed)
    ranks = mesokit("--import", "notes", "run", "long.toml", "--output", "out", "--ranks", "2")
    began = time.time_ns()
    victim = draw.randrange(2)
    pids = begun(ranks, folder)
    ranks.until(folder / "out" / "log.csv", newer_than=began)
    time.sleep(draw.random() * 0.3)
    os.kill(pids[victim], signal.SIGKILL)
    status = ended_within(ranks, SOON)
    if status:  # it may have come to its end before
        assert status == 128 + signal.SIGKILL
        step = checkpoint.read_meta(folder / "out" / "checkpoint.npz")["step"]
        how = f"the last checkpoint is of step {step}: mesokit resume out --ranks 2"
        one_message(ranks, f"mesokit: rank {victim} ended by SIGKILL; {how}")
        assert "BAD TERMINATION" not in ranks.out + ranks.err
    again = mesokit("resume", "out", "--quiet", "--ranks", "2")
    assert again.end() == 0, again.err
    same_files(long_run, folder / "out")


def alive(pid):
    """Whether a process is at work; one that has ended may wait to be asked for its status."""
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, 0)
        stat = Path(f"/proc/{pid}/stat")
        return not (stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z")
    return False


def test_nobody_outlives_the_process_that_is_killed(folder, mesokit):
    words = "--import", "notes", "run", "endless.toml", "--output", "out", "--ranks", "2"
    ranks = mesokit(*words)
    pids = begun(ranks, folder)
    assert len(pids) == 2 and all(map(alive, pids))
    os.kill(ranks.process.pid, signal.SIGKILL)
    last = time.monotonic() + 10.0
    while any(map(alive, pids)):
        assert time.monotonic() < last
        time.sleep(0.05)
    ranks.end()  # of the streams, which the launcher has as well: it has ended, too
    checkpoint.read_meta(folder / "out" / "checkpoint.npz")


@pytest.mark.parametrize(  # Ctrl-C to mesokit: see test_the_bar_is_drawn_on_our_terminal
    ("whom", "number"),
    [
        ("mesokit", signal.SIGTERM),
        ("mpiexec", signal.SIGINT),
        ("mpiexec", signal.SIGTERM),
        ("rank 0", signal.SIGTERM),
        ("rank 1", signal.SIGINT),
    ],
)
def test_a_signal_stops_all_ranks(folder, mesokit, mpiexec, whom, number):
    words = "--import", "notes", "run", "endless.toml", "--output", "out"
    ranks = mpiexec(2, *words) if whom == "mpiexec" else mesokit(*words, "--ranks", "2")
    pids = begun(ranks, folder)
    os.kill(int(pids[int(whom[-1])]) if "rank" in whom else ranks.process.pid, number)
    assert ended_within(ranks, SOON) == 128 + number
    step = checkpoint.read_meta(folder / "out" / "checkpoint.npz")["step"]
    again = (
        "mpiexec -n 2 mesokit resume out" if whom == "mpiexec" else "mesokit resume out --ranks 2"
    )
    one_message(ranks, f"mesokit: stopped at step {step} by {number.name}; go on with: {again}")


@pytest.mark.parametrize(("rank", "by_option"), [(0, True), (1, False)])
def test_the_physics_of_one_rank_fails(folder, mesokit, mpiexec, rank, by_option):
    faulty(folder, rank, "raise RunError('step 7: too fast')", *ENGINE)
    words = "--import", "faulty", "run", "endless.toml", "--output", "out"
    ranks = mesokit(*words, "--ranks", "2") if by_option else mpiexec(2, *words)
    assert ranks.end() == 1
    one_message(ranks, f"mesokit: error: rank {rank}: step 7: too fast")
    assert failed(folder) == ("rank 1: " if rank else "") + "step 7: too fast"


def test_the_physics_of_all_ranks_fails(folder, mpiexec):
    faulty(folder, "notes.rank", "raise RunError('step 7: too fast')", *ENGINE, end.PATIENCE)
    ranks = mpiexec(3, "--import", "faulty", "run", "endless.toml", "--output", "out")
    assert ranks.end() == 1
    one_message(ranks, "mesokit: error: step 7: too fast")
    assert failed(folder) == "step 7: too fast"


def test_two_of_three_ranks_fail(folder, mpiexec):
    faulty(folder, "max(notes.rank, 1)", "raise RunError('step 7: too fast')", *ENGINE)
    ranks = mpiexec(3, "--import", "faulty", "run", "endless.toml", "--output", "out")
    assert ranks.end() == 1
    one_message(ranks, "mesokit: error: rank 1: step 7: too fast")
    assert failed(folder) == "rank 1: step 7: too fast"


def test_a_particle_of_one_rank_is_too_fast(folder, mpiexec):
    """It is the record of the run that says so, as on one process."""
    fast = "memory.fluid.particles.data[memory.at(2, memory.places[:1])] = 1e9"
    faulty(folder, 1, f"memory = given[0].memory; {fast}", *ENGINE)
    ranks = mpiexec(2, "--import", "faulty", "run", "endless.toml", "--output", "out")
    assert ranks.end() == 1
    said = one_message(ranks, "mesokit: error: .*a particle moves at .*; the fluid heats up: .*")
    assert said.endswith(failed(folder))


def test_a_mistake_in_one_rank(folder, mesokit):
    """Of an imported module: it says where, and on which rank."""
    faulty(folder, 1, "return 1 / 0", *ENGINE)
    ranks = mesokit("--import", "faulty", "run", "endless.toml", "--output", "out", "--ranks", "2")
    assert ranks.end() == 1
    one_message(
        ranks,
        r"mesokit: error: rank 1: line \d+ of .*faulty\.py: ZeroDivisionError: division by zero",
    )
    assert ranks.err.count("ZeroDivisionError: division by zero") == 1


def test_the_disk_is_full(folder, mpiexec):
    """Rank 0 may write no more than a few thousand bytes to a file."""
    (folder / "little.py").write_text(
        "import notes, resource, signal\n"
        "if notes.rank == 0:\n"
        "    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))\n"
    )
    ranks = mpiexec(2, "--import", "little", "run", "endless.toml", "--output", "out")
    assert ranks.end() == 1
    one_message(ranks, "mesokit: error: .*cannot write out/.*: file too large")


SCRIPT = """
from mesokit import Simulation, every

def look(simulation):
    if simulation.ranks.rank == 1 and simulation.step == 100:
        raise ValueError("no such thing")

Simulation("endless.toml", callbacks=[every(50, look)]).run()
"""


def test_a_callback_of_one_rank_fails(folder, mpiexec):
    """All ranks know, also where the script goes on: the one that failed, and where in its code."""
    (folder / "script.py").write_text(SCRIPT)
    ranks = mpiexec(2, sys.executable, "script.py")
    assert ranks.end() == 1
    gist = "RunError: rank 1: callback look at step 100: ValueError: no such thing"
    assert ranks.err.count(gist) == 1
    assert ranks.err.count('raise ValueError("no such thing")') == 1


CAUGHT = """
from pathlib import Path
from mesokit import RunError, Simulation, StopRun, every

for name, wrong in WRONGS.items():
    def look(simulation):
        if simulation.ranks.rank == 1 and simulation.step == 100:
            raise wrong

    simulation = Simulation("endless.toml", output=name, callbacks=[every(50, look)])
    try:
        simulation.run()
        end = f"stopped: {simulation.callbacks.stopped}"
    except RunError as error:
        end = str(error)
    Path(f"{name}-{simulation.ranks.rank}").write_text(f"{simulation.step} {end}")
"""
ENDS = {  # what is raised, how the run ends, whether it has failed
    "error": ('ValueError("x")', "rank 1: callback look at step 100: ValueError: x", True),
    "exit": ("SystemExit(5)", "rank 1: sys.exit(5)", True),
    "stop": ('StopRun("enough")', "stopped: enough", False),
}


@pytest.fixture(scope="module")
def caught(runs):
    """The folder of runs, one after another, that a callback of rank 1 ends."""
    return runs("caught", end_by_callback)


def end_by_callback(folder):
    wrongs = ", ".join(f'"{name}": {wrong}' for name, (wrong, _, _) in ENDS.items())
    (folder / "script.py").write_text(CAUGHT.replace("WRONGS", f"{{{wrongs}}}"))
    ranks = Ranks([MPIEXEC, "-n", "2", sys.executable, "script.py"], folder)
    assert ranks.end() == 0, ranks.err


@pytest.mark.parametrize("name", ENDS)
def test_what_a_callback_of_one_rank_does_all_do(caught, name):
    """Nobody waits for one that has gone on."""
    _, end, fails = ENDS[name]
    assert [(caught / f"{name}-{rank}").read_text() for rank in (0, 1)] == 2 * [f"100 {end}"]
    assert failed(caught, name) == (end if fails else None)


ASKS = """
import notes
from mesokit import Simulation, every
from mesokit.processes import end, several

several.LONG, end.PATIENCE = 0.5, 0.2

def look(simulation):
    if simulation.ranks.root:
        print(simulation.engine.totals())

Simulation("case.toml", callbacks=[every(100, look)]).run()
"""


def test_a_question_that_one_rank_alone_asks(folder, mpiexec):
    """Another says what it waits for, and signals end them."""
    (folder / "script.py").write_text(ASKS)
    ranks = mpiexec(2, sys.executable, "script.py")
    said = ranks.process.stderr.readline()
    assert said.startswith("warning: rank 1 has waited 0.5 seconds for callbacks of other ranks")
    process = ranks.pids()[1]
    os.kill(process, signal.SIGTERM)
    os.kill(process, signal.SIGINT)
    assert ended_within(ranks, SOON) != 0


def test_ctrl_c_in_a_script(folder, mpiexec):
    script = SCRIPT.replace("== 100", "< 0").replace(
        '"endless.toml"', '"endless.toml", output="out"'
    )
    (folder / "script.py").write_text(f"import notes\n{script}")
    ranks = mpiexec(2, sys.executable, "script.py")
    os.kill(begun(ranks, folder)[1], signal.SIGINT)
    assert ended_within(ranks, SOON) == 130
    assert ranks.err.count("Stopped: stopped at step") == 1


def test_the_bar_is_drawn_on_our_terminal(folder):
    """And Ctrl-C there is a signal to the run."""
    import pty

    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.environ |= {"PYTHONPATH": str(SOURCE), "TERM": "xterm"}
        words = ["run", "endless.toml", "--output", "out", "--ranks", "2"]
        os.execv(MESOKIT[0], [*MESOKIT, *words])
    seen = b""
    with contextlib.suppress(OSError):  # of a terminal that is closed
        while piece := os.read(terminal, 4096):
            seen += piece
            if b"left" in seen and b"^C" not in seen:
                os.write(terminal, b"\x03")
    assert os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 130
    assert b"particle-steps/s" in seen and "━".encode() in seen
    assert b"by SIGINT; go on with: mesokit resume out --ranks 2" in seen
