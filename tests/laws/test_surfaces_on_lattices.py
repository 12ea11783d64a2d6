"""Laws of surfaces: differences of heights, steps, and the width in a steady state."""

import numpy as np
import pytest

from mesokit import theory
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.observe.height_differences import HeightDifferences
from mesokit.method.kinetic_monte_carlo.observe.height_steps import HeightSteps
from mesokit.method.kinetic_monte_carlo.observe.roughness import Roughness
from mesokit.method.kinetic_monte_carlo.start import AlternatingStart
from tests.helpers.lattices import FakeLattice, lattice_case, near, results_of


def test_a_ring_of_single_steps_is_as_rough_as_a_walk_that_returns():
    observe = [HeightDifferences(every=1), Roughness(every=1), HeightSteps(every=10)]
    case = lattice_case(
        (32,), SingleStep(up=1.0, down=0.2), "chain", steps=6000, warmup=100, timestep=4.0,
        start=AlternatingStart(), observe=observe,
    )  # fmt: skip
    found = results_of(case)
    g = found["height-differences"]
    assert abs(g.deviation[1:]).max() < 4.5  # of neighbours it is 1 exactly
    assert g.value == pytest.approx(np.arange(1, 17) * (32 - np.arange(1, 17)) / 31, rel=0.1)
    assert near(g.comparisons) == {"roughness exponent"}
    assert near(found["roughness"].comparisons) == {"saturated mean square width"}
    width = found["roughness"]["saturated mean square width"]
    assert width.expected == pytest.approx(33 / 12) and width.error < 0.15
    steps = found["height-steps"]
    assert steps.select(dh=1)[0] == steps.select(dh=-1)[0] == 0.5


def test_a_surface_that_has_not_settled_has_no_exact_theory():
    for warmup in (0, 10):
        case = lattice_case((32,), SingleStep(), "chain", warmup=warmup, start=AlternatingStart())
        made = HeightDifferences().accumulator(case)
        made.observe(FakeLattice(np.arange(32) % 2))
        assert made.result().expected is None


@pytest.mark.parametrize("length", [10, 24])
def test_a_surface_in_equilibrium_has_the_steps_of_boltzmann(length):
    observe = [HeightSteps(every=1), HeightDifferences(every=1)]
    case = lattice_case(
        (length,), SolidOnSolid(bond_energy=1.5, kT=1.0), "chain", steps=4000, warmup=500,
        timestep=20.0, observe=observe,
    )  # fmt: skip
    found = results_of(case)
    assert near(found["height-steps"].comparisons) == {"pairs without a step", "mean square step"}
    steps = found["height-steps"]
    use = steps.error > 0
    assert use.sum() > 8 and abs(steps.deviation[use & (steps.value > 1e-4)]).max() < 4.5
    assert near(found["height-differences"].comparisons) >= {"nearest mean square difference"}
    assert abs(found["height-differences"].deviation).max() < 4.5


def test_steps_of_a_long_ring_are_those_of_a_chain():
    step, q = np.arange(-6, 7), np.exp(-0.75)
    ring, chain = (theory.solid_on_solid_steps(step, q, n) for n in (4000, None))
    np.testing.assert_allclose(ring, chain, rtol=0.02)
    assert chain[6] == pytest.approx((1 - q) / (1 + q))
    every = theory.solid_on_solid_steps(np.arange(-300, 301), q, 10)
    assert every.sum() == pytest.approx(1) and (every > 0).sum() > 100


def test_differences_are_along_the_axis_and_not_over_an_end():
    """Terraces: a slope of 2 along x, and of 3 along y."""
    x, y = np.indices((8, 6))
    for axis, rise in (("x", 2), ("y", 3)):
        case = lattice_case((8, 6), Family(), ends=["x", "y"])
        made = HeightDifferences(axis=axis).accumulator(case)
        made.observe(FakeLattice(2 * x + 3 * y))
        result = made.result()
        assert result.value == pytest.approx((rise * result.x["distance"]) ** 2)
    case = lattice_case((8, 6), Family())
    made = HeightDifferences(axis="y").accumulator(case)
    made.observe(FakeLattice(100 * x + 7 * (y % 2)))
    assert made.result().value == pytest.approx([49, 0, 49], abs=1e-9)
    steps = HeightSteps().accumulator(lattice_case((8, 6), Family(), ends=["x", "y"]))
    steps.observe(FakeLattice(2 * x + 3 * y))
    assert steps.result().select(dh=2)[0] == pytest.approx(42 / 82)
    assert steps.result().select(dh=3)[0] == pytest.approx(40 / 82)


def test_a_growing_surface_has_the_exponent_of_its_class():
    case = lattice_case(
        (256,), Family(), "chain", steps=160, warmup=50, timestep=100.0,
        observe=[HeightDifferences(every=1)],
    )  # fmt: skip
    exponent = results_of(case)["height-differences"]["roughness exponent"]
    assert exponent.approximate and exponent.measured == pytest.approx(0.5, abs=0.07)
