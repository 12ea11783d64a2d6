"""A thermostat gives each cell the energy that it should have, and touches nothing else."""

import numpy as np
import pytest
from scipy import stats

from mesokit import MaxwellBoltzmann, NoThermostat, Plates, Uniform, theory
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.thermostat import RULES
from tests.helpers.small_fluids import Measured, conserved_sums, make_fluid, relative_energy

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


@pytest.mark.parametrize("ratio", [300, 1000])
def test_kinds_of_very_different_mass_share_one_temperature(ratio):
    """2D, four particles per cell: energies of the light ones are the last digits of the sums.

    The relative standard error of a kind's mean energy is 1/sqrt(samples particles), times 1.5 for
    what samples 50 steps apart share.
    """
    kinds = (Species(mass=1, density=3), Species(mass=ratio, density=1))
    fluid = make_fluid((12, 12), species=kinds, timestep=0.5, thermostat=MaxwellBoltzmann())
    fluid.advance(500)
    masses = fluid.masses()
    sums = np.zeros(2)
    for _ in range(60):
        fluid.advance(50)
        energy = 0.5 * masses * (fluid.velocities() ** 2).sum(axis=1)
        sums += energy[masses < 2].mean(), energy[masses > 2].mean()
    light, heavy = sums / 60
    assert abs(light - 1) < 4 * 1.5 / np.sqrt(60 * 432)
    assert abs(heavy - 1) < 4 * 1.5 / np.sqrt(60 * 144)


def test_a_cold_start_is_warmed_without_overshooting():
    """Relative speeds near the rounding of cell energies must not be stretched to the target."""
    random = np.random.default_rng(0)
    r = 20 * random.random((4000, 2))
    v = np.array([0.7, 0.3]) + 1e-4 * random.standard_normal((4000, 2))
    fluid = make_fluid(
        (20, 20), thermostat=MaxwellBoltzmann(), positions=r, velocities=v,
        force=Uniform((0.0, 0.0)),  # a kind of step that others have too
    )  # fmt: skip
    for _ in range(6):
        fluid.advance(1)
        w = fluid.velocities() - fluid.velocities().mean(axis=0)
        assert (w**2).mean() < 1.1
    assert (w**2).mean() > 0.9
