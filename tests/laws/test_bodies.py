"""Bodies that move in the fluid: conservation, equipartition, the same bits, swimming."""

import numpy as np
import pytest

from mesokit import BodyMotion, MaxwellBoltzmann, Plates, SRDPlusA
from mesokit.method.mpcd.body.protocol import BodyStart, BodyTrap, CounterForce, Squirming
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.start.fluid import start
from tests.helpers.bodies import ROOM, SHAPES, SIZES, SOME, blocks, body, pressures_in_time
from tests.helpers.small_fluids import assert_same, make_case, make_fluid, mean

FAST = {"timestep": 0.1}
HELD = FAST | {"thermostat": MaxwellBoltzmann(), "measures": ("stress",)}  # one compiled kind


# Shapes, dimensions, and whether plates are there. Bodies in 3D are between plates, so that tests
# of walls and of three dimensions share a compiled kind; without plates they are long tests.
WALLED = [(name, d, d == 3) for name, d in SHAPES]
WALLED += [pytest.param(name, 3, False, marks=pytest.mark.long) for name, d in SHAPES if d == 3]


def between(walled, virtual="fill"):
    """Plates across z, or none."""
    return {"walls": [Plates(axis="z", virtual=virtual)]} if walled else {}


def momentum_of_all(fluid):
    """Momentum of fluid and bodies, with what walls took."""
    return fluid.totals()[1] + fluid.wall_impulse[:, : fluid.dimension].sum(axis=0)


@pytest.mark.parametrize("surface", ["no-slip", "slip"])
@pytest.mark.parametrize(("name", "d", "walled"), WALLED)
def test_hits_keep_momentum_and_energy(name, d, walled, surface):
    """Without virtual particles nothing brings energy; no particle is ever in a body."""
    one, plates = body(name, d, surface=surface, virtual="none"), between(walled, "none")
    fluid = make_fluid(SIZES[d], bodies=[one], measures=("walls",), **plates, **FAST)
    first, energy, momentum = fluid.bodies.velocities, fluid.totals()[2], momentum_of_all(fluid)
    for _ in range(10):
        fluid.advance(10)
        assert not fluid.bodies.inside(fluid.positions()).any()
    assert abs(momentum_of_all(fluid) - momentum).max() < 1e-12 * fluid.n
    assert fluid.totals()[2] == pytest.approx(energy, rel=1e-12)
    assert abs(fluid.bodies.velocities - first).max() > 1e-3


@pytest.mark.parametrize(("name", "d", "walled"), WALLED)
def test_no_flight_into_a_body_is_missed(name, d, walled):
    """What is seen without following a flight leaves no particle in a body, to be put outside."""
    some, plates = [body(name, d, virtual="none")], between(walled, "none")
    fluid = make_fluid(SIZES[d], bodies=some, measures=("walls",), **plates, **FAST)
    missed = 0
    for _ in range(100):
        fluid.advance(1)
        missed += fluid.bodies.counts()["put back"]
        missed += int(fluid.bodies.inside(fluid.positions()).sum())
    assert missed == 0
    assert abs(fluid.bodies.velocities).max() > 1e-3


@pytest.mark.parametrize(("name", "height"), [("sphere", 2.2), ("cuboid", 1.7)])
def test_no_flight_by_way_of_a_wall_ends_in_a_body(name, height):
    """A wall 0.2 cells from a surface bends flights: that these pass says nothing."""
    beside = BodyStart(rule="given", positions=[[6, 6, height]])
    held = body(name, 3, start=beside, fixed=("x", "y", "z", "orientation"), virtual="none")
    plates = between(True, "none")
    fluid = make_fluid(SIZES[3], bodies=[held], measures=("walls",), **plates, **FAST)
    inside = 0
    for _ in range(100):
        fluid.advance(1)
        inside += int(fluid.bodies.inside(fluid.positions()).sum())
    assert inside == 0
    assert abs(fluid.bodies.forces).max() > 0


@pytest.mark.parametrize("d", [2, 3])
def test_virtual_particles_keep_momentum(d):
    fluid = make_fluid(ROOM[d], bodies=SOME[d], measures=("walls",), **between(d == 3), **FAST)
    momentum = momentum_of_all(fluid)
    fluid.advance(100)
    assert fluid.memory.bodies.counters[0, 4] > 20  # virtual particles
    assert abs(momentum_of_all(fluid) - momentum).max() < 1e-12 * fluid.n


def in_thermal_units(fluid, steps, every=2):
    """M V^2 and I Omega^2 over kT of a kind of equal bodies, a sample at a time."""
    bodies, d = fluid.bodies, fluid.dimension
    inertia = np.diag(bodies.inertia(0))[-1 if d == 2 else slice(None)]
    translation, rotation = [], []
    for _ in range(steps // every):
        fluid.advance(every)
        spins = bodies.in_own_frame(bodies.spins)[:, -1 if d == 2 else slice(None)]
        translation.append(np.mean(bodies.masses[0] * bodies.velocities**2))
        rotation.append(np.mean(inertia * spins**2))
    return np.array(translation), np.array(rotation)


@pytest.mark.parametrize("name", ["disk", "union"])
@pytest.mark.parametrize("virtual", ["fill", "none"])
def test_bodies_have_the_temperature_of_the_fluid(name, virtual):
    """The published rules make them 12 and 18 % too hot here."""
    some = body(name, 2, number=4, virtual=virtual)
    fluid = make_fluid((24, 24), bodies=[some], **HELD)
    fluid.advance(100)
    translation, rotation = map(blocks, in_thermal_units(fluid, 6000))
    masses = fluid.bodies.masses
    part = 1 - masses[0] / (masses.sum() + fluid.numbers.total_mass)
    assert mean(translation / part).agrees(1.0), mean(translation / part)
    assert mean(rotation).agrees(1.0), mean(rotation)
    assert mean(rotation).error < 0.04  # the test can tell


def test_traps_hold_bodies_by_boltzmanns_distribution():
    """The mean square distance along an axis is kT/k."""
    fluid = make_fluid((16, 16), bodies=[body("disk", 2, trap=BodyTrap(k=40))], **HELD)
    seen = BodyMotion().accumulator(fluid.numbers.case)
    fluid.advance(200)
    for _ in range(3000):
        fluid.advance(3)
        seen.observe(fluid)
    result = seen.result()
    for axis in "xy":
        found = result[f"mean square distance along {axis}"]
        assert found.expected == 1 / 40 and found.note == ""
        assert abs(found.deviation) < 4 and found.error < 0.15 * found.expected, str(found)


@pytest.mark.parametrize("virtual", ["fill", "none"])
@pytest.mark.parametrize("name", ["disk", "rectangle"])
def test_the_pressure_around_bodies_is_that_of_the_free_fluid(name, virtual):
    """n kT with the density outside: the stress has what bodies give particles, and the other way
    round. The bodies themselves add a thousandth."""
    some = body(name, 2, number=6, virtual=virtual)
    fluid = make_fluid((24, 24), bodies=[some], **HELD)
    pressures = pressures_in_time(fluid)
    kinetic, collisional = np.mean(pressures, axis=0)
    found = mean(blocks(np.sum(pressures, axis=1)))
    assert found.agrees(10 + 6 / 576, systematic=0.005), found
    assert kinetic < 8.8 and collisional > 1.2 and found.error < 0.1


# A dumbbell swimmer, which pushes the fluid behind it, and a rotor.
DRIVEN = (
    body("disk", 2, force=(40, 0), frame="body", counter=CounterForce(at=(-4, 0))),
    body("rectangle", 2, torque=80, counter=CounterForce(shell=1.5)),
)
# A torque too small to count: of the same compiled kind as those.
IDLE = {"torque": 1e-30, "counter": CounterForce(shell=1.5)}
# All of them are compiled for other tests too
SHEARED = {"collision": SRDPlusA(angle=90), "thermostat": MaxwellBoltzmann()}
KINDS = {
    "2D": {"size": ROOM[2], "bodies": SOME[2]},
    "3D": {"size": ROOM[3], "bodies": SOME[3], **between(3)},
    "sheared": {
        "size": ROOM[2], "bodies": (*DRIVEN, body("union", 2)), "shear_rate": 0.05, **SHEARED,
    },
    "slit": {
        "size": ROOM[2], "bodies": SOME[2], "walls": [Plates(axis="y")],
        "thermostat": MaxwellBoltzmann(),
    },
}  # fmt: skip


def state_of(fluid):
    """All that a checkpoint has, by name."""
    return [np.asarray(array) for _, array in sorted(fluid.state().items())]


SLIT = pytest.param("slit", marks=pytest.mark.long)  # one more kind: the same between plates in 2D


@pytest.mark.parametrize("kind", ["2D", "3D", "sheared", SLIT])
def test_threads_and_restarts_change_no_bit(kind):
    """Also from two bodies that are near each other, at many hits in a step."""
    case = make_case(**KINDS[kind], timestep=0.2)
    alone = CPU(case, 1)
    start(alone)
    alone.advance(60)
    half = alone.state()
    alone.advance(60)
    assert not alone.bodies.inside(alone.positions()).any()
    two = CPU(case, 2)
    start(two)
    two.advance(60)
    three = CPU(case, 3)
    three.restore(two.state())
    three.advance(60)
    assert_same(state_of(alone), state_of(three))
    assert abs(half["body_place"] - alone.state()["body_place"]).max() > 1e-3


SHOT = BodyStart(rule="given", positions=[[9, 9]], velocities=[[0.1, 0.2]])


@pytest.mark.parametrize(
    ("more", "along"),
    [
        ({"shear_rate": 0.05}, [1]),  # where images slide, a drift along y would gain for ever
        ({"shear_rate": 0.05, "bodies": [body("disk", 2, start=SHOT)]}, [1]),
        ({"bodies": [body("union", 2, fixed=("orientation",))]}, [0, 1]),
        ({"bodies": [body("disk", 2, fixed=("x",))]}, [1]),
        ({}, [0, 1]),
    ],
)
def test_a_start_is_at_rest_as_a_whole(more, along):
    """Along all axes on which nothing from outside acts."""
    fluid = make_fluid(ROOM[2], **{"bodies": SOME[2]} | more, **FAST)
    momentum = fluid.totals()[1]
    assert abs(momentum[along]).max() < 1e-9
    assert abs(fluid.bodies.masses @ fluid.bodies.velocities)[along].min() > 0.1


def test_what_is_fixed_does_not_go_with_a_shear_flow():
    """Near the end of the box, where the flow is fastest."""
    there = BodyStart(rule="given", positions=[[13, 21]])
    still = body("disk", 2, start=there, fixed=("x", "y", "orientation"), **IDLE)
    fluid = make_fluid(ROOM[2], bodies=[still], shear_rate=0.05, **FAST | SHEARED)
    fluid.advance(20)
    assert fluid.bodies.places().tolist() == [[13, 21]]
    assert fluid.bodies.angles.tolist() == [[0, 0, 0]]


def test_lists_under_shear_hold_for_a_body_that_the_flow_does_not_carry():
    """A heavy disk at rest, cut by the border at which images slide .1 cells a step.

    The lists of bodies that go with the flow are made anew for their own paths.
    """
    at_rest = BodyStart(rule="given", positions=[[13, 23.5]], velocities=[[0, 0]], spins=[[0]])
    disk = body("disk", 2, start=at_rest, mass=1e9, **IDLE)
    case = make_case(ROOM[2], bodies=[disk], shear_rate=0.05, timestep=0.083, **SHEARED)
    kept, anew = CPU(case, 1), CPU(case, 1)
    start(kept)
    for _ in range(60):
        anew.restore(kept.state())  # which makes its lists for this one step
        kept.advance(1)
        anew.advance(1)
        assert_same(state_of(kept), state_of(anew))


PRESSED = {  # bodies, and how near to a plate their centres may come
    "3D": {"sphere": 2.0, "spheroid": 1.5, "cuboid": 1.5, "union": 1.3},
    "slit": {"disk": 2.0, "rectangle": 1.5, "union": 1.0},
}


@pytest.mark.parametrize(("kind", "size", "steps"), [
    ("3D", (14, 13, 12), 500),
    pytest.param("slit", ROOM[2], 1200, marks=pytest.mark.long),
], ids=PRESSED)  # fmt: skip
def test_walls_take_the_momentum_that_bodies_and_fluid_lose(kind, size, steps):
    """Forces press bodies of all sorts against a plate, which their gaps hold off."""
    d, pressed, down = len(size), PRESSED[kind], 30.0 * np.eye(len(size))[-1]
    bodies = [body(name, d, force=tuple(-down)) for name in pressed]
    case = KINDS[kind] | {"size": size, "bodies": bodies, "density": 5 if d == 3 else 10}
    fluid = make_fluid(**case, timestep=0.2, measures=("walls",))
    before = momentum_of_all(fluid)
    fluid.advance(steps)
    change = momentum_of_all(fluid) - before
    np.testing.assert_allclose(change, -len(pressed) * down * steps * 0.2, atol=1e-9 * fluid.n)
    gaps = fluid.bodies.places()[:, -1] - list(pressed.values())
    taken = fluid.wall_impulse[:, d - 1].sum()
    assert (gaps < 3.0).all() and abs(taken) > 1000.0, gaps


def test_a_squirmer_swims_along_its_axis_and_takes_no_momentum():
    """At B1/2 times 1 - phi, over 1 + 2 b/R, in 2D (Blake 1971), with a slip length of .15."""
    swimmer = body("disk", 2, number=4, swim=Squirming(B1=0.15))
    fluid = make_fluid((36, 36), bodies=[swimmer], **HELD)
    fluid.advance(200)
    speeds = []
    for _ in range(1200):
        fluid.advance(2)
        speeds.append((fluid.bodies.velocities * fluid.bodies.headings).sum(axis=1).mean())
    phi = 4 * np.pi * 4 / 36**2
    expected = 0.075 * (1 - phi) / (1 + 2 * 0.15 / 2)
    found = mean(blocks(np.array(speeds)))
    assert found.agrees(expected, systematic=0.1), (str(found), expected)
    assert abs(fluid.totals()[1]).max() < 1e-11 * fluid.n


def test_a_body_in_shear_turns_with_the_fluid():
    """At half of the shear rate, with a rule that conserves angular momentum."""
    rate = 0.06
    fluid = make_fluid(
        (20, 20), bodies=[body("disk", 2, **IDLE)], shear_rate=rate, timestep=0.05, **SHEARED
    )  # fmt: skip
    fluid.advance(400)
    angles = []
    for _ in range(300):
        fluid.advance(40)
        angles.append(fluid.bodies.angles[0, 2])
    turning = mean(blocks(np.diff(angles) / (40 * 0.05)))
    assert turning.agrees(-0.5 * rate, systematic=0.1), turning
    assert turning.error < 0.15 * 0.5 * rate


def test_the_fluid_nearby_takes_the_opposite_of_forces_and_torques():
    """Momentum stays. The swimmer goes ahead, the rotor turns, and the mean force is 0."""
    # a box that hardly slides is of the same compiled kind as "sheared"
    fluid = make_fluid(ROOM[2], bodies=DRIVEN, timestep=0.2, shear_rate=1e-13, **SHEARED)
    momentum = fluid.totals()[1]
    fluid.advance(100)
    speeds, forces, begun = [], [], fluid.bodies.angles[1, 2]
    for _ in range(400):
        fluid.advance(1)
        speeds.append((fluid.bodies.velocities * fluid.bodies.headings)[0].sum())
        forces.append(fluid.bodies.forces[0])
    assert abs(fluid.totals()[1] - momentum).max() < 1e-11 * fluid.n
    assert mean(blocks(np.array(speeds))).value > 0.2
    assert fluid.bodies.angles[1, 2] - begun > 4
    # what is left is the change of its momentum
    assert abs(np.mean(forces, axis=0)).max() < 2 * fluid.bodies.masses[0] / (400 * 0.2)


def test_a_swimmer_gets_its_force_in_a_step_and_the_fluid_behind_it_the_opposite():
    """What one more unit of force changes; a hit in the same step takes at most 3 % of it back."""
    after = []
    for force in (40, 41):
        swimmer = body(
            "disk", 2, force=(force, 0), frame="body", counter=CounterForce(at=(-4, 0)),
            start=BodyStart(rule="given", positions=((13, 12),)), virtual="none",
        )  # fmt: skip
        bodies = (swimmer, DRIVEN[1])
        fluid = make_fluid(ROOM[2], bodies=bodies, timestep=0.02, shear_rate=1e-13, **SHEARED)
        fluid.advance(1)
        after.append((fluid.bodies.masses[0] * fluid.bodies.velocities[0], fluid.totals()[1]))
    gained = np.subtract(*after[::-1])
    assert gained[0] == pytest.approx([0.02, 0.0], abs=0.0012)
    assert abs(gained[1]).max() < 1e-12 * fluid.n
