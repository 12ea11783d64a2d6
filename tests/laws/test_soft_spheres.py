"""Soft spheres: collisions of two, what is kept, fluids beside other programs."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

from mesokit import (
    HertzLaw,
    Langevin,
    LennardJones,
    Plates,
    RescaleAll,
    SpringDashpot,
    theory,
)
from mesokit.potential.wca import WCA
from tests.helpers.soft_spheres import at_rest, collision, lennard_jones, soft, total

PHASES = np.arange(10) / 10  # of the first touch within a step


@pytest.mark.parametrize("law", [
    SpringDashpot(stiffness=1e5, damping=20), SpringDashpot(stiffness=1e5, damping=20, pulls=False),
    SpringDashpot(stiffness=1e5, damping=400, pulls=False), SpringDashpot(0.5, contact_time=0.01),
])  # fmt: skip
def test_two_spheres_bounce_as_schwager_and_poschel_say(law):
    # of second order in the step; what it depends on when within a step they touch is small too
    expected = law.restitution_of(0.5, 1.0)
    at = {n: np.array([collision(law, 1.0, n, p)[1] for p in PHASES]) for n in (50, 200)}
    assert abs(at[50].mean() / expected - 1) < 0.001 > at[50].std() / expected
    assert abs(at[200].mean() - expected) < abs(at[50].mean() - expected) / 8 + 1e-6


def test_a_collision_takes_the_contact_time():
    law = SpringDashpot(restitution=0.8, contact_time=0.01)
    times = [collision(law, 1.0, 50, phase)[2] for phase in PHASES]
    assert abs(np.mean(times) / 0.01 - 1) < 0.015  # steps are a fiftieth
    _, _, _, deepest = collision(SpringDashpot(stiffness=1e5, damping=0), 1.0, 200)
    assert abs(deepest / math.sqrt(0.5 / 1e5) - 1) < 1e-3


def test_hertz_spheres_press_and_part_as_hertz_says():
    law = HertzLaw(stiffness=1e5)
    expected = theory.hertz_contact(1e5, 0.5, 1.0)
    _, restitution, time, deepest = collision(law, 1.0, 1000)
    assert abs(deepest / expected.overlap - 1) < 1e-3
    assert abs(time / expected.time - 1) < 2e-3
    assert abs(restitution - 1) < 1e-4


def test_slow_viscoelastic_spheres_lose_what_schwager_and_poschel_say():
    law = HertzLaw(stiffness=1e5, damping=1e-5)
    expected = 1 - law.restitution_of(0.5, 0.01)
    _, restitution, _, _ = collision(law, 0.01, 1000)
    assert abs((1 - restitution) / expected - 1) < 0.02


def test_a_fluid_keeps_momentum_to_rounding_and_energy_to_the_square_of_the_step():
    engine = lennard_jones(0.005)
    engine.advance(400)
    state, errors = engine.state(), []
    for timestep in (0.004, 0.002):
        engine = lennard_jones(timestep)
        engine.restore({name: array.copy() for name, array in state.items()})
        first, energies = total(engine), []
        for _ in range(100):
            engine.advance(round(0.02 / timestep))
            energies.append(total(engine) - first)
        errors.append(np.std(energies))
        assert np.abs(engine.totals()[1]).max() < 1e-12 * math.sqrt(400)
    assert abs(errors[0] / errors[1] - 4) < 0.6


def test_a_fluid_runs_backwards():
    engine = lennard_jones()
    engine.advance(100)
    before = engine.positions(unwrapped=True)
    engine.advance(60)
    engine.system.bodies.velocity[:, :3] *= -1
    engine.advance(60)
    assert np.abs(engine.positions(unwrapped=True) - before).max() < 1e-8


def test_a_configuration_has_the_energy_and_virial_of_nist():
    # 30 particles, NIST Standard Reference Simulation Website, configuration 4
    places = np.loadtxt(Path(__file__).parent / "nist_lj_cfg4.txt") + 4.0
    law = LennardJones(cutoff=3.0, shift=False)
    engine = soft([8.0, 8.0, 8.0], given=at_rest(places), number=30, pair=law)
    assert abs(engine.energies()["contact"] + 16.790) < 0.0005
    assert abs(abs(np.trace(engine.stress["pair"]) * 512) - 46.249) < 0.0005
    i, j = np.triu_indices(30, 1)  # all six components, pair by pair: F = 24 (2/r^12 - 1/r^6) r/r^2
    way = (places[i] - places[j] + 4.0) % 8.0 - 4.0
    square = (way**2).sum(axis=1)
    pull = np.where(square < 9, 24 * (2 / square**6 - 1 / square**3) / square, 0.0)
    stress = -np.einsum("p,pa,pb->ab", pull, way, way) / 512
    np.testing.assert_allclose(engine.stress["pair"], stress, atol=1e-7)


@pytest.mark.parametrize("law", [LennardJones(), WCA()])
def test_a_dilute_gas_has_the_pressure_of_the_second_virial_coefficient(law):
    # equal to first order in density: the third coefficient is within the tolerance
    size, number, kT = 30.0, 800, 2.0
    engine = soft(
        [size] * 3, number=number, kT=kT, pair=law, timestep=0.005,
        thermostat=RescaleAll(kT=kT, every=5),
    )  # fmt: skip
    engine.advance(2000)
    found = []
    for _ in range(120):
        engine.advance(50)
        found.append(-np.trace(engine.stress["pair"]) / 3)
    density = number / size**3
    from scipy.integrate import quad

    from mesokit.potential.protocol import central

    kernel = law.kernel()
    second = -2 * math.pi * quad(
        lambda r: r * r * math.expm1(-central(kernel, r * r)[0] / kT), 0.0, law.reach, limit=200
    )[0]  # fmt: skip
    expected = second * density**2 * kT
    blocks = np.mean(np.reshape(found, (12, 10)), axis=1)
    error = blocks.std(ddof=1) / math.sqrt(12)
    third = 3.0 * density**3 * kT  # of spheres of this size, at most
    assert abs(np.mean(found) - expected) < 4 * error + third


def test_a_bath_holds_the_temperature():
    engine = soft(
        [10.0, 10.0, 10.0], number=400, kT=0.1, pair=WCA(), timestep=0.005,
        thermostat=Langevin(kT=1.5, friction=2.0),
    )  # fmt: skip
    engine.advance(1000)
    found = []
    for _ in range(200):
        engine.advance(40)
        found.append(engine.totals()[2] / 600)
    blocks = np.mean(np.reshape(found, (20, 10)), axis=1)
    assert abs(blocks.mean() - 1.5) < 4 * blocks.std(ddof=1) / math.sqrt(20)


def test_elastic_grains_keep_energy_momentum():
    # energies of pairs at contact are of second order in the step, and do not drift
    places = np.array(list(itertools.product(range(6), range(6)))) * 1.6 + 0.8
    engine = soft(
        [9.6, 9.6], given={"positions": places}, number=36, kT=1.0,
        pair=SpringDashpot(1.0, contact_time=0.01),
    )  # fmt: skip
    first = total(engine)
    engine.advance(50_000)
    assert abs(total(engine) / first - 1) < 1e-3
    assert np.abs(engine.totals()[1]).max() < 1e-12


def test_each_grain_of_a_column_bears_those_above():
    number, law = 20, SpringDashpot(0.3, contact_time=0.02)
    places = np.array([[2.0, 0.5 + i] for i in range(number)])
    engine = soft(
        [4.0, 22.0], walls=[Plates("y")], given=at_rest(places), number=number, pair=law,
        gravity=[0.0, -1.0],
    )  # fmt: skip
    engine.advance(200_000)
    y = engine.positions()[:, 1]
    k, _ = law.constants(0.5)
    forces = k * (1 - np.diff(y))
    assert np.allclose(forces, number - 1 - np.arange(number - 1), rtol=1e-3)
    wall, _ = law.constants(1.0)
    assert abs(wall * (0.5 - y[0]) / number - 1) < 1e-3


@pytest.mark.parametrize(("friction", "rolls"), [(0.5, False), (0.2, True)])
def test_a_ball_on_a_slope_rolls_until_friction_is_too_weak(friction, rolls):
    # a = g sin/(1 + I/m r^2) while tan < mu (1 + m r^2/I), else g (sin - mu cos)
    angle = math.radians(40)
    gravity = 10 * np.array([math.sin(angle), -math.cos(angle)])
    law = SpringDashpot(0.3, contact_time=0.02, friction=friction)
    engine = soft(
        [30.0, 5.0], walls=[Plates("y")], given=at_rest([[1.0, 0.5]]), number=1, pair=law,
        gravity=list(gravity),
    )  # fmt: skip
    engine.advance(4000)
    v, t = engine.velocities()[0, 0], engine.time
    limit = friction * (1 + 2)  # a disk: m r^2/I = 2
    assert (math.tan(angle) < limit) is not rolls
    rolling = 10 * math.sin(angle) / 1.5
    sliding = 10 * (math.sin(angle) - friction * math.cos(angle))
    assert abs(v / t / (sliding if rolls else rolling) - 1) < 0.01


def block(angle, tangential, rolling):
    """A disk that rolling resistance holds on a slope: how far it has gone after a while, and how
    fast it then is."""
    gravity = [math.sin(angle), -math.cos(angle)]
    law = SpringDashpot(
        0.3, contact_time=0.02, friction=0.9, tangential=tangential, rolling=rolling
    )
    engine = soft(
        [30.0, 5.0], walls=[Plates("y")], given=at_rest([[5.0, 0.5]]), number=1, pair=law,
        gravity=gravity,
    )  # fmt: skip
    engine.advance(100_000)
    return engine.positions(unwrapped=True)[0, 0] - 5.0, engine.velocities()[0, 0]


def test_springs_with_a_memory_hold_on_a_slope_and_dashpots_creep():
    angle = math.radians(20)
    gone, speed = block(angle, "history", 0.9)
    assert abs(gone) < 0.01
    assert abs(speed) < 1e-9
    gone, speed = block(angle, "viscous", 0.9)
    assert speed > 1e-4
