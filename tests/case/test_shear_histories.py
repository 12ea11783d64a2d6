"""Histories of shear: strain is the integral of the rate, and keys that go together."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    CaseError,
    Cessation,
    Fluid,
    OscillatingShear,
    Run,
    ShearHistory,
    ShearRamp,
    StartUp,
    SteadyShear,
    StepStrain,
)
from mesokit.case.shear import HISTORIES

EXAMPLES: dict[type, ShearHistory] = {
    SteadyShear: SteadyShear(0.3),
    OscillatingShear: OscillatingShear(0.3, frequency=1.7),
    StartUp: StartUp(0.3, start=2.3),
    Cessation: Cessation(0.3, stop=2.3),
    ShearRamp: ShearRamp(0.3, duration=1.9, start=1.1, initial=-0.2),
    StepStrain: StepStrain(0.3, duration=1.9, start=1.1),
}
REPEATED = [StartUp(0.3, start=2.0, period=5.0), ShearRamp(0.3, 1.9, initial=0.1, period=3.0)]


@pytest.mark.parametrize("kind", HISTORIES, ids=lambda kind: kind.__name__)
def test_strain_is_the_integral_of_the_rate(kind):
    history = EXAMPLES[kind]
    edges = np.linspace(0.0, 8.0, 4001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    rates = np.array([history.rate_at(t) for t in middle.tolist()])
    strain = np.concatenate([[0.0], np.cumsum(rates * np.diff(edges))])
    np.testing.assert_allclose(history.strain_at(edges), strain, atol=1e-3 * history.largest)
    assert abs(rates).max() == pytest.approx(history.largest, rel=1e-3)


@pytest.mark.parametrize("history", REPEATED, ids=["start-up", "ramp"])
def test_a_period_begins_anew(history):
    t, period = np.linspace(0.01, 0.99, 25) * history.period, history.period
    again = history.strain_at(t + 2 * period) - 2 * history.strain_at(0.99999999 * period)
    np.testing.assert_allclose(again, history.strain_at(t), atol=1e-7)
    rates = [[history.rate_at(x + n * period) for x in t.tolist()] for n in (0, 3)]
    np.testing.assert_allclose(*rates, atol=1e-12)


@pytest.mark.parametrize(
    ("keys", "history"),
    [
        ({"shear_rate": 0.1}, SteadyShear(0.1)),
        ({"shear_rate": 0.1, "shear_frequency": 0.7}, OscillatingShear(0.1, 0.7)),
    ],
)
def test_short_keys_say_the_same(keys, history):
    closed, short, long = (False, False), Box([8, 8], **keys), Box([8, 8], shear=history)
    assert short.history == long.history == history
    assert short.kernel(closed, 12.3) == long.kernel(closed, 12.3)
    assert short.displacement(12.3) == long.displacement(12.3)


def test_no_strain_is_no_shear():
    assert not Box([8, 8], shear=StepStrain(0.0, duration=1.0)).sheared


@pytest.mark.parametrize(
    ("box", "words"),
    [
        ({"shear_rate": 0.1, "shear": StartUp(0.1)}, "box.shear_rate = 0.1: not with box.shear"),
        ({"shear": StartUp(0.1, start=5, period=5)}, "box.shear.period = 5: expected more than 5"),
        ({"shear": StepStrain(0.1, duration=2, start=1, period=2)}, "expected more than 3"),
    ],
)
def test_what_does_not_go_together(box, words):
    with pytest.raises(CaseError, match=words):
        Case(run=Run(steps=1), box=Box([8, 8], **box), fluid=Fluid(density=5))
