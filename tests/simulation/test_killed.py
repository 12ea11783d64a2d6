"""A real process, killed or interrupted at any moment, resumes to the same bits."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import mesokit
from mesokit.run.simulation import Simulation

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name == "nt", reason="no signals can be sent to a process"),
]

KILLS = 6
STEPS = 8000
SIBLINGS = {
    "event-driven": """
[run]
steps = 1500
[box]
size = [20.5, 24]
[spheres]
number = 250
gravity = [0, -0.5]
timestep = 0.5
[spheres.collision]
rule = "hard"
restitution = 0.9
tangential = 0.2
friction = 0.4
contact_time = 1e-4
[[wall]]
shape = "plates"
axis = "y"
lower = { contact = { amplitude = 0.2, frequency = 10 } }
[[observe]]
quantity = "granular-temperature"
""",
    "soft-spheres": """
[run]
steps = 20000
[box]
size = [20.5, 24]
[spheres]
number = 300
gravity = [0, -1]
[spheres.pair]
rule = "spring-dashpot"
restitution = 0.6
contact_time = 0.015
friction = 0.5
rolling = 0.1
[[wall]]
shape = "plates"
axis = "y"
[[observe]]
quantity = "mean-square-displacement"
every = 50
""",
    "contact-dynamics": """
[run]
steps = 1500
[box]
size = [15, 16]
[spheres]
number = 150
gravity = [0, -1]
timestep = 0.01
[spheres.contact]
friction = 0.5
rolling = 0.1
cohesion = { force = 0.2, range = 0.02 }
[spheres.solver]
rule = "gauss-seidel"
order = "random"
sweeps = 20
[[wall]]
shape = "plates"
axis = "y"
upper = { contact = { pressure = 0.5 } }
[[observe]]
quantity = "plate-motion"
every = 50
""",
    "flock": """
[run]
steps = 6000
[box]
size = [16, 16]
[flock]
density = 3
[[wall]]
shape = "disk"
centre = [8, 8]
radius = 3
[[observe]]
quantity = "polar-order"
""",
}
CONTACTS = dict.fromkeys(("soft-spheres", "contact-dynamics"), '["position", "contact"]')
LONG = ["--set", f"run.steps={STEPS}", "--set", "run.checkpoint_every=100"]
SOURCE = str(Path(mesokit.__file__).parent.parent)


def mesokit_process(*arguments):
    environment = os.environ | {"PYTHONPATH": SOURCE}
    return subprocess.Popen(
        [sys.executable, "-m", "mesokit", *map(str, arguments), "--threads", "1", "--quiet"],
        env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def wait_for(path, process):
    while not path.exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.005)


def start_or_resume(case_file, folder):
    """The command that goes on: a kill before the case was written leaves nothing to resume."""
    if (folder / "case.toml").exists():
        return mesokit_process("resume", folder)
    return mesokit_process("run", case_file, "--output", folder, *LONG)


@pytest.fixture(scope="module")
def whole(case_file, tmp_path_factory):
    """Folder of a run in a process that was left alone, and seconds to its first checkpoint."""
    folder = tmp_path_factory.mktemp("process") / "whole"
    began = time.perf_counter()
    process = start_or_resume(case_file, folder)
    wait_for(folder / "checkpoint.npz", process)
    started = time.perf_counter() - began
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    return folder, started


def assert_same_end(folder, other):
    one, two = (Simulation.resume(path, threads=1) for path in (folder, other))
    assert one.step == two.step == STEPS + 37
    np.testing.assert_array_equal(one.engine.positions(), two.engine.positions())
    np.testing.assert_array_equal(one.engine.velocities(), two.engine.velocities())
    np.testing.assert_array_equal(one.engine.images(), two.engine.images())
    assert mesokit.open(folder).results == mesokit.open(other).results


def written(path):
    """Tells whether a file has been written anew."""
    return (path.stat().st_ino, path.stat().st_mtime_ns) if path.exists() else None


def steps_of(folder):
    with np.load(folder / "checkpoint.npz") as checkpoint:
        return int(checkpoint["engine/step"])


def test_killed_at_random_moments(whole, case_file, tmp_path):
    """While it starts, and after it has written a checkpoint of its own, to the end of the run."""
    reference, started = whole
    folder = tmp_path / "killed"
    checkpoint = folder / "checkpoint.npz"
    steps = []
    for kill, moment in enumerate(np.random.default_rng(20).uniform(0.0, 1.0, KILLS)):
        before = written(checkpoint)
        process = start_or_resume(case_file, folder)
        if kill % 2 == 0:
            time.sleep(moment * started)
        else:
            while process.poll() is None and written(checkpoint) == before:
                time.sleep(0.001)
            time.sleep(0.2 * moment * started)
        process.kill()
        process.communicate()
        steps += [steps_of(folder)] if checkpoint.exists() else []
    assert steps == sorted(steps) and steps[-1] > 0
    process = start_or_resume(case_file, folder)
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    assert_same_end(folder, reference)


@pytest.mark.parametrize("method", SIBLINGS)
def test_other_methods_killed(method, tmp_path):
    """Contacts that remember, queues of events and headings survive as well."""
    case_file, checkpoint = tmp_path / "case.toml", tmp_path / "killed" / "checkpoint.npz"
    case_file.write_text(SIBLINGS[method])
    often = ["--set", f"run.method={method}", "--set", "run.checkpoint_every=50"]
    fields = CONTACTS.get(method, '["position"]')  # of trajectories
    often += ["--set", f"trajectory.fields={fields}"]
    start = ["run", case_file, *often, "--set", "trajectory.every=200", "--output"]
    process = mesokit_process(*start, tmp_path / "whole")
    wait_for(tmp_path / "whole" / "checkpoint.npz", process)
    _, errors = process.communicate()
    assert not errors
    process, steps = mesokit_process(*start, checkpoint.parent), []
    for number in np.random.default_rng(21).integers(1, 4, 3):  # of new checkpoints before a kill
        for _ in range(number):
            before = written(checkpoint)
            while process.poll() is None and written(checkpoint) == before:
                time.sleep(0.001)
        process.kill()
        process.communicate()
        steps.append(steps_of(checkpoint.parent))
        process = mesokit_process("resume", checkpoint.parent)
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    killed, whole = mesokit.open(checkpoint.parent), mesokit.open(tmp_path / "whole")
    assert 0 < steps[0] < steps[-1] < whole.case.run.steps
    assert killed.results == whole.results
    assert len(killed.trajectory) == len(whole.trajectory) > 1
    last, wanted = killed.trajectory[-1], whole.trajectory[-1]
    assert set(last) == set(wanted)
    for name, entry in wanted.items():
        np.testing.assert_array_equal(last[name], entry)
    for name, array in np.load(tmp_path / "whole" / "checkpoint.npz").items():
        if name.startswith("engine/"):
            np.testing.assert_array_equal(np.load(checkpoint)[name], array)


@pytest.mark.parametrize("name", ["SIGINT", "SIGUSR1"])
def test_interrupted(whole, case_file, tmp_path, name):
    number = getattr(signal, name)
    folder = tmp_path / "interrupted"
    process = start_or_resume(case_file, folder)
    wait_for(folder / "checkpoint.npz", process)
    process.send_signal(number)
    _, errors = process.communicate()
    assert process.returncode == 128 + number, errors
    assert errors.count("\n") == 1 and f"mesokit resume {folder}" in errors
    assert "Traceback" not in errors
    simulation = Simulation.resume(folder, threads=1)
    assert simulation.step < STEPS + 37
    simulation.run()
    assert_same_end(folder, whole[0])
