"""Forces, torques and flow rates of fluids that give a known momentum to their walls."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mesokit import (
    SRD,
    Array,
    Cylinder,
    Disk,
    FlowRate,
    Forces,
    MaxwellBoltzmann,
    Plates,
    Sphere,
    SRDPlusA,
    Surface,
    Uniform,
    WallStress,
    theory,
)
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.observe.shared.tensor import kept
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.run.simulation import Simulation
from tests.helpers.comparisons import by_name
from tests.helpers.fake_fluid import FakeFluid

LATE = Run(steps=1, warmup=10**6)  # its flow has built up
PUSHED = {"force": Uniform((0.01, 0)), "thermostat": MaxwellBoltzmann()}


def fed(case, observable, mean, samples=400, noise=1.0, seed=1, **fluid):
    """What it says of surfaces that take `mean` (surfaces, columns) per time, with noise."""
    accumulator, fake = observable.accumulator(case), FakeFluid(case, seed, **fluid)
    rng = np.random.default_rng(seed)
    for _ in range(samples):
        fake.jump(10)
        taken = np.array(mean) + noise * rng.normal(size=np.shape(mean))
        fake.hit_walls(taken * 10 * fake.timestep, 10)
        accumulator.observe(fake)
    return accumulator.result()


def channel_case(make_case):
    walls = [Plates(axis="y"), Disk(centre=[8, 4], radius=1.5, name="post")]
    return make_case((16, 8), [Forces()], walls, **PUSHED)


def test_force_and_torque_of_each_body(make_case):
    case = channel_case(make_case)
    mean = [[3.0, -80.0, 0.0], [3.0, 80.0, 0.0], [6.0, 0.0, 2.0]]
    result = fed(case, Forces(), mean)
    assert list(result.x["body"]) == ["plates-1-lower", "plates-1-upper", "post"]
    assert list(result.x["component"]) == ["fx", "fy", "tz"]
    assert np.abs((result.value - mean) / result.error).max() < 4
    assert result.error == pytest.approx(np.full((3, 3), 0.05), rel=0.5)
    assert result.units["fx"] == "m a/tau^2" and result.units["tz"] == "m a^2/tau^2"
    assert result.extra["series"].shape == (400, 3, 3)
    total = by_name(result)["force on all solids along x"]
    assert total.expected == pytest.approx(10 * 0.01 * free_volume(case))
    assert total.measured == pytest.approx(12, abs=4 * total.error)
    share = by_name(result)["share of post along x"]
    assert share.measured == pytest.approx(100 * 6 / total.expected, abs=4 * share.error)


def test_momentum_that_is_given_back_does_not_widen_error_bars(make_case):
    """A surface takes what the fluid loses: over a long time no more than it can have lost."""
    case = make_case((12, 12), [Forces()], [Disk(centre=[6, 6], radius=2)], **PUSHED)
    rng, ends = np.random.default_rng(3), []
    for _ in range(40):
        accumulator, fake = Forces().accumulator(case), FakeFluid(case, 1)
        momentum = rng.normal(size=(801, 3)) * (10 * free_volume(case)) ** 0.5
        for gained in np.diff(momentum, axis=0):
            fake.hit_walls(-gained[None], 10)
            accumulator.observe(fake)
        result = accumulator.result()
        ends.append([result.value[0], result.error[0]])
    value, error = np.array(ends).transpose(1, 0, 2)
    scatter = np.sqrt((value**2).mean(axis=0))
    # known for forces; for the torque, which nothing balances, from a few blocks: up to 3 times
    assert error[:, :2].mean(axis=0) == pytest.approx(scatter[:2], rel=0.4)
    assert scatter[2] < np.median(error[:, 2]) < 4 * scatter[2]


def test_beads_of_solutes_are_pushed_once(make_case):
    """The force on the fluid, and the mass that the superficial velocity counts."""
    beads = Solutes((Polymer(12),), mass=10.0)
    plain = channel_case(make_case)
    case = dataclasses.replace(plain, solutes=beads)
    mean = [[3.0, 0, 0], [3.0, 0, 0], [7.0, 0, 0]]
    total = by_name(fed(case, Forces(), mean))["force on all solids along x"]
    mass = 10 * free_volume(case) + 120
    assert total.expected == pytest.approx(0.01 * mass)
    assert setting.mass_density(case) == pytest.approx(mass / free_volume(case))
    assert setting.superficial_mass(case) == pytest.approx(mass * 128 / free_volume(case))


def test_force_on_one_solid_is_the_force_on_the_fluid(make_case):
    case = make_case((12, 12), [Forces()], [Disk(centre=[6, 6], radius=2)], **PUSHED)
    result = Forces().accumulator(case).result()
    assert result.expected[0, :2] == pytest.approx([0.1 * free_volume(case), 0])
    assert np.isnan(result.expected[0, 2])


def test_forces_on_plates_are_those_of_wall_stress(make_case):
    walls = [Plates(axis="y", upper=Surface(velocity=(0.5, 0)))]
    case = make_case((4, 8), [Forces()], walls, **PUSHED)
    stress = WallStress().accumulator(make_case((4, 8), [WallStress()], walls, **PUSHED))
    expected = Forces().accumulator(case).expected()
    assert expected[:, :2] == pytest.approx(4 * stress.result().expected)


def test_drag_lift_and_reynolds_number_of_a_given_speed(make_case):
    observable = Forces(length=3.0, speed=0.2)
    case = make_case((12, 12), [observable], [Disk(centre=[6, 6], radius=1.5)], **PUSHED)
    found = by_name(fed(case, observable, [[6.0, 1.2, 0.0]]))
    scale = 2 / (10 * 0.2**2 * 3)
    for kind, force in (("drag", 6.0), ("lift", 1.2)):
        coefficient = found[f"{kind} coefficient of disk-1"]
        assert coefficient.measured == pytest.approx(force * scale, abs=4 * coefficient.error)
        assert coefficient.error == pytest.approx(0.05 * scale, rel=0.5)
    nu = setting.transport(case).viscosity
    assert found["Reynolds number"].measured == pytest.approx(0.6 / nu)


def test_measured_speed_has_its_part_in_the_error_of_the_drag(make_case):
    observable = Forces(length=3.0, every=10)
    case = make_case((12, 12), [observable], [Disk(centre=[6, 6], radius=1.5)], **PUSHED)
    case = dataclasses.replace(case, run=LATE)

    def moving(r):
        return np.full(r.shape, (0.3, 0.0))

    found = by_name(fed(case, observable, [[60.0, 0.0, 0.0]], noise=0.01, field=moving))
    share = free_volume(case) / 144
    drag = found["drag coefficient of disk-1"]
    assert drag.measured == pytest.approx(120 / (30 * (0.3 * share) ** 2), abs=4 * drag.error)
    relaxation = 0.3 / 0.01  # the force gives that momentum in this time
    assert f"the run has {400 / relaxation:.2g} relaxation times" in drag.note
    speed_error = np.sqrt(kept(400 / relaxation) / case.particles) * share
    assert drag.error == pytest.approx(2 * drag.measured * speed_error / (0.3 * share), rel=0.1)


def test_sphere_coefficients_are_of_an_area(make_case):
    observable = Forces(length=2.0, speed=0.1, area=np.pi)
    walls = [Sphere(centre=[4, 4, 4], radius=1)]
    case = make_case((8, 8, 8), [observable], walls, force=Uniform((0, 0, 0.01)))
    found = by_name(fed(case, observable, [[0.0, 0.0, 5.0, 0, 0, 0]], samples=40))
    drag = found["drag coefficient of sphere-1"]
    assert drag.measured == pytest.approx(10 / (10 * 0.01 * np.pi), abs=4 * drag.error)
    assert "lift coefficient of sphere-1 along x" in found


def test_torque_between_round_surfaces(make_case):
    walls = [
        Disk(centre=[8, 8], radius=6, fluid="inside"),
        Disk(centre=[8, 8], radius=2, surface=Surface(rotation=0.1)),
    ]
    for rule, one_sided in ((SRD(angle=90), True), (SRDPlusA(angle=90), False)):
        case = make_case((16, 16), [Forces()], walls, collision=rule)
        t = setting.transport(case)
        shear = 4 * np.pi * 10 * t.viscosity * 0.1 * 4 * 36 / 32
        spin = 2 * np.pi * 10 * t.viscosity_collisional * 4 * 0.1 if one_sided else 0
        expected = Forces().accumulator(case).expected()
        assert expected[:, 2] == pytest.approx([shear, spin - shear])
        assert np.all(expected[:, :2] == 0)


def test_time_series_of_many_bodies_stays_bounded(make_case):
    walls = [Disk(centre=[2 + 3 * i, 4], radius=1) for i in range(8)]
    case = make_case((24, 8), [Forces()], walls)
    accumulator = Forces().accumulator(case)
    fake = FakeFluid(case)
    for _ in range(5000):
        fake.hit_walls(np.ones((8, 3)), 10)
        accumulator.observe(fake)
    result = accumulator.result()
    assert result.extra["series"].shape == (2500, 8, 3)
    assert np.all(result.extra["series"] == 1.0)
    assert result.samples == 5000


@pytest.mark.parametrize(
    ("observe", "words"),
    [
        ([Forces(speed=0.1)], "speed: no effect without length"),
        ([Forces(length=1.0, area=2.0)], "area: only in 3D"),
        ([Forces(length=1.0, flow="z")], "flow = 'z': a 2D box"),
        ([Forces(length=1.0)], "flow: missing"),
        ([FlowRate(axis="z")], "axis = 'z': a 2D box"),
    ],
)
def test_what_makes_no_sense_is_refused(make_case, observe, words):
    with pytest.raises(CaseError, match=words) as error:
        make_case((8, 8), observe, [Disk(centre=[4, 4], radius=1)])
    assert "\n" not in str(error.value)


def test_forces_are_those_on_walls_that_count_them(make_case):
    assert make_case((8, 8), [WallStress(), Forces()], [Plates(axis="y")])
    with pytest.raises(CaseError, match="needs a"):
        make_case((8, 8), [Forces()])
    with pytest.raises(CaseError, match="not counted with virtual = 'top-up'"):
        make_case((8, 8), [Forces()], [Plates(axis="y", virtual="top-up")])
    body = Disk(centre=[4, 4], radius=1, virtual="top-up")
    assert make_case((8, 8), [Forces()], [body])


# --- flow rate ----------------------------------------------------------------------------------


def flowing(case, observable, velocity, samples=300):
    accumulator = observable.accumulator(case)
    fake = FakeFluid(case, field=lambda r: np.full(r.shape, velocity))
    for _ in range(samples):
        fake.jump(10)
        accumulator.observe(fake)
    return accumulator.result()


@pytest.mark.parametrize(("samples", "short"), [(200, True), (3000, False)])
def test_shares_and_coefficients_of_a_short_run_have_its_caveat(make_case, samples, short):
    """That of the flow rate; the error of the whole force is known in a run of any length."""
    walls = [Plates(axis="y"), Disk(centre=[8, 4], radius=1.5, name="post")]
    given = Forces(length=3.0, speed=0.25, every=10)
    case = make_case((16, 8), [given], walls, **PUSHED)
    case = dataclasses.replace(case, run=LATE)

    def moving(r):
        return np.full(r.shape, (0.25, 0.0))

    mean = [[3.0, -80.0, 0.0], [3.0, 80.0, 0.0], [6.0, 0.0, 2.0]]
    found = by_name(fed(case, given, mean, samples, noise=0.01, field=moving))
    words = "error bar is a lower bound: the run has "
    notes = {what: one.note.partition(words)[2] for what, one in found.items()}
    marked = {what for what, times in notes.items() if times}
    assert all(float(notes[what].split()[0]) == pytest.approx(8, rel=0.1) for what in marked)
    flow = {"Reynolds number", "drag coefficient of post", "lift coefficient of post"}
    shares = {what for what in found if what.startswith("share of")}
    assert len(shares) == 3 and marked == (flow | shares if short else set())
    assert "force on all solids along x" in found


def test_flow_rate_counts_the_solids(make_case):
    case = make_case((12, 12), [FlowRate()], [Disk(centre=[6, 6], radius=3)], **PUSHED)
    case = dataclasses.replace(case, run=LATE)
    result = flowing(case, FlowRate(), (0.2, 0.0))
    found, share = by_name(result), free_volume(case) / 144
    mean = found["mean velocity along x"]
    assert mean.measured == pytest.approx(0.2 * share, abs=4 * mean.error)
    relaxation = 0.2 / 0.01  # the force gives that momentum in this time
    assert "15 relaxation times" in mean.note and "lower bound" in mean.note
    thermal = kept(300 / relaxation) / case.particles
    assert mean.error == pytest.approx(share * np.sqrt(thermal), rel=0.02)
    rate = found["flow rate along x"]
    assert rate.measured == pytest.approx(12 * mean.measured)
    k = found["permeability along x"]
    assert k.measured == pytest.approx(setting.transport(case).viscosity * mean.measured / 0.01)
    assert k.expected == pytest.approx(theory.square_array_permeability(np.pi * 9 / 144, 12))
    assert len(result.value) == 300 and result.extra["mean"] == mean.measured


class Slowing:
    """A fluid whose momentum fluctuates, and is forgotten in a time, about the flow of a force."""

    def __init__(self, case, time, push, seed):
        self.rng, self.time = np.random.default_rng(seed), 0.0
        self.mass, self.keep = case.particles, np.exp(-1.0 / time)
        self.mean = self.mass * push * time
        self.momentum = self.rng.normal() * self.mass**0.5

    def totals(self):
        self.time += 1.0
        noise = np.sqrt((1 - self.keep**2) * self.mass) * self.rng.normal()
        self.momentum = self.keep * self.momentum + noise
        return self.mass, np.array([self.mean + self.momentum, 0.0]), 0.0


@pytest.mark.parametrize("relaxations", [3, 12, 22])
def test_error_bars_of_flow_rates_hold_in_short_runs(make_case, relaxations):
    case, runs = make_case((12, 12), [FlowRate()], [Disk(centre=[6, 6], radius=3)], **PUSHED), 60
    values, errors = [], []
    for seed in range(runs):
        accumulator, fluid = FlowRate().accumulator(case), Slowing(case, 20.0, 0.01, seed)
        for _ in range(20 * relaxations):
            accumulator.observe(fluid)
        mean = accumulator.result()["mean velocity along x"]
        values.append(mean.measured)
        errors.append(mean.error)
    assert np.std(values) / np.mean(errors) == pytest.approx(1, abs=3 / np.sqrt(2 * runs))


def expected_of(make_case, size, walls, **fluid):
    observable = FlowRate()
    case = make_case(size, [observable], walls, **fluid)
    return case, observable.accumulator(case).expected()


def test_expected_flow_rates(make_case):
    case, (speed, name) = expected_of(make_case, (4, 12), [Plates(axis="y")], **PUSHED)
    nu = setting.transport(case).viscosity
    assert speed == pytest.approx(0.01 * 144 / (12 * nu)) and name == "poiseuille"
    pipe = [Cylinder(centre=[8, 8, 0], radius=6, axis="z", fluid="inside")]
    push = {"force": Uniform((0, 0, 0.01))}
    case, (speed, name) = expected_of(make_case, (16, 16, 4), pipe, **push)
    nu = setting.transport(case).viscosity
    assert speed * 256 == pytest.approx(np.pi * 0.01 * 6**4 / (8 * nu))
    case, (speed, name) = expected_of(
        make_case, (12, 12, 12), [Sphere(centre=[6, 6, 6], radius=3)], **push
    )
    nu, c = setting.transport(case).viscosity, 4 * np.pi / 3 / 64
    drag = 6 * np.pi * 10 * nu * 3 * theory.cubic_array_drag(c) * speed
    assert drag == pytest.approx(10 * 0.01 * 12**3) and "cubic" in name
    posts = [Array(of=Disk(centre=[3, 3], radius=1.5), repeat=[4, 2])]
    case, (speed, name) = expected_of(make_case, (24, 12), posts, **PUSHED)
    nu, c = setting.transport(case).viscosity, np.pi / 16
    assert theory.square_array_drag(c) * 10 * nu * speed == pytest.approx(10 * 0.01 * 36)
    _, (speed, name) = expected_of(make_case, (24, 24), [Plates(axis="y")])
    assert (speed, name) == (0.0, "rest")


def test_nothing_is_expected_where_no_theory_is_known(make_case):
    odd = [Disk(centre=[6, 6], radius=2), Disk(centre=[12, 5], radius=2)]
    for walls in (odd, [Disk(centre=[6, 6], radius=2)]):
        _, (speed, name) = expected_of(make_case, (18, 12), walls, **PUSHED)
        assert np.isnan(speed) and name == ""


def test_recognition(make_case):
    def case(size, walls):
        return make_case(size, walls=walls)

    tilted = Cylinder(centre=[6, 6, 6], radius=2, axis=(0, 0, 2))
    assert recognise.lattice(case((12, 12, 6), [tilted])).across == (0, 1)
    wide = case((16, 16, 16), [Cylinder(centre=[8, 8, 8], radius=4, fluid="inside", axis="x")])
    assert recognise.pipe(wide).axis == 0 and recognise.lattice(wide) is None
    turning = Disk(centre=[6, 6], radius=2, surface=Surface(rotation=0.1))
    assert recognise.lattice(case((12, 12), [turning])) is None
    shell = Disk(centre=[6, 6], radius=5, fluid="inside")
    gap = recognise.gap(case((12, 12), [turning, shell]))
    assert (gap.inner, gap.outer, gap.inner_rate, gap.outer_rate) == (2, 5, 0.1, 0)
    aside = Disk(centre=[6.5, 6], radius=2)
    assert recognise.gap(case((12, 12), [aside, shell])) is None
    slip = Disk(centre=[6, 6], radius=2, surface=Surface(rule="slip"))
    assert recognise.gap(case((12, 12), [slip, shell])) is None


# --- real runs ----------------------------------------------------------------------------------


def test_momentum_of_a_real_flow_is_balanced(make_case):
    """A post in a channel: all that drives the fluid ends in the solids."""
    parts = make_case(
        (32, 16),
        [Forces(length=4.0), FlowRate()],
        [Plates(axis="y"), Disk(centre=[16, 8], radius=2)],
        force=Uniform((0.01, 0)),
        thermostat=MaxwellBoltzmann(),
        collision=SRD(angle=90),
    )
    run = type(parts.run)(steps=4000, warmup=1500)
    simulation = Simulation(Case(**{**vars(parts), "run": run}), threads=1)
    simulation.run()
    found = by_name(simulation["forces"])
    total = found["force on all solids along x"]
    # the momentum of the fluid, N kT of its square, is all that stands between the two
    assert total.error == pytest.approx((2 * 10 * free_volume(parts)) ** 0.5 / 400)
    assert abs(total.deviation) < 4 and abs(total.percent) < 4
    share = found["share of disk-1 along x"]
    # own lattice Boltzmann value of this channel, docs/theory.md
    assert share.measured == pytest.approx(43.9, abs=4 * share.error + 2)


def test_nothing_is_expected_where_nothing_holds_the_fluid(make_case):
    slip = Plates(axis="y", lower=Surface(rule="slip"), upper=Surface(rule="slip"))
    case = make_case((16, 8), [Forces()], [slip], **PUSHED)
    (found,) = fed(case, Forces(), np.zeros((2, 3)), samples=50).comparisons
    assert np.isnan(found.expected)
    assert str(found).endswith("(nothing holds the fluid)")
    mixed = Plates(axis="y", lower=Surface(rule="slip"))
    case = make_case((16, 8), [Forces()], [mixed], **PUSHED)
    assert fed(case, Forces(), np.zeros((2, 3)), samples=50).comparisons[0].expected > 0


def test_a_body_force_pulls_beads_too(make_case):
    """The balance that solids are compared with has fluid and solutes in it."""
    solutes = Solutes((Polymer(30),), mass=10.0)
    push, disk = Uniform((0.01, 0.0)), Disk(centre=(6, 6), radius=2)
    total = {}
    for given in (None, solutes):
        case = make_case((12, 12), [Forces()], [disk], density=5, force=push, solutes=given)
        total[given is None] = case.observe[0].accumulator(case).total()[0]
    assert total[False] - total[True] == pytest.approx(0.01 * 30 * 10)


def test_several_observers_of_the_walls_see_the_same_and_go_on_after_a_stop(make_case):
    """What walls take is cumulative: no reading takes it from another, at any interval."""
    disk = [Disk(centre=[6, 6], radius=2)]
    case = make_case((12, 12), [Forces(every=10), Forces(every=20, name="b")], disk, **PUSHED)
    often, seldom, fake = case.observe[0].accumulator(case), case.observe[1].accumulator(case), None
    rng, fake = np.random.default_rng(5), FakeFluid(case, 1)
    for step in range(1, 9):
        fake.hit_walls(rng.normal(size=(1, 3)), 10)
        often.observe(fake)
        if step % 2 == 0:
            seldom.observe(fake)
        if step == 4:
            again = case.observe[0].accumulator(case)
            again.restore(often.state())
            often = again
    np.testing.assert_allclose(often.result().value, seldom.result().value, rtol=0, atol=1e-9)
