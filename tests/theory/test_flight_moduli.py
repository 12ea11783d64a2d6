"""Moduli of flights: the sum over collisions, and a simulated fluid."""

import numpy as np
import pytest

from mesokit import AT, Box, Case, DynamicModuli, Fluid, Run, Simulation, theory


@pytest.mark.parametrize("kept", [-0.3, 0.2, 0.9])
@pytest.mark.parametrize("turn", [0.01, 0.4, 1.3])
def test_they_are_the_sum_over_flights(kept, turn):
    timestep, pressure = 0.7, 5.0
    n = np.arange(2000)
    memory = pressure * timestep * (1 + kept) / 2 * kept**n
    frequency = turn / timestep
    storage = frequency * (memory * np.sin(turn * n)).sum()
    loss = frequency * (memory * np.cos(turn * n)).sum()
    found = theory.flight_moduli(frequency, timestep, memory.sum(), pressure)
    np.testing.assert_allclose(found, (storage, loss), rtol=1e-9)


def test_a_fluid_of_long_flights_stores_what_they_say():
    case = Case(
        run=Run(steps=4000, warmup=100, seed=4),
        box=Box([24, 24], shear_rate=0.12, shear_frequency=0.5),
        fluid=Fluid(density=6, timestep=1.2, collision=AT()),
        observe=[DynamicModuli(every=1)],
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    result = simulation["dynamic-moduli"]
    z = ((result.value - result.expected) / result.error)[[0, 2]]
    assert np.isfinite(z).all() and (np.abs(z) < 4).all()
    assert result.expected[0, 0] > 10 * result.error[0, 0]
