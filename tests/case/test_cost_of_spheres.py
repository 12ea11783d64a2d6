"""Which method is cheaper for grains, as `mesokit check` says."""

import pytest

from mesokit import (
    Box,
    Case,
    HardCollision,
    HardSpheres,
    HertzLaw,
    Langevin,
    LennardJones,
    Plates,
    Run,
    SoftSpheres,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from mesokit.seam.method import method_of

GRAINS = {"number": 300, "kT": 1.0}
FALL = {**GRAINS, "gravity": [0, -1]}
LOSSY = HardCollision(restitution=0.6, contact_time=1e-3)
SHAKEN = Surface(contact=SurfaceContact(amplitude=0.1, frequency=20))


def told(spheres, size=(20, 40), walls=()):
    """Numbers and rows of the summary."""
    method = "event-driven" if isinstance(spheres, HardSpheres) else "soft-spheres"
    case = Case(run=Run(1000, method=method), box=Box(size), spheres=spheres, walls=walls)
    found = method_of(case).summary(case, 1)
    return found.numbers, {what: (value, note) for what, value, note in found.rows}


@pytest.mark.parametrize(
    ("spheres", "walls", "cheaper"),
    [
        (HardSpheres(**GRAINS, collision=LOSSY), [], "event-driven"),
        (HardSpheres(**FALL, collision=LOSSY), [Plates("y")], "soft-spheres"),
        (HardSpheres(**FALL), [Plates("y")], "event-driven"),
        (HardSpheres(**FALL, collision=LOSSY), [Plates("y", lower=SHAKEN)], "event-driven"),
        (SoftSpheres(**GRAINS), [], "event-driven"),
        (SoftSpheres(**FALL), [Plates("y")], "soft-spheres"),
        (SoftSpheres(**FALL, thermostat=Langevin()), [Plates("y")], "event-driven"),
        (SoftSpheres(**FALL, pair=SpringDashpot(restitution=1)), [Plates("y")], "event-driven"),
        (SoftSpheres(**FALL, pair=HertzLaw(stiffness=1e4, friction=0.5)), [Plates("y")],
         "soft-spheres"),
        (SoftSpheres(**GRAINS, pair=SpringDashpot(contact_time=100.0)), [], "soft-spheres"),
    ],
)  # fmt: skip
def test_which_is_cheaper(spheres, walls, cheaper):
    numbers, rows = told(spheres, walls=walls)
    assert numbers["cheaper"] == cheaper
    assert rows["cheaper"][0] in ("event-driven", "soft spheres")


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
