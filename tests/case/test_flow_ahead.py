"""What is said of the flow before a run: known, bounded, or not known."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mesokit import (
    FENE,
    SRD,
    BondLength,
    Box,
    Cylinder,
    Disk,
    FlowRate,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    MoleculeSize,
    NoThermostat,
    Plates,
    Polymer,
    Run,
    Solutes,
    StepStrain,
    Stress,
    Uniform,
    VelocityProfile,
    theory,
)
from mesokit.method.mpcd.derived import derive, summary
from mesokit.method.mpcd.expected.heating import temperature_rise
from mesokit.method.mpcd.expected.molecules import longest_relaxation

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
    assert found.reynolds == pytest.approx(found.flow_speed / 2 * 20 / nu)  # of the mean
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


def test_little_friction_heats_by_the_law_for_one_temperature(make_case):
    """(rho g)^2 h^3 (h/5 + jump)/(3 eta k); more heats less than by the square of the force, as
    the fluid is thin where it is warm."""

    def rise(push):
        case = make_case(
            (20, 20), walls=[Plates("y")], thermostat=NoThermostat(), collision=SRD(angle=90),
            density=8, timestep=0.2, force=Uniform([push, 0])
        )  # fmt: skip
        return temperature_rise(case)

    fluid = {"angle": 90, "kT": 1.0}
    eta = theory.transport("srd", 2, 8, 0.2, **fluid).dynamic_viscosity
    k, jump = theory.heat_at_walls("srd", 2, 8, 0.2, **fluid)
    expected = (8 * 1e-4) ** 2 * 10**3 * (10 / 5 + jump) / (3 * eta * k)
    assert np.trapezoid(rise(1e-4)) / 400 == pytest.approx(expected, rel=1e-3)
    assert 0.7 < rise(5e-3).mean() / (2500 * rise(1e-4).mean()) < 0.97


def test_images_faster_than_sound_are_warned_of(make_case):
    """A step strain of 0.5 in 0.5 at height 8, where sound goes at sqrt(kT/m)."""
    ring = Molecule(length=4, topology="ring", bond=Harmonic(K=2.0))

    def shocks(duration):
        step = StepStrain(strain=0.5, duration=duration, start=10)
        case = make_case((8, 8), thermostat=MaxwellBoltzmann(), molecule=ring)
        case = dataclasses.replace(case, box=Box((8, 8), shear=step))
        return [text for text in derive(case).warnings if "speed of sound" in text]

    (text,) = shocks(0.5)
    assert "up to 8 times the speed of sound" in text
    assert len(shocks(1.9)) == 1 and not shocks(2.1)


def test_the_warm_up_of_sheared_molecules_is_three_relaxation_times(make_case):
    trimer = Molecule(length=3, bond=Harmonic(K=0.4))

    def said(warmup, **shear):
        case = make_case((8, 9), density=9, thermostat=MaxwellBoltzmann(), molecule=trimer,
                         observe=[Stress()], **shear)  # fmt: skip
        found = derive(dataclasses.replace(case, run=Run(steps=400, warmup=warmup)))
        return found.relaxation, [text for text in found.warnings if "warmup" in text]

    (time, name), (text,) = said(0, shear_rate=0.1)
    friction = (
        1 / theory.transport("srd", 2, 9, 0.1, angle=130, thermostat="maxwell-boltzmann").diffusion
    )
    times = theory.rouse_times(theory.linear_modes(3), friction, K=0.4)
    assert time == pytest.approx(times.mode[0], rel=1e-3) and name == "Rouse"
    steps = int(3 * time / 0.1) + 1
    assert f"about {steps} steps" in text
    assert not said(steps, shear_rate=0.1)[1] and not said(0)[1]


@pytest.mark.parametrize(("length", "rate"), [(6, 0.02), (12, 0.0)])
def test_chains_have_their_time_and_weissenberg_number(make_case, length, rate):
    """By Zimm in a fluid, and by Rouse where the solvent is random."""
    bond = Harmonic(K=1.5)
    rows, times = {}, {}
    for solvent in ("fluid", "random"):
        chains = Solutes((Polymer(2, length=length), Polymer(3)), bond=bond, solvent=solvent)
        shear = {"shear_rate": rate} if rate and solvent == "fluid" else {}
        bath = MaxwellBoltzmann()
        case = make_case((20, 20, 20), thermostat=bath, solutes=chains, **shear)
        rows[solvent] = {name: (value, word) for name, value, word in summary(case).rows}
        times[solvent] = longest_relaxation(case)
    assert times["fluid"][1] == "Zimm" and times["random"][1] == "Rouse"
    friction = (
        1 / theory.transport("srd", 3, 10, 0.1, angle=130, thermostat="maxwell-boltzmann").diffusion
    )
    rouse = theory.rouse_times(theory.linear_modes(length), friction, K=1.5).mode[0]
    assert times["random"][0] > 0.5 * rouse > 0.5 * times["fluid"][0]
    assert "slowest mode, Zimm" in rows["fluid"]["relaxation time"][1]
    assert ("Weissenberg number" in rows["fluid"]) is bool(rate)
    number = float(rows["fluid"].get("Weissenberg number", ("0",))[0])
    assert number == pytest.approx(rate * times["fluid"][0], rel=1e-3)


def test_heat_in_a_round_pipe_is_the_work_of_the_force(make_case):
    """A bound: nobody knows what round walls take."""
    walls = [Cylinder([5, 7, 7], radius=6, axis="x", fluid="inside")]
    case = make_case(
        (10, 14, 14), walls=walls, thermostat=NoThermostat(), collision=SRD(),
        force=Uniform([0.02, 0, 0])
    )  # fmt: skip
    found = derive(dataclasses.replace(case, run=Run(steps=100)))
    mean = found.flow_speed / 2
    time = 100 * case.fluid.timestep
    assert found.heating == pytest.approx(2 / 3 * 0.02 * mean * time) and found.heating_bound
    assert found.reynolds == pytest.approx(mean * 12 / found.transport.viscosity)
    assert not [text for text in found.warnings if "solids repeat" in text]


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
