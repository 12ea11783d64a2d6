"""Conserved quantities, stress and forces on plates."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    WCA,
    Box,
    Case,
    Conservation,
    DynamicModuli,
    Fluid,
    Harmonic,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    Stress,
    StressAutocorrelation,
    Surface,
    Uniform,
    WallStress,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.rheometer import modes_of_stress
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.observe.conservation import ROWS
from mesokit.method.mpcd.observe.wall_stress import balance
from mesokit.method.mpcd.solutes import Polymer, Solutes
from tests.helpers.comparisons import by_name, comparisons
from tests.helpers.fake_fluid import FakeFluid


def test_conservation_of_what_is_conserved(make_case):
    case = make_case((4, 4))
    accumulator, fluid = Conservation(every=1).accumulator(case), FakeFluid(case, kept=1.0)
    for _ in range(50):
        fluid.advance()
        accumulator.observe(fluid)
    found = by_name(accumulator.result())
    assert found["largest drift of momentum"].measured == 0
    assert found["largest relative drift of kinetic energy"].measured == 0
    fluid.thermal[0] += 1e-6
    accumulator.observe(fluid)
    drifted = by_name(accumulator.result())
    assert drifted["largest drift of momentum"].measured == pytest.approx(2**0.5 * 1e-6 / 160)
    assert drifted["largest relative drift of kinetic energy"].measured > 1e-12


def test_temperature_with_a_thermostat(make_case):
    case = make_case((4, 4), thermostat=MaxwellBoltzmann(), kT=1.7, mass=2.0)
    accumulator, fluid = Conservation().accumulator(case), FakeFluid(case)
    for _ in range(500):
        fluid.jump(10)
        accumulator.observe(fluid)
    found = by_name(accumulator.result())["temperature"]
    assert found.expected == 1.7 and abs(found.deviation) < 4 and found.error < 0.02


def test_drifts_are_not_claimed_where_something_acts(make_case):
    case = make_case((4, 4), walls=[Plates(axis="y")], force=Uniform((0.1, 0)))
    accumulator, fluid = Conservation().accumulator(case), FakeFluid(case)
    accumulator.observe(fluid)
    result = accumulator.result()
    assert result.comparisons == ()
    assert np.isnan(result.expected[:, 3:]).all()  # momentum has that of the flow, no drift


def test_time_series_stays_bounded(make_case):
    case = make_case((2, 2), density=1)
    accumulator = Conservation(every=1).accumulator(case)

    class Still:
        step = 0
        time = property(lambda self: 0.1 * self.step)

        def totals(self):
            return 4, np.zeros(2), 1.0

    fluid = Still()
    for step in range(3 * ROWS):
        fluid.step = step
        accumulator.observe(fluid)
    result = accumulator.result()
    steps = result.extra["step"]
    assert ROWS / 2 < len(steps) <= ROWS and steps[0] == 0
    assert set(np.diff(steps)) == {4.0}
    assert result.samples == 3 * ROWS


def noisy(rng, mean, scale=0.3):
    return mean + scale * rng.normal(size=np.shape(mean))


def test_stress_under_shear_gives_the_viscosity(make_case):
    case = make_case((4, 4, 4), shear_rate=0.1, thermostat=MaxwellBoltzmann())
    theory, rng = setting.transport(case), np.random.default_rng(1)
    accumulator, fluid = Stress().accumulator(case), FakeFluid(case)
    scale = 10 * 0.1
    kinetic, collisional = -10 * np.eye(3), np.zeros((3, 3))
    kinetic[0, 1] = kinetic[1, 0] = theory.viscosity_kinetic * scale
    collisional[0, 1] = collisional[1, 0] = theory.viscosity_collisional * scale
    for _ in range(500):
        fluid.stress = {"kinetic": noisy(rng, kinetic), "collisional": noisy(rng, collisional)}
        accumulator.observe(fluid)
    result = accumulator.result()
    found = by_name(result)
    assert found["viscosity from the stress"].expected == theory.viscosity
    warming = setting.warming(case)
    assert found["pressure"].expected == pytest.approx(10 * (1 + warming * 0.1**2), rel=1e-12)
    for c in comparisons(result):
        expected = 0.0 if "difference" in c.what else c.expected
        made = 10.0 if c.what == "pressure" else expected  # of what was put in
        assert abs(c.measured - made) < 4 * c.error < 0.2
    assert found["kinetic part from the stress"].approximate
    assert not found["viscosity from the stress"].approximate
    error = found["viscosity from the stress"].error
    assert error == pytest.approx(0.3 * 2**0.5 / 500**0.5 / scale, rel=0.5)
    value, _ = result.select(part="total", row="x", column="y")
    assert value == pytest.approx(found["viscosity from the stress"].measured * scale)


def test_stress_is_not_for_walls(make_case):
    with pytest.raises(CaseError, match="use wall-stress"):
        make_case((4, 4), [Stress()], walls=[Plates(axis="y")])


def test_beads_push_plates_one_by_one(make_case):
    """A slit of ideal dimers: half of the places at a plate are free, somewhat more are taken."""
    plates, H, spread = [Plates(axis="y")], 8, (1 / 3) ** 0.5
    at_plate = 0.5 / (1 - 2 * spread / (H * (2 * np.pi) ** 0.5))
    bond = Harmonic(K=1.5)

    def pressure(**more):
        return balance(make_case((4, H), walls=plates, **more))[:, 1]

    dimers = pressure(molecule=Molecule(length=2, bond=bond))
    assert dimers == pytest.approx(10 * at_plate * np.array([-1, 1]), rel=1e-4)
    kinds = (Polymer(6), Polymer(5, length=2))
    dissolved = 10 + (6 + 10 * at_plate) / 32
    assert pressure(solutes=Solutes(kinds, bond=bond))[1] == pytest.approx(dissolved, rel=1e-4)
    assert np.isnan(pressure(solutes=Solutes((Polymer(6),), pair=WCA()))).all()


def test_wall_stress_balances_the_force(make_case):
    case = make_case(
        (4, 8),
        walls=[Plates(axis="y")],
        force=Uniform((0.02, 0)),
        thermostat=MaxwellBoltzmann(),
    )
    accumulator, fluid, rng = (
        WallStress().accumulator(case),
        FakeFluid(case),
        np.random.default_rng(1),
    )
    drag, pressure = 10 * 0.02 * 8 / 2, 10.0
    force = np.array([[drag, -pressure], [drag, pressure]]) * 4  # on 4 cells
    for _ in range(400):
        turns = np.zeros((2, 1))
        fluid.hit_walls(np.hstack([noisy(rng, force, 0.5) * 10 * 0.1, turns]), 10)
        accumulator.observe(fluid)
    result = accumulator.result()
    assert len(result.comparisons) == 5
    assert all(abs(c.deviation) < 4 and c.error < 0.02 for c in comparisons(result))
    both = by_name(result)["drag along x on both plates"]
    assert both.expected == pytest.approx(1.6)


def test_couette_drag_pulls_the_plates_against_their_motion(make_case):
    walls = [Plates(axis="y", upper=Surface(velocity=(0.8, 0)))]
    case = make_case((4, 8), walls=walls, thermostat=MaxwellBoltzmann())
    expected = balance(case)
    eta = setting.transport(case).dynamic_viscosity
    assert expected == pytest.approx(np.array([[eta * 0.1, -10], [-eta * 0.1, 10]]))


def test_weight_rests_on_the_lower_plate(make_case):
    case = make_case(
        (4, 8), walls=[Plates(axis="y")], force=Uniform((0, -0.05)), thermostat=MaxwellBoltzmann()
    )
    lower, upper = balance(case)[:, 1]
    assert lower + upper == pytest.approx(-10 * 0.05 * 8)
    assert -lower / upper == pytest.approx(np.exp(0.05 * 8))


def test_wall_stress_needs_walls(make_case):
    with pytest.raises(CaseError, match="needs one"):
        make_case((4, 4), [WallStress()])


def test_moduli_of_a_known_stress(make_case):
    """Of a stress that follows the strain and its rate the fit gives both shares back."""
    shear = {"shear_rate": 0.2, "shear_frequency": 0.7}
    case = make_case((4, 4), [DynamicModuli()], timestep=0.1, **shear)
    accumulator, fluid = DynamicModuli().accumulator(case), FakeFluid(case)
    amplitude = 0.2 / 0.7
    for step in range(1, 1000):
        fluid.step = step
        phase = 0.7 * (fluid.time - 0.05)  # the stress is that of the step, not of its end
        s, c = np.sin(phase), np.cos(phase)
        stress = np.zeros((2, 2))
        stress[0, 1] = amplitude * (3.0 * s + 5.0 * c) + 0.4
        fluid.stress = {"kinetic": 0.25 * stress, "collisional": 0.75 * stress}
        accumulator.observe(fluid)
    result = accumulator.result()
    assert result.samples == 999
    np.testing.assert_allclose(result.value, np.outer([0.25, 0.75, 1.0], [3.0, 5.0]), rtol=1e-9)


def test_moduli_are_approximate_where_theory_is_off_by_more_than_the_error(make_case):
    found = {}
    for scatter in (0.0, 20.0):
        shear = {"shear_rate": 0.2, "shear_frequency": 1.9}
        case = make_case((4, 4), [DynamicModuli(every=1)], timestep=0.1, **shear)
        accumulator, fluid = DynamicModuli(every=1).accumulator(case), FakeFluid(case)
        random = np.random.default_rng(3)
        for step in range(1, 400):
            noise = scatter * random.standard_normal((2, 2, 2))
            fluid.stress = {"kinetic": 1 + noise[0], "collisional": 1 + noise[1]}
            fluid.step = step
            accumulator.observe(fluid)
        found[scatter] = [c.note for c in accumulator.result().comparisons]
    assert found == {0.0: ["approximate: molecular chaos"] * 3, 20.0: [""] * 3}


def test_moduli_need_an_oscillation_with_enough_samples(make_case):
    with pytest.raises(CaseError, match="shear_frequency"):
        make_case((4, 4), [DynamicModuli()], shear_rate=0.1)
    with pytest.raises(CaseError, match="samples in a period"):
        make_case((4, 4), [DynamicModuli()], shear_rate=0.1, shear_frequency=50.0)
    with pytest.raises(CaseError, match="shear_frequency = 2"):
        make_case((4, 4), shear_frequency=2.0)


def test_modulus_of_a_known_stress(make_case):
    """A stress that forgets with a rate: value at lag 0, decay and integral."""
    case = make_case((4, 4), [StressAutocorrelation()], timestep=0.1)
    accumulator, fluid = StressAutocorrelation().accumulator(case), FakeFluid(case)
    rng, kept, stress = np.random.default_rng(2), 0.9, np.zeros((2, 2))
    for step in range(1, 20_000):
        fluid.step = step
        stress = kept * stress + np.sqrt(1 - kept**2) * rng.normal(size=(2, 2))
        fluid.stress = {"kinetic": 0.25 * stress, "collisional": 0.75 * stress}
        accumulator.observe(fluid)
    result = accumulator.result()
    expected = 16.0 * kept ** np.arange(5)
    assert (abs(result.value[:5] - expected) < 4 * result.error[:5]).all()
    (viscosity,) = result.comparisons
    integral = 16.0 * 0.1 * (0.5 + kept / (1 - kept)) / case.fluid.density
    assert abs(viscosity.measured - integral) < 4 * viscosity.error + 0.02 * integral


def test_modulus_of_molecules_stands_beside_rouse(make_case):
    """Bonds in G(t) after lag 0, the apparent viscosity, and both moduli."""
    molecule = Molecule(length=2, bond=Harmonic(K=0.5))
    case = make_case(
        (4, 4), [StressAutocorrelation()], density=10, timestep=0.1, molecule=molecule,
        thermostat=MaxwellBoltzmann(),
    )  # fmt: skip
    accumulator, fluid = StressAutocorrelation().accumulator(case), FakeFluid(case)
    rng, kept = np.random.default_rng(3), np.zeros((2, 2))
    for _ in range(400):
        kept = 0.9 * kept + rng.normal(size=(2, 2))
        fluid.stress = {"kinetic": 0.1 * kept, "collisional": 0.1 * kept, "bond": 0.8 * kept}
        accumulator.observe(fluid)
    result = accumulator.result()
    phi_kT, (tau,), eta = modes_of_stress(case)
    assert phi_kT == 5.0 and np.isnan(result.expected[0])
    np.testing.assert_allclose(result.expected[1:], 5 * np.exp(-result.x["time"][1:] / tau))
    (viscosity,) = result.comparisons
    last = result.x["time"][result.x["time"] <= 4 * tau].max()  # to which the integral goes
    bonds = 5 * tau * (1 - np.exp(-last / tau))
    assert viscosity.expected == pytest.approx((eta + bonds) / 10)
    assert "lower bound" in viscosity.note and not viscosity.approximate
    w = result.extra["frequency"]
    stored = 5 * (w * tau) ** 2 / (1 + (w * tau) ** 2)
    np.testing.assert_allclose(result.extra["storage_theory"], stored)
    np.testing.assert_allclose(result.extra["loss_theory"], w * eta + stored / (w * tau))


@pytest.mark.parametrize(("rate", "known"), [(1e-3, True), (0.5, False)])
def test_shear_adds_to_the_pressure_of_a_fluid_at_rest(rate, known):
    """By the square of the shear rate times the time that velocities are remembered."""
    case = Case(
        run=Run(steps=200, warmup=20, seed=4),
        box=Box((8, 8, 8), shear_rate=rate),
        fluid=Fluid(density=10, timestep=0.2, thermostat=MaxwellBoltzmann()),
        observe=[Stress()],
    )
    simulation = Simulation(case)
    simulation.run()
    pressure = simulation["stress"]["pressure"]
    assert pressure.approximate is not known
    warm = 1 + setting.warming(case) * rate**2  # a thermostat of cells takes shear for heat
    assert pressure.expected == pytest.approx(10 * warm, rel=1e-12) and 1 <= warm < 1.02
    assert (abs(pressure.measured - 10) > 5 * pressure.error) is not known
