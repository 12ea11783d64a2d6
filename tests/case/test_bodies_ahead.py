"""What is said of bodies before a run: rows of a check, warnings, and where they do not run yet."""

from __future__ import annotations

import math

import pytest

from mesokit import (
    SRD,
    ATPlusA,
    Box,
    Capsule,
    Case,
    CaseError,
    Cuboid,
    Disk,
    Ellipse,
    Fluid,
    MaxwellBoltzmann,
    NoCollision,
    Plates,
    Rectangle,
    Run,
    Sphere,
    Spheroid,
    SRDPlusA,
    Trajectory,
    theory,
)
from mesokit.case.describe.explain import explain
from mesokit.method.mpcd.body.capsule import CapsuleBody
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.ellipse import EllipseBody
from mesokit.method.mpcd.body.protocol import (
    BodyStart,
    BodyTrap,
    CounterForce,
    GapPotential,
    Squirming,
)
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.body.spheroid import SpheroidBody
from mesokit.method.mpcd.body.union import UnionBody
from mesokit.method.mpcd.derived import derive, summary
from mesokit.method.mpcd.engine.cuda.refused import refused
from mesokit.method.mpcd.expected.bodies import followed
from mesokit.method.mpcd.method import METHOD
from mesokit.method.mpcd.observe.body_correlation import BodyCorrelation

HELD = {"thermostat": MaxwellBoltzmann()}
DENSE = {"density": 10, "collision": SRDPlusA()}


def case_of(size, *bodies, walls=(), observe=(), **fluid):
    """A case with these bodies, in a fluid that conserves angular momentum unless said."""
    fluid = Fluid(**DENSE | fluid)
    parts = {"bodies": bodies, "walls": walls, "observe": observe, "fluid": fluid}
    return Case(run=Run(steps=1), box=Box(size), **parts)


def warnings_of(*given, word="bodies", **more):
    """What such a case is warned of its bodies."""
    return [line for line in derive(case_of(*given, **more)).warnings if word in line]


def test_each_kind_has_a_row():
    case = case_of(
        [20, 20], DiskBody(radius=3, number=2), CapsuleBody(length=6, radius=1, mass=99, name="rod")
    )
    rows = {name: (value, word) for name, value, word in summary(case).rows}
    assert rows["bodies disk-1"] == ("2", "radius 3 a, mass 282.7, volume fraction 0.141")
    assert rows["bodies rod"] == ("1", "reach 3 a, mass 99, volume fraction 0.0279")


def test_the_fraction_is_of_what_walls_leave():
    case = case_of([20, 20], DiskBody(radius=2), walls=[Disk([4, 4], 3)])
    rows = {name: word for name, _, word in summary(case).rows}
    assert rows["bodies disk-1"].endswith("volume fraction 0.0338")


@pytest.mark.parametrize(
    ("body", "surface", "cost"),
    [
        (SphereBody(radius=3, number=2), 2 * 36 * math.pi, 25),
        (CapsuleBody(length=8, radius=2), 3 * (16 + 32 / 3) * math.pi / 2, 100),  # 3 V / R
    ],
    ids=["balls", "a rod"],
)
def test_bodies_cost_by_their_surface(body, surface, cost):
    """A particle of the fluid in each unit of it is as dear as so many that only fly."""
    bare, with_body = case_of([20, 20, 20]), case_of([20, 20, 20], body)
    empty, seconds = (derive(case, threads=1).seconds for case in (bare, with_body))
    flying = with_body.particles + 10 * surface * cost
    assert seconds == pytest.approx(empty * flying / bare.particles, rel=1e-9)


def test_nothing_is_said_of_a_sphere_that_is_well_resolved():
    assert warnings_of([20, 20, 20], SphereBody(radius=3)) == []


# name: (size, bodies, keys of the fluid, the only warning)
WARNED = {
    "thin": (
        [20, 20], [CapsuleBody(length=9, radius=0.8)], {}, "bodies[#1]: it is 1.6 cells thick; "
        "below 2 the flow around it is not resolved: give all lengths 1.2 times as many cells",
    ),
    "light": (
        [20, 20], [DiskBody(radius=3), DiskBody(radius=2, density=5)], {},
        "bodies[#2]: its density 5 is below that of the fluid, 10: its virtual particles are "
        "thinned in proportion",
    ),
    "fast": (
        [20, 20, 20], [SphereBody(radius=1, mass=10, interaction=GapPotential(depth=0))],
        {"density": 2, "kT": 9},
        "fluid.timestep = 0.3: in one, bodies[#1] moves by 0.28 of its radius; above 0.25 it is "
        "too hot: a shorter timestep or a larger mass",
    ),
    "hit into gaps": (
        [20, 20], [DiskBody(radius=1, number=2)], {}, "fluid.timestep = 0.3: hits move bodies[#1] "
        "by 0.026 cells after the gap law has acted, which brings bodies that touch about 0.099 kT "
        "a step; above 0.03 they are too hot: a shorter timestep or a longer interaction.range",
    ),
    "sampled": (
        [20, 20], [UnionBody(parts=[Disk([0, 0], 3), Disk([4, 0], 3)])], {},
        "bodies[#1].parts: some overlap, so its volume and inertia are sampled on a grid",
    ),
    "apart": (
        [20, 20], [UnionBody(parts=[Disk([0, 0], 2), Disk([4.5, 0], 2)])], {},
        "bodies[#1].parts: they lie apart, in 2 pieces, which move as one body with fluid between "
        "them",
    ),
    "held": (
        [20, 20], [DiskBody(radius=3, fixed=["x", "y"], force=[1, 0])], {},
        "bodies[#1].force = [1, 0]: it acts along fixed axes alone, and moves nothing",
    ),
    "not turned": (
        [20, 20], [DiskBody(radius=3, fixed=["orientation"], torque=1)], {},
        "bodies[#1].torque = 1: the orientation is fixed, so that it turns nothing",
    ),
    "across its hinge": (
        [20, 20, 20], [SphereBody(radius=3, hinge=[0, 0, 2], torque=[3, 0, 0])], {},
        "bodies[#1].torque = [3, 0, 0]: it acts across hinge = [0, 0, 2], so that it turns nothing",
    ),
    "fast for sound": (
        [20, 20], [DiskBody(radius=1, swim=Squirming(B1=0.6))], {}, "bodies[#1]: expected to move "
        "at Mach number 0.3: above 0.2 the fluid is compressible; a smaller B1",
    ),
    "fast for momentum": (
        [60, 60], [DiskBody(radius=8, swim=Squirming(B1=0.2))], {}, "bodies[#1]: expected to move "
        "at Reynolds number 1.3: above 1 inertia changes its flow and speed; a smaller B1",
    ),
    "inertial": (
        [40, 40],
        [DiskBody(radius=2, force=[2, 0], frame="body", counter=CounterForce(at=[-5, 0]))], {},
        "bodies[#1]: expected U d/nu = 0.1, of its speed and the distance of its counter-force; "
        "above 0.05 inertia takes or gives more than a tenth of the speed; a smaller force",
    ),
    "beside the line": (
        [40, 40],
        [DiskBody(radius=2, force=[0.25, 0], frame="body", counter=CounterForce(at=[-3, 4]))], {},
        "bodies[#1].counter.at = [-3, 4]: beside the line of force = [0.25, 0], so that the two "
        "turn the body, with a torque of -1",
    ),
    "beside the line in 3D": (
        [30] * 3,
        [SphereBody(radius=2, force=[0, 0, 1], frame="body", counter=CounterForce(at=[5, 0, 0]))],
        {}, "bodies[#1].counter.at = [5, 0, 0]: beside the line of force = [0, 0, 1], so that the "
        "two turn the body, with a torque of [0, -5, 0]",
    ),
    "stiff": (
        [20, 20], [DiskBody(radius=3, mass=400, trap=BodyTrap(k=160_000))], {},
        "bodies[#1].trap.k = 160000: it swings by 2 rad in a timestep; above 0.5 its velocity is "
        "too hot: a weaker trap or a shorter timestep",
    ),
    "crowded": (
        [12, 12], [DiskBody(radius=3, number=2)], {}, "bodies: two of them reach 6.5 from centre "
        "to centre, more than half of the box of 12: of the images of another, only the nearest "
        "repels",
    ),
    "pushed": (
        [20, 20], [DiskBody(radius=3, force=[0, 2])], {}, "bodies: together they are pushed along "
        "y, and nothing holds the fluid: the whole box speeds up for ever; use walls, or "
        "counter_force = true",
    ),
}  # fmt: skip


@pytest.mark.parametrize(
    ("height", "there"),
    [(2.5, "2.5 cells from a wall"), (0, "inside a wall"), (20, "inside a wall"), (3, "")],
)
def test_a_trap_that_presses_a_body_to_a_wall_is_warned_of(height, there):
    trapped = DiskBody(radius=3, trap=BodyTrap(k=5, centre=[10, height]))
    plates = {"walls": [Plates(axis="y")]}
    assert warnings_of([20, 20], trapped, word="trap.centre", **plates) == [
        f"bodies[#1].trap.centre = [10, {height}]: {there}, and the body is 6 cells thick: the "
        "trap presses it against the wall"
    ] * bool(there)


SMALL, ONE = Disk([1, 0], 2), Disk([0, 0], 3)  # the first touches the second from within
LONG = Capsule([-4, 0], [4, 0], 1)
HIDDEN = {  # in which part each is
    "a disk": ((SMALL, ONE), {1: 2}),
    "a disk that reaches out": ((Disk([1.01, 0], 2), ONE), {}),
    "a rod": ((Rectangle([0, 0], [10.2, 2.2]), LONG), {2: 1}),
    "a rod that reaches out": ((Rectangle([0, 0], [9.9, 2.2]), LONG), {}),
    "corners": ((ONE, Rectangle([0, 0], [4, 4])), {2: 1}),
    "corners that reach out": ((ONE, Rectangle([0, 0], [4.3, 4.3])), {}),
    "an ellipse": ((Ellipse([0, 0], [5, 4]), ONE, SMALL), {1: 2, 3: 2}),
    "equal ones": ((Ellipse([0, 0], [6, 6]), ONE), {1: 2}),
}


@pytest.mark.parametrize("name", HIDDEN)
def test_parts_inside_of_another_are_named(name):
    parts, expected = HIDDEN[name]
    said = warnings_of([24, 24], UnionBody(parts=parts), **HELD, word="wholly")
    assert said == [
        f"bodies[#1].parts[#{part}]: wholly inside parts[#{other}], so that it adds nothing to "
        "shape and mass, but repels by gaps of its own; leave it out"
        for part, other in expected.items()
    ]
    body = UnionBody(parts=parts, interaction=GapPotential(depth=0))
    bare = warnings_of([24, 24], body, **HELD, word="wholly")
    assert [", but" in line for line in bare] == [False] * len(expected)


def test_parts_inside_of_another_in_three_dimensions():
    parts = [
        Cuboid([0, 0, 0], [6, 6, 6]), Sphere([1, 0, 0], 2), Sphere([1.1, 0, 0], 2),
        Capsule([0, 0, -1], [0, 1, 1], 2), Spheroid([0, 0, 0], 1, 3, [1, 1, 0]),
    ]  # fmt: skip
    said = warnings_of([24] * 3, UnionBody(parts=parts), word="wholly inside parts[#1]")
    assert [line.partition(":")[0] for line in said] == [
        f"bodies[#1].parts[#{n}]" for n in (2, 4, 5)
    ]


def test_a_part_inside_of_another_adds_no_mass():
    """But for what sampling is off by."""
    masses = [body.mass_in(2, 10) for body in (UnionBody(parts=[ONE, SMALL]), DiskBody(radius=3))]
    assert masses[0] == pytest.approx(masses[1], rel=0.004)


def test_a_torque_along_the_axes_of_a_body_may_turn_it_about_its_hinge():
    """Its frame and that of the hinge differ as soon as the body starts with an orientation."""
    turned = BodyStart(rule="given", positions=[[9, 9, 9]], orientations=[[0.707, 0, 0.707, 0]])
    more = {"hinge": [0, 0, 2], "torque": [3, 0, 0], "frame": "body", "start": turned}
    assert warnings_of([20, 20, 20], SphereBody(radius=3, **more), **HELD) == []


@pytest.mark.parametrize("name", WARNED)
def test_a_warning(name):
    size, bodies, fluid, expected = WARNED[name]
    more = {"timestep": 0.3} if name in ("fast", "hit into gaps") else {}
    assert warnings_of(size, *bodies, **HELD | fluid | more) == [expected]


def test_a_shear_faster_than_sound_is_warned_of():
    """Also with bodies, beside which the fluid has no theory of its own."""
    case = Case(
        run=Run(10), box=Box([20, 20], shear_rate=0.5), fluid=Fluid(density=10, **HELD),
        bodies=(DiskBody(radius=3),),
    )  # fmt: skip
    said = derive(case).warnings
    assert any("of the speed of sound across a cell; keep it below 0.2" in one for one in said)


@pytest.mark.parametrize("body", [
    DiskBody(radius=3, swim=Squirming(B1=0.1)), DiskBody(radius=3, torque=1),
    DiskBody(radius=3, force=[1, 0], counter_force=True),
])  # fmt: skip
def test_bodies_that_move_the_fluid_heat_it(body):
    [line] = warnings_of([20, 20], body)
    assert line.startswith("no thermostat: bodies that swim, or that forces move, heat the fluid")
    assert warnings_of([20, 20], body, **HELD) == []
    assert warnings_of([20, 20], body, collision=ATPlusA()) == []


def test_what_is_expected_of_each_kind_has_rows():
    """A squirmer, and a sphere that a force draws."""
    spheres = (
        SphereBody(radius=3, name="swims", swim=Squirming(B1=-0.03)),
        SphereBody(radius=2, name="drawn", force=[0, 4, 3], counter_force=True),
    )
    case = case_of([30] * 3, *spheres)
    rows = {name: (value, word) for name, value, word in summary(case).rows}
    known = theory.transport("srd+a", 3, density=10, timestep=0.1, angle=130)
    nu, mobility = known.viscosity, 1 / (6 * math.pi * 10 * known.viscosity * 2)
    assert rows["speed of swims"] == (
        "0.02 a/tau",
        f"estimate, of one in a wide fluid; Reynolds number {0.06 / nu:.3g}",
    )
    assert rows["speed of drawn"][0] == f"{5 * mobility:.4g} a/tau"
    assert rows["diffusion of drawn"] == (
        f"{mobility:.4g} a^2/tau",
        f"estimate, of one in a wide fluid; R^2/D = {4 / mobility:.3g} tau",
    )


def test_bodies_that_keep_their_velocity_for_the_whole_run_are_warned_of():
    """M D/kT; nothing is said of one of the fluid's density, in a run of one step."""
    eta = 10 * theory.transport("srd+a", 3, density=10, timestep=0.1, angle=130).viscosity
    [said] = warnings_of([30] * 3, SphereBody(radius=2, mass=1e12))
    assert f"lasts {1e12 / (12 * math.pi * eta):.2g} tau, longer than the run of 0.1 tau" in said
    assert warnings_of([30] * 3, SphereBody(radius=2)) == []


def test_a_counter_force_beside_a_sphere_takes_a_part_of_its_speed():
    """In a wide fluid F/(eta pi) (1/(6 R) - 1/(4 d) + R^2/(12 d^3) + a^2/(20 d^3))."""
    drawn = {"radius": 2, "force": (12.0, 0, 0), "frame": "body"}
    beside, off = (
        followed(case_of([30] * 3, SphereBody(**drawn, counter=CounterForce(at=at))), "test")
        for at in ((-5, 0, 0), (0, 5, 0))
    )
    eta = 10 * theory.transport("srd+a", 3, density=10, timestep=0.1, angle=130).viscosity
    known = 12 / (eta * math.pi) * (1 / 12 - 1 / 20 + 4 / (12 * 125) + 1 / (20 * 125))
    assert beside.roughly().speed == pytest.approx(known, rel=0.01)
    assert off.roughly().speed == pytest.approx(12 / (12 * math.pi * eta))


@pytest.mark.parametrize(("d", "body"), [
    (3, SpheroidBody(half_length=3, radius=2.999)), (3, CapsuleBody(length=6.001, radius=3)),
])  # fmt: skip
def test_nearly_round_bodies_diffuse_as_spheres(d, body):
    def diffusion(body):
        return followed(case_of([30] * d, body), "test").roughly().diffusion

    assert diffusion(body) == pytest.approx(diffusion(SphereBody(radius=3)), rel=0.01)


def test_an_ellipse_swims_by_its_aspect():
    ellipse = EllipseBody(size=[8, 4], swim=Squirming(B1=0.3))
    found = followed(case_of([30, 30], ellipse), "test").roughly()
    assert found.speed == pytest.approx(0.2) and math.isnan(found.diffusion)


HOLD = {"trap": BodyTrap(k=1)}
AHEAD = {"force": [0.1, 0.01], "frame": "body"}


@pytest.mark.parametrize(
    "body",
    [
        DiskBody(radius=3, force=[1, 0], counter_force=True),
        DiskBody(radius=3, force=[1, 0], fixed=["y"], counter_force=True),
        UnionBody(parts=[Disk([0, 0], 2), Disk([4, 0], 2)]),
        DiskBody(radius=3, force=[1, 0], **HOLD),
        DiskBody(radius=2, **AHEAD, counter=CounterForce(at=[-3, -0.3])),
        DiskBody(radius=2, **AHEAD, fixed=["orientation"], counter=CounterForce(at=[-4, 0])),
        DiskBody(radius=3, density=5, virtual="none"),
        DiskBody(radius=3, density=5, surface="slip"),
        DiskBody(radius=3, number=2, interaction=GapPotential(depth=0, range=0.25)),
    ],
)
def test_no_warning(body):
    assert warnings_of([20, 20], body, **HELD) == []


def test_a_force_that_walls_take_is_no_warning():
    body = DiskBody(radius=3, force=[1, 0])
    assert warnings_of([20, 20], body, walls=[Plates("y")], **HELD) == []


@pytest.mark.parametrize(("d", "name"), [(2, "disk"), (3, "sphere")])
def test_rotational_friction_lacks_a_part_of_what_collisions_carry(d, name):
    body = DiskBody(radius=3) if d == 2 else SphereBody(radius=3)
    [line] = warnings_of([20] * d, body, collision=SRD())
    known = theory.transport("srd", d, density=10, timestep=0.1, angle=130)
    kept = 1 - known.viscosity_collisional / known.viscosity / d
    assert line == (
        "fluid.collision.rule = 'srd': it does not conserve angular momentum: bodies have "
        f"{kept:.2g} of the rotational friction of a {name}, and turn too fast in a shear flow; "
        "use 'at+a' or 'srd+a'"
    )


@pytest.mark.parametrize("rule", [SRD(), NoCollision()])
def test_bodies_that_do_not_turn_need_no_angular_momentum(rule):
    fixed = ["orientation"] if rule.acts else []
    found = warnings_of([20, 20], DiskBody(radius=3, fixed=fixed), collision=rule)
    assert not [line for line in found if "angular momentum" in line]


def test_a_trajectory_of_no_bodies_is_refused():
    with pytest.raises(CaseError, match=r"^trajectory.of = 'bodies': .*'bodies' needs \[\[bodies"):
        Case(run=Run(steps=1), box=Box([20, 20]), trajectory=Trajectory(every=1, of="bodies"))


def test_lags_beyond_the_run_are_said():
    [line] = warnings_of(
        [20, 20], DiskBody(radius=3), observe=[BodyCorrelation(max_lag=500)], word="max_lag"
    )
    expected = "observe[#1].max_lag = 500: more than run.steps = 1, beyond which there are no lags"
    assert line == expected


def test_both_modes_of_a_spheroid_are_explained():
    [found] = explain("bodies.spheroid.swim")
    assert "(B1 + B2 x/a) t_x" in " ".join(found.meaning.split())


def test_they_run_on_ranks_of_processors_alone():
    case = case_of([20, 20], DiskBody(radius=3))
    assert list(refused(case)) == ["no bodies that move yet; expected --device cpu"]
    METHOD.check_ranks(case, 2)


@pytest.mark.parametrize("holds", [{"fixed": ("x", "y")}, {"trap": BodyTrap(k=1.0)}, {}])
def test_bodies_that_are_held_show_no_diffusion(holds):
    case = case_of([20, 20], DiskBody(radius=2, **holds))
    rows = {name: word for name, _, word in summary(case).rows}
    assert "bodies disk-1" in rows
    assert ("diffusion of disk-1" in rows) == (not holds)
