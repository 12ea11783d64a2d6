"""Observables of spheres: stops, short runs, pools, and numbers known beforehand."""

import numpy as np
import pytest

from mesokit import (
    ClusterSize,
    CollisionRate,
    EquationOfState,
    HeightProfile,
    KindTemperature,
    MeanSquareDisplacement,
    Plates,
    RadialDistribution,
    Simulation,
    SphereKind,
    SquareWell,
    VelocityAutocorrelation,
    VelocityCumulant,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.spheres.common.expected.enskog import pair_rate
from mesokit.method.spheres.common.observe import OBSERVABLES as OF_SPHERES_ALONE
from mesokit.method.spheres.common.observe.cluster_size import cluster_sizes
from mesokit.method.spheres.hard.observe import OBSERVABLES as OF_HARD_SPHERES
from mesokit.observe import OBSERVABLES as OF_SEVERAL
from tests.helpers.comparisons import comparison, comparisons
from tests.helpers.fake_spheres import FakeSpheres, hard, hard_case_for

OBSERVABLES = (*OF_SEVERAL, *OF_SPHERES_ALONE, *OF_HARD_SPHERES)
OF_SPHERES = [kind for kind in OBSERVABLES if "event-driven" in kind.methods]


def sampled(accumulator, spheres, samples):
    for _ in range(samples):
        spheres.advance(10)
        accumulator.observe(spheres)


@pytest.mark.parametrize("kind", OF_SPHERES)
def test_same_bits_after_a_stop(kind):
    case = hard_case_for(kind())
    whole, first, second = (kind().accumulator(case) for _ in range(3))
    sampled(whole, FakeSpheres(case), 40)
    spheres = FakeSpheres(case)
    sampled(first, spheres, 17)
    second.restore({name: array.copy() for name, array in first.state().items()})
    sampled(second, spheres, 23)
    assert second.result() == whole.result()
    assert whole.result().samples in (39, 40)  # rates need two looks


def test_without_a_collision_no_pressure_is_known():
    case = hard([EquationOfState(every=10)])
    accumulator, spheres = EquationOfState(every=10).accumulator(case), FakeSpheres(case)
    spheres.rates = (0.0, 0.0, 0.0)
    spheres.collisions = (0, 0, 0)
    sampled(accumulator, spheres, 5)
    first, second, rate = accumulator.result().comparisons
    assert np.isnan([first.measured, second.measured]).all() and rate.measured == 0
    assert all(c.note == "undetermined: no collision was seen" for c in (first, second, rate))
    assert np.isnan(rate.deviation)


@pytest.mark.parametrize(("depth", "width"), [(0.5, 1.5), (-0.3, 1.2)])
def test_no_theory_of_hard_spheres_for_those_that_attract_or_repel(depth, width):
    """Collision rates count cores alone, and are no equation of state."""
    well = SquareWell(depth=depth, width=width)
    for kind in (EquationOfState, CollisionRate):
        case = hard([kind(every=10)], collision=well)
        accumulator = kind(every=10).accumulator(case)
        sampled(accumulator, FakeSpheres(case), 40)
        result = accumulator.result()
        assert np.isnan([c.expected for c in comparisons(result)]).all()
        if kind is EquationOfState:
            assert result.x["measured by"].tolist() == ["virial"]
    case = hard([EquationOfState(every=10)])
    accumulator = EquationOfState(every=10).accumulator(case)
    sampled(accumulator, FakeSpheres(case), 40)
    assert np.isfinite(accumulator.result().expected).all()


@pytest.mark.parametrize("kind", OF_SPHERES)
@pytest.mark.parametrize("samples", [0, 1, 2, 5])
def test_short_runs_have_results(kind, samples):
    case = hard_case_for(kind(name="mine"))
    accumulator = kind(name="mine").accumulator(case)
    sampled(accumulator, FakeSpheres(case), samples)
    result = accumulator.result()
    assert result.name == "mine" and result.quantity == kind().quantity
    assert repr(result)


@pytest.mark.parametrize("kind", OF_SPHERES)
def test_two_runs_make_one(kind):
    case = hard_case_for(kind())
    one, other = (kind().accumulator(case) for _ in range(2))
    sampled(one, FakeSpheres(case, seed=1), 20)
    sampled(other, FakeSpheres(case, seed=2), 20)
    alone = one.result().samples
    one.pool(other)
    assert one.result().samples == 2 * alone


def test_rates_are_those_of_the_counts():
    case = hard([CollisionRate(every=1)], number=1000, size=(90, 90))
    accumulator = CollisionRate(every=1).accumulator(case)
    sampled(accumulator, FakeSpheres(case), 200)
    found, path = accumulator.result().comparisons
    assert abs(found.measured - 6.0) < 4 * found.error and found.error < 0.01
    speed = np.linalg.norm(FakeSpheres(case).v, axis=1).mean()
    assert path.measured == pytest.approx(speed / found.measured, rel=0.02)


def test_expected_rate_is_enskogs():
    case = hard([CollisionRate()], number=None, packing_fraction=0.2, size=(60, 60))
    rate = theory.enskog_rate(case.particles / 3600, 1.0, 1.0, 0.2, 2)
    assert pair_rate(case, 1.0) == pytest.approx(rate, rel=2e-3)


@pytest.mark.parametrize("size", [(40, 40), (16, 16, 16)])
@pytest.mark.parametrize("number", [4, 500])
def test_fourth_cumulant_of_maxwells_velocities_is_zero(size, number):
    case = hard([VelocityCumulant()], number=number, size=size, packing_fraction=None)
    accumulator = VelocityCumulant().accumulator(case)
    sampled(accumulator, FakeSpheres(case), 2000)
    (found,) = accumulator.result().comparisons
    assert found.expected == 0.0 and found.error < 0.01
    assert abs(found.measured) < 4 * found.error


def test_fourth_cumulant_of_even_velocities():
    case = hard([VelocityCumulant()], number=4000, size=(90, 90))
    accumulator, spheres = VelocityCumulant().accumulator(case), FakeSpheres(case)
    spheres.v = np.random.default_rng(2).uniform(-1, 1, (4000, 2))
    accumulator.observe(spheres)
    # of one component <v^4> = 1/5, <v^2> = 1/3: a_2 = (2/4) (2/5 + 2/9)/(4/9) - 1
    assert accumulator.result().value[0] == pytest.approx(-0.3, abs=0.015)


def test_kinds_of_one_temperature_have_a_ratio_of_one():
    # 5 heavy disks hold most of the mass, and with it most of the mean velocity
    kinds = [SphereKind(2.0, share=1), SphereKind(1.0, share=3)]
    case = hard([KindTemperature()], number=20, kinds=kinds, size=(20, 20))
    accumulator, spheres = KindTemperature().accumulator(case), FakeSpheres(case)
    sampled(accumulator, spheres, 4000)
    for found in comparisons(accumulator.result()):
        assert found.expected == 1.0 and found.error < 0.01
        assert abs(found.measured - 1) < 4 * found.error
    spheres.v = np.where(spheres.made.kinds[:, None] == 0, [1.0, 0.0], [-1.0, 0.0])
    one = KindTemperature().accumulator(case)
    one.observe(spheres)
    m = spheres.made.masses
    heavy, total = m[:5].sum(), m.sum()
    light = total - heavy
    # about the mean velocity the kinds move with 2 light/total and 2 heavy/total
    energies = np.array([heavy * light**2, light * heavy**2])
    free = np.array([5 - heavy / total, 15 - light / total])
    known = energies / energies.sum() * 19 / free
    assert one.result().value == pytest.approx(known)


def test_clusters_reach_through_the_box_but_not_through_walls():
    places = np.array([[0.1, 5.0], [9.5, 5.0], [5.0, 0.5], [5.0, 9.9], [5.9, 0.5], [2.5, 2.5]])
    ones = np.ones(6)
    periodic = cluster_sizes(places, ones, np.array([10.0, 10.0]), 0.1)
    closed = cluster_sizes(places, ones, np.array([10.0, 0.0]), 0.1)
    assert sorted(periodic) == [1, 2, 3] and sorted(closed) == [1, 1, 2, 2]


def test_shares_of_clusters_add_up():
    case = hard([ClusterSize(gap=0.5)], number=60)
    accumulator = ClusterSize(gap=0.5).accumulator(case)
    sampled(accumulator, FakeSpheres(case), 20)
    result = accumulator.result()
    assert result.value.sum() == pytest.approx(1.0)
    mean, largest, _ = result.comparisons
    assert 1 < mean.measured < 60 and 0 < largest.measured <= 1


def test_heights_of_an_ideal_gas_are_barometric():
    observable = HeightProfile(bins=10)
    spheres = {"number": 400, "gravity": (0, -1), "packing_fraction": 0.001}
    case = hard([observable], size=(20, 20), walls=[Plates("y")], **spheres)
    accumulator, fake = observable.accumulator(case), FakeSpheres(case)
    section = case.spheres
    radius = 0.5 * section.scale(case.box)
    mass = section.kinds[0].mean_mass(2)
    fake.kT = 5.0 * mass  # a scale height of 5
    for _ in range(400):
        fake.advance(1)
        u = fake.rng.random(400)
        fake.r[:, 1] = radius - 5 * np.log1p(u * np.expm1(-(20 - 2 * radius) / 5))
        accumulator.observe(fake)
    result = accumulator.result()
    assert np.all(np.abs(result.value - result.expected) < 4 * result.error + 1e-3)
    (mean,) = result.comparisons
    assert abs(mean.measured - mean.expected) < 4 * mean.error + 0.01


def test_what_cannot_be_measured_is_refused():
    with pytest.raises(CaseError, match="height-profile"):
        hard([HeightProfile()])
    with pytest.raises(CaseError, match="height-profile"):
        hard([HeightProfile()], walls=[Plates("x"), Plates("y")], gravity=(1, -1))
    with pytest.raises(CaseError, match="one kind"):
        hard([VelocityCumulant()], kinds=[SphereKind(1.0), SphereKind(0.5)])
    with pytest.raises(CaseError, match="two kinds"):
        hard([KindTemperature()])


class TestRadialDistribution:
    def test_spheres_that_do_not_know_of_others_are_an_ideal_gas(self):
        """Of one kind, and between two, by number or name."""
        kinds = [SphereKind(1.0, name="large"), SphereKind(0.5, share=2.0)]
        for chosen in ((), (2,), ("large", 2)):
            given = RadialDistribution(kinds=chosen, bins=4)
            case = hard([given], number=90, kinds=kinds)
            accumulator = given.accumulator(case)
            sampled(accumulator, FakeSpheres(case), 400)
            result = accumulator.result()
            deviations = (result.value - 1) / result.error
            assert abs(deviations).max() < 4 and result.error.max() < 0.03
            assert not any(c.what == "g at contact" for c in result.comparisons)

    def test_kinds_that_there_are_not(self):
        for kind in (3, "blue", 0):
            with pytest.raises(CaseError, match="expected 1 to 2 or 'large'"):
                hard(
                    [RadialDistribution(kinds=[kind])],
                    kinds=[SphereKind(1.0, name="large"), SphereKind(0.5)],
                )
        with pytest.raises(CaseError, match="of = 'beads': expected 'particles'"):
            hard([RadialDistribution(of="beads")])

    @pytest.mark.parametrize(("dimension", "fraction"), [(2, 0.5), (3, 0.3)])
    def test_hard_spheres_touch_as_often_as_their_pressure_says(self, dimension, fraction):
        volume = np.pi / 4 if dimension == 2 else np.pi / 6
        side = (500 * volume / fraction) ** (1 / dimension)
        case = hard([RadialDistribution(every=5)], [side] * dimension, number=500, timestep=0.1)
        simulation = Simulation(case, threads=1)
        simulation.run(800)
        found = comparison(simulation["radial-distribution"], "g at contact")
        assert abs(found.deviation) < 3.5 and found.error < 0.02 * found.expected


def test_velocities_are_forgotten_as_displacements_say():
    """The integral of the autocorrelation is the diffusion coefficient; thin gases are Enskog's."""
    side = (500 * np.pi / 6 / 0.05) ** (1 / 3)
    given = [
        VelocityAutocorrelation(every=1, max_lag=200),
        MeanSquareDisplacement(every=4, max_lag=300),
    ]
    simulation = Simulation(hard(given, [side] * 3, number=500, timestep=0.05), threads=1)
    simulation.run(6000)
    level, share, integral = simulation["velocity-autocorrelation"].comparisons
    assert level.expected == pytest.approx(1 - 1 / 500) and abs(level.deviation) < 3.5
    assert share.measured == pytest.approx(share.expected, rel=2e-3)
    straight = comparison(simulation["mean-square-displacement"], "diffusion")
    spread = np.hypot(integral.error, straight.error)
    assert spread < 0.03 * straight.measured
    assert integral.measured == pytest.approx(straight.measured, abs=3.5 * spread)
    assert integral.measured == pytest.approx(integral.expected, rel=0.06)


def test_velocities_along_gravity_and_between_walls_are_left_out():
    fall = {"gravity": (0, -1), "number": 5}
    case = hard([VelocityAutocorrelation()], walls=[Plates("y")], **fall)
    assert case.observe[0].accumulator(case).axes == [0]
    with pytest.raises(CaseError, match="every axis has gravity or a wall"):
        hard([VelocityAutocorrelation()], walls=[Plates("x"), Plates("y")], **fall)
