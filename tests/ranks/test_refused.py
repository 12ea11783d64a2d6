"""What several ranks cannot do is refused before the run, in one line of one rank."""

import sys

import pytest
from rank_runs import CASE, MESOKIT, MPIEXEC, Ranks

from mesokit.running.cores import usable_cores

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


def refusal(ranks):
    assert ranks.end() == 2, (ranks.out, ranks.err)
    lines = ranks.err.splitlines()
    besides = "warning: ", "mesokit: reading the case"  # the latter where that takes long
    said = [line for line in lines if line.strip() and not line.startswith(besides)]
    assert len(said) == 1, ranks.err
    return said[0]


def start(folder, *words, n=2):
    return Ranks([MPIEXEC, "-n", n, *MESOKIT, *words], folder)


@pytest.mark.parametrize(
    ("n", "setting", "said"),
    [
        (2, "run.replicas=2", "run.replicas = 2: not on 2 ranks; expected 1"),
        (5, "box.size=[2, 2]", "5 ranks: too many for 2 x 2 cells"),
    ],
)
def test_a_case_that_ranks_cannot_run(folder, n, setting, said):
    ranks = start(folder, "run", "case.toml", "--output", "out", "--set", setting, n=n)
    assert said in refusal(ranks)
    assert not (folder / "out").exists()


def test_solutes_that_act_by_a_potential(folder):
    (folder / "case.toml").write_text(SOLUTES)
    said = refusal(start(folder, "run", "case.toml"))
    assert said.endswith(
        "solutes.coupling = 'potential': not on 2 ranks; expected one rank, or "
        "coupling = 'collision'"
    )


def test_a_method_for_one_rank(folder):
    (folder / "flock.toml").write_text(FLOCK)
    said = refusal(start(folder, "run", "flock.toml"))
    assert said == "mesokit: error: flock.toml: run.method = 'flock': not on 2 ranks; expected one"


def test_a_study(folder):
    said = refusal(start(folder, "study", "case.toml", "--seeds", "2"))
    assert said == (
        "mesokit: error: study: starts runs of its own; expected one process, no mpiexec"
    )
    said = refusal(start(folder, "run", "case.toml", "--seeds", "2"))
    assert said == "mesokit: error: --seeds: not on 2 ranks; expected one process"


def test_a_study_of_a_script(folder):
    (folder / "script.py").write_text(
        "from mesokit import Study\nStudy('case.toml', None, 2, output='study').run()\n"
    )
    ranks = Ranks([MPIEXEC, "-n", "2", sys.executable, "script.py"], folder)
    assert ranks.end() == 1
    assert ranks.err.count("CaseError: Study: not on 2 ranks; expected one process") == 1


def test_ranks_of_ranks(folder):
    said = refusal(start(folder, "run", "case.toml", "--ranks", "2"))
    assert said == "mesokit: error: --ranks: this is one of the ranks of an mpiexec; leave it out"


def test_other_ranks_have_another_case(folder):
    (folder / "other").mkdir()
    (folder / "other" / "case.toml").write_text(
        CASE.format(steps=400, checkpoints=100).replace("density = 5", "density = 6")
    )
    one = [*MESOKIT, "run", "case.toml", "--output", folder / "out"]
    two = [*MESOKIT, "run", "other/case.toml", "--output", folder / "out"]
    ranks = Ranks([MPIEXEC, "-n", "1", *one, ":", "-n", "1", *two], folder)
    assert ranks.end() == 1
    [said] = ranks.err.splitlines()[-1:]
    assert said == "mesokit: error: rank 1: case: density = 6.0 where rank 0 has density = 5.0"


@pytest.mark.parametrize(
    "made", ["Simulation('case.toml', output={})", "Simulation.resume({} or 'other')"]
)
def test_one_rank_alone_has_the_folder(folder, made):
    """A folder is given on all ranks; the first writes there."""
    program = "from mesokit import Simulation; from mpi4py import MPI\n" + made.format(
        "(None if MPI.COMM_WORLD.rank else 'out')"
    )
    ranks = Ranks([MPIEXEC, "-n", "2", sys.executable, "-c", program], folder)
    assert ranks.end() == 1
    other = "None" if "resume" not in made else "other"
    assert ranks.err.count(f"RunError: rank 1: output: {other} where rank 0 has out") == 1
    assert not (folder / "out").exists()


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
    assert f"expected at most {16 * cores}: 16 for each core" in refusal(many)
    words = "--ranks", cores + 1, "--threads", 1, "--output", "out", "--set", "run.steps=2"
    some = Ranks([*MESOKIT, "run", "case.toml", *words], folder)
    assert some.end() == 0, some.err
    assert f"warning: {cores + 1} ranks share {cores} core" in some.err
