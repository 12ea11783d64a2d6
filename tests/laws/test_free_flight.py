"""Without collisions particles fly as straight as they started, and beyond a box that is open."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    Fluid,
    MeanSquareDisplacement,
    NoCollision,
    Run,
    Simulation,
    Snapshots,
    VelocityAutocorrelation,
    theory,
)
from mesokit.errors import CaseError
from tests.helpers.comparisons import comparisons

FREE = Fluid(density=5, timestep=1.0, collision=NoCollision())


def flown(box, *observe, steps=10):
    simulation = Simulation(Case(run=Run(steps=steps), box=box, fluid=FREE, observe=observe))
    engine = simulation.engine
    start = engine.positions(unwrapped=True), engine.velocities()
    simulation.run()
    return simulation, *start


@pytest.mark.parametrize("box", [Box([20, 20]), Box([20, 20], open=["x", "y"])], ids=str)
def test_particles_keep_their_velocity_and_fly_on(box):
    simulation, r, v = flown(box, steps=150)  # sorted twice on the way
    engine = simulation.engine
    np.testing.assert_array_equal(engine.velocities(), v)
    np.testing.assert_allclose(engine.positions(unwrapped=True), r + 150.0 * v, atol=1e-9)
    outside = ((engine.positions() < 0) | (engine.positions() > 20)).any()
    assert outside == bool(box.open) == (not engine.images().any())


def test_figures_of_free_flight_have_their_theory():
    observe = (
        Snapshots(),
        MeanSquareDisplacement(every=1, max_lag=10),
        VelocityAutocorrelation(every=1, max_lag=10),
    )
    simulation, _, v = flown(Box([20, 20], open=["x", "y"]), *observe)
    result = simulation["snapshots"]
    assert list(result.x["step"]) == [0, 1, 10]
    assert [c.expected for c in result.comparisons] == [0, 0]
    assert all(c.measured < 1e-12 for c in comparisons(result))
    spread = result.value[:, :, :2].std(axis=1)
    assert (np.diff(spread, axis=0) > 0).all()
    for name in ("mean-square-displacement", "velocity-autocorrelation"):
        found = simulation[name]
        assert found.theory == "free flight"
        # all lags are the same squares of velocities: one number of 4000 terms of variance 2
        ratio = found.value[1:] / found.expected[1:]
        assert abs(ratio - 1).max() < 4 * np.sqrt(2 / v.size)


@pytest.mark.parametrize(
    ("box", "parts", "words"),
    [
        (Box([8, 8], open=["x"]), {}, "only with collision rule 'none'"),
        (Box([8, 8], open=["z"]), {"collision": {"rule": "none"}}, "a 2D box has only"),
        (Box([8, 8], shear_rate=0.1), {"collision": {"rule": "none"}}, "carries no shear"),
        (
            Box([8, 8]),
            {"collision": {"rule": "none"}, "thermostat": {"rule": "rescale"}},
            "leave the thermostat out",
        ),
    ],
)
def test_what_only_collisions_can_do_is_refused(box, parts, words):
    with pytest.raises(CaseError, match=words):
        Case(run=Run(steps=1), box=box, fluid=Fluid(**parts))


def test_theory_has_no_coefficients():
    with pytest.raises(ValueError, match="particles never meet"):
        theory.transport("none", 2, density=5, timestep=0.1)


def test_what_needs_a_box_is_refused_in_an_open_one():
    from mesokit import Plates, VelocityProfile

    box = Box([8, 8], open=["x"])
    for more in ({"observe": [VelocityProfile(axis="y")]}, {"walls": [Plates("y")]}):
        with pytest.raises(CaseError, match=r"not with (box\.open|wall)"):
            Case(run=Run(steps=1), box=box, fluid=FREE, **more)
