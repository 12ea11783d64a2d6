"""What must hold for each observable, new ones included."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import AT
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.observe import OBSERVABLES as OF_MPCD
from mesokit.method.spheres.common.observe import OBSERVABLES as OF_SPHERES
from mesokit.method.spheres.hard.observe import OBSERVABLES as OF_HARD_SPHERES
from mesokit.method.spheres.soft.observe import OBSERVABLES as OF_SOFT_SPHERES
from mesokit.observe import OBSERVABLES as OF_SEVERAL
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import with_error
from mesokit.statistics import Blocks
from tests.helpers.fake_fluid import FakeFluid, case_for, taken

# those of spheres have their own tests: no fluid can answer them
OBSERVABLES = (*OF_SEVERAL, *OF_MPCD, *OF_SPHERES, *OF_HARD_SPHERES, *OF_SOFT_SPHERES)
OF_FLUIDS = [kind for kind in OBSERVABLES if not kind.methods]


def sampled(accumulator, fluid, samples, rng):
    for _ in range(samples):
        fluid.advance(10)
        d = fluid.dimension
        fluid.stress = {n: rng.normal(size=(d, d)) for n in ("kinetic", "collisional")}
        fluid.hit_walls(taken(fluid.case, rng), 10)
        accumulator.observe(fluid)


@pytest.mark.parametrize("size", [(6, 6), (4, 4, 4)])
@pytest.mark.parametrize("kind", OF_FLUIDS)
def test_same_bits_after_a_stop(kind, size, make_case):
    observable = kind()
    case = case_for(observable, make_case, size)
    whole, first, second = (observable.accumulator(case) for _ in range(3))
    fluid, rng = FakeFluid(case), np.random.default_rng(1)
    twin, twin_rng = FakeFluid(case), np.random.default_rng(1)
    sampled(whole, fluid, 77, rng)
    sampled(first, twin, 33, twin_rng)
    state = {name: array.copy() for name, array in first.state().items()}
    assert all(isinstance(array, np.ndarray) and array.dtype != object for array in state.values())
    second.restore(state)
    sampled(first, twin, 1, np.random.default_rng(9))  # what goes on after must not leak back
    twin, twin_rng = FakeFluid(case), np.random.default_rng(1)
    sampled(observable.accumulator(case), twin, 33, twin_rng)
    sampled(second, twin, 44, twin_rng)
    assert second.result() == whole.result()
    assert whole.result().samples == 77


@pytest.mark.parametrize("kind", OF_FLUIDS)
@pytest.mark.parametrize("samples", [0, 1, 2, 5])
def test_short_runs_have_results(kind, samples, make_case):
    observable = kind(name="mine")
    case = case_for(observable, make_case, (6, 6))
    accumulator = observable.accumulator(case)
    sampled(accumulator, FakeFluid(case), samples, np.random.default_rng(1))
    result = accumulator.result()
    assert result.name == "mine" and result.quantity == observable.quantity
    assert repr(result)


@pytest.mark.parametrize("kind", OF_FLUIDS)
@pytest.mark.parametrize(
    "fluid", [{"collision": AT()}, {"species": (Species(1.0, 3.0), Species(4.0, 2.0))}]
)
def test_other_fluids(kind, fluid, make_case):
    observable = kind()
    case = case_for(observable, make_case, (6, 6, 6), **fluid)
    accumulator = observable.accumulator(case)
    sampled(accumulator, FakeFluid(case), 8, np.random.default_rng(1))
    assert accumulator.result().label


@pytest.mark.parametrize("kind", OBSERVABLES)
def test_it_says_what_it_is(kind):
    assert kind.__doc__ and kind().label == kind().quantity
    assert kind(name="a").label == "a"


def test_one_without_an_accumulator_is_refused():
    class Bare(Observable):
        pass

    with pytest.raises(TypeError, match="accumulator"):
        Bare()


class Memory(BlockAccumulator):
    memory = ("blocks", "own", "count", "last")
    added = ("count", "runs")

    def __init__(self, sample, own=None):
        self.blocks, self.own, self.count, self.runs = Blocks(), own, 1, [sample]
        self.last = np.full(2, sample)
        self.blocks.add(sample)


def test_memory_is_kept_and_pooled_by_the_names_of_its_parts():
    one, other = Memory(1.0), Memory(4.0, Blocks())
    assert set(one.state()) == {"blocks/sums", "blocks/counts", "count", "last"}
    assert {"own/sums", "own/counts"} < set(other.state())
    one.pool(other)
    assert (one.blocks.mean(), one.count, one.runs) == (2.5, 2, [1.0, 4.0])
    assert one.last.tolist() == [1.0, 1.0]  # of this run alone
    again = Memory(0.0)
    again.restore(one.state())
    assert (again.count, again.last.tolist(), type(again.count)) == (2, [1.0, 1.0], int)


def test_values_are_printed_like_in_a_journal():
    assert with_error(0.87012, 0.0123) == "0.870(12)"
    assert with_error(0.87, 0.0996) == "0.87(10)"
    assert with_error(12345.6, 123.0) == "12350(120)"
    assert with_error(3.2e-7, 1.5e-8) == "3.20(15)e-07"
    assert with_error(5.0, 1.2) == "5.0(12)"
    assert with_error(1.5, 1.2e-9) == "1.5000000000(12)"
    assert with_error(15.0, 1.2e-9) == "1.50000000000(12)e+01"
    assert with_error(-0.5, float("nan")) == "-0.5000"
