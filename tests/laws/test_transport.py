"""How fast momentum, particles and sound travel."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

from mesokit import AT, SRD, theory
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.small_fluids import KNOWN, Measured, make_fluid, mean, shear_viscosity

# Molecular chaos leaves out correlated collisions (1 to 2 %) and the loop of fluctuations (1 to
# 2 % at ten particles per cell); a wave 16 cells long sees 1 % less of the transfer within cells.
CHAOS = 0.03


def expected(rule, **parameters):
    angle = getattr(rule, "angle", None)
    return theory.transport(rule.rule, 3, angle=angle, **parameters)


@pytest.mark.parametrize("rule", KNOWN, ids=lambda rule: rule.__name__)
def test_viscosity(rule):
    nu = expected(rule(), density=10, timestep=0.1).viscosity
    found = shear_viscosity(16, runs=2, viscosity=nu, collision=rule())
    assert found.error < 0.02 * nu
    assert found.agrees(nu, systematic=CHAOS), (found, nu)


def test_viscosity_is_galilean_invariant_with_grid_shift():
    """Particles that fly a tenth of a cell meet the same others again, unless the cells move."""
    shape = {"length": 12, "amplitude": 0.6, "runs": 6, "decays": 2.0}
    at_rest, moving = (shear_viscosity(drift=u, **shape) for u in (0.0, 0.7))
    error = np.hypot(at_rest.error, moving.error)
    assert Measured(moving.value - at_rest.value, error).agrees(0.0), (at_rest, moving)
    fixed_cells = {"grid_shift": 0.0, "timestep": 0.05}
    stuck, freed = (shear_viscosity(drift=u, **shape, **fixed_cells) for u in (0.0, 0.7))
    error = np.hypot(stuck.error, freed.error)
    assert abs(freed.value - stuck.value) > 5 * error, (stuck, freed)


def diffusion(length, lag, origins, **parts):
    """Mean square displacement over `lag` steps / (6 t), from origins one lag apart, at kT = 1.

    The drawn energy, which a small box keeps, makes it a per cent hotter or colder.
    """
    fluid = make_fluid((length,) * 3, **parts)
    fluid.advance(50)
    kT = 2 * fluid.totals()[2] / (3 * fluid.n)
    samples, old = [], fluid.positions(unwrapped=True)
    for _ in range(origins):
        fluid.advance(lag)
        new = fluid.positions(unwrapped=True)
        samples.append(np.sum((new - old) ** 2) / (6 * lag * fluid.numbers.timestep * fluid.n * kT))
        old = new
    return mean(samples)


def chaos_diffusion(lag, **parameters):
    """The same from theory.

    The diffusion coefficient itself is reached only for long lags.
    """
    coefficient = theory.transport("srd", 3, **parameters).diffusion
    dt = parameters["timestep"]
    g = theory.decorrelation_from_diffusion(coefficient, dt)
    return float(theory.msd_molecular_chaos(lag, dt, g, 3)) / (6 * lag * dt)


def test_self_diffusion_where_particles_fly_far():
    parameters = {"density": 5, "timestep": 1.0}
    found = diffusion(12, 20, 20, collision=SRD(angle=90), **parameters)
    wanted = chaos_diffusion(20, angle=90, **parameters)
    # 1.376(6) of an independent simulation against 1.3718: half a per cent is not chaos
    assert found.agrees(wanted, systematic=0.01), (found, wanted)


def test_self_diffusion_where_particles_stay_together():
    """The flow that a particle stirs up carries it on."""
    parameters = {"density": 10, "timestep": 0.1}
    found = diffusion(12, 200, 10, collision=SRD(angle=130), **parameters)
    alone = theory.transport("srd", 3, angle=130, **parameters)
    wanted = theory.self_diffusion(3, alone.diffusion, alone.viscosity, 10, [12] * 3)
    # a lag of 20, in which momentum crosses the box six times; theory is good to 1 %
    assert found.agrees(wanted, systematic=0.02), (found, wanted)
    assert found.value > 1.08 * chaos_diffusion(200, angle=130, **parameters)


def ringing(t, damping, frequency, cosine, sine):
    return np.exp(-damping * t) * (cosine * np.cos(frequency * t) + sine * np.sin(frequency * t))


def sound_speed(collision, seed, size=(32, 8, 8), amplitude=0.15):
    """Speed of a standing wave of sound from its frequency and damping."""
    fluid = make_fluid(size, collision=collision, seed=seed)
    k = 2 * np.pi / size[0]
    r, v = fluid.positions(), fluid.velocities()
    v[:, 0] += amplitude * np.sin(k * r[:, 0])
    start(fluid, r, v)
    time, wave = [], []
    for _ in range(70):
        _, momentum = fluid.modes(np.array([[k, 0.0, 0.0]]))
        time.append(fluid.time)
        wave.append(-2 * momentum[0, 0].imag / fluid.n)
        fluid.advance(5)
    guess = [0.5 * k * k, 1.1 * k, amplitude, 0.0]
    (damping, frequency, *_), _ = curve_fit(ringing, time, wave, guess)
    return np.hypot(damping, frequency) / k


@pytest.mark.parametrize("collision", [SRD(), AT()], ids=["adiabatic", "isothermal"])
def test_sound_speed(collision):
    wanted = expected(collision, density=10, timestep=0.1).sound_speed
    found = mean([sound_speed(collision, seed) for seed in range(1, 9)])
    assert found.error < 0.01 * wanted
    assert found.agrees(wanted, systematic=0.01), (found, wanted)
