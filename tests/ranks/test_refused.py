"""What several ranks cannot do is refused before the run, in one line of one rank."""

import json
import re
import sys

import numpy as np
import pytest

from mesokit.processes.cores import usable_cores
from tests.helpers.rank_runs import CASE, MESOKIT, MPIEXEC, Ranks, on_ranks

FLOCK = """
[run]
steps = 10
method = "flock"
[box]
size = [16, 16]
[flock]
density = 3
"""
SOLUTES = """
[run]
steps = 10
[box]
size = [20, 20]
[fluid]
density = 5
[solutes]
polymers = [{ number = 1 }]
mass = 3000
coupling = "potential"
solvent_pair = { rule = "wca", sigma = 3 }
"""


def lines_of(err):
    """What is said but warnings, and that reading takes long, where it does."""
    besides = "warning: ", "mesokit: reading the case"
    return [line for line in err.splitlines() if line.strip() and not line.startswith(besides)]


def start(folder, *words, n=2):
    return Ranks([MPIEXEC, "-n", n, *MESOKIT, *words], folder)


ROWS = 600  # particles of the case


def write_rows(path, last=1.0, rows=ROWS):
    array = np.ones((rows, 2))
    array[-1] = last
    (np.savez if path.suffix == ".npz" else np.save)(path, array)


# what fluid.start names, and what is said of it
SOURCES = {
    ("positions", "nan.npy"): "row 599 is not finite",
    ("positions", "far.npy"): "2^30 boxes away or more",
    ("positions", "few.npy"): "shape (7, 2): expected",
    ("positions", "nan.npz"): "row 599 is not finite",
    ("positions", "text.npy"): "expected a .npy or .npz file",
    ("file", "text.gsd"): "cannot be read as a GSD file",
    ("run", "empty"): "empty': ",
}
RUN = "run", "case.toml", "--output", "out"
COMMANDS = {  # status and message of each
    RUN + ("--set", f"fluid.start.{key}={file}"): (
        2,
        rf"case\.toml: fluid\.start\.{key}.*{re.escape(said)}.*",
    )
    for (key, file), said in SOURCES.items()
} | {
    RUN + ("--set", "run.replicas=2"): (
        2,
        r"case\.toml: run\.replicas = 2: not on 3 ranks; expected 1",
    ),
    ("run", "solutes.toml"): (
        2,
        r".*solutes\.coupling = 'potential': not on 3 ranks; expected one rank, or "
        "coupling = 'collision'",
    ),
    ("run", "flock.toml"): (
        2,
        r"flock\.toml: run\.method = 'flock': not on 3 ranks; expected one",
    ),
    ("study", "case.toml", "--seeds", "2"): (
        2,
        "study: starts runs of its own; expected one process, no mpiexec",
    ),
    ("run", "case.toml", "--seeds", "2"): (2, "--seeds: not on 3 ranks; expected one process"),
    ("run", "case.toml", "--ranks", "2"): (
        2,
        "--ranks: this is one of the ranks of an mpiexec; leave it out",
    ),
    ("run", "{rank}/case.toml", "--output", "out"): (
        1,
        r"rank 1: case: density = 6\.0 where rank 0 has density = 5\.0",
    ),
}
# a folder is given on all ranks; the first writes there
MADE = "from mesokit import Simulation\n{}"
SCRIPTS = {
    MADE.format("Simulation('case.toml', output=None if rank else 'out')"): "None",
    MADE.format("Simulation.resume('other' if rank else 'out')"): "other",
}


@pytest.fixture(scope="module")
def ended(once):
    """How each of three ranks ends, by command or script."""
    return json.loads((once("refused", end_all) / "said").read_text())


def end_all(folder):
    """Ranks note how they end; no run begins."""
    case = CASE.format(steps=400, checkpoints=100)
    files = {"case": case, "solutes": SOLUTES, "flock": FLOCK, "0/case": case}
    files |= {f"{rank}/case": case.replace("density = 5", "density = 6") for rank in (1, 2)}
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / f"{name}.toml").write_text(text)
    write_rows(folder / "nan.npy", np.nan)
    write_rows(folder / "nan.npz", np.nan)
    write_rows(folder / "far.npy", 1e300)
    write_rows(folder / "few.npy", rows=7)
    (folder / "text.npy").write_text("a")
    (folder / "text.gsd").write_text("a")
    (folder / "empty").mkdir()
    given = {
        "words": {" ".join(words): words for words in COMMANDS},
        "scripts": {script: script for script in SCRIPTS},
    }
    (folder / "said").write_text(on_ranks(3, "refused.py", json.dumps(given), folder=folder))
    assert not (folder / "out").exists()


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_a_command_is_refused_in_one_line(words, ended):
    status, pattern = COMMANDS[words]
    others = 0 if words[0] == "study" else status  # which is a command of one process
    assert [end for end, _ in ended[" ".join(words)]] == [status, others, others]
    [line] = lines_of("".join(said for _, said in ended[" ".join(words)]))
    assert re.fullmatch(f"mesokit: error: {pattern}", line), line


@pytest.mark.parametrize("script", SCRIPTS, ids=["simulation", "resume"])
def test_one_rank_alone_has_the_folder(script, ended):
    error = f"RunError: rank 1: output: {SCRIPTS[script]} where rank 0 has out"
    assert ended[script] == 3 * [error]


def test_more_ranks_than_cells(folder):
    """All ranks end with the status, and mpiexec with them."""
    setting = "box.size=[2, 2]"
    ranks = start(folder, "run", "case.toml", "--output", "out", "--set", setting, n=5)
    assert ranks.end() == 2, (ranks.out, ranks.err)
    [line] = lines_of(ranks.err)
    assert "5 ranks: too many for 2 x 2 cells" in line
    assert not (folder / "out").exists()


def test_a_study_of_a_script(folder):
    (folder / "script.py").write_text(
        "from mesokit import Study\nStudy('case.toml', None, 2, output='study').run()\n"
    )
    ranks = Ranks([MPIEXEC, "-n", "2", sys.executable, "script.py"], folder)
    assert ranks.end() == 1
    assert ranks.err.count("CaseError: Study: not on 2 ranks; expected one process") == 1


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("mesokit.__version__ = '0'", "rank 1: version of mesokit: 0 where rank 0 has "),
        ("sys.byteorder = 'big'", "rank 1: byte order: big where rank 0 has little"),
    ],
)
def test_other_ranks_are_of_another_kind(folder, what, said):
    (folder / "sitecustomize.py").write_text(
        f"import os, sys\nif os.environ.get('PMI_RANK') == '1':\n    import mesokit\n    {what}\n"
    )
    ranks = start(folder, "run", "case.toml", "--output", "out")
    assert ranks.end() == 1
    assert ranks.err.count("mesokit: error: ") == 1
    assert said in ranks.err


def test_without_mpi4py(folder):
    (folder / "mpi4py.py").write_text("raise ImportError('not here')\n")
    ranks = start(folder, "run", "case.toml")
    ranks.end()
    assert ranks.err.count("pip install 'mesokit[mpi]'") == 1


def test_a_single_process_loads_no_mpi(folder):
    program = (
        "import sys; from mesokit import Box, Fluid, Run, Simulation\n"
        "Simulation(run=Run(steps=0), box=Box([8, 8]))\n"
        "assert not any(name.startswith('mpi4py') for name in sys.modules)"
    )
    alone = Ranks([sys.executable, "-c", program], folder)
    assert alone.end() == 0, alone.err


def test_more_ranks_than_cores(folder):
    """Some are slow, which is said; very many would keep the machine from anything else."""
    cores = usable_cores()
    many = Ranks([*MESOKIT, "run", "case.toml", "--ranks", 16 * cores + 1], folder)
    assert many.end() == 2, (many.out, many.err)
    [line] = lines_of(many.err)
    assert f"expected at most {16 * cores}: 16 for each core" in line
    words = "--ranks", cores + 1, "--threads", 1, "--output", "out", "--set", "run.steps=2"
    some = Ranks([*MESOKIT, "run", "case.toml", *words], folder)
    assert some.end() == 0, some.err
    assert f"warning: {cores + 1} ranks share {cores} core" in some.err
