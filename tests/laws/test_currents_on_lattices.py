"""Laws of currents: rings, open chains, and a full half that empties."""

import numpy as np
import pytest

from mesokit import Simulation, theory
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.observe.crossings import Crossings
from mesokit.method.kinetic_monte_carlo.observe.current import Current
from mesokit.method.kinetic_monte_carlo.observe.shared.carried import Carried
from mesokit.method.kinetic_monte_carlo.start import RandomStart, SlabStart
from tests.helpers.lattices import lattice_case, near, results_of


def test_a_ring_has_the_exact_current_and_its_variance():
    start = RandomStart(fractions=[0.6, 0.4], exact=True)
    case = lattice_case(
        (20,), Exclusion(), "chain", steps=20_000, start=start, observe=[Current(every=20)]
    )
    result = results_of(case)["current"]
    assert near(result.comparisons) == {"mean current", "variance of crossings per time"}
    assert result["mean current"].expected == pytest.approx(8 * 12 / (20 * 19))
    assert result["mean current"].error < 0.004
    variance = result["variance of crossings per time"]
    assert variance.expected == pytest.approx(theory.ring_diffusion(8, 20) * 0.16)
    assert variance.error < 0.4 * variance.expected


def test_hops_both_ways_carry_the_difference():
    start = RandomStart(fractions=[0.5, 0.5], exact=True)
    model = Exclusion(forward=1.0, backward=0.4)
    case = lattice_case(
        (20,), model, "chain", steps=20_000, start=start, observe=[Current(every=20)]
    )
    result = results_of(case)["current"]
    assert near(result.comparisons) == {"mean current"}
    assert result["mean current"].expected == pytest.approx(0.6 * 100 / 380)


def test_an_open_chain_has_the_exact_current_at_every_bond():
    model = Exclusion(enter=1.0, leave=1.0)
    case = lattice_case(
        (10,), model, "chain", steps=20_000, warmup=100, ends=["x"],
        observe=[Current(every=20), Crossings(every=100, part=0.3)],
    )  # fmt: skip
    found = results_of(case)
    assert near(found["current"].comparisons) == {"mean current"}
    mean = found["current"]["mean current"]
    assert mean.expected == pytest.approx(12 / 42) and mean.error < 0.005
    across = found["crossings"]
    rate = across.value[-1] / (across.x["time"][-1] - across.x["time"][0])
    assert rate == pytest.approx(mean.measured, rel=0.01)


def pooled(length, time, runs):
    start, first = SlabStart(), None
    for seed in range(1, runs + 1):
        case = lattice_case(
            (length,), Exclusion(), "chain", steps=10, timestep=time / 10, seed=seed, ends=["x"],
            start=start, observe=[Crossings(every=1)],
        )  # fmt: skip
        simulation = Simulation(case)
        accumulator = simulation.case.observe[0].accumulator(simulation.case)
        accumulator.observe(simulation.engine)
        for _ in range(10):
            simulation.engine.advance(1)
            accumulator.observe(simulation.engine)
        if first is None:
            first = accumulator
        else:
            first.pool(accumulator)
    return first.result()


def test_a_full_half_empties_as_the_largest_eigenvalue_of_a_matrix_scatters():
    result = pooled(240, 100.0, 200)
    assert near(result.comparisons) == {"crossings from 10 to 100 tau"}
    late, variance = result.comparisons
    assert late.measured == pytest.approx(late.expected, rel=0.02)
    assert variance.measured == pytest.approx(variance.expected, abs=4 * variance.error)
    assert variance.error < 0.15 * variance.expected


@pytest.mark.long
def test_a_full_half_empties_as_known_to_a_thousandth():
    result = pooled(2400, 1000.0, 400)
    late, variance = result.comparisons
    assert late.expected == pytest.approx(228.767, abs=2e-3)
    assert abs(late.measured - late.expected) < 4 * late.error < 1.0
    assert variance.measured == pytest.approx(variance.expected, abs=4 * variance.error)


GAS = LatticeGas(
    process=[
        GasProcess(name="on", site="empty -> A", rate=1.0),
        GasProcess(name="off", site="A -> empty", rate=1.0),
        GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0),
        GasProcess(name="pull", site="empty -> A", neighbour="A -> empty", rate=1.0),
    ]
)


@pytest.mark.parametrize(
    ("kind", "axes"), [("triangular", "xy"), ("honeycomb", "x"), ("fcc", "xz")]
)
def test_a_hop_carries_as_far_as_the_sites_are_apart(kind, axes):
    size = (4, 6, 4)[: KINDS[kind].dimension]
    places = KINDS[kind].places(size).reshape(*size, -1)
    middle = (2,) * len(size)  # an even site
    for axis in axes:
        k = "xyz".index(axis)
        rows = Carried(lattice_case(size, GAS, kind), None, axis).rows
        steps = [places[tuple(np.add(middle, step))] - places[middle] for step in KINDS[kind].even]
        expected = np.array(steps)[:, k] / KINDS[kind].spacing[k]
        by_name = dict(zip(GAS.events(), rows, strict=True))
        np.testing.assert_allclose(by_name["hop"], expected, atol=1e-12)
        np.testing.assert_allclose(by_name["pull"], -expected, atol=1e-12)
        assert not by_name["on"].any() and not by_name["off"].any()


def test_hops_in_a_plane_carry_nothing_on_average():
    case = lattice_case((16, 16), GAS, steps=200, observe=[Current(every=1, axis="y")])
    mean = results_of(case)["current"]["mean current"]
    assert abs(mean.measured) < 4 * mean.error < 0.1
    assert mean.expected == 0 and mean.note == "no direction is preferred"
