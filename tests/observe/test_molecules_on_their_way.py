"""Transit, residence and translocation of molecules whose way is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2

from mesokit import (
    Disk,
    Harmonic,
    MagneticField,
    MeanSquareDisplacement,
    MoleculeHistogram,
    MoleculeSize,
    NormalModes,
    Polymer,
    ResidenceTime,
    Solutes,
    TransitTime,
    TranslocationTime,
    Uniform,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.ideal import drift_of
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from tests.helpers.fake_molecules import case_with, followed

ROD = np.array([[-1.5, 0.0], [-0.5, 0.0], [0.5, 0.0], [1.5, 0.0]])
PUSH = {"force": Uniform((0.1, 0.0))}


def dragged(observable, speed, steps=400, interval=0.7, number=3, **parts):
    """Rods of 3 cells that a flow carries along x with one speed, from different places."""
    case = case_with(observable, number=number, length=4, **parts)
    starts = np.linspace(0.3, 15.7, number)[:, None, None] * [1.0, 0.0] + ROD
    times = interval * np.arange(steps)
    beads = starts + (speed * times)[:, None, None, None] * [1.0, 0.0]
    return followed(observable, case, times, beads).result()


@pytest.mark.parametrize("length", [None, 5.0])
def test_transit_is_length_over_velocity(length):
    found = dragged(TransitTime(length=length), 0.37)
    assert found["mean transit time"].measured == pytest.approx((length or 20.0) / 0.37)
    assert found["length over velocity"].measured == pytest.approx((length or 20.0) / 0.37)
    starts, ends = (np.linspace(0.3, 15.7, 3) + way for way in (0, 399 * 0.7 * 0.37))
    planes = [np.floor(x / (length or 20)) for x in (starts, ends)]
    assert found["transits"].measured == (planes[1] - planes[0] - 1).sum()


def test_transit_goes_with_the_force():
    push = {"force": Uniform((-0.1, 0.0))}
    assert dragged(TransitTime(length=4), -0.4, **push)["mean transit time"].measured == (
        pytest.approx(10)
    )
    assert dragged(TransitTime(length=4), 0.4, **push)["transits"].measured == 0


def test_several_planes_between_two_samples():
    found = dragged(TransitTime(length=0.25), 1.3, steps=40)
    assert found["mean transit time"].measured == pytest.approx(0.25 / 1.3)


def test_residence_of_what_is_dragged_through():
    region = ResidenceTime(region=[[18, 23], [0, 20]], every=7)  # over the end of the box
    found = dragged(region, 0.37)
    assert found["mean residence time"].measured == pytest.approx(5 / 0.37, rel=0.02)
    assert found["share of the time"].measured == pytest.approx(5 / 20, abs=0.02)
    # of beads: from when the first one comes in until the last is out
    beads = ResidenceTime(region=[[18, 23], [0, 20]], of="beads", every=7)
    found = dragged(beads, 0.37)
    assert found["mean residence time"].measured == pytest.approx((5 + 3) / 0.37, rel=0.02)


def test_translocation_is_extension_over_velocity():
    found = dragged(TranslocationTime(position=4.0), 0.37)
    assert found["mean translocation time"].measured == pytest.approx(3 / 0.37)
    assert found["share of tries"].measured == 1
    starts, ends = (np.linspace(0.3, 15.7, 3) - 4 + way for way in (0, 399 * 0.7 * 0.37))
    ahead = np.ceil((starts + 1.5) / 20)  # first plane that nobody has passed
    assert found["translocations"].measured == (np.floor((ends - 1.5) / 20) - ahead + 1).sum()
    # planes nearer than a molecule is long: nobody saw when it began with the second one
    assert dragged(TranslocationTime(length=2.0), 0.37)["translocations"].measured == 0


def test_who_draws_back_has_tried_in_vain():
    observable = TranslocationTime(position=10.0)
    case = case_with(observable, length=4)
    way = [2, 6, 9, 10.2, 9, 6, 9, 11, 13, 6, 13]  # in vain once, through, back, and through
    beads = np.array(way)[:, None, None, None] * [1.0, 0.0] + ROD
    found = followed(observable, case, np.arange(len(way), dtype=float), beads).result()
    assert found["translocations"].measured == 2
    assert found["share of tries"].measured == pytest.approx(2 / 3)
    # front at 10 from 7.5 to 10.5 in a step, back from 9.5 to 11.5; then from 7.5 to 14.5 at once
    first = (7 + 0.5 / 2) - (5 + 2.5 / 3)
    second = (5.5 - 2.5) / 7
    assert found["mean translocation"].measured == pytest.approx((first + second) / 2)


def walk(observable, case, steps, number, seed=1):
    """Ideal walkers that drift: Gaussian steps, so that every sample is exact."""
    drift = drift_of(case, observable.accumulator(case).group)
    interval = observable.every * case.fluid.timestep
    rng = np.random.default_rng(seed)
    scale = np.sqrt(2 * drift.diffusion * interval)
    r = rng.random((number, 1, 2)) * 20
    ways = []
    for _ in range(steps):
        ways.append(r)
        r = r + drift.velocity * interval + scale * rng.normal(size=r.shape)
    return followed(observable, case, interval * np.arange(steps), ways).result()


@pytest.mark.parametrize("steps", [500, 2000])
def test_walkers_leave_a_slab_in_the_mean_exit_time(steps):
    """Also in a run whose ends cut many visits."""
    number = 200_000 // steps
    observable = ResidenceTime(region=[[5, 8], [0, 20]], every=20)
    found = walk(observable, case_with(observable, number, 1, timestep=0.1), steps, number)
    time, share = found["mean time until exit"], found["share of the time"]
    assert time.error < 0.06 * time.expected
    assert abs(time.deviation) < 3.5, time
    assert share.expected == pytest.approx(0.15) and abs(share.deviation) < 3.5, share


def test_visits_as_long_as_the_run_are_a_lower_bound():
    observable = ResidenceTime(region=[[5, 8], [0, 20]], every=20)
    found = walk(observable, case_with(observable, 100, 1, timestep=0.1), 50, 100)
    assert "lower bound" in found["mean time until exit"].note


@pytest.mark.parametrize("steps", [150, 1000])
def test_walkers_that_drift_pass_planes_as_schroedinger_says(steps):
    """Also with some six transits of each molecule."""
    number = 150_000 // steps
    observable = TransitTime(length=2, every=20)
    case = case_with(observable, number, 1, timestep=0.1, force=Uniform((3.0, 0.0)))
    found = walk(observable, case, steps, number)
    for what in ("mean transit time", "velocity", "length over velocity"):
        assert found[what].error < 0.03 * abs(found[what].measured)
    assert abs(found["velocity"].deviation) < 3.5, found
    time = found["mean transit time"]
    assert abs(time.deviation) < 3.5, time
    # 7000 transits that scatter by 0.58 of their mean: 0.7 %; those that have ended are 4 % short
    assert abs(time.percent) < 3.5 * 0.7, time
    if steps == 1000:
        width = np.diff(found.extra["edges"])
        number = found["transits"].measured
        some = number * width * found.expected > 20
        counts, wanted = (number * width * y for y in (found.value, found.expected))
        chi = ((counts - wanted) ** 2 / wanted)[some]
        assert some.sum() > 8 and chi2.sf(chi.sum(), some.sum()) > 1e-3


def test_few_transits_scatter_as_their_number_does():
    """Error bars knew of the mean alone, half of the scatter."""
    observable = TransitTime(length=2, every=20)
    case, known = case_with(observable, 300, 1, timestep=0.1), []
    for seed in range(24):
        found = walk(observable, case, 100, 300, seed)
        time = found["mean transit time"]
        assert "few" in time.note and found["transits"].measured < 150
        known.append((time.measured, time.error))
    value, error = np.array(known).T
    assert 0.6 < value.std(ddof=1) / np.sqrt(np.mean(error**2)) < 1.4


@pytest.mark.parametrize("everything", [False, True])
def test_momentum_that_all_have_together_is_sure(everything):
    """A mean that cannot change had the scatter of the molecules as its error."""
    rng, means = np.random.default_rng(2), MeansOverMolecules(50, 1, everything)
    for _ in range(100):
        velocity = rng.normal(size=(50, 1))
        means.add(velocity - velocity.mean() + 0.3)
    assert means.mean()[0] == pytest.approx(0.3)
    assert (means.error()[0] < 1e-9) == everything


@pytest.mark.parametrize("of", ["gyration", "end-to-end", "orientation"])
@pytest.mark.parametrize("size", [(20, 20), (20, 20, 20)])
def test_ideal_chains_are_distributed_as_theory_says(of, size):
    observable = MoleculeHistogram(of=of, bins=12)
    case = case_with(observable, number=400, length=6, size=size)
    rng, d = np.random.default_rng(5), len(size)
    bonds = rng.normal(size=(20, 400, 5, d)) * np.sqrt(1 / (2 * 1.5))
    beads = np.concatenate([np.zeros((20, 400, 1, d)), bonds.cumsum(axis=2)], axis=2)
    found = followed(observable, case, np.arange(20.0), beads).result()
    assert abs(found.comparisons[0].deviation) < 3.5
    counts, wanted = (
        8000 * np.diff(found.extra["edges"]) * y for y in (found.value, found.expected)
    )
    some = wanted > 20
    chi = ((counts - wanted) ** 2 / wanted)[some]
    assert some.sum() > 5 and chi2.sf(chi.sum(), some.sum() - 1) > 1e-3
    error = 8000 * np.diff(found.extra["edges"]) * found.error
    assert 0.8 < np.mean(error[some] / np.sqrt(wanted * (1 - wanted / 8000))[some]) < 1.4
    assert found.value @ np.diff(found.extra["edges"]) == pytest.approx(1, abs=1e-3)


def test_events_of_pooled_runs_are_those_of_all():
    observable = TransitTime(length=5)
    case = case_with(observable, length=4)
    times = np.arange(200.0)
    both = []
    for speed in (0.5, 1.0):
        beads = ROD + (speed * times)[:, None, None, None] * [1.0, 0.0]
        both.append(followed(observable, case, times, beads))
    numbers = [a.durations.number for a in both]
    both[0].pool(both[1])
    found = both[0].result()
    assert found["transits"].measured == sum(numbers)
    mean = (numbers[0] * 10 + numbers[1] * 5) / sum(numbers)
    assert found.extra["mean"] == pytest.approx(mean)
    one = TransitTime(length=5).accumulator(case).result()
    assert one.samples == 0 and found.samples == 400


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (ResidenceTime(region=[[0, 5]]), "expected \\[from, to\\] along each of the 2 axes"),
        (ResidenceTime(region=[[5, 0], [0, 20]]), "expected from < to"),
        (ResidenceTime(), "there is no solid to be near"),
        (ResidenceTime(region=[[0, 5], [0, 20]], solid="post"), "no effect with a region"),
        (MoleculeHistogram(of="gyration", axis="x"), "axis: no effect"),
        (MoleculeHistogram(of="orientation", largest=3.0), "largest: no effect"),
    ],
)
def test_what_cannot_be_is_refused(observable, words):
    with pytest.raises(CaseError, match=words):
        case_with(observable)


def test_near_a_solid_of_a_name(make_case):
    from mesokit import FENE, Polymer, Solutes

    post = Disk(centre=(10.0, 10.0), radius=3.0, name="post")
    solutes = Solutes((Polymer(1, length=4),), bond=FENE())
    with pytest.raises(CaseError, match="solid = 'pots': expected one of post"):
        make_case((20, 20), [ResidenceTime(solid="pots")], walls=(post,), solutes=solutes)
    observable = ResidenceTime(solid="post", near=1.0)
    case = make_case((20, 20), [observable], walls=(post,), solutes=solutes)
    accumulator = observable.accumulator(case)
    places = np.array([[[14.2, 10.0]], [[13.8, 10.0]], [[30.0, 26.5]]])
    np.testing.assert_array_equal(accumulator.within(places), [False, True, True])


@pytest.mark.parametrize(
    ("observable", "known"),
    [
        (MeanSquareDisplacement(of="centres"), False),
        (NormalModes(), False),
        (MoleculeSize(), True),
    ],
)
def test_a_magnetic_field_leaves_shapes_alone_and_motion_without_a_theory(
    make_case, observable, known
):
    chains = {"polymers": (Polymer(5, length=4),), "bond": Harmonic(K=1.5), "solvent": "random"}
    turned, quiet = (
        observable.accumulator(
            make_case((20, 20), [observable], solutes=Solutes(**chains, magnetic=field))
        ).result()
        for field in ([MagneticField([0.0, 0.0, 30.0])], ())
    )
    assert quiet.expected is not None and np.isfinite(quiet.expected).all()
    assert (turned.expected is not None and np.isfinite(turned.expected).all()) == known


@pytest.mark.parametrize(("kept", "looks", "width"), [(0.5, 4, 40), (0.9, 1, 120), (0.9, 20, 200)])
def test_mean_exit_time_knows_how_long_velocities_are_remembered(kept, looks, width):
    """Against walkers whose velocity keeps a share in each step of time 1."""
    rng = np.random.default_rng(3)
    x, v = rng.random(10_000) * width, rng.normal(size=10_000)
    left, step = np.zeros(len(x)), 0
    while (inside := left == 0).any():
        step += 1
        v[inside] = kept * v[inside] + (1 - kept**2) ** 0.5 * rng.normal(size=inside.sum())
        x[inside] += v[inside]
        if step % looks == 0:
            left[inside & ((x < 0) | (x > width))] = step
    diffusion = 0.5 + kept / (1 - kept)
    expected = theory.mean_exit_time(width, diffusion, looks, diffusion - 0.5)
    assert expected > 1.05 * theory.mean_exit_time(width, diffusion, looks)
    assert abs(left.mean() - expected) < 3.5 * left.std() / len(x) ** 0.5 + 0.03 * expected


def test_mean_exit_time_knows_how_often_one_looks():
    """Against walkers on a line, many of them, as Chernoff has it."""
    rng = np.random.default_rng(7)
    x = rng.random(20_000) * 4
    left, step = np.zeros(len(x)), 0
    while (inside := left == 0).any():
        step += 1
        x[inside] += 0.4 * rng.normal(size=inside.sum())
        left[inside & ((x < 0) | (x > 4))] = step
    expected = theory.mean_exit_time(4, 0.08, 1.0)
    assert abs(left.mean() - expected) < 3.5 * left.std() / len(x) ** 0.5 + 0.005 * expected
