"""Body forces: each particle gains m a dt, and the flow that a force drives."""

import numpy as np
import pytest
from numba import njit

from mesokit import AT, Sinusoidal, theory
from mesokit.method.mpcd.field import RULES
from mesokit.method.mpcd.field.protocol import acceleration, field_at
from tests.helpers.small_fluids import Measured, example, make_fluid


@pytest.mark.parametrize("force", RULES, ids=lambda rule: rule.__name__)
def test_momentum_grows_by_the_force(force):
    """Exactly, collisions or not: what one step adds is the sum of m a at half of the flights."""
    size, dt = (6, 7, 5), 0.2
    given = example(force, 3)  # which keeps the table of its kernel alive
    fluid = make_fluid(size, collision=AT(), force=given, timestep=dt, mass=2.0)
    fluid.advance(3)
    middle = fluid.positions() + 0.5 * dt * fluid.velocities()
    field = given.kernel(size)
    pull = njit(lambda field, r, time: acceleration(field_at(field, time), r))
    a = np.array([pull(field, tuple(r), 3.5 * dt) for r in middle])  # (n, 0) without a force
    expected = 2.0 * dt * a.sum(axis=0) if a.size else 0.0
    before = fluid.totals()[1]
    fluid.advance(1)
    np.testing.assert_allclose(fluid.totals()[1] - before, expected, atol=1e-8)


def test_kolmogorov_flow():
    length, amplitude = 16, 0.3
    nu = theory.transport("at", 3, 10, 0.1).viscosity
    k = 2 * np.pi / length
    rate = nu * k * k
    force = Sinusoidal(amplitude=amplitude * rate)
    fluid = make_fluid((length,) * 3, collision=AT(), force=force)
    fluid.advance(int(5 / rate / 0.1))
    wave = []
    for _ in range(200):
        fluid.advance(5)
        _, momentum = fluid.modes(np.array([[0.0, k, 0.0]]))
        wave.append(2 * momentum[0, 0] / fluid.n)
    # thermal noise of one part of the mode, remembered for the time 1/rate
    error = np.sqrt(2 / fluid.n * 2 / rate / (len(wave) * 5 * 0.1))
    wave = np.mean(wave)
    # 3 % as for the viscosity (molecular chaos, wave of finite length)
    assert Measured(-wave.imag, error).agrees(amplitude, systematic=0.03), (wave, error)
    assert Measured(wave.real, error).agrees(0.0), (wave, error)
