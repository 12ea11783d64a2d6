"""What is said of the flow before a run: known, bounded, or not known."""

from __future__ import annotations

import dataclasses

import pytest

from mesokit import (
    FENE,
    SRD,
    BondLength,
    Cylinder,
    Disk,
    FlowRate,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    MoleculeSize,
    NoThermostat,
    Plates,
    Run,
    Stress,
    Uniform,
    VelocityProfile,
    theory,
)
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.summary import summary

PUSH = {"force": Uniform([0.02, 0])}


def test_nothing_is_claimed_of_a_flow_round_obstacles(make_case):
    """The speed of the empty channel is a bound, and no reason to warn of its Mach number."""
    empty = derive(make_case((40, 30), walls=[Plates("y")], **PUSH))
    case = make_case((40, 30), walls=[Plates("y"), Disk([20, 15], 5)], **PUSH)
    found = derive(case)
    assert empty.mach > 0.2 and any("Mach" in text for text in empty.warnings)
    assert (found.flow_speed, found.reynolds, found.mach) == (None, None, None)
    assert found.flow_bound == empty.flow_speed
    assert not any("Mach" in text for text in found.warnings)
    assert any("the flow needs up to" in text for text in found.warnings)
    rows = {name: (value, word) for name, value, word in summary(case).rows}
    assert rows["flow speed"][0] == "not known" and "without them" in rows["flow speed"][1]
    most = f"{empty.reynolds:.4g} without obstacles"
    assert rows["Reynolds number"] == ("not known", most)


def test_the_flow_in_a_round_pipe_is_that_of_hagen_and_poiseuille(make_case):
    pipe = Cylinder([0, 12, 12], radius=10, axis="x", fluid="inside")
    case = make_case((8, 24, 24), walls=[pipe], force=Uniform([0.01, 0, 0]))
    found = derive(case)
    nu = found.transport.viscosity
    assert found.flow == "Hagen-Poiseuille"
    assert found.flow_speed == pytest.approx(0.01 * 100 / (4 * nu))
    assert found.reynolds == pytest.approx(found.flow_speed * 20 / nu)
    assert found.steady_time == pytest.approx(100 / (5.783 * nu), rel=1e-3)


def test_what_lacks_theory_is_named_in_a_fluid_of_molecules(make_case):
    """Those of springs have theories of their own."""

    def said(bond, shear=None, walls=(), *observe):
        fluid = {"molecule": Molecule(length=2, bond=bond), "walls": walls, "observe": observe}
        found = make_case((20, 20), **fluid, **({"shear_rate": shear} if shear else {}))
        return [text for text in derive(found).warnings if "theory" in text]

    spring, plates = Harmonic(K=1), [Plates("y")]
    assert said(spring, 0.1, (), Stress(), BondLength(), VelocityProfile()) == []
    (text,) = said(spring, None, plates, MoleculeSize(), VelocityProfile(), FlowRate())
    assert text.endswith("velocity-profile and flow-rate lack theory")
    (text,) = said(FENE(), 0.1, (), Stress())
    assert "no theory of a fluid of molecules" in text


def test_thin_fluids_slip_at_plates(make_case):
    def slips(density, timestep, **plates):
        case = make_case(
            (20, 20), walls=[Plates("y", **plates)], density=density, timestep=timestep,
            collision=SRD(), thermostat=MaxwellBoltzmann(), force=Uniform([1e-3, 0]),
        )  # fmt: skip
        return [text for text in derive(case).warnings if "plates slip" in text]

    (text,) = slips(4, 0.6)
    expected = theory.virtual_gas_slip("srd", 2, 4, 0.6, angle=130, thermostat="maxwell-boltzmann")
    assert f"{expected:.2g} cells" in text
    assert not slips(10, 0.1) and not slips(4, 0.6, virtual="none")


def heating(make_case, virtual="extrapolate", steps=10_000, **plates):
    walls = [Plates("y", virtual=virtual, **plates)]
    case = make_case(
        (20, 20), walls=walls, thermostat=NoThermostat(), collision=SRD(), force=Uniform([0.004, 0])
    )
    longer = derive(dataclasses.replace(case, run=Run(steps=steps)))
    return longer, [text for text in longer.warnings if "friction" in text]


@pytest.mark.parametrize("virtual", ["top-up", "none"])
def test_heating_by_friction_is_a_bound_where_nobody_knows_what_walls_cool(make_case, virtual):
    """Particles bounce back with the energy that they had: without virtual ones nothing cools."""
    found, (text,) = heating(make_case, virtual)
    assert found.heating_bound == (virtual == "top-up") == ("at most" in text and "cool" in text)
    assert found.heating == pytest.approx(10 * heating(make_case, virtual, 1000)[0].heating)


@pytest.mark.parametrize("rule", ["no-slip", "slip"])
def test_heating_by_friction_ends_where_walls_take_all_of_it(make_case, rule):
    """A slip plate takes none: the middle of a slit twice as high."""
    early, _ = heating(make_case, steps=20, lower={"rule": rule})
    bare, _ = heating(make_case, "none", steps=20, lower={"rule": rule})
    assert early.heating == pytest.approx(bare.heating, rel=0.05)
    late, (text,) = heating(make_case, steps=20_000, lower={"rule": rule})
    later, _ = heating(make_case, steps=40_000, lower={"rule": rule})
    assert later.heating == pytest.approx(late.heating, rel=0.01)
    assert "at most" not in text and f"{100 * late.heating:.2g} %" in text
