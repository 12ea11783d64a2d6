"""Profiles and maps of fluids whose flow, density and temperature are known."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    AT,
    Demix,
    DensityField,
    DensityProfile,
    MaxwellBoltzmann,
    Plates,
    Sinusoidal,
    Species,
    Surface,
    TemperatureProfile,
    Uniform,
    VelocityField,
    VelocityProfile,
    theory,
)
from mesokit.errors import CaseError
from mesokit.io.tables import record
from mesokit.method.mpcd.expected import setting
from mesokit.report.caption import compared
from mesokit.report.table import cells
from tests.helpers.comparisons import by_name, comparisons
from tests.helpers.fake_fluid import FakeFluid


def watched(case, observable, flow=None, samples=300, seed=1):
    accumulator, fluid = observable.accumulator(case), FakeFluid(case, seed, flow)
    for _ in range(samples):
        fluid.jump(10)
        accumulator.observe(fluid)
    return accumulator.result()


def poiseuille_case(make_case, **kwargs):
    return make_case(
        (8, 12),
        walls=[Plates(axis="y", **kwargs)],
        force=Uniform((0.02, 0)),
        thermostat=MaxwellBoltzmann(),
    )


def parabola(viscosity, slip=0.0, push=0.02, height=12):
    return lambda y: slip + push * y * (height - y) / (2 * viscosity)


@pytest.mark.parametrize(("force", "what"), [
    (Uniform((0.02, 0)), "viscosity from curvature"),
    (Sinusoidal(amplitude=0.02), "viscosity from amplitude"),
])  # fmt: skip
def test_a_quotient_of_noise_is_undetermined(make_case, force, what):
    """Where the flow cannot be told from none, no viscosity follows from it."""
    walls = [Plates(axis="y")] * isinstance(force, Uniform)
    case = make_case((8, 12), walls=walls, force=force, thermostat=MaxwellBoltzmann())
    flows = {"noise": lambda y: 0 * y, "strong": parabola(setting.transport(case).viscosity)}
    if not walls:
        flows["strong"] = lambda y: np.sin(2 * np.pi * y / 12)
    noise, strong = (
        by_name(watched(case, VelocityProfile(), flows[f])) for f in ("noise", "strong")
    )
    for number in noise.values():
        assert np.isnan([number.measured, number.error, number.deviation, number.percent]).all()
        assert number.note.startswith("its divisor is within two standard errors of zero")
        assert f"{number.what}: undetermined, expected" in str(number)
        assert cells(number)[1] == "undetermined" and cells(number)[4] == ""
        assert record(number)["measured"] is None and "undetermined" in compared([number], 6)
    assert what in noise and noise.keys() == strong.keys()
    assert all(np.isfinite([n.measured, n.error]).all() for n in strong.values())


def test_poiseuille_gives_the_viscosity_that_drove_the_flow(make_case):
    case = poiseuille_case(make_case)
    nu = setting.transport(case).viscosity
    for actual in (nu, 2 * nu):
        result = watched(case, VelocityProfile(), parabola(actual))
        found = by_name(result)
        viscosity = found["viscosity from curvature"]
        assert viscosity.expected == nu
        assert abs(viscosity.measured - actual) < 4 * viscosity.error
        assert viscosity.error < 0.08 * actual
        assert abs(found["slip at the walls"].deviation) < 4
    assert np.abs(result.deviation).max() > 6  # twice the viscosity is not the line
    known, length = setting.transport(case), 96**0.5  # of the box, 2.06 cells the shortest wave
    raised = nu + (1 / nu + 1 / known.sound_attenuation) * np.log(length / 2.06) / (160 * np.pi)
    assert result.extra["raised"] == pytest.approx(result.expected * nu / raised)
    assert result.extra["raised_by"] == pytest.approx(100 * (raised / nu - 1))
    fitted = (result.value - result.fit) / result.error
    assert 0.6 < (fitted**2).mean() < 1.5


def test_short_runs_say_that_the_error_bar_is_a_lower_bound(make_case):
    case = poiseuille_case(make_case)
    nu = setting.transport(case).viscosity
    relaxation = 144 / (np.pi**2 * nu)  # in time; a sample is one time unit
    lengths = {300: "lower bound", int(90 * relaxation): "lower bound"}
    for samples, words in (lengths | {int(130 * relaxation): "independent of slip"}).items():
        found = by_name(watched(case, VelocityProfile(), parabola(nu), samples))
        note = found["viscosity from curvature"].note
        assert words in note
        assert ("lower bound" in str(found["viscosity from curvature"])) == (words == "lower bound")


def test_no_theory_of_the_viscosity_without_the_full_grid_shift(make_case):
    case = make_case(
        (8, 12),
        walls=[Plates(axis="y")],
        force=Uniform((0.02, 0)),
        thermostat=MaxwellBoltzmann(),
        grid_shift=0.5,
    )
    assert setting.transport(case) is None
    result = watched(case, VelocityProfile(), parabola(0.8))
    assert result.expected is None
    viscosity = by_name(result)["viscosity from curvature"]
    assert np.isnan(viscosity.expected) and np.isnan(viscosity.deviation)
    assert str(viscosity).count("(theory needs the full grid shift") == 1


def test_wall_slip_is_read_off(make_case):
    case = poiseuille_case(make_case)
    nu = setting.transport(case).viscosity
    centre = 0.02 * 36 / (2 * nu)
    profile = watched(case, VelocityProfile(), parabola(nu, slip=0.2 * centre), samples=600)
    slip = by_name(profile)["slip at the walls"]
    assert abs(slip.measured - 100 * 0.2 / 1.2) < 4 * slip.error
    assert slip.error < 3


def test_error_of_the_fit_knows_that_bins_rise_and_fall_together(make_case):
    """Noise in the curvature that all bins share must show in the error bar of the viscosity."""
    case = poiseuille_case(make_case)
    rng = np.random.default_rng(5)
    viscosities, errors = [], []
    for seed in range(12):
        accumulator, fluid = VelocityProfile().accumulator(case), FakeFluid(case, seed)
        noise = 0.0
        for _ in range(100):
            fluid.jump(10)
            noise = 0.7 * noise + rng.normal()
            push = 0.02 * (1 + 0.5 * noise)
            fluid.flow = parabola(0.85, push=push)
            accumulator.observe(fluid)
        found = by_name(accumulator.result())["viscosity from curvature"]
        viscosities.append(found.measured)
        errors.append(found.error)
    spread = np.std(viscosities, ddof=1)
    assert 0.5 < np.sqrt(np.mean(np.square(errors))) / spread < 1.7


def test_couette(make_case):
    walls = [Plates(axis="y", lower=Surface(velocity=(-0.5, 0)), upper=Surface(velocity=(0.5, 0)))]
    case = make_case((8, 12), walls=walls, thermostat=MaxwellBoltzmann())
    found = by_name(watched(case, VelocityProfile(), lambda y: (y - 6) / 12))
    assert found["shear rate"].expected == pytest.approx(1 / 12)
    assert abs(found["shear rate"].deviation) < 4
    slipping = by_name(watched(case, VelocityProfile(), lambda y: 0.8 * (y - 6) / 12))
    slip = slipping["slip at the walls"]
    assert abs(slip.measured - 10) < 4 * slip.error
    assert slip.measured > 5 * slip.error
    relaxation = 144 / (np.pi**2 * setting.transport(case).viscosity)  # a sample is a time unit
    for times, short in ((20, True), (130, False)):
        seen = watched(case, VelocityProfile(), lambda y: (y - 6) / 12, int(times * relaxation))
        numbers = by_name(seen)
        assert numbers["shear rate"].lower_bound is short
        assert numbers["slip at the walls"].lower_bound is short


def test_lees_edwards_line_and_staircase(make_case):
    case = make_case((8, 8), shear_rate=0.2, thermostat=MaxwellBoltzmann())
    observable = VelocityProfile(bins_per_cell=8)
    line = by_name(watched(case, observable, lambda y: 0.2 * (y - 4), samples=600))
    assert abs(line["shear rate"].deviation) < 4
    assert abs(line["chi-square per degree of freedom"].deviation) < 4
    stairs = by_name(
        watched(case, observable, lambda y: 0.2 * (np.floor(y) + 0.5 - 4), samples=600)
    )
    assert stairs["chi-square per degree of freedom"].deviation > 5


def test_kolmogorov(make_case):
    force = Sinusoidal(amplitude=0.05)
    case = make_case((12, 12), force=force, thermostat=MaxwellBoltzmann())
    k = 2 * np.pi / 12
    nu = 1.3 * setting.transport(case).viscosity
    result = watched(case, VelocityProfile(), lambda y: 0.05 / (nu * k**2) * np.sin(k * y))
    found = result.comparisons[0]
    assert abs(found.measured - nu) < 4 * found.error and found.error < 0.05 * nu


@pytest.mark.parametrize(
    ("plates", "expected"),
    [
        ({"upper": Surface(rule="slip")}, lambda y: y * (24 - y)),
        ({"lower": Surface(rule="slip")}, lambda y: 144 - y * y),
    ],
)
def test_expected_flow_with_one_slip_plate(make_case, plates, expected):
    walls = [Plates(axis="y", **plates)]
    case = make_case((8, 12), walls=walls, force=Uniform((0.02, 0)), thermostat=MaxwellBoltzmann())
    y = np.linspace(0, 12, 30)
    nu = setting.transport(case).viscosity
    assert setting.flow(case, 0).profile(y) == pytest.approx(0.02 * expected(y) / (2 * nu))


def test_expected_flow_of_drive_and_moving_plate_add_up(make_case):
    walls = [Plates(axis="y", lower=Surface(velocity=(1, 0)))]
    case = make_case((8, 12), walls=walls, force=Uniform((0.02, 0)))
    y = np.linspace(0, 12, 30)
    expected = 1 - y / 12 + 0.02 * y * (12 - y) / (2 * setting.transport(case).viscosity)
    assert setting.flow(case, 0).profile(y) == pytest.approx(expected)


def test_bin_average_is_exact_for_parabolas():
    edges = np.linspace(0, 3, 4)
    assert setting.bin_average(lambda y: y**2, edges) == pytest.approx([1 / 3, 7 / 3, 19 / 3])


def test_temperature_is_unbiased_in_slices_with_few_particles(make_case):
    """About 1 particle in a slice: taking off the slice's own mean would halve the result."""
    case = make_case((2, 8), density=4, kT=2.0, mass=3.0, thermostat=MaxwellBoltzmann())
    result = watched(case, TemperatureProfile(bins_per_cell=8), samples=3000)
    mean = by_name(result)["mean temperature"]
    assert abs(mean.deviation) < 4 and mean.error < 0.01 * 2
    assert abs(by_name(result)["chi-square per degree of freedom"].deviation) < 4


def test_temperature_about_a_flow(make_case):
    case = make_case((4, 8), collision=AT(), shear_rate=0.5)
    result = watched(case, TemperatureProfile(), lambda y: 0.5 * (y - 4), samples=500)
    mean = by_name(result)["mean temperature"]
    assert abs(mean.measured - (1 + 0.25 / 16 / 24)) < 4 * mean.error < 0.03
    warming = theory.shear_warming("at", 2, 10, 0.1)
    assert result.expected == pytest.approx(np.full(32, 1 + 0.25 * (1 / 16 / 24 + warming)))
    assert mean.approximate  # molecular chaos


def test_temperature_across_another_axis_than_the_flow(make_case):
    """The flow, a multiple of kT at the edge of the box, is not counted."""
    case = make_case((4, 8), collision=AT(), shear_rate=0.5)
    profile = TemperatureProfile(axis="x")
    result = watched(case, profile, lambda y: 0.5 * (y - 4), samples=500)
    mean = by_name(result)["mean temperature"]
    assert abs(mean.measured - (1 + 0.25 / 16 / 24)) < 4 * mean.error < 0.03
    assert result.value.shape == (16,)
    assert np.abs(result.value - 1).max() < 6 * result.error.max()
    accumulator = profile.accumulator(case)
    again = profile.accumulator(case)
    accumulator.observe(FakeFluid(case))
    again.restore(accumulator.state())
    assert again.result() == accumulator.result()


def test_density_uniform_and_depleted(make_case):
    case = make_case((8, 8), walls=[Plates(axis="y")])
    result = watched(case, DensityProfile())
    assert np.abs(result.deviation).max() < 5
    assert all(abs(c.deviation) < 4 for c in comparisons(result))
    assert len(result.comparisons) == 3
    accumulator, fluid = DensityProfile().accumulator(case), FakeFluid(case)
    for _ in range(300):
        fluid.jump(10)
        close = fluid.unwrapped[:, 1] < 1
        fluid.unwrapped[close & (fluid.rng.random(fluid.n) < 0.1), 1] += 3
        accumulator.observe(fluid)
    assert by_name(accumulator.result())["density in the cell at the lower plate"].deviation < -5


def test_density_of_a_mixture_is_that_of_all_its_species(make_case):
    """Beside theory all particles, or those of one species; of a fluid that demixes, nothing."""
    kinds = (Species(1.0, 6.0), Species(4.0, 3.0))
    case = make_case((8, 8), species=kinds)
    for kind, density in ((None, 9.0), (1, 6.0), (2, 3.0)):
        result = watched(case, DensityProfile(kind=kind), samples=100)
        assert result.expected == pytest.approx(np.full(32, density))
        assert result.value.mean() == pytest.approx(density)  # the offset: chi-square leaves it out
    with pytest.raises(CaseError, match="kind = 3"):
        make_case((8, 8), [DensityProfile(kind=3)], species=kinds)
    even = (Species(1.0, 5.0), Species(1.0, 5.0))
    apart = watched(make_case((8, 8), species=even, collision=Demix()), DensityProfile())
    assert apart.expected is None and not apart.comparisons


def test_chi_square_of_a_profile_that_forgets_slowly(make_case):
    """Waves that outlast the blocks of a run are left out; without that it is about 2."""
    case = make_case((16, 2))
    found = []
    for seed in range(10):
        accumulator = DensityProfile("x").accumulator(case)
        fluid = FakeFluid(case, seed, kept=0.6)  # diffusion coefficient 0.2
        for _ in range(60):
            fluid.advance(10)
            accumulator.observe(fluid)
        found.append(accumulator.result()["chi-square"])
    assert all("longest modes" in c.note for c in found)
    z = np.array([c.deviation for c in found])
    assert abs(z.mean()) < 3 / len(z) ** 0.5


def test_barometric_density_keeps_the_number(make_case):
    case = make_case((8, 8), walls=[Plates(axis="y")], force=Uniform((0, -0.3)))
    expected = DensityProfile().accumulator(case).result().expected
    assert expected.mean() == pytest.approx(10)
    assert np.log(expected[0] / expected[-1]) == pytest.approx(0.3 * (8 - 0.25))


def test_fields(make_case):
    case = poiseuille_case(make_case)
    nu = setting.transport(case).viscosity
    velocity = watched(case, VelocityField(), parabola(nu))
    assert velocity.value.shape == (8, 12, 2)
    assert np.abs(velocity.deviation[..., 0]).max() < 6
    assert 0.7 < np.nanmean(velocity.deviation**2) < 1.4
    swapped = watched(case, VelocityField(axes=("y", "x")), parabola(nu))
    assert swapped.value.shape == (12, 8, 2)
    assert np.abs(swapped.deviation[..., 0]).max() < 6
    density = watched(case, DensityField(bins_per_cell=2))
    assert density.value.shape == (16, 24)
    assert density.value.mean() == pytest.approx(10)


def test_axes_that_are_not_there(make_case):
    for wrong in (
        VelocityProfile(axis="z"),
        VelocityProfile(component="z"),
        DensityField(axes=("x", "z")),
    ):
        with pytest.raises(CaseError, match="2D box has only"):
            make_case(observe=[wrong])
    with pytest.raises(CaseError, match="two different axes"):
        make_case(observe=[VelocityField(axes=("x", "x"))])


SHEARED = {"shear_rate": 0.1}
ALONG_Z = {"walls": [Plates("y")], "force": Uniform((0, 0, 0.1))}
DRAGGED = {"walls": [Plates("x", upper=Surface(velocity=(0, 0, 0.1)))]}
CARRIED = {"walls": [Plates("y", *[Surface(velocity=(0, 0, 0.1))] * 2)]}
SLIPPERY = {"walls": [Plates("y", *[Surface(rule="slip")] * 2)], "force": Uniform((0, 0, 0.1))}
OBLIQUE = {"walls": [Plates("y")], "force": Uniform((0.1, 0, 0.1))}
SINE = {"force": Sinusoidal(amplitude=0.1, flow="y", gradient="x")}


@pytest.mark.parametrize(
    ("axis", "parts", "seen"),
    [
        ("y", SHEARED, "x"), ("y", ALONG_Z, "z"), ("x", DRAGGED, "z"), ("y", CARRIED, "z"),
        ("y", SLIPPERY, "z"), ("x", SINE, "y"), ("y", OBLIQUE, "x"), ("y", {}, "x"), ("x", {}, "y"),
    ],
)  # fmt: skip
def test_the_velocity_is_that_of_the_flow_unless_said(make_case, axis, parts, seen):
    case = make_case((6, 6, 6), thermostat=MaxwellBoltzmann(), **parts)
    result = VelocityProfile(axis=axis).accumulator(case).result()
    assert (result.label, result.extra["component"]) == (f"velocity v_{seen}", seen)
    said = VelocityProfile(axis=axis, component="x").accumulator(case).result()
    assert said.label == "velocity v_x"
