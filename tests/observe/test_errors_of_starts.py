"""A fluid that keeps its energy keeps the kT of its start, which one run cannot average over."""

import numpy as np
import pytest

from mesokit import (
    SRD,
    Box,
    Case,
    Fluid,
    MaxwellBoltzmann,
    MeanSquareDisplacement,
    Run,
    Simulation,
    StressAutocorrelation,
    VelocityAutocorrelation,
)


def measured(thermostat=None, seed=1):
    more = {} if thermostat is None else {"thermostat": thermostat}
    case = Case(
        run=Run(steps=600, warmup=20, seed=seed),
        box=Box([6, 6, 6]),
        fluid=Fluid(density=5, timestep=1.0, collision=SRD(angle=90), **more),
        observe=[
            MeanSquareDisplacement(max_lag=40),
            VelocityAutocorrelation(every=1, max_lag=20),
            StressAutocorrelation(max_lag=20),
        ],
    )
    simulation = Simulation(case)
    simulation.run()
    return [
        simulation["mean-square-displacement"]["diffusion coefficient"],
        simulation["velocity-autocorrelation"]["diffusion coefficient"],
        simulation["stress-autocorrelation"]["viscosity"],
    ]


def test_diffusion_has_the_error_of_the_kT_of_the_start():
    of_start = (2 / (3 * 1080)) ** 0.5
    for number in measured()[:2]:
        assert number.error > of_start * number.measured
    assert measured(MaxwellBoltzmann())[1].error < of_start * measured()[1].measured


@pytest.mark.long
def test_errors_hold_over_starts():
    """Both coefficients, and the viscosity from the integral down to zero."""
    runs = [measured(seed=seed) for seed in range(1, 13)]
    for each in zip(*runs, strict=True):
        deviations = np.array([one.measured - one.expected for one in each])
        errors = np.array([one.error for one in each])
        root = np.sqrt(np.mean((deviations / errors) ** 2))
        assert root < 1.6, each[0].what
