"""A thermostat gives each cell the energy that it should have, and touches nothing else."""

import numpy as np
import pytest
from laboratory import Measured, conserved_sums, make_fluid, relative_energy
from scipy import stats

from mesokit import theory
from mesokit.geometry import Plates
from mesokit.mpcd.field import Uniform
from mesokit.mpcd.thermostat import RULES, MaxwellBoltzmann, NoThermostat

SIZE = (14, 12, 16)
REST = Uniform(acceleration=(0.0, 0.0))


def hot_fluid(thermostat):
    """Twice too hot, with a flow that varies from cell to cell; after one collision."""
    fluid = make_fluid(SIZE, thermostat=thermostat(), timestep=1e-6, grid_shift=0.0)
    r, v = fluid.positions(), np.sqrt(2) * fluid.velocities()
    v[:, 0] += np.sin(2 * np.pi * np.floor(r[:, 1]) / SIZE[1])
    fluid = make_fluid(
        SIZE, thermostat=thermostat(), timestep=1e-6, grid_shift=0.0, positions=r, velocities=v
    )
    before = conserved_sums(fluid, v)
    _, energy = relative_energy(fluid)
    fluid.advance(1)
    return fluid, before, energy


@pytest.mark.parametrize("thermostat", RULES, ids=lambda rule: rule.__name__)
def test_sets_the_temperature_and_leaves_the_flow(thermostat):
    fluid, before, energy_before = hot_fluid(thermostat)
    after = conserved_sums(fluid, fluid.velocities())
    assert abs(after["momentum"] - before["momentum"]).max() < 1e-9
    number, energy = relative_energy(fluid)
    freedom = 3 * (number - 1)
    if thermostat is NoThermostat:
        np.testing.assert_allclose(energy, energy_before, atol=1e-9)
        return
    several = number > 1
    assert abs(energy[~several]).max(initial=0) < 1e-9
    error = np.sqrt(2 / freedom.sum())
    temperature = Measured(2 * energy.sum() / freedom.sum(), error)
    assert temperature.agrees(1.0), temperature


def test_energy_of_a_cell_is_gamma_distributed_in_3d():
    fluid, *_ = hot_fluid(MaxwellBoltzmann)
    assert ks_of_cells(*relative_energy(fluid), 3) > 1e-3


def test_energy_of_a_cell_is_gamma_distributed_in_2d():
    fluid = make_fluid(
        (64, 48), walls=[Plates(axis="y")], force=REST, thermostat=MaxwellBoltzmann(),
        density=4, grid_shift=0.0,
    )  # fmt: skip
    fluid.advance(3)
    assert ks_of_cells(*relative_energy(fluid), 2) > 1e-3


def ks_of_cells(number, energy, dimension):
    """p-value of the hypothesis that all cells are drawn from the gamma law of their number."""
    several = number > 1
    p = [
        float(theory.cell_energy_cdf(e, int(n), dimension))
        for n, e in zip(number[several], energy[several], strict=True)
    ]
    return stats.kstest(p, "uniform").pvalue
