"""The kinetic energy of `conservation` is compared with theory where a thermostat holds it."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    Conservation,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    Uniform,
)
from mesokit.report import plot


def measured(steps=400, warmup=0, walls=(), **fluid):
    """What a small fluid says of its energy."""
    case = Case(
        run=Run(steps, warmup=warmup),
        box=Box([12, 12]),
        fluid=Fluid(density=10, **fluid),
        walls=list(walls),
        observe=[Conservation(every=2)],
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    return simulation["conservation"]


def test_a_thermostat_at_rest():
    """A free fluid has two degrees of freedom less in 2D."""
    result = measured(thermostat=MaxwellBoltzmann(), kT=2.0)
    energy, temperature = result.expected[:, -2:].T
    np.testing.assert_allclose(energy, (result.value[0, 0] - 1) * 2.0)
    np.testing.assert_allclose(temperature, 2.0)
    ax = plot(result).axes[1]
    assert "rel. to theory" in ax.get_ylabel() and abs(ax.lines[-1].get_ydata().mean()) < 0.01
    assert result.extra["not_steady"] == ""


@pytest.mark.parametrize("warmup, steady", [(0, False), (2000, True)])
def test_a_driven_flow_has_the_energy_of_the_flow(warmup, steady):
    flow = {"force": Uniform((0.05, 0.0)), "thermostat": MaxwellBoltzmann()}
    result = measured(warmup=warmup, walls=[Plates("y")], **flow)
    energy, thermal = result.expected[0, -2], result.value[0, 0]
    assert energy > 1.05 * thermal
    assert (result.extra["not_steady"] == "") == steady
    titles = [ax.get_title(loc="left") for ax in plot(result).axes]
    assert any("not steady: the flow needs" in title for title in titles) != steady
    if steady:
        assert result.value[:, -2].mean() == pytest.approx(energy, rel=0.02)
        assert result.value[:, -1].mean() == pytest.approx(result.expected[0, -1], rel=0.02)


def test_a_fluid_without_a_thermostat_conserves_it():
    result = measured()
    ax = plot(result).axes[1]
    assert "rel. change" in ax.get_ylabel() and "10^{-1" in ax.get_ylabel()  # round-off
    np.testing.assert_allclose(result.value[:, -2], result.expected[:, -2], rtol=1e-12)
