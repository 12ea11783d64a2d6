"""Forces that change in time: what they add to the momentum, and the factor itself."""

import numpy as np
import pytest
from numba import njit

from mesokit import (
    AT,
    SRD,
    Box,
    Case,
    Fluid,
    MaxwellBoltzmann,
    NoForce,
    OscillatingForce,
    Plates,
    Run,
    ScheduledForce,
    Uniform,
    theory,
)  # fmt: skip
from mesokit.errors import CaseError
from mesokit.method.mpcd.field.varying import factor
from tests.helpers.small_fluids import make_fluid, mean

PUSH = Uniform((0.02, 0.0, 0.0))
COSINE = OscillatingForce(PUSH, frequency=1.7, phase=-90)
PULSE = ScheduledForce(PUSH, times=[0.5, 0.5, 1.0, 1.3, 1.3], factors=[0, 2, 2, 1, -1])


@pytest.mark.parametrize("force", [COSINE, PULSE], ids=["cosine", "table"])
def test_momentum_is_the_sum_of_the_force_over_the_steps(force):
    """Exactly, and the same whether the steps are run at once or one by one."""
    fluid = make_fluid((6, 7, 5), collision=AT(), force=force)
    dt, begun = fluid.numbers.timestep, fluid.totals()[1][0]
    fluid.advance(7)
    for _ in range(13):
        fluid.advance(1)
    middles = (np.arange(20) + 0.5) * dt
    expected = 0.02 * fluid.n * dt * sum(force.at(t) for t in middles)
    assert abs(expected) > 0.5
    assert fluid.totals()[1][0] - begun == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("force", [COSINE, PULSE], ids=["cosine", "table"])
def test_the_factor_is_the_same_compiled(force):
    compiled = njit(lambda change, time: factor(change, time))
    change = force.change()
    for time in np.linspace(0, 4, 41):
        assert compiled(change, time) == pytest.approx(force.at(time), abs=1e-14), time


def test_a_table_is_constant_beyond_its_ends_and_jumps_where_a_time_is_given_twice():
    found = [PULSE.at(t) for t in (0.0, 0.499, 0.5, 1.15, 1.299, 1.3, 9.0)]
    assert found == pytest.approx([0, 0, 2, 1.5, 1 + 1 / 300, -1, -1], abs=1e-12)
    assert PULSE.largest == pytest.approx(0.04)


@pytest.mark.long
def test_the_flow_in_a_slit_follows_an_oscillating_force_as_theory_says():
    """Amplitude and lag of the velocity at every height, period by period."""
    height, period, g = 16, 640, 0.03
    frequency = 2 * np.pi / (0.1 * period)
    nu = theory.transport("srd", 2, 10, 0.1, angle=90).viscosity
    fluid = make_fluid(
        (32, height), walls=[Plates("y", virtual="fill")], collision=SRD(angle=90),
        force=OscillatingForce(Uniform((g, 0.0)), frequency), thermostat=MaxwellBoltzmann(),
    )  # fmt: skip
    y = (np.arange(2 * height) + 0.5) / 2
    inside = (y > 1) & (y < height - 1)  # the cells next to the plates obey no-slip only roughly
    behind = 0.2  # the flow vanishes a fifth of a cell behind plates that virtual particles fill

    def response(viscosity):
        height_of_flow, place = height + 2 * behind, y[inside] + behind
        return theory.oscillating_slit_response(place, height_of_flow, viscosity, frequency)

    def projected(velocity):
        return (velocity @ response(nu).conj()) / (abs(response(nu)) ** 2).sum()

    fluid.advance(period)
    found = []
    for _ in range(10):
        velocity = np.zeros(2 * height, complex)
        for k in range(1, period // 10 + 1):
            fluid.advance(10)
            _, mass, momentum, _ = fluid.moments((1,), (2 * height,))
            velocity += momentum[0] / mass * np.exp(-1j * frequency * k) * 20 / period
        found.append(projected(velocity[inside]) / g)
    ratio, lag = mean(np.real(found)), mean(1 + np.imag(found))
    assert max(ratio.error, lag.error) < 0.015
    off = projected(response(0.97 * nu)) - 1  # fluctuations of a small 2D box: 3 % of the viscosity
    assert ratio.agrees(1.0, systematic=abs(off.real)), ratio
    assert lag.agrees(1.0, systematic=abs(off.imag)), lag
    assert np.abs(np.angle(response(nu)[len(y) // 2])) > 1.3  # far behind the force


@pytest.mark.parametrize(
    ("force", "words"),
    [
        ({"rule": "oscillating", "of": COSINE, "frequency": 1}, "expected a force that acts"),
        ({"rule": "oscillating", "of": NoForce(), "frequency": 1}, "expected a force that acts"),
        ({"rule": "scheduled", "of": PUSH, "times": [1, 0], "factors": [1, 1]}, "times in order"),
        ({"rule": "scheduled", "of": PUSH, "times": [1], "factors": [1, 1]}, "one for each"),
        (
            OscillatingForce(Uniform([1, 0]), 1.0),
            r"of.acceleration = \[1, 0\]: expected 3",
        ),
    ],
)
def test_wrong_ones_are_refused(force, words):
    with pytest.raises(CaseError, match=words):
        Case(run=Run(steps=1), box=Box([6, 7, 5]), fluid=Fluid(force=force))
