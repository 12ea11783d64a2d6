"""Reduced units in SI: what is said to be matched is the same in both, what is not is not."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path

import h5py
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mesokit
from mesokit import (
    Box,
    Case,
    CaseError,
    Fluid,
    MaxwellBoltzmann,
    OtherFluid,
    Plates,
    Run,
    Simulation,
    Species,
    Uniform,
    Units,
    Water,
    convert,
    derive,
)
from mesokit.case.units import BOLTZMANN
from mesokit.cli import main
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.si import QUANTITIES

MATCHED = {"reynolds": "Reynolds", "peclet": "colloid Peclet", "mach": "Mach",
           "thermal": "thermal noise"}  # fmt: skip
scale = st.floats(-2, 2).map(lambda power: 10**power)


@st.composite
def others(draw: st.DrawFn) -> OtherFluid:
    """Fluids from gases to honey."""
    return OtherFluid(
        density=1000 * draw(scale),
        dynamic_viscosity=1e-3 * draw(scale),
        temperature=draw(st.floats(100, 1000)),
        diffusion=1e-9 * draw(scale),
        sound_speed=draw(st.floats(100, 5000)),
    )


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Slits with a flow, in 2D and 3D, of every fluid, with units of every kind."""
    dimension = draw(st.sampled_from([2, 3]))
    flat = dimension == 2
    return Case(
        run=Run(draw(st.integers(0, 1000)), warmup=100),
        box=Box([8] * dimension),
        fluid=Fluid(
            density=draw(st.floats(3, 30)),
            timestep=draw(st.floats(0.01, 0.1)),
            kT=draw(scale),
            mass=draw(scale),
            force=Uniform([0.001, *[0] * (dimension - 1)]),  # type: ignore[arg-type]
            thermostat=MaxwellBoltzmann(),
        ),
        walls=(Plates("y"),),
        units=Units(
            cell=1e-6 * draw(scale),
            match=draw(st.sampled_from([m for m in MATCHED if not (flat and m == "peclet")])),
            fluid=draw(st.builds(Water, temperature=st.floats(273.15, 373.15)) | others()),
            depth=draw(st.none() | scale.map(lambda x: 1e-6 * x)) if flat else None,
        ),
    )


@given(cases())
def test_numbers_by_hand(case: Case) -> None:
    """Reynolds, Mach, Schmidt and Peclet from the flow, once in reduced and once in SI units."""
    si, numbers = convert(case), derive(case)
    theory, speed, size = numbers.transport, numbers.flow_speed, numbers.flow_size
    assert case.units and theory and speed
    real = case.units.fluid.properties()
    u, length = speed * si.velocity, size * si.length
    assert (si.speed, si.size) == (pytest.approx(u), pytest.approx(length))
    expected = {
        "Reynolds": (numbers.reynolds, real.density * u * length / real.dynamic_viscosity),
        "Mach": (numbers.mach, u / real.sound_speed),
        "Schmidt": (theory.schmidt, real.dynamic_viscosity / real.density / real.diffusion),
        "Peclet": (speed * size / theory.diffusion, u * length / real.diffusion),
    }
    for name, (simulated, there) in expected.items():
        assert si[name].simulated == pytest.approx(simulated)
        assert si[name].real == pytest.approx(there)
        assert si[name].factor == pytest.approx(there / simulated)


@given(cases())
def test_what_is_matched_is_the_same(case: Case) -> None:
    si = convert(case)
    assert case.units
    number = si[MATCHED[case.units.match]]
    assert number.matched and number.verdict == "matched"
    assert number.simulated == pytest.approx(number.real)


@given(cases())
def test_matched_properties_are_those_of_the_real_fluid(case: Case) -> None:
    si, theory = convert(case), setting.transport(case)
    assert case.units and theory
    real = case.units.fluid.properties()
    simulated = {
        "density": setting.mass_density(case) * si.density,
        "dynamic_viscosity": theory.dynamic_viscosity * si.dynamic_viscosity,
        "kT": case.fluid.kT * si.energy,
        "sound_speed": theory.sound_speed * si.velocity,
    }
    for name in mesokit.case.units.MATCHES[case.units.match]:
        assert simulated[name] == pytest.approx(getattr(real, name))


@given(cases())
def test_units_hang_together(case: Case) -> None:
    """Laws of physics hold in SI: the fall in a time, Stokes' force, the ideal gas."""
    si, units = convert(case), case.units
    assert units
    assert si.length == units.cell
    assert si.velocity == pytest.approx(si.length / si.time)
    assert si.velocity**2 / si.length == pytest.approx(si.acceleration)
    assert si.mass * si.velocity**2 == pytest.approx(si.energy)
    assert si.energy == pytest.approx(BOLTZMANN * si.temperature)
    assert si.energy / (si.length**2 * si.depth) == pytest.approx(si.pressure)
    assert si.dynamic_viscosity == pytest.approx(si.density * si.viscosity)
    assert si.dynamic_viscosity * si.depth * si.velocity == pytest.approx(si.force)
    assert si.duration == pytest.approx(
        (case.run.steps + 100) * case.fluid.timestep * si.time
    )  # the warm-up included


@given(cases(), st.floats(0.2, 5))
def test_other_reduced_units_are_the_same_in_si(case: Case, unit: float) -> None:
    """Masses and energies that are all larger by one factor change nothing but the numbers."""
    fluid = dataclasses.replace(case.fluid, mass=case.fluid.mass * unit, kT=case.fluid.kT * unit)
    one, two = convert(case), convert(dataclasses.replace(case, fluid=fluid))
    assert two.time == pytest.approx(one.time)
    assert two.mass * unit == pytest.approx(one.mass)
    for a, b in zip(one.numbers, two.numbers, strict=True):
        assert a.factor == pytest.approx(b.factor) and a.real == pytest.approx(b.real)


def slit(**units: object) -> Case:
    """A 2D slit of water."""
    return Case(
        run=Run(100),
        box=Box([20, 20]),
        fluid=Fluid(force=Uniform((0.001, 0)), thermostat=MaxwellBoltzmann()),
        walls=(Plates("y"),),
        units=Units(**{"cell": 1e-6, "match": "reynolds"} | units),  # type: ignore[arg-type]
    )


def test_a_deeper_slice_weighs_more_and_flows_the_same() -> None:
    thin, deep = convert(slit()), convert(slit(depth=5e-6))
    assert (thin.depth, deep.depth) == (1e-6, 5e-6)
    for name in ("time", "velocity", "acceleration", "pressure", "viscosity", "density"):
        assert getattr(deep, name) == pytest.approx(getattr(thin, name))
    for name in ("mass", "force", "energy"):
        assert getattr(deep, name) == pytest.approx(5 * getattr(thin, name))
    assert "a slice 5e-06 m deep" in str(deep)
    assert "slice" not in str(thin)


def test_brownian_motion_of_a_colloid() -> None:
    """A sphere of 1 um in water at 25 degrees diffuses its radius squared in 4.08 s."""
    case = Case(run=Run(1), box=Box([10, 10, 10]), units=Units(1e-6, "peclet"))
    si, theory = convert(case), setting.transport(case)
    assert theory
    diffusion = case.fluid.kT / (6 * math.pi * theory.dynamic_viscosity)
    assert diffusion * si.viscosity == pytest.approx(2.4535e-13, rel=1e-3)
    assert si.time / diffusion == pytest.approx(4.08, rel=2e-3)
    assert si.temperature == pytest.approx(298.15)


def test_a_fluid_at_rest_has_factors_but_no_numbers() -> None:
    si = convert(Case(run=Run(1), box=Box([10, 10, 10]), units=Units(1e-6, "reynolds")))
    assert si.speed is None and si["Reynolds"].matched
    assert si["Reynolds"].simulated is None and si["Schmidt"].simulated == pytest.approx(16.9, 0.01)
    assert "flow  " not in str(si)


def test_what_is_not_known_is_not_compared() -> None:
    fluid = OtherFluid(density=900, dynamic_viscosity=0.1, temperature=300)
    si = convert(slit(fluid=fluid))
    for name in ("Schmidt", "Mach", "Peclet", "Knudsen"):
        assert si[name].simulated is not None
        assert si[name].real is None and si[name].verdict == "not compared"
    with pytest.raises(KeyError, match="there are Reynolds, Mach"):
        si["Froude"]


def test_a_mixture_has_thermal_units_only() -> None:
    kinds = (Species(mass=1, density=5), Species(mass=4, density=5))
    parts = {"run": Run(1), "box": Box([10, 10, 10]), "fluid": Fluid(species=kinds)}
    si = convert(Case(**parts, units=Units(1e-6, "thermal")))  # type: ignore[arg-type]
    assert si.temperature == pytest.approx(298.15)
    assert 25 * si.density == pytest.approx(997.04, abs=0.1)
    assert si["Reynolds"].factor is None
    with pytest.raises(CaseError, match=r"^units\.match = 'mach': no theory of a mixture; only"):
        Case(**parts, units=Units(1e-6, "mach"))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("units", "words"),
    [
        ({"match": "peclet"}, "units.match = 'peclet': only in 3D"),
        ({"match": "schmidt"}, "Units.match = 'schmidt': expected 'reynolds', 'peclet', 'mach'"),
        ({"cell": 0}, "Units.cell = 0: expected a number of at least 1e-10"),
        ({"cell": "1 um"}, "Units.cell = '1 um': expected a number"),
        ({"depth": -1}, "Units.depth = -1"),
        ({"fluid": {"substance": "wine"}}, "Units.fluid.substance = 'wine': expected 'water'"),
        ({"fluid": {"temperature": 300}}, "Units.fluid.substance: missing"),
        (
            {"fluid": {"substance": "water", "temperature": 25}},
            "Units.fluid.temperature = 25: expected a number of at least 273.15",
        ),
        (
            {"fluid": {"substance": "other", "density": 1, "viscosity": 1, "temperature": 1}},
            "Units.fluid.viscosity: unknown key; did you mean 'dynamic_viscosity'?",
        ),
        (
            {
                "match": "mach",
                "fluid": OtherFluid(density=900, dynamic_viscosity=0.1, temperature=300),
            },
            "units.fluid.sound_speed: missing; units.match = 'mach' needs it",
        ),
    ],
)
def test_refuses(units: dict[str, object], words: str) -> None:
    with pytest.raises(CaseError) as error:
        slit(**units)
    assert str(error.value).startswith(words)


def test_refuses_a_depth_in_3d_fluids_without_theory_and_cases_without_units() -> None:
    box, fluid = Box([10, 10, 10]), Fluid(grid_shift=0.5)
    with pytest.raises(CaseError, match=r"^units\.depth = 1e-06: only in 2D"):
        Case(run=Run(1), box=box, units=Units(1e-6, "thermal", depth=1e-6))
    with pytest.raises(CaseError, match=r"'reynolds': theory needs the full grid shift; only"):
        Case(run=Run(1), box=box, fluid=fluid, units=Units(1e-6, "reynolds"))
    with pytest.raises(CaseError, match=r"^units: missing"):
        convert(Case(run=Run(1), box=box))


KEYS = ["cell", "match", "depth", "fluid", "fluid.substance", "fluid.temperature", "fluid.density"]


@given(
    st.sampled_from(KEYS),
    st.floats() | st.integers() | st.booleans() | st.text(max_size=5) | st.sampled_from(
        [*MATCHED, "water", "other", {"substance": "water"}, 273.15, 1e-10, 1e3, {}, []]
    ),
)  # fmt: skip
def test_any_value_is_a_case_or_one_line(
    tmp_path_factory: pytest.TempPathFactory, key: str, value: object
) -> None:
    path = tmp_path_factory.getbasetemp() / "units.toml"
    path.write_text(slit().to_toml())
    try:
        case = Case.from_toml(path, {f"units.{key}": value})
    except CaseError as error:
        assert len(str(error).splitlines()) == 1 and "units.toml: units" in str(error)
    else:
        assert all(math.isfinite(getattr(convert(case), name)) for name in QUANTITIES)


@pytest.mark.parametrize("match", ["reynolds", "peclet", "mach", "thermal"])
@pytest.mark.parametrize("cell", [1e-10, 1e3])
@pytest.mark.parametrize("density", [1e-3, 1e5])
@pytest.mark.parametrize("viscosity", [1e-8, 1e8])
@pytest.mark.parametrize("temperature", [0.1, 1e5])
def test_the_limits_are_finite(
    match: str, cell: float, density: float, viscosity: float, temperature: float
) -> None:
    fluid = OtherFluid(density, viscosity, temperature, diffusion=1e-25, sound_speed=0.1)
    for kT in (1e-6, 1e6):
        units = Units(cell, match, fluid)  # type: ignore[arg-type]
        timestep = 1e-6 if kT > 1 else 0.1
        case = Case(
            run=Run(1), box=Box([4, 4, 4]), fluid=Fluid(kT=kT, timestep=timestep), units=units
        )
        si = convert(case)
        assert all(0 < getattr(si, name) < math.inf for name in QUANTITIES)


def ends(*arguments: object) -> None:
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    assert not end.value.code


def test_check_info_and_the_files_of_a_run_say_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    case, folder = slit(), tmp_path / "run"
    case = dataclasses.replace(case, run=Run(steps=0))
    (tmp_path / "case.toml").write_text(case.to_toml())
    text = str(convert(case))
    ends("check", tmp_path / "case.toml")
    assert text in capsys.readouterr().out
    Simulation(case, output=folder, threads=1).run()
    ends("info", folder)
    assert text.replace("\n", "\n  ") in capsys.readouterr().out
    si, stored = mesokit.open(folder).si, json.loads((folder / "provenance.json").read_text())
    assert si == convert(case)
    assert stored["units"] == json.loads(json.dumps(si.record()))
    with h5py.File(folder / "run.h5") as file:
        assert file["parameters/units"].attrs["velocity"] == si.velocity
