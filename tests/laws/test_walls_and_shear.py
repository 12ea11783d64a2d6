"""Flow between plates and in a sheared box."""

import numpy as np
import pytest
from scipy import stats

from mesokit import SRD, MaxwellBoltzmann, Plates, Surface, Uniform, WallStress, theory
from mesokit.errors import CaseError
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start
from mesokit.statistics import weighted_line
from tests.helpers.small_fluids import Measured, make_case, make_fluid, mean

LENGTH, HEIGHT = 48, 16
BINS = 2 * HEIGHT
Y = (np.arange(BINS) + 0.5) / 2
INSIDE = (Y > 1) & (Y < HEIGHT - 1)  # the cells next to the plates obey no-slip only roughly
NU = theory.transport("srd", 2, 10, 0.1, angle=90).viscosity  # 1.5 % of it are fluctuations


def slit(acceleration=0.0, speed=0.0, virtual="fill", **parts):
    """A 2D slit whose plates move at -speed and speed."""
    lower, upper = (Surface(velocity=(u, 0.0)) for u in (-speed, speed))
    return make_fluid(
        (LENGTH, HEIGHT), walls=[Plates(axis="y", lower=lower, upper=upper, virtual=virtual)],
        force=Uniform(acceleration=(acceleration, 0.0)), collision=SRD(angle=90),
        thermostat=MaxwellBoltzmann(), **parts,
    )  # fmt: skip


def profile(fluid, warmup, blocks, steps=500):
    """Velocity (blocks, BINS) and density, each the mean over some relaxation times."""
    fluid.advance(warmup)
    velocity, density = [], []
    for _ in range(blocks):
        sums = np.zeros((2, BINS))
        for _ in range(steps // 10):
            fluid.advance(10)
            number, mass, momentum, _ = fluid.moments((1,), (BINS,))
            sums += mass, momentum[0]
            assert number.sum() == fluid.n
        velocity.append(sums[1] / sums[0])
        density.append(sums[0] / (steps // 10))
    return np.array(velocity), np.array(density)


@pytest.fixture(scope="module")
def poiseuille():
    return driven("fill")


def driven(virtual):
    """Acceleration, top speed, velocity and density of a driven slit, from its expected state."""
    top = 0.4
    g = 8 * NU * top / HEIGHT**2
    fluid = slit(g, virtual=virtual)
    r, v = fluid.positions(), fluid.velocities()
    v[:, 0] += theory.poiseuille_velocity(r[:, 1], HEIGHT, g, NU)
    start(fluid, r, v)
    return g, top, *profile(fluid, 2000, 40)


def test_virtual_particles_that_go_on_with_the_flow_leave_no_slip():
    """At rest with the plate they leave a slip length of a fifth of a cell."""
    g, top, velocity, _ = driven("extrapolate")
    slip = mean([theory.poiseuille_fit(Y[INSIDE], v[INSIDE], HEIGHT, g).slip for v in velocity])
    assert slip.error * HEIGHT / (4 * top) < 0.03
    assert slip.agrees(0.0), slip


def test_poiseuille_flow_is_the_parabola_of_the_viscosity(poiseuille):
    g, top, velocity, _ = poiseuille
    fits = [theory.poiseuille_fit(Y[INSIDE], v[INSIDE], HEIGHT, g) for v in velocity]
    nu, slip = mean([f.viscosity for f in fits]), mean([f.slip for f in fits])
    assert nu.error < 0.015 * NU
    # 2 %: molecular chaos, fluctuations of a small 2D box (0.749 of an independent simulation)
    assert nu.agrees(NU, systematic=0.03), (nu, NU)
    # as far behind the plate as a straight profile would vanish: a fifth of a cell (3 % of the
    # velocity in the middle of a slit 24 to 32 cells high); without virtual particles one cell
    behind = HEIGHT / (4 * top)
    assert abs(slip.value) * behind < 0.25 + 3 * slip.error * behind, slip
    middle = theory.poiseuille_fit(Y[INSIDE], velocity.mean(axis=0)[INSIDE], HEIGHT, g)
    parabola = middle.slip + theory.poiseuille_velocity(Y, HEIGHT, g, middle.viscosity)
    away = abs(velocity.mean(axis=0) - parabola)[INSIDE]
    assert (away < 4 * (velocity.std(axis=0) / np.sqrt(len(velocity)))[INSIDE]).all()
    assert away.max() < 0.02 * top


def test_density_is_uniform_up_to_the_plates(poiseuille):
    density = poiseuille[3] / (LENGTH * 0.5)
    error = density.std(axis=0, ddof=1) / np.sqrt(len(density))
    chi2 = np.sum(((density.mean(axis=0) - 10) / error) ** 2)
    # blocks of 40: the estimated errors make it an F rather than a chi-square distribution
    assert stats.f.sf(chi2 / BINS, BINS, len(density) - 1) > 1e-3


def test_couette_flow_is_linear_and_not_damped():
    u = 0.4
    fluid = slit(speed=u)
    r, v = fluid.positions(), fluid.velocities()
    v[:, 0] += theory.couette_velocity(r[:, 1], HEIGHT, -u, u)
    start(fluid, r, v)
    velocity, _ = profile(fluid, 1500, 16)
    fits = np.array([np.polynomial.polynomial.polyfit(Y[INSIDE], v[INSIDE], 2) for v in velocity])
    lines = [np.polynomial.polynomial.polyfit(Y[INSIDE] - HEIGHT / 2, v[INSIDE], 1)
             for v in velocity]  # fmt: skip
    slope = mean([line[1] for line in lines])
    assert slope.agrees(2 * u / HEIGHT, systematic=0.01), slope
    assert mean([line[0] for line in lines]).agrees(0.0)
    assert mean(fits[:, 2]).agrees(0.0)


@pytest.mark.long
def test_a_thin_fluid_slips_as_virtual_particles_know_nothing_of_its_stress():
    """Slip length 0.13 where theory says 0.16, standard error 0.016."""
    u, density, timestep = 0.4, 3, 1.0
    lower, upper = (Surface(velocity=(v, 0.0)) for v in (-u, u))
    fluid = make_fluid(
        (250, HEIGHT), walls=[Plates(axis="y", lower=lower, upper=upper)], density=density,
        timestep=timestep, collision=SRD(angle=130), thermostat=MaxwellBoltzmann(),
    )  # fmt: skip
    r, v = fluid.positions(), fluid.velocities()
    v[:, 0] += theory.couette_velocity(r[:, 1], HEIGHT, -u, u)
    start(fluid, r, v)
    velocity, _ = profile(fluid, 2000, 24)
    lines = [np.polynomial.polynomial.polyfit(Y[INSIDE], v[INSIDE], 1) for v in velocity]
    rate = mean([line[1] for line in lines])
    slip = Measured(u / rate.value - HEIGHT / 2, u * rate.error / rate.value**2)
    expected = theory.virtual_gas_slip(
        "srd", 2, density, timestep, angle=130, thermostat="maxwell-boltzmann"
    )
    assert slip.error < 0.02 and slip.value > 6 * slip.error, slip
    assert slip.agrees(expected, systematic=0.3), (slip, expected)


@pytest.mark.parametrize("virtual", ["fill", "none"])
def test_what_the_force_gives_the_walls_take(virtual):
    """Momentum balance of the fluid, to rounding, step by step."""
    g, u = 0.03, 0.2
    fluid = slit(g, u, virtual, measures=("walls",))
    fluid.advance(7)
    assert fluid.wall_steps == 7
    before, at_first = fluid.totals()[1], fluid.wall_impulse
    fluid.advance(50)
    gained = fluid.totals()[1] - before
    taken = (fluid.wall_impulse - at_first)[:, :2]
    assert fluid.wall_steps == 57
    given = np.array([fluid.n * g * 50 * fluid.numbers.timestep, 0.0])
    np.testing.assert_allclose(gained + taken.sum(axis=0), given, atol=1e-7)
    # pressure on each plate: an ideal gas of density 10, 5 % by chance
    pressure = taken[:, 1] / (50 * fluid.numbers.timestep * LENGTH)
    np.testing.assert_allclose(pressure, [-10, 10], rtol=0.2)


def test_wall_stress_is_refused_where_it_is_not_counted():
    with pytest.raises(CaseError, match="top-up"):
        make_case(
            (4, 4), walls=[Plates(axis="y", virtual="top-up")], observe=[WallStress()]
        )  # fmt: skip


def test_sheared_box_has_a_linear_profile():
    """From rest: the sliding images alone set the fluid in motion."""
    rate, size = 0.1, (8, 12, 10)
    case = make_case(size, shear_rate=rate, thermostat=MaxwellBoltzmann())
    fluid = CPU(case)
    random = np.random.default_rng(2)
    n = case.particles
    start(fluid, random.random((n, 3)) * size, random.standard_normal((n, 3)))
    fluid.advance(1200)  # seven times L^2/(pi^2 nu)
    y = np.arange(0.05, 12, 0.1)
    slopes, shapes = [], []
    for _ in range(40):
        sums = np.zeros((2, 120))
        for _ in range(40):
            fluid.advance(5)
            _, mass, momentum, _ = fluid.moments((1,), (120,))
            sums += mass, momentum[0]
        v = sums[1] / sums[0]
        fit = weighted_line(y - 6, v, 1.0)
        slopes.append(fit.coefficients[1])
        shapes.append(v - fit.coefficients[0])
    slope = mean(slopes)
    assert slope.error < 0.01 * rate
    assert slope.agrees(rate), slope
    shape = np.mean(shapes, axis=0)
    assert np.sqrt(np.mean((shape - rate * (y - 6)) ** 2)) < 0.01 * rate * 12
