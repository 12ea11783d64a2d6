"""Histograms of velocities and of numbers in cells, on gases whose distribution is known."""

import numpy as np
import pytest

from mesokit import CellOccupancy, Disk, MaxwellBoltzmann, Plates, Uniform, VelocityDistribution
from tests.helpers.comparisons import comparisons
from tests.helpers.whole_fluid import AtOnce

SAMPLES = 2500


class Gas(AtOnce):
    """An ideal gas, drawn anew each time; on demand without momentum."""

    def __init__(self, case, resting=True, spread=1.0, crowded=1.0):
        self.rng, self.case, self.resting = np.random.default_rng(7), case, resting
        self.spread, self.crowded = spread, crowded
        self.n, self.d = case.particles, case.box.dimension

    def masses(self, ids):
        return np.full(len(ids), self.case.fluid.mass)

    def velocities(self, ids):
        v = self.spread * self.rng.normal(size=(self.n, self.d))
        return (v - self.resting * v.mean(axis=0))[ids]

    def positions(self, ids):
        r = self.rng.random((self.n, self.d)) ** self.crowded
        return (r * self.case.box.size)[ids]


def watched(observable, case, **parts):
    accumulator = observable.accumulator(case)
    gas = Gas(case, **parts)
    for _ in range(SAMPLES):
        accumulator.observe(gas)
    return accumulator.result()


def off(comparison):
    return (comparison.measured - comparison.expected) / comparison.error


@pytest.fixture
def gas_case(make_case):
    return make_case((8, 8), (), density=5, thermostat=MaxwellBoltzmann())


def test_velocities_of_a_gas_at_rest_have_the_chi_square_that_is_expected(gas_case):
    result = watched(VelocityDistribution(), gas_case)
    assert result.x["of"][0] == "v_x"
    for found in comparisons(result):
        assert abs(off(found)) < 3.5, found
    width = np.diff(result.extra["edges"], axis=1)
    assert (result.value * width).sum(axis=1) == pytest.approx([1, 1])
    sure = result.error > 0
    assert (abs(result.deviation[sure]) < 4.5).all()


def test_it_tells_a_moving_gas_and_a_warm_one(gas_case):
    """Momentum is one degree of freedom of a component; 2 % more speed is seen in both."""
    moving = watched(VelocityDistribution(), gas_case, resting=False)
    assert off(moving.comparisons[0]) > 4 and moving.comparisons[0].measured == pytest.approx(
        moving.comparisons[0].expected + 1.0, abs=0.4
    )
    warm = watched(VelocityDistribution(), gas_case, spread=1.04)
    assert min(map(off, warm.comparisons)) > 5


def test_numbers_in_cells_have_the_chi_square_that_is_expected(gas_case):
    for found in comparisons(watched(CellOccupancy(), gas_case)):
        assert abs(off(found)) < 3.5, found
    uneven = watched(CellOccupancy(), gas_case, crowded=1.3)
    assert min(map(off, uneven.comparisons)) > 5


def test_cells_that_a_solid_cuts_do_not_count(make_case):
    case = make_case((12, 12), (), walls=(Disk([6, 6], 3),))
    accumulator = CellOccupancy().accumulator(case)
    whole = accumulator.cells.reshape(12, 12)
    assert whole[0].all() and not whole[4:8, 4:8].any()
    assert accumulator.result().comparisons[0].expected == 1 - 1 / whole.sum()


@pytest.mark.parametrize(
    ("parts", "known"),
    [
        ({}, [True, True]),
        ({"thermostat": MaxwellBoltzmann(), "force": Uniform([0.01, 0])}, [True, False]),
        ({"force": Uniform([0.01, 0])}, [False, False]),
    ],
)
def test_theory_is_there_where_the_fluid_is_at_rest_and_at_kT(make_case, parts, known):
    case = make_case((8, 8), (), walls=(Plates("y"),), **parts)
    result = VelocityDistribution().accumulator(case).result()
    assert result.x["of"][0] == ("v_y" if "force" in parts else "v_x")
    assert [np.isfinite(c.expected) for c in result.comparisons] == known
