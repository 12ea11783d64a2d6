"""Friction heats a fluid that no thermostat holds, until the plates take all of it."""

from __future__ import annotations

import pytest

from mesokit import SRD, Box, Case, Fluid, Plates, Run, Simulation, TemperatureProfile, Uniform
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.expected.heating import heating

pytestmark = pytest.mark.long

# The law holds to a part of the rise, for molecular chaos. Measured over seeds: +2.8 % (timestep
# 0.1, Mach number 0.3), +3.8 % (0.1, Mach number 0.6), +3.9 % (0.5)
NEAR = 0.05


def slit(timestep, push, steps, warmup):
    return Case(
        run=Run(steps=steps, warmup=warmup, seed=5),
        box=Box((10, 12, 10)),
        fluid=Fluid(
            density=10, timestep=timestep, collision=SRD(), force=Uniform((push, 0.0, 0.0))
        ),
        walls=[Plates("y")],
        observe=[TemperatureProfile(every=20)],
    )


@pytest.mark.parametrize(
    ("timestep", "push", "steps"),
    [(0.1, 0.0193, 48_000), (0.1, 0.0386, 12_000), (0.5, 0.0091, 12_000)],
)
def test_plates_with_virtual_particles_are_as_warm_as_theory_says(timestep, push, steps):
    """Errors are 1 to 2 % of the rise. Without the jump at the plates theory would have 0.7 of
    it at timestep 0.1, and 0.15 at 0.5."""
    case = slit(timestep, push, steps, warmup=3000)
    simulation = Simulation(case, threads=1)
    simulation.run()
    result = simulation["temperature-profile"]
    found, rise = result["mean temperature"], heating(case, 1).steady
    assert 0.1 < rise < 0.5 and found.error < 0.02 * rise
    assert abs(found.measured - found.expected) < 3.5 * found.error + NEAR * rise, found
    # and where it is warm: the cells at the plates too
    error = abs(result.value - result.expected) - 3.5 * result.error
    assert (error < 2 * NEAR * rise).all(), error / rise
    assert derive(case).heating == pytest.approx(rise, rel=1e-3)
