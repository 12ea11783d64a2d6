"""A signal within one long step of event-driven dynamics stops the run, and changes no bit."""

from __future__ import annotations

import signal
import subprocess
import sys

import pytest

from mesokit import Box, Case, HardSpheres, Run, Simulation
from mesokit.method.spheres.hard.engine import system
from tests.helpers.hard_spheres import same

# A step of some minutes. The signal comes half a second after its first event.
PROGRAM = """
import os, signal, sys, threading
from mesokit import Box, Case, HardSpheres, Run, Simulation

spheres = HardSpheres(number=20, timestep=1e8)
case = Case(run=Run(2, method="event-driven"), box=Box([6, 6]), spheres=spheres)
simulation = Simulation(case, output=sys.argv[1])
advance = simulation.engine.advance

def signalled(steps, measure=()):
    if steps:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGTERM)).start()
    advance(steps, measure)

simulation.engine.advance = signalled
try:
    simulation.run()
except KeyboardInterrupt as stopped:
    print(sum(simulation.engine.collisions), stopped)
"""


def test_a_signal_is_heard_within_a_step(tmp_path):
    command = [sys.executable, "-c", PROGRAM, str(tmp_path / "run")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    collisions, _, words = done.stdout.partition(" ")
    assert words.strip() == "stopped at step 0 by SIGTERM", done.stderr
    assert int(collisions) > 0  # within the step
    assert (tmp_path / "run" / "checkpoint.npz").exists()


# a step has many windows, or more events in a window than a call of the loop does
@pytest.mark.parametrize(
    "number, timestep, calls", [(20, 3000.0, 3), (6000, 150.0, 2)], ids=["windows", "events"]
)
def test_it_goes_on_where_it_was(number, timestep, calls, tmp_path, monkeypatch):
    case = Case(
        run=Run(3, method="event-driven"),
        box=Box([(number / 0.6) ** 0.5] * 2),
        spheres=HardSpheres(number=number, timestep=timestep),
    )
    whole = Simulation(case)
    whole.run()
    asked, heard = [], system.heard

    def ask():
        asked.append(1)
        if len(asked) == calls:
            signal.raise_signal(signal.SIGTERM)
        return heard()

    stopped = Simulation(case, output=tmp_path / "run")
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt, match="by SIGTERM"):
        patch.setattr(system, "heard", ask)
        stopped.run()
    inner = stopped.engine.system
    assert inner.windows * inner.window + inner.now > stopped.step * timestep
    again = Simulation.resume(tmp_path / "run")
    assert again.step == stopped.step < 3
    again.run()
    assert same(again.engine, whole.engine)
    stopped.run()
    assert same(stopped.engine, whole.engine)
