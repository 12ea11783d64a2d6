"""What is measured of bodies that move in a fluid."""

from __future__ import annotations

import re

import numpy as np
import pytest

import mesokit
from mesokit import (
    SRD,
    ATPlusA,
    BodyCorrelation,
    BodyDisplacement,
    BodyDrift,
    BodyMotion,
    BodyTracks,
    Box,
    Case,
    CaseError,
    Fluid,
    Run,
    RunError,
    SphereBody,
    SRDPlusA,
    theory,
)
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.protocol import BodyStart, BodyTrap, CounterForce, Squirming
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import every_kind, followed
from mesokit.report.figures import plot
from mesokit.run.simulation import Simulation
from mesokit.seam.estimate import Estimate
from tests.helpers.moving_disks import DISKS, LATTICE, moving_disks, with_a_plank

STEP = 0.1
PLANKS = {"kind": "planks"}
OBSERVABLES = (BodyCorrelation, BodyDisplacement, BodyDrift, BodyMotion, BodyTracks)


class Scripted:
    """Four bodies, the last of another kind: each has a velocity and turns at a rate."""

    def __init__(self, velocity, rate):
        self.velocity, self.rate = np.array(velocity, float), np.array(rate, float)
        self.time, self.step, self.bodies, self.number = 0.0, 0, self, 4
        self.masses = np.ones(4)

    def advance(self):
        self.step, self.time = self.step + 1, STEP * (self.step + 1)

    def places(self, unwrapped):
        assert unwrapped
        return 1.0 + self.time * self.velocities

    def _about_z(self, values):
        return np.stack([0 * values, 0 * values, values], axis=1)

    def in_own_frame(self, vectors):
        return vectors

    def counts(self):
        return {"second hits": 3, "put back": self.step % 2, "still hitting": 0}

    def totals(self):
        return 104, np.zeros(2), 0.5 * (2 * 100 + 7)

    def motion(self):
        return np.array([0.0, 0.0, 7.0])

    @property
    def headings(self):
        turned = self.rate * self.time
        return np.stack([np.cos(turned), np.sin(turned)], axis=1)

    velocities = property(lambda self: self.velocity)
    spins = property(lambda self: self._about_z(self.rate))
    angles = property(lambda self: self._about_z(self.rate * self.time))
    forces = property(lambda self: 2 * self.velocity)
    torques = property(lambda self: self._about_z(3 * self.rate))


def seen(observable, case=None, velocity=((1, 0), (0, 2), (-1, 1), (0.5, 0)), rate=(1, 1, 1, 2)):
    """The result of bodies that move so for 40 steps."""
    case = with_a_plank(observe=[observable]) if case is None else case
    accumulator, bodies = observable.accumulator(case), Scripted(velocity, rate)
    for _ in range(40):
        accumulator.observe(bodies)
        bodies.advance()
    return accumulator.result()


@pytest.mark.parametrize("kind", OBSERVABLES)
def test_they_need_bodies(kind):
    with pytest.raises(CaseError, match="needs bodies that move in the fluid"):
        moving_disks(bodies=(), observe=[kind()])


def test_a_kind_is_found_by_its_name_or_number():
    case = with_a_plank()
    one, other = every_kind(case, "this")
    assert (one.name, one.number, one.rows) == ("disks", 3, slice(0, 3))
    assert (other.name, other.mass, other.rows) == ("planks", 60, slice(3, 4))
    assert other.moments[2] == pytest.approx(60 * (4**2 + 2**2) / 12)
    assert followed(case, "this", "planks").place == followed(case, "this", 2).place == 1
    for unknown in (0, 3, "plank"):
        with pytest.raises(CaseError, match="expected 'disks', 'planks', 1 or 2"):
            with_a_plank(observe=[BodyDrift(kind=unknown)])


def test_tracks_have_all_that_a_body_does():
    result = seen(BodyTracks(**PLANKS))
    names = [
        "x", "y", "heading x", "heading y", "angle", "vx", "vy", "spin", "force x", "force y",
        "torque",
    ]  # fmt: skip
    assert result.x["component"].tolist() == names and result.value.shape == (40, 1, 11)
    t = result.x["time"]
    rows = [
        1 + 0.5 * t, 1 + 0 * t, np.cos(2 * t), np.sin(2 * t), 2 * t, 0.5 + 0 * t, 0 * t,
        2 + 0 * t, 1 + 0 * t, 0 * t, 6 + 0 * t,
    ]  # fmt: skip
    np.testing.assert_allclose(result.value[:, 0], np.transpose(rows), atol=1e-12)
    assert seen(BodyTracks(bodies=2)).x["body"].tolist() == [1, 2]
    assert plot(result).axes[0].get_xlabel().startswith("$x$")


def test_displacements_of_free_flights():
    result = seen(BodyDisplacement(max_lag=20))
    t = result.x["time"]
    np.testing.assert_allclose(result.value, (1 + 4 + 2) / 3 * t**2, atol=1e-12)
    assert result.extra["components"] == "xy"
    result = seen(BodyDisplacement(of="angles", max_lag=20, **PLANKS))
    np.testing.assert_allclose(result.value, 4 * t**2, atol=1e-12)
    assert result.extra["components"] == "z" and result.units["value"] == ""
    label = plot(result).axes[0].get_ylabel()
    assert label == "mean square angular displacement"


def walked(observable, steps, size):
    """The result of bodies that forget where they go, and turn, at each step."""
    case = moving_disks(observe=[observable])
    accumulator, rng = observable.accumulator(case), np.random.default_rng(2)
    bodies = Scripted(np.zeros((4, 2)), np.zeros(4))
    place, angle = np.zeros((4, 2)), np.zeros(4)
    for _ in range(steps):
        place += size * rng.normal(size=(4, 2))
        angle += size * rng.normal(size=4)
        bodies.velocity, bodies.rate, bodies.time = place, angle, 1.0
        accumulator.observe(bodies)
    return accumulator.result()


@pytest.mark.parametrize("of", ["places", "angles"])
def test_the_slope_is_the_diffusion_coefficient(of):
    result = walked(BodyDisplacement(of=of, max_lag=20), 1000, 0.1)
    [found] = result.comparisons
    expected = 0.1**2 / (2 * STEP)
    assert found.what == "rotational " * (of == "angles") + "diffusion coefficient"
    assert abs(found.measured - expected) < 4 * found.error < expected


def test_the_slope_of_places_is_that_after_the_longest_wave_of_the_box():
    """Its flow brings more than half of the diffusion of a disk, so that earlier slopes are low."""
    memory = 14**2 / (4 * np.pi**2 * setting.solvent(moving_disks()).viscosity)
    lag = round(6 * memory / STEP)
    result = walked(BodyDisplacement(max_lag=lag), 10 * lag, 0.1)
    fitted = result.x["time"][np.isfinite(result.fit)]
    assert fitted.min() >= 2 * memory and fitted.max() == pytest.approx(lag * STEP, rel=0.2)
    assert result.comparisons[0].note == ""
    [short] = walked(BodyDisplacement(max_lag=lag // 4), 3 * lag, 0.1).comparisons
    assert (
        f"a lower bound at such short lags: max_lag = {np.ceil(4 * memory / STEP):.0f}"
        in short.note
    )


@pytest.mark.parametrize("holds", [{"fixed": ("x", "y")}, {"trap": BodyTrap(k=1.0)}, {}])
def test_held_bodies_take_the_theory_of_a_shear_flow_away(holds):
    disk = DiskBody(radius=1.5, **holds)
    box = Box([14, 14], shear_rate=0.1)
    case = Case(run=Run(5), box=box, fluid=Fluid(density=5), bodies=(disk,))
    found = setting.flow(case, 0)
    assert found.kind == ("driven shear" if holds else "lees-edwards")
    assert (found.profile is None) == bool(holds)


def test_no_hit_turns_a_ball_with_a_slip_surface():
    """Nor a body of revolution about its own axis."""
    disks = DiskBody(radius=1.5, number=4, surface="slip")
    names = [c.what for c in seen(BodyMotion(), moving_disks(bodies=(disks,))).comparisons]
    assert any("mean square velocity" in name for name in names)
    assert not any("angular" in name for name in names)
    drift = seen(BodyDrift(), moving_disks(bodies=(disks,), observe=[BodyDrift()]))
    spin = drift["angular velocity about z"]
    assert spin.note == "as it started: no hit turns it" and np.isnan(spin.expected)
    for observable in (BodyDisplacement(of="angles"), BodyCorrelation(of="angular velocity")):
        with pytest.raises(CaseError, match="turns about no axis freely"):
            moving_disks(bodies=(disks,), observe=[observable])
    slippery = [
        mesokit.SpheroidBody(half_length=3, radius=2, surface="slip"),
        mesokit.CuboidBody(size=(4, 3, 3), surface="slip"),
    ]
    case = Case(run=Run(1), box=Box([16, 16, 16]), fluid=Fluid(), bodies=slippery)
    assert [one.untouched for one in every_kind(case, "this")] == [(0,), ()]


def test_bodies_that_move_have_a_share_of_the_pressure():
    still = DiskBody(radius=1.5, number=2, fixed=("x", "y"))
    assert setting.carriers(moving_disks())[1] == pytest.approx(5 + 3 / 14**2)
    assert setting.carriers(moving_disks(bodies=(DISKS, still)))[1] == pytest.approx(5 + 3 / 14**2)


def test_the_direction_is_forgotten_at_the_rate_of_rotational_diffusion():
    result = walked(BodyCorrelation(of="orientation", max_lag=80), 2000, 0.2)
    [found] = result.comparisons
    expected = 0.2**2 / (2 * STEP)
    assert abs(found.measured - expected) < 4 * found.error < 2 * expected
    assert result.value[0] == pytest.approx(1)


def test_correlations_of_steady_motion():
    result = seen(BodyCorrelation(max_lag=20))
    np.testing.assert_allclose(result.value, (1 + 4 + 2) / 3 / 2)  # a component
    t = result.x["time"]
    assert result["diffusion"].measured == pytest.approx(7 / 6 * t[-1])
    assert result["diffusion"].note.startswith("approximate: a lower bound, as the slowest flow")
    share = 1 - DISKS_MASS / ALL_MASS
    assert result["value at lag 0"].expected == pytest.approx(share / DISKS_MASS)
    result = seen(BodyCorrelation(of="angular velocity", max_lag=20))
    np.testing.assert_allclose(result.value, 1)
    assert result["value at lag 0"].expected == pytest.approx(2 / (DISKS_MASS * 1.5**2))
    result = seen(BodyCorrelation(of="orientation", max_lag=20, **PLANKS))
    np.testing.assert_allclose(result.value, np.cos(2 * t), atol=1e-12)


def test_an_integral_up_to_a_long_lag_is_a_diffusion_coefficient():
    """The slowest flow in this box lasts L^2/(4 pi^2 nu)."""
    case = moving_disks(observe=[BodyCorrelation()])
    slowest = 14**2 / (4 * np.pi**2 * setting.solvent(case).viscosity)
    of = BodyCorrelation().accumulator(case)
    assert of.cut_short(4.1 * slowest) == ""
    assert of.cut_short(3.9 * slowest).endswith(f"max_lag = {np.ceil(40 * slowest):.0f} is enough")


DISKS_MASS = 5 * np.pi * 1.5**2
ALL_MASS = round(5 * (14**2 - 3 * np.pi * 1.5**2 - 8)) + 3 * DISKS_MASS + 60


def test_motion_over_that_of_equipartition():
    result = seen(BodyMotion())
    disks, planks = result.value
    assert disks[0] == pytest.approx((1 + 4 + 2) / 3 * DISKS_MASS / 2)
    assert disks[1] == pytest.approx(DISKS_MASS * 1.5**2 / 2)
    assert planks == pytest.approx([0.25 * 60 / 2, 4 * 60 * 20 / 12])
    shares = 1 - np.array([DISKS_MASS, 60]) / ALL_MASS
    np.testing.assert_allclose(result.expected, np.stack([shares, [1, 1]], axis=1))
    assert result["mean square velocity of planks"].unit == "2 kT/M"
    # twice the kinetic energy of 100 particles; the bodies share their momentum
    warmth = 200 / (2 * (100 - 1 + 4 / (104 + 3 * DISKS_MASS + 60 - 4)))
    assert result["temperature of the fluid"].measured == pytest.approx(warmth)
    assert result["second hits in a step"].measured == 3
    assert result["put back in a step"].measured == 0.5


def test_equipartition_of_bodies_that_are_not_free():
    still = DiskBody(radius=1.5, number=2, fixed=("x", "orientation"), start=LATTICE)
    [one] = every_kind(moving_disks(bodies=(still,)), "this")
    assert (one.moving, one.turning, one.free_share) == ((1,), (), 1.0)
    case = moving_disks(bodies=(still,), observe=[BodyMotion()])
    result = seen(BodyMotion(), case, np.ones((4, 2)), np.ones(4))
    assert result.expected.tolist() == [[1.0, pytest.approx(np.nan, nan_ok=True)]]
    assert [c.what for c in result.comparisons][:2] == [
        "mean square velocity of disk-1", "temperature of the fluid",
    ]  # fmt: skip
    with pytest.raises(CaseError, match="disk-1 turns about no axis freely"):
        moving_disks(bodies=(still,), observe=[BodyCorrelation(of="orientation")])
    fixed = DiskBody(radius=1.5, fixed=("x", "y"))
    with pytest.raises(CaseError, match="disk-1 moves along no axis freely"):
        moving_disks(bodies=(fixed,), observe=[BodyDisplacement()])
    pushed = DiskBody(radius=1.5, force=(1.0, 0.0))
    [one] = every_kind(moving_disks(bodies=(pushed,)), "this")
    assert not one.thermal and np.isnan(one.velocity_square())


@pytest.mark.parametrize(
    ("collision", "virtual", "slips", "source"),
    [
        (ATPlusA(), "fill", (0.158, 0.075, 0.040), "balls that turn"),
        (SRDPlusA(angle=90), "fill", (0.158, 0.075, 0.040), "balls that turn"),
        (ATPlusA(), "none", (8.25, 1.32, 0.070), "plates in SRD"),
        (SRD(angle=130), "fill", (0.353, 0.22, 0.117), "plates in SRD"),
    ],
)
def test_the_slip_length_is_that_of_such_rules(collision, virtual, slips, source):
    """At mean free paths of 0.02, 0.1 and 0.5; between them by a line of logarithms."""
    of = []
    for step in (0.02, 0.1, 0.3, 0.5):
        case = Case(
            run=Run(40, seed=3),
            box=Box([14, 14]),
            fluid=Fluid(density=10, timestep=step, collision=collision),
            bodies=(DiskBody(radius=3, virtual=virtual),),
        )
        of.append(followed(case, "this").slip)
    assert [of[i][0] for i in (0, 1, 3)] == pytest.approx(slips)
    assert all(source in note for _, note in of)
    notes = [note for _, note in of]
    assert notes[0].startswith("approximate: short flights take up to 7 % off a viscosity; with")
    assert notes[1].startswith("with a slip length of")
    assert notes[3].startswith("approximate: no slip was") == (source == "balls that turn")
    part = np.log(3) / np.log(5)
    assert of[2][0] == pytest.approx(slips[1] ** (1 - part) * slips[2] ** part)


def test_a_body_with_a_counter_force_swims_as_fast_as_the_dumbbell_of_theory():
    """Beside its own axis alone, and with a note where inertia counts."""
    known = []
    for force, at, density in (((0.1, 0.0), (-4.0, 0.0), None), ((20.0, 0.0), (4.0, 0.0), None),
                               ((2, 1), (-4, 0), None), ((0.1, 0.0), (-4.0, 0.0), 40)):  # fmt: skip
        swimmer = DiskBody(
            radius=2, density=density, force=force, frame="body", counter=CounterForce(at=at)
        )
        case = Case(run=Run(40), box=Box([20, 20]), fluid=Fluid(density=10, timestep=0.1,
                    collision=ATPlusA()), bodies=(swimmer,))  # fmt: skip
        known.append(followed(case, "this").swimming_speed())
    viscosity = 10 * theory.transport("at+a", 2, 10, 0.1).viscosity
    speed = theory.dumbbell_speed(0.1, 2.0, 4.0, viscosity, 20, 2, slip=0.075)
    assert known[0][0] == pytest.approx(speed) and known[0][1].startswith("with a slip length")
    assert known[1][0] == pytest.approx(200 * speed)
    assert known[1][1].startswith("approximate: without inertia, but U d/nu is")
    assert np.isnan(known[2][0])
    # The fluid goes back as the heavier body goes ahead, so that the momentum of all stays zero.
    excess = 30 * np.pi * 4 / (10 * (400 - np.pi * 4) + 40 * np.pi * 4)
    assert known[3][0] == pytest.approx(speed * (1 - excess), rel=1e-3)


def test_motion_that_is_not_thermal_alone_is_named():
    pushed = DiskBody(radius=1.5, number=4, force=(1.0, 0.0), fixed=("orientation",))
    held = DiskBody(radius=1.5, fixed=("x", "y"), swim=Squirming(B2=0.1))
    case = moving_disks(bodies=(pushed, held), observe=[BodyMotion()])
    result = seen(BodyMotion(), case, np.ones((5, 2)), np.ones(5))
    found = {c.what: c.note for c in result.comparisons[:3]}
    assert found == dict.fromkeys(
        [
            "mean square velocity of disk-1", "mean square angular velocity of disk-2",
            "temperature of the fluid",
        ],
        "no equipartition: swimming and drift included",
    )  # fmt: skip
    assert np.isnan(result.value).tolist() == [[False, True], [True, False]]


def test_mobilities_are_velocities_over_forces():
    pushed = DiskBody(radius=1.5, number=4, force=(0.0, 2.0), torque=-4.0, counter_force=True)
    result = seen(BodyDrift(), moving_disks(bodies=(pushed,), observe=[BodyDrift()]))
    assert result["mobility along y"].measured == pytest.approx(0.75 / 2)
    assert result["rotational mobility about z"].measured == pytest.approx(1.25 / -4)
    assert result["velocity along x"].measured == pytest.approx(0.125)
    assert "mobility along x" not in result
    assert np.isnan(result["velocity along x"].expected)
    alone = seen(BodyDrift(kind=2))
    assert alone["velocity along y"].expected == 0
    assert [c.key for c in alone.comparisons][2:] == [
        "velocity-along-its-own-axis", "angular-velocity-about-z",
    ]  # fmt: skip


def test_what_is_fixed_has_no_mobility():
    keys = {"radius": 1.5, "number": 4, "force": (3.0, 2.0), "torque": 4.0}
    kind = DiskBody(**keys, fixed=["x", "orientation"])
    result = seen(
        BodyDrift(), moving_disks(bodies=(kind,), observe=[BodyDrift()]),
        velocity=((0, 1), (0, 2), (0, 1), (0, 2)), rate=(0, 0, 0, 0),
    )  # fmt: skip
    names = [c.what for c in result.comparisons]
    assert [name for name in names if "mobility" in name] == ["mobility along y"]
    assert result["mobility along y"].measured == pytest.approx(0.75)
    for name in names:
        held = name in ("velocity along x", "angular velocity about z")
        assert (result[name].note == "fixed") == held
        assert (result[name].expected == 0) == held
    still = DiskBody(**keys, fixed=["x", "y"], counter_force=True)
    result = seen(BodyDrift(), moving_disks(bodies=(still,), observe=[BodyDrift()]))
    assert result["velocity along its own axis"].note == "fixed"


def test_across_a_hinge_there_is_no_rotational_mobility():
    sphere = SphereBody(radius=2, torque=(1.0, 0.0, 2.0), hinge=(0.0, 0.0, 1.0))
    case = Case(run=Run(1), box=Box([12, 12, 12]), fluid=Fluid(), bodies=[sphere])
    accumulator = BodyDrift().accumulator(case)
    for turn in (3, 5):
        bodies = type("Bodies", (), {
            "velocities": np.zeros((1, 3)), "headings": np.eye(3)[:1],
            "spins": np.array([[0.0, 0.0, turn]]),
        })  # fmt: skip
        accumulator.observe(type("Fluid", (), {"bodies": bodies}))
    result = accumulator.result()
    assert result["rotational mobility about z"].measured == 2
    assert "rotational mobility about x" not in result
    notes = [result[f"angular velocity about {axis}"].note for axis in "xyz"]
    assert notes == ["fixed", "fixed", ""]


def test_what_a_trap_holds_has_no_mobility():
    keys = {"radius": 1.5, "number": 4, "force": (3.0, 2.0), "torque": 4.0}
    turning = "rotational mobility about z"
    for trap, left in (
        (BodyTrap(k=2), [turning]),
        (BodyTrap(angular=2), ["mobility along x", "mobility along y"]),
        (BodyTrap(k=2, angular=2), []),
    ):
        kind = DiskBody(**keys, trap=trap)
        result = seen(BodyDrift(), moving_disks(bodies=(kind,), observe=[BodyDrift()]))
        names = [c.what for c in result.comparisons]
        assert [name for name in names if "mobility" in name] == left
        held = [name for name in names if result[name].note == "held by a trap"]
        assert len(held) == 3 - len(left)


def run_of(**more):
    simulation = Simulation(moving_disks(**more), threads=1)
    simulation.run()
    return simulation.results


EVERYTHING = [mesokit.Conservation(every=5), BodyMotion(every=1), BodyTracks(every=5)]


@pytest.fixture(scope="module")
def at_rest():
    return run_of(observe=EVERYTHING, steps=400)


def test_bodies_move_as_fast_as_the_fluid(at_rest):
    motion = at_rest["body-motion"]
    velocity, spin = motion["mean square velocity"], motion["mean square angular velocity"]
    assert abs(velocity.measured - velocity.expected) < 4 * velocity.error < 0.6
    assert abs(spin.measured - spin.expected) < 4 * spin.error < 0.6
    assert motion["temperature of the fluid"].measured == pytest.approx(1, abs=0.1)
    tracks = at_rest["body-tracks"]
    assert tracks.value.shape == (81, 3, 11) and np.isfinite(tracks.value).all()


def test_momentum_of_fluid_and_bodies_is_kept(at_rest):
    kept = at_rest["conservation"]
    assert kept.extra["conserves_momentum"] == 1 and kept.extra["conserves_energy"] == 0
    assert kept["largest drift of momentum"].measured < 1e-10
    warm = kept.value[:, kept.x["component"].tolist().index("temperature")]
    assert warm.mean() == pytest.approx(1, abs=0.1)
    assert kept.value[0, 0] == kept.expected[0, 0] == 874 + 3
    assert kept["particles put back in a step"].measured < 0.02
    assert kept["particles still hitting in a step"].measured == 0


def test_a_particle_that_still_hits_after_all_rounds_is_counted():
    """Between two disks that stand 0.3 cells apart, at 60 cells in a unit of time."""
    apart = BodyStart(rule="given", positions=[[5, 7], [8.3, 7], [6.5, 1]])
    held = DiskBody(radius=1.5, number=3, fixed=("x", "y", "orientation"), start=apart)
    case = moving_disks(bodies=(held,), observe=[mesokit.Conservation(every=1)], steps=1)
    fluid = Simulation(case, threads=1).engine
    places, velocities = fluid.positions(), 0.0 * fluid.velocities()
    nearest = np.argmin(((places - [6.65, 7]) ** 2).sum(axis=1))
    places[nearest], velocities[nearest] = [6.65, 7], [60, 0]
    one = Simulation(case, threads=1, positions=places, velocities=velocities)
    one.run()
    counted = one.results["conservation"]["particles still hitting in a step"]
    assert counted.measured == pytest.approx(0.5)  # in one of two samples


def test_a_body_that_goes_too_far_in_a_step_stops_the_run():
    """A check sees the first step; here it is the second in which a force makes it too fast."""
    fast = BodyStart(rule="lattice", velocities=[[0, 0], [0, -3.4], [0, 0]])
    them = DiskBody(radius=1.5, number=3, mass=1e4, name="them", start=fast, force=(0, -3e5))
    with pytest.raises(RunError) as error:
        Simulation(moving_disks(bodies=(them,)), threads=1).run(3)
    assert re.fullmatch(
        r"step 2: body 2 of them goes 0\.7\d+ cells in a timestep, at a speed of 7\.\d+; expected "
        "at most 0.35, or gaps may be missed: a shorter fluid.timestep, weaker forces or a "
        "smaller swim.B1",
        str(error.value),
    )


FORCED = {"radius": 1.5, "number": 3, "force": (5.0, 0.0)}


@pytest.mark.long
def test_a_force_with_its_counter_force_keeps_momentum():
    both = run_of(
        observe=[mesokit.Conservation(every=1)], bodies=(DiskBody(**FORCED, counter_force=True),)
    )["conservation"]
    assert both["largest drift of momentum"].measured < 1e-10


def test_a_force_alone_gives_momentum():
    alone = run_of(observe=[mesokit.Conservation(every=1)], bodies=(DiskBody(**FORCED),))
    alone = alone["conservation"]
    assert alone.extra["conserves_momentum"] == 0 and "largest drift of momentum" not in alone
    t, momentum = alone.x["time"], alone.value[:, 1]
    assert momentum[-1] - momentum[0] == pytest.approx(3 * 5.0 * (t[-1] - t[0]), rel=1e-6)


def one_sphere(rule=None, side=18, **keys):
    ball = SphereBody(**{"radius": 2, "number": 1, **keys})
    fluid = Fluid(density=10, timestep=STEP, collision=rule or ATPlusA())
    return Case(run=Run(steps=1), box=Box([side] * 3), fluid=fluid, bodies=(ball,))


def test_the_memory_of_a_sphere_is_drag_with_that_of_the_fluid():
    of = followed(one_sphere(), "body-correlation")
    time = np.array([0.0, 1.0, 8.0, 20.0, 40.0])
    nu = setting.solvent(one_sphere()).viscosity
    kept, turned = of.memory(time, turns=False), of.memory(time, turns=True)
    assert np.isnan([kept[:2], turned[:2]]).all()  # sound has not passed
    wide = theory.sphere_vacf(time[2:], 2, nu, 10, of.mass)
    images = theory.vacf_modes(time[2:], nu, 0.0, 10, [18] * 3)
    images = images - theory.vacf_tail(time[2:], nu, 0.0, 10, 3)
    assert kept[2:] == pytest.approx(wide + images)
    inertia = 0.4 * of.mass * 4
    assert turned[2:] == pytest.approx(theory.sphere_angular_vacf(time[2:], 2, nu, 10, inertia))
    assert of.memory_holds() == pytest.approx((4 / nu, 18**2 / (4 * np.pi**2 * nu)))


@pytest.mark.parametrize(
    "keys",
    [
        {"number": 2},
        {"swim": Squirming(B1=0.1)},
        {"surface": "slip"},
        {"fixed": ("x",)},
        {"trap": BodyTrap(k=1.0)},
        {"force": (1.0, 0.0, 0.0), "counter_force": True},
    ],
)
def test_no_memory_is_known_of_other_bodies(keys):
    of = followed(one_sphere(**keys), "body-correlation")
    assert of.memory(np.array([10.0, 20.0]), turns=False) is None


def test_no_memory_of_turning_is_known_without_angular_momentum():
    of = followed(one_sphere(SRD(angle=130)), "body-correlation")
    assert of.memory(np.array([10.0]), turns=True) is None
    assert of.memory(np.array([10.0]), turns=False) is not None


def test_a_correlation_twice_as_large_as_memory_has_that_ratio_to_it():
    """Beside 40 blocks of noise that is equally large at each lag."""
    case = one_sphere(side=40)
    of = BodyCorrelation(max_lag=600).accumulator(case)
    time = STEP * np.arange(601)
    memory = of.of.memory(time, turns=False)
    noise = np.random.default_rng(4).normal(size=(40, len(time)))
    kept = Estimate(2 * np.nan_to_num(memory), 1e-7 * (noise - noise.mean(axis=0)), np.ones(40))
    (ratio,) = [c for c in of.level(time, kept, memory) if c.what.startswith("ratio")]
    assert ratio.measured == pytest.approx(2)
    begin, end = of.of.memory_holds()
    used = memory[(time >= begin) & (time <= end)]
    assert ratio.error == pytest.approx(1e-7 * np.sqrt(40 / (used**2).sum()), rel=0.3)


@pytest.mark.parametrize(
    ("keys", "places", "angles"),
    [
        ({}, "", ""),
        ({"force": (1.0, 0.0, 0.0), "counter_force": True}, "the drift is in it", ""),
        ({"torque": (0.0, 0.0, 2.0)}, "", "the drift is in it"),
        ({"swim": Squirming(B1=0.1)}, "swimming is in it", ""),
    ],
)
def test_a_displacement_says_what_moves_bodies_besides(keys, places, angles):
    of = followed(one_sphere(**keys), "body-displacement")
    assert (of.carried(turns=False), of.carried(turns=True)) == (places, angles)


def test_a_drift_stands_beside_the_diffusion_coefficients():
    case = one_sphere(force=(1.0, 0.0, 0.0), counter_force=True)
    moved = BodyDisplacement(max_lag=20).accumulator(case)
    kept = BodyCorrelation(max_lag=20).accumulator(case)
    random = np.random.default_rng(2).normal(size=(90, 3))
    places = np.cumsum(random + 0.1, axis=0)
    for i in range(len(places)):
        moved.origins.add(places[i : i + 1], lambda old, new: ((new - old) ** 2).sum(axis=1))
        kept.origins.add(random[i : i + 1], lambda old, new: (new * old).sum(axis=1))
    for result in (moved.result(), kept.result()):
        assert "the drift is in it" in result["diffusion"].note
