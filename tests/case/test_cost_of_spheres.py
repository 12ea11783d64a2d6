"""Which method is cheaper for grains, as `mesokit check` says."""

import math

import pytest

from mesokit import (
    Box,
    Case,
    GaussSeidel,
    HardCollision,
    HardSpheres,
    HertzLaw,
    Langevin,
    LennardJones,
    Plates,
    RigidSpheres,
    Run,
    SoftSpheres,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from mesokit.method.spheres.common import cost
from mesokit.seam.method import method_of

GRAINS = {"number": 300, "kT": 1.0}
FALL = {**GRAINS, "gravity": [0, -1]}
LOSSY = HardCollision(restitution=0.6, contact_time=1e-3)
SHAKEN = Surface(contact=SurfaceContact(amplitude=0.1, frequency=20))


METHODS = {
    HardSpheres: "event-driven",
    SoftSpheres: "soft-spheres",
    RigidSpheres: "contact-dynamics",
}


def told(spheres, size=(20, 40), walls=(), steps=1000):
    """Numbers and rows of the summary."""
    method = METHODS[type(spheres)]
    case = Case(run=Run(steps, method=method), box=Box(size), spheres=spheres, walls=walls)
    found = method_of(case).summary(case, 1)
    return found.numbers, {what: (value, note) for what, value, note in found.rows}


@pytest.mark.parametrize(
    ("spheres", "walls", "cheaper"),
    [
        (HardSpheres(**GRAINS, collision=LOSSY), [], "event-driven"),
        (HardSpheres(**FALL, collision=LOSSY), [Plates("y")], "contact-dynamics"),
        (HardSpheres(**FALL), [Plates("y")], "event-driven"),
        (HardSpheres(**FALL, collision=LOSSY), [Plates("y", lower=SHAKEN)], "event-driven"),
        (SoftSpheres(**GRAINS), [], "event-driven"),
        (SoftSpheres(**FALL), [Plates("y")], "soft-spheres"),
        (SoftSpheres(**FALL, thermostat=Langevin()), [Plates("y")], "event-driven"),
        (SoftSpheres(**FALL, pair=SpringDashpot(restitution=1)), [Plates("y")], "event-driven"),
        (SoftSpheres(**FALL, pair=HertzLaw(stiffness=1e4, friction=0.5)), [Plates("y")],
         "soft-spheres"),
        (SoftSpheres(**GRAINS, pair=SpringDashpot(contact_time=100.0)), [], "soft-spheres"),
        (SoftSpheres(**FALL, pair=SpringDashpot(0.5, contact_time=1e-3)), [Plates("y")],
         "contact-dynamics"),
        (RigidSpheres(**GRAINS), [], "event-driven"),
        (RigidSpheres(**FALL), [Plates("y")], "soft-spheres"),
        (RigidSpheres(**FALL, solver=GaussSeidel(sweeps=20)), [Plates("y")], "contact-dynamics"),
    ],
)  # fmt: skip
def test_which_is_cheaper(spheres, walls, cheaper):
    numbers, rows = told(spheres, walls=walls)
    assert numbers["cheaper"] == cheaper
    assert rows["cheaper"][0] == cost.NAMES[cheaper]


def test_sweeps_of_rigid_grains():
    """Those of a column as high as the bed, 1.4 times, make the cost of a bed."""
    flat, _ = told(RigidSpheres(**FALL, solver=GaussSeidel(sweeps=10**6)), walls=[Plates("y")])
    column = 18**2 * 4 * math.log(1e4) / math.pi**2
    assert flat["sweeps_needed"] == pytest.approx(1.4 * column, rel=0.01)
    assert flat["sweeps"] == flat["sweeps_needed"]
    few, rows = told(RigidSpheres(**FALL, solver=GaussSeidel(sweeps=10)), walls=[Plates("y")])
    assert few["sweeps"] == 10 and few["sweeps_needed"] == flat["sweeps_needed"]
    # 0.4 us for each grain, and 12 ns for each of 540 contacts and sweep
    assert few["seconds"] == pytest.approx(1000 * (300 * 0.4e-6 + 540 * 10 * 12e-9))
    assert rows["contacts"][0] == "540"
    assert few["equal_stiffness"] < flat["equal_stiffness"] / 1000  # as the square of the sweeps


@pytest.mark.parametrize(("size", "more"), [((20, 40), 4), ((9, 9, 18), 8)])
def test_stiffness_of_equal_cost_goes_as_a_power_of_the_number_of_grains(size, more):
    """K ~ N^(4/d), where all sweeps are done that forces take."""
    d, axis, stiffness, sweeps = len(size), "xyz"[len(size) - 1], [], []
    for number in (216, 216 * more):
        gravity, solver = [0] * (d - 1) + [-1], GaussSeidel(sweeps=10**6)
        spheres = RigidSpheres(number=number, kT=1.0, gravity=gravity, solver=solver)
        numbers, _ = told(spheres, size, [Plates(axis)])
        stiffness.append(numbers["equal_stiffness"])
        sweeps.append(numbers["sweeps_needed"])
    assert sweeps[1] / sweeps[0] == pytest.approx(more ** (2 / d), rel=0.05)
    assert stiffness[1] / stiffness[0] == pytest.approx(more ** (4 / d), rel=0.1)


def test_grains_at_rest_take_few_sweeps():
    """Their forces last from step to step, so the rest of a long run is cheap."""
    spheres = RigidSpheres(**FALL)
    short, _ = told(spheres, walls=[Plates("y")])
    long, _ = told(spheres, walls=[Plates("y")], steps=100_000)
    driven, _ = told(spheres, walls=[Plates("y", lower=Surface(velocity=[1, 0]))], steps=100_000)
    # 2.2 falls through the box of all 500 sweeps, then 2 of them
    moving, resting = (300 * 0.4e-6 + 540 * n * 12e-9 for n in (500, 2))
    settling = 2.2 * math.sqrt(80) / long["timestep"]
    expected = settling * moving + (100_000 - settling) * resting
    assert long["seconds"] == pytest.approx(expected, rel=1e-3)
    assert driven["seconds"] == pytest.approx(100 * short["seconds"], rel=1e-9)


def test_where_the_step_of_rigid_grains_comes_from():
    shaken = Plates("y", lower=SHAKEN)
    found = {
        name: told(RigidSpheres(**given), size, walls)
        for name, given, size, walls in (
            ("fall", {"number": 30, "gravity": [0, -1]}, (20, 10), [Plates("y")]),
            ("deep fall", {"number": 30, "gravity": [0, -1]}, (20, 90), [Plates("y")]),
            ("flight", {"number": 30, "kT": 1.0}, (20, 10), []),
            ("vibration", {"number": 30}, (20, 10), [shaken]),
            ("given", {"number": 30, "timestep": 0.003}, (20, 10), []),
        )
    }
    steps = {name: numbers["timestep"] for name, (numbers, _) in found.items()}
    assert steps == pytest.approx(
        {
            "fall": 0.01 * math.sqrt(2),
            # 0.8 of dt with 2 (v + g dt) dt = 0.25, v of a fall by 90
            "deep fall": 0.8 * (math.sqrt(180 + 0.5) - math.sqrt(180)) / 2,
            "flight": 0.02 / 3,
            "vibration": 0.02 * 2 * math.pi / 20,
            "given": 0.003,
        },
        rel=1e-9,
    )
    causes = {name: rows["timestep"][1] for name, (_, rows) in found.items()}
    words = ("hundredth of the fall", "passes", "fiftieth of the flight", "vibration", "")
    assert [word in causes[name] for name, word in zip(causes, words, strict=True)] == [True] * 5


def test_steps_of_a_free_flight():
    numbers, _ = told(SoftSpheres(packing_fraction=0.2, timestep=2e-4), (60, 60))
    assert numbers["steps_per_flight"] == pytest.approx(1 / (1.2871 * 2e-4), rel=1e-3)
    dilute, _ = told(HardSpheres(packing_fraction=1.11e-3), (600, 600))
    dense, _ = told(HardSpheres(packing_fraction=0.6), (60, 60))
    assert dilute["soft_steps_per_flight"] > 1e5 and dense["soft_steps_per_flight"] == 500
    assert (
        dilute["soft_seconds"] / dilute["seconds"] > 10 * dense["soft_seconds"] / dense["seconds"]
    )


def test_grains_at_rest_have_more_others_on_their_lists():
    """Fallen ones cost a step as much as those that fill the box from the first."""
    law = SpringDashpot(restitution=0.6, friction=0.5)
    fallen, rows = told(SoftSpheres(**FALL, pair=law), walls=[Plates("y")])
    flying, _ = told(SoftSpheres(**GRAINS, pair=law))
    assert rows["run time"][1] == "estimate: 1 thread"
    # 25 ns and 20 for each of the 1.43 or, at 0.8 of the area, 3.88 others
    assert fallen["seconds"] / flying["seconds"] == pytest.approx(
        (25 + 77.6) / (25 + 28.5), rel=0.05
    )


def test_nothing_is_said_of_what_has_no_other_method():
    assert "cheaper" not in told(SoftSpheres(**GRAINS, pair=LennardJones()))[0]
    assert "cheaper" not in told(HardSpheres(number=300, kT=0.0))[0]
