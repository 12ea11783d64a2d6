"""Of a fluid whose particles hardly meet no theory of a viscous one is told as if it held."""

import dataclasses

import pytest

from mesokit import (
    Box,
    Case,
    FlowRate,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    SRDPlusA,
    Stress,
    Surface,
    TransverseModes,
    Uniform,
    VelocityProfile,
    WallStress,
)
from mesokit.method.mpcd.expected import setting
from tests.helpers.fake_fluid import FakeFluid

PROFILE = VelocityProfile(axis="y", component="x", every=5)


def case(density: float, observe: list, size: int = 24, **parts) -> Case:
    return Case(
        run=Run(steps=400),
        box=Box([size, size], **{k: parts.pop(k) for k in ("shear_rate",) if k in parts}),
        walls=parts.pop("walls", []),
        fluid=Fluid(density=density, thermostat=MaxwellBoltzmann(), **parts),
        observe=observe,
    )


def plates(**upper) -> list:
    return [Plates("y", upper=Surface(**upper))]


DRIVEN = {"walls": [Plates("y")], "force": Uniform([0.01, 0.0])}
MOVED = {"walls": plates(velocity=[0.4, 0.0])}
WHERE = [
    pytest.param([PROFILE], DRIVEN, id="poiseuille"),
    pytest.param([PROFILE, WallStress(every=1)], MOVED, id="couette"),
    pytest.param([Stress(every=1)], {"shear_rate": 0.05}, id="shear"),
    pytest.param([TransverseModes(every=2)], {}, id="modes"),
]
EQUILIBRIUM = ("mean square of the modes",)  # that of a gas, however thin


@pytest.mark.parametrize(("observe", "parts"), WHERE)
def test_no_theory_of_collisions_is_told_of_few_pairs(observe, parts):
    simulation = Simulation(case(0.03, observe, **parts))
    simulation.run()
    found = [c for one in simulation.results.values() for c in one.comparisons]
    compared = [c for c in found if c.deviation == c.deviation]
    assert found and not [c for c in compared if c.what not in EQUILIBRIUM]


@pytest.mark.parametrize(("observe", "parts"), WHERE)
def test_thick_fluids_keep_theirs(observe, parts):
    simulation = Simulation(case(6.0, observe, **parts))
    simulation.run()
    found = [c for one in simulation.results.values() for c in one.comparisons]
    assert [c for c in found if c.expected == c.expected and not c.approximate]
    assert not [c for c in found if "thin" in c.note]


def test_check_says_why():
    from mesokit.seam.method import summary_of

    thin = case(0.3, [PROFILE], **DRIVEN)
    assert any("no theory of so thin a fluid" in one for one in summary_of(thin).warnings)
    thick = dataclasses.replace(thin, fluid=dataclasses.replace(thin.fluid, density=1.5))
    assert not any("no theory of so thin" in one for one in summary_of(thick).warnings)


@pytest.mark.parametrize(
    ("size", "timestep", "slips"), [(12, 1.0, True), (48, 1.0, False), (12, 0.2, False)]
)
def test_long_flights_slip_along_plates(size, timestep, slips):
    """Where a flight is a part of the channel the flow rate is more than that of no slip."""
    given = case(8.0, [FlowRate()], size, timestep=timestep, **DRIVEN)
    accumulator, fluid = FlowRate().accumulator(given), FakeFluid(given)
    for _ in range(40):
        accumulator.observe(fluid)
    rate = next(c for c in accumulator.result().comparisons if c.what.startswith("flow rate"))
    assert rate.approximate == slips == setting.slipping(given).startswith("approximate: slip")
    assert rate.expected > 0


@pytest.mark.parametrize(
    ("timestep", "off"),
    [(0.02, "so short flights take up to 7 % off"), (0.05, "so short flights take up to 3 % off")],
)
def test_short_flights_lower_the_viscosity(timestep, off):
    """Where particles meet again and again, by as much as was measured, and where that is seen."""
    fluid = case(10, [], timestep=timestep, collision=SRDPlusA(angle=90))
    assert setting.chaos_is_off(fluid, 1.8, 0.01) == f"approximate: molecular chaos; {off}"
    assert setting.chaos_is_off(fluid, 1.8, 0.5) == ""
    longer = case(10, [], timestep=0.1, collision=SRDPlusA(angle=90))
    assert "flights" not in setting.chaos_is_off(longer, 0.4, 0.001)
