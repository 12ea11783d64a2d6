"""Laws of the fluid where kernels run as loops over threads: at sizes that emulation is slow for.

The bits are those of the processor's engine; these tests know nothing of it.
"""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    SRD,
    Box,
    Case,
    Conservation,
    Fluid,
    MaxwellBoltzmann,
    NoThermostat,
    Plates,
    Run,
    Simulation,
    SteadyShear,
    Stress,
    Uniform,
    VelocityProfile,
    theory,
)

pytestmark = pytest.mark.long
STANDARD_ERRORS = 4.0


def run(**parts):
    """A case, run on a device from its start to its end."""
    simulation = Simulation(Case(**parts), device="host")
    simulation.run(progress=False)
    return simulation


def test_momentum_and_energy_are_conserved() -> None:
    box, fluid = Box([10, 10, 10]), Fluid(collision=SRD(angle=130), thermostat=NoThermostat())
    simulation = Simulation(Case(run=Run(steps=250), box=box, fluid=fluid), device="host")
    number, momentum, energy = simulation.engine.totals()
    simulation.run(progress=False)
    after = simulation.engine.totals()
    assert after[0] == number == 10_000
    np.testing.assert_allclose(after[1], momentum, atol=1e-8)
    assert after[2] == pytest.approx(energy, rel=1e-9)
    assert np.abs(simulation.engine.velocities()).max() > 2.0


def test_a_held_fluid_has_the_distribution_of_its_temperature() -> None:
    box, fluid = (
        Box([24, 24]),
        Fluid(collision=SRD(angle=130), thermostat=MaxwellBoltzmann(), kT=2.0),
    )
    simulation = Simulation(Case(run=Run(steps=100), box=box, fluid=fluid), device="host")
    squares = []
    for _ in range(20):
        simulation.run(20, progress=False)
        squares.append((simulation.engine.velocities() ** 2).mean())
    error = 2.0 * np.sqrt(2.0 / (20 * 2 * simulation.engine.n))  # of independent velocities
    assert abs(np.mean(squares) - 2.0) < STANDARD_ERRORS * error
    fourth = (simulation.engine.velocities() ** 4).mean() / 2.0**2
    assert abs(fourth - 3.0) < STANDARD_ERRORS * np.sqrt(96.0 / (2 * simulation.engine.n))


def test_a_sheared_fluid_has_the_viscosity_of_theory() -> None:
    simulation = run(
        run=Run(steps=2000, warmup=200),
        box=Box([12, 12, 12], shear=SteadyShear(0.1)),
        fluid=Fluid(collision=SRD(angle=130), thermostat=MaxwellBoltzmann()),
        observe=[Stress(every=1)],
    )
    found = {one.what: one for one in simulation["stress"].comparisons}
    viscosity, pressure = found["viscosity from the stress"], found["pressure"]
    expected = theory.transport("srd", 3, 10, 0.1, angle=130).viscosity
    assert viscosity.error < 0.03 * expected
    assert abs(viscosity.measured - expected) < STANDARD_ERRORS * viscosity.error
    assert abs(pressure.measured - 10.0) < STANDARD_ERRORS * pressure.error


def test_a_channel_has_the_flow_of_poiseuille() -> None:
    simulation = run(
        run=Run(steps=3000, warmup=2000),
        box=Box([16, 16]),
        fluid=Fluid(
            collision=SRD(angle=130), thermostat=MaxwellBoltzmann(), force=Uniform([0.02, 0.0])
        ),
        walls=[Plates("y")],
        observe=[VelocityProfile(every=5, axis="y"), Conservation(every=100)],
    )
    found = {one.what: one for one in simulation["velocity-profile"].comparisons}
    viscosity = found["viscosity from curvature"]
    expected = theory.transport("srd", 2, 10, 0.1, angle=130).viscosity
    assert viscosity.error < 0.05 * expected
    assert abs(viscosity.measured - expected) < STANDARD_ERRORS * viscosity.error
