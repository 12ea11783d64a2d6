"""The lanes of the last strip that hold no particle cannot harm those that do."""

import numpy as np
import pytest

from mesokit import SRD, Box, Case, Fluid, MaxwellBoltzmann, Plates, Run, Uniform
from mesokit.loops.layout import LANES
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.small_fluids import assert_same


def readings(fluid: CPU) -> list:
    """What is read of particles, one by one and in sums."""
    number, momentum, energy = fluid.totals()
    waves = fluid.modes(np.array([[0.3, 0.0], [0.0, 1.0]]))
    particles = fluid.positions(), fluid.velocities()
    return [*particles, number, momentum, energy, *fluid.moments((0,), (6,)), *waves]


@pytest.mark.parametrize("rubbish", [1e20, -1e20, np.inf, np.nan])
def test_rubbish_in_spare_lanes_changes_nothing(rubbish: float) -> None:
    case = Case(
        run=Run(steps=1),
        box=Box([6, 9]),
        fluid=Fluid(collision=SRD(90), thermostat=MaxwellBoltzmann(), force=Uniform([0.001, 0.0])),
        walls=[Plates("y")],
    )
    found = []
    for dirty in (False, True):
        fluid = CPU(case)
        start(fluid)
        assert fluid.n % 256 != 0
        for k in range(4 * dirty):
            memory = fluid.memory
            spare = np.arange(fluid.n, memory.strips * LANES)
            memory.fluid.particles.data[memory.at(k, spare)] = rubbish
        at_start = readings(fluid)
        fluid.advance(150)
        found.append([*at_start, *readings(fluid)])
    assert_same(*found)
