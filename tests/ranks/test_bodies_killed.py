"""A run with bodies that ends by SIGKILL goes on with other numbers of ranks and threads."""

import os
import signal
import time

import pytest

import mesokit as mk
from mesokit.io import checkpoint
from tests.helpers.rank_runs import same_files

pytestmark = [
    pytest.mark.long,
    pytest.mark.further,  # test_ends kills ranks, test_same_bits has these bodies
    pytest.mark.skipif(os.name == "nt", reason="no signals can be sent to a process"),
]

# Of the kind "bodies in a channel" of `same_bits`
CASE = """
[run]
steps = 2000
checkpoint_every = 100
[box]
size = [40, 20]
[fluid]
density = 5
force = { rule = "uniform", acceleration = [0.01, 0] }
thermostat = { rule = "maxwell-boltzmann" }
[[wall]]
shape = "plates"
axis = "y"
[[wall]]
shape = "disk"
centre = [10.3, 9.7]
radius = 3
[[bodies]]
shape = "disk"
radius = 2
number = 3
swim = { B1 = 0.1 }
force = [20, 0]
frame = "body"
counter = { at = [-4, 0] }
[[bodies]]
shape = "rectangle"
size = [5, 3]
density = 10
torque = 50
counter = { shell = 1.5 }
[[observe]]
quantity = "body-tracks"
every = 50
[trajectory]
every = 100
of = "bodies"
[log]
every = 100
"""


WITH_A_POLYMER = """
[run]
steps = 1500
checkpoint_every = 100
[box]
size = [42, 28]
[fluid]
density = 5
collision = { rule = "srd+a", angle = 130 }
thermostat = { rule = "maxwell-boltzmann" }
force = { rule = "uniform", acceleration = [0.01, 0] }
[[wall]]
shape = "disk"
name = "posts"
centre = [7, 7]
radius = 2.5
[[bodies]]
shape = "disk"
radius = 1.5
number = 3
interaction = { depth = 1, range = 0.5 }
[[bodies]]
shape = "ellipse"
size = [7, 3.5]
[solutes]
polymers = [{ number = 1, length = 30 }]
mass = 8
bond = { rule = "fene" }
pair = { rule = "wca" }
wall = { rule = "wca", sigma = 0.5 }
[[observe]]
quantity = "body-tracks"
every = 50
[[observe]]
quantity = "molecule-tracks"
every = 50
[trajectory]
every = 100
of = "suspended"
[log]
every = 100
"""


def kill_after_a_checkpoint(ranks, folder, victim):
    """Kill one rank once a checkpoint is written; the step of the last one."""
    file, began = folder / "out" / "checkpoint.npz", time.time_ns()
    for old in folder.glob("pid-*"):
        old.unlink()
    ranks.until(file, newer_than=began)
    os.kill(ranks.pids()[victim], signal.SIGKILL)
    assert ranks.end() == 128 + signal.SIGKILL, ranks.err
    return checkpoint.read_meta(file)["step"]


@pytest.mark.parametrize("case", [CASE, WITH_A_POLYMER], ids=["driven", "with a polymer"])
def test_it_goes_on_with_more_ranks_and_then_with_threads(case, folder, mesokit):
    (folder / "case.toml").write_text(case)
    whole = mk.Simulation(folder / "case.toml", output=folder / "whole", threads=1)
    whole.run(progress=False)
    noting = ("--import", "notes")
    two = mesokit(*noting, "run", "case.toml", "--output", "out", "--quiet", "--ranks", "2")
    first = kill_after_a_checkpoint(two, folder, victim=1)
    three = mesokit(*noting, "resume", "out", "--quiet", "--ranks", "3")
    second = kill_after_a_checkpoint(three, folder, victim=0)
    assert 0 < first < second < whole.case.run.steps
    alone = mesokit("resume", "out", "--quiet", "--threads", "2")
    assert alone.end() == 0, alone.err
    same_files(folder / "whole", folder / "out")
