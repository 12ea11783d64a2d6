"""A run among solids that was stopped goes on to the same bits, for any number of threads."""

import signal

import numpy as np
import pytest

from mesokit import (
    AT,
    Box,
    Capsule,
    Case,
    Disk,
    Fluid,
    Forces,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    Surface,
    Uniform,
)

WALLS = [
    Plates(axis="y"),
    Disk(centre=[10, 10], radius=4, surface=Surface("diffuse", rotation=0.05)),
    Capsule(start=[18, 3], end=[23.5, 5], radius=1.2),
]


@pytest.mark.parametrize("rule", ["srd", "at"])
def test_stopped_among_solids_and_resumed(rule, tmp_path):
    fluid = Fluid(collision=AT()) if rule == "at" else Fluid(thermostat=MaxwellBoltzmann())
    fluid = {"collision": fluid.collision, "thermostat": fluid.thermostat}

    def simulate(threads, **run):
        case = Case(
            run=Run(steps=60, warmup=5, **run),
            box=Box([24, 20]),
            fluid=Fluid(**fluid, force=Uniform([0.002, 0])),
            walls=WALLS,
            observe=[Forces(every=3)],
        )
        return Simulation(case, threads=threads, output=tmp_path / "run" if run else None)

    whole = simulate(1)
    whole.run()
    stopped = simulate(2, checkpoint_every=17)
    go = stopped._loop._go

    def go_and_stop(legs):
        go(legs)
        if stopped.step >= 31:
            stopped._stop.by = signal.SIGTERM

    stopped._loop._go = go_and_stop
    with pytest.raises(KeyboardInterrupt):
        stopped.run()
    resumed = Simulation.resume(tmp_path / "run", threads=3)
    resumed.run()
    np.testing.assert_array_equal(whole.engine.positions(), resumed.engine.positions())
    np.testing.assert_array_equal(whole.engine.velocities(), resumed.engine.velocities())
    assert whole["forces"] == resumed["forces"]
