"""Soft spheres that start with velocities of their own: steps follow from what moves."""

import dataclasses
import math

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    Disk,
    HertzLaw,
    Plates,
    RandomStart,
    Run,
    RunError,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    Surface,
    SurfaceContact,
)
from mesokit.io.lammps_data import read
from mesokit.method.spheres.common.start.from_file import FileStart
from mesokit.method.spheres.soft import scales
from mesokit.seam.method import method_of, summary_of
from tests.helpers.soft_spheres import at_rest, total

GAP = 0.013


def case_of(law, size=(10, 10), walls=(), **spheres):
    given = {"number": 2, "kT": 0.0} | spheres
    return Case(
        run=Run(0, method="soft-spheres"),
        box=Box(size),
        walls=list(walls),
        spheres=SoftSpheres(pair=law, **given),
    )


def thrown(law, speed, gap=GAP, **spheres):
    """Two disks that meet head on, so far apart at first, after the collision."""
    places = [[4.0, 5.0], [5.0 + gap, 5.0]]
    velocities = np.array([[0.5 * speed, 0.0], [-0.5 * speed, 0.0]])
    case = case_of(law, **spheres)
    simulation = Simulation(case, threads=1, **at_rest(places, velocities=velocities))
    engine = simulation.engine
    time = gap / speed + 1.5 * law.contact_time_of(0.5, speed)
    engine.advance(math.ceil(time / engine.timestep))
    return simulation, (engine.velocities()[1, 0] - engine.velocities()[0, 0]) / speed


@pytest.mark.parametrize("kT", [0.0, 2.0])
@pytest.mark.parametrize("speed", [0.003, 40.0])
def test_elastic_grains_keep_their_speed(speed, kT):
    law = HertzLaw(stiffness=3e7)
    simulation, restitution = thrown(law, speed, kT=kT)
    assert restitution == pytest.approx(1.0, abs=1e-3)
    contact = law.contact_time_of(0.5, speed)
    assert simulation.engine.timestep == pytest.approx(contact / scales.IN_CONTACT)


def test_restitution_does_not_depend_on_a_kT_that_nothing_has():
    law, speed = SpringDashpot(0.7, contact_time=0.02), 3.0
    step = 0.02 / scales.IN_CONTACT
    found = [
        [thrown(law, speed, GAP + k / 7 * speed * step, kT=kT)[1] for k in range(7)]
        for kT in (0.0, 1e-5, 4.0)
    ]
    assert found[0] == found[1] == found[2]
    assert np.mean(found) == pytest.approx(0.7, rel=5e-4)


def test_spheres_pressed_together_are_followed_as_they_fly_apart():
    law = HertzLaw(stiffness=2e5)
    engine = Simulation(case_of(law), threads=1, **at_rest([[4.0, 5.0], [4.7, 5.0]])).engine
    stored = total(engine)
    assert stored == pytest.approx(0.4 * 2e5 * 0.3**2.5)
    engine.advance(100)
    assert engine.energies()["contact"] == 0.0
    assert total(engine) == pytest.approx(stored, rel=1e-3)


def data_file(path, speed):
    """Two disks that meet, as LAMMPS writes them."""
    density = 6 / math.pi
    rows = [f"{i} 1 1 {density!r} {x} 5 0" for i, x in ((1, 4.0), (2, 5.0 + GAP))]
    velocities = [f"{i} {v} 0 0 0 0 0" for i, v in ((1, 0.5 * speed), (2, -0.5 * speed))]
    head = ["two", "2 atoms", "0 10 xlo xhi", "0 10 ylo yhi", "-0.5 0.5 zlo zhi", "Atoms # sphere"]
    path.write_text("\n".join([*head, *rows, "Velocities", *velocities]))
    assert len(read(str(path)).positions) == 2
    return str(path)


def test_check_knows_the_speeds_of_a_file_and_a_run_keeps_them(tmp_path):
    law = HertzLaw(stiffness=5e6)
    case = case_of(law, start=FileStart(file=data_file(tmp_path / "a.data", 7.0)))
    known = method_of(case).initial.prepared(case, {})
    assert known.spheres.speed == pytest.approx(7.0)
    numbers = summary_of(known).numbers
    assert numbers["contact_time"] == pytest.approx(law.contact_time_of(0.5, 7.0))
    assert numbers["steps_per_contact"] == pytest.approx(50)
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    assert Case.from_toml(simulation.directory.case_file).spheres.speed == known.spheres.speed
    at_rest_again = dataclasses.replace(case.spheres.start, moving=False)
    still = dataclasses.replace(
        case, spheres=dataclasses.replace(case.spheres, start=at_rest_again)
    )
    found = method_of(still).initial.prepared(still, {})
    assert found == still  # nothing moves, and nothing is pressed together
    rows = {what: value for what, value, _ in summary_of(found).rows}
    assert rows["collision speed"] == "0" and "contact time" not in rows


def test_velocities_that_are_drawn_change_no_case():
    case = case_of(HertzLaw(stiffness=1e6), number=20, kT=0.5)
    assert method_of(case).initial.prepared(case, {}) is case
    fastest = scales.FASTEST * math.sqrt(0.5)
    assert scales.speed_of_collision(case) == fastest


@pytest.mark.parametrize(
    ("walls", "speed"),
    [
        ([Plates("y", lower=Surface(velocity=[-4, 0]))], 4.0),
        ([Plates("y", upper=Surface(contact=SurfaceContact(amplitude=0.1, frequency=30)))], 6.0),
        ([Disk([5, 5], 2, surface=Surface(rotation=0.5))], 0.25 * math.hypot(10, 10)),
    ],
    ids=["moves", "vibrates", "turns"],
)
def test_walls_that_move_count(walls, speed):
    law, start = HertzLaw(stiffness=1e6), RandomStart()
    case = case_of(law, walls=walls, start=start)
    assert scales.speed_of_collision(case) == pytest.approx(speed)
    walls = [*walls, Plates("x")]
    falls = case_of(law, walls=walls, start=start, gravity=[-2.0, 0.0])
    assert scales.speed_of_collision(falls) == pytest.approx(speed + math.sqrt(40.0))


def test_a_run_ends_where_contacts_get_too_short():
    """The case says a speed that its spheres exceed by far."""
    law, kinds = HertzLaw(stiffness=1e6), [SphereKind(mass=0.5)]
    case = case_of(law, speed=0.01, kinds=kinds, timestep=law.contact_time_of(0.25, 0.01) / 12)
    velocities = np.array([[0.4, 0.0], [-0.4, 0.0]])
    with pytest.raises(RunError, match=r"a sphere moves at 0\.4: .* above 0\.0\d+; expected"):
        Simulation(case, **at_rest([[3.0, 5.0], [6.0, 5.0]], velocities=velocities))
