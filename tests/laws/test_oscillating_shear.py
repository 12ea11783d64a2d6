"""A box whose shear oscillates, and stress at rest: two ways to the viscosity."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    DynamicModuli,
    Fluid,
    MaxwellBoltzmann,
    Run,
    Simulation,
    StressAutocorrelation,
    VelocityProfile,
)
from tests.helpers.comparisons import by_name

pytestmark = pytest.mark.long


def sheared(frequency, steps, size=(8, 8, 8), rate=0.2):
    return Simulation(
        Case(
            run=Run(steps=steps, warmup=200, seed=3),
            box=Box(size, shear_rate=rate, shear_frequency=frequency),
            fluid=Fluid(density=10, timestep=0.1, thermostat=MaxwellBoltzmann()),
            observe=[DynamicModuli(), VelocityProfile(axis="y", every=5)],
        ),
    )


def test_a_simple_fluid_loses_by_its_viscosity_and_stores_nothing():
    """Slow against collisions. Molecular chaos is good to some per cent (see test_stress)."""
    frequency = 0.2
    simulation = sheared(frequency, 20_000)
    simulation.run()
    found = by_name(simulation["dynamic-moduli"])
    stored, lost = found["storage modulus"], found["loss modulus"]
    assert lost.error < 0.02 * lost.expected
    assert abs(lost.measured - lost.expected) < 4 * lost.error + 0.06 * lost.expected
    assert abs(stored.measured) < 4 * stored.error + 0.03 * lost.expected


def test_the_fluid_follows_the_images():
    """The box is lower than the depth to which the oscillation reaches: a straight line."""
    simulation = sheared(0.02, 0)
    fluid, box = simulation.engine, simulation.case.box
    fluid.advance(300)
    slopes, rates = [], []
    for _ in range(60):
        fluid.advance(25)
        _, mass, momentum, _ = fluid.moments((1,), (8,))
        y = np.arange(8) + 0.5
        slopes.append(np.polyfit(y, momentum[0] / mass, 1)[0])
        rates.append(box.shear_rate * np.cos(box.shear_frequency * fluid.time))
    share = np.polyfit(rates, slopes, 1)[0]
    assert share == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("size", [(16, 16), (8, 8, 8)], ids=["2D", "3D"])
def test_stress_at_rest_forgets_at_once_and_its_integral_is_the_viscosity(size):
    """Green and Kubo. Molecular chaos is good to some per cent (see test_stress)."""
    simulation = Simulation(
        Case(
            run=Run(steps=8000, warmup=100, seed=5),
            box=Box(size),
            fluid=Fluid(density=10, timestep=0.1, thermostat=MaxwellBoltzmann()),
            observe=[StressAutocorrelation(max_lag=100)],
        )
    )
    simulation.run()
    result = simulation["stress-autocorrelation"]
    (viscosity,) = result.comparisons
    assert viscosity.error < 0.03 * viscosity.expected
    assert abs(viscosity.measured - viscosity.expected) < (
        4 * viscosity.error + 0.06 * viscosity.expected
    )
    assert abs(result.value[3:10].mean()) < 0.01 * result.value[0]
