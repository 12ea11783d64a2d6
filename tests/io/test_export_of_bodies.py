"""Trajectories of bodies, their exports, and runs of them that are resumed."""

from __future__ import annotations

import dataclasses

import gsd.hoomd
import h5py
import numpy as np
import pytest

import mesokit
from mesokit import CaseError, MaxwellBoltzmann, Polymer, Run, Solutes, every
from mesokit.case.trajectory import Trajectory
from mesokit.geometry import region
from mesokit.io import gsd_file
from mesokit.io.moments import Moment, Particles
from mesokit.method.mpcd.body.drawn import drawn_as
from mesokit.run.simulation import Simulation
from tests.helpers.bodies import body
from tests.helpers.moving_disks import moving_disks, with_a_plank
from tests.helpers.small_fluids import make_case

pytestmark = pytest.mark.usefixtures("no_figures")
FIELDS = ("position", "velocity", "orientation", "spin", "image", "id")
OF_BODIES = Trajectory(every=10, of="bodies", fields=FIELDS, precision="float64")


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    seen = {}

    def look(simulation):
        bodies = simulation.engine.bodies
        seen[simulation.step] = {
            "position": bodies.places(), "velocity": bodies.velocities, "image": bodies.images,
            "orientation": bodies.orientations, "spin": bodies.spins[:, 2],
        }  # fmt: skip

    folder = tmp_path_factory.mktemp("runs") / "bodies"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        case = with_a_plank(trajectory=OF_BODIES)
        simulation = Simulation(case, output=folder, threads=1, callbacks=[every(10, look)])
        simulation.run()
    simulation.seen = seen
    return simulation


def test_ids_of_bodies_follow_those_of_the_fluid(ended):
    engine, bodies, first = ended.engine, ended.engine.bodies, ended.case.particles
    ids = first + np.array([3, 0, 2])
    np.testing.assert_array_equal(engine.positions(ids), bodies.places()[[3, 0, 2]])
    unwrapped = engine.positions(ids, unwrapped=True)
    np.testing.assert_array_equal(unwrapped, bodies.places(unwrapped=True)[[3, 0, 2]])
    np.testing.assert_array_equal(engine.velocities(ids), bodies.velocities[[3, 0, 2]])
    np.testing.assert_array_equal(engine.images(ids), bodies.images[[3, 0, 2]])
    np.testing.assert_array_equal(engine.orientations(ids), bodies.orientations[[3, 0, 2]])
    np.testing.assert_array_equal(engine.spins(ids), bodies.spins[[3, 0, 2], 2])
    mixed = np.append(0, ids)
    heavy = 5 * np.pi * 1.5**2
    assert engine.masses(mixed) == pytest.approx([1, 60, heavy, heavy])
    assert engine.species(mixed).tolist() == [0, 2, 1, 1]
    assert np.array_equal(engine.velocities(mixed)[0], engine.velocities()[0])


def test_a_trajectory_of_bodies_has_all_their_fields(ended):
    frames = mesokit.open(ended.directory.path).trajectory
    assert frames.id.tolist() == (ended.case.particles + np.arange(4)).tolist()
    assert frames.species.tolist() == [1, 1, 1, 2] and frames.mass[3] == 60
    for name in ("position", "velocity", "orientation", "spin", "image"):
        expected = [ended.seen[step][name] for step in (0, 10, 20, 30, 40)]
        np.testing.assert_array_equal(frames.read(name), expected)


def test_files_of_others_have_the_shapes_of_bodies(ended, tmp_path):
    run, last = mesokit.open(ended.directory.path), ended.seen[40]
    with gsd.hoomd.open(str(run.export(tmp_path / "bodies.gsd"))) as file:
        frame = file[4]
        assert len(file) == 5 and frame.particles.N == 4
        turned = file.file.read_chunk(4, "log/particles/angular_velocity")
    assert frame.particles.types == ["fluid", "disks", "planks"]
    assert frame.particles.diameter.tolist() == [3, 3, 3, 2]
    _, disks, planks = frame.particles.type_shapes
    assert disks == {"type": "Sphere", "diameter": 3.0}
    assert planks["type"] == "Polygon"
    corners = np.array(planks["vertices"])
    assert sorted(corners.tolist()) == [[-2, -1], [-2, 1], [2, -1], [2, 1]]
    x, y = corners.T
    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() == 16  # to the left, twice 8
    assert frame.particles.orientation == pytest.approx(last["orientation"], abs=1e-6)
    assert turned[:, 2] == pytest.approx(last["spin"], abs=1e-6)
    disk, plank = 0.5 * 5 * np.pi * 1.5**4, 60 * (4**2 + 2**2) / 12
    inertia = frame.particles.moment_inertia
    assert inertia == pytest.approx(np.array([[0, 0, disk]] * 3 + [[0, 0, plank]]), rel=1e-6)
    momentum = np.zeros((4, 4))  # in 2D 2 q (0, L) is 2 L (-sin, 0, 0, cos) of half the angle
    own = inertia[:, 2] * turned[:, 2]
    momentum[:, 0] = -2 * own * frame.particles.orientation[:, 3]
    momentum[:, 3] = 2 * own * frame.particles.orientation[:, 0]
    assert frame.particles.angmom == pytest.approx(momentum, rel=1e-5, abs=1e-6)
    assert frame.particles.position[:, :2] == pytest.approx(last["position"] - 7, abs=1e-5)

    with h5py.File(run.export(tmp_path / "bodies.h5md")) as file:
        stored = file["particles/trajectory/orientation/value"][4]
    assert stored == pytest.approx(last["orientation"], abs=1e-6)
    lines = run.export(tmp_path / "bodies.lammpstrj").read_text().splitlines()
    names, rows = lines[8].split()[2:], [line.split() for line in lines[-4:]]
    columns = [names.index(name) for name in ("quatw", "quatk", "shapex", "shapez", "mass")]
    table = np.array(rows)[:, columns].astype(float)
    assert table[:, :2] == pytest.approx(last["orientation"][:, [0, 3]], abs=1e-6)
    assert table[:, 2:].tolist() == [[3, 3, pytest.approx(5 * np.pi * 1.5**2)]] * 3 + [[0, 0, 60]]
    assert "orientation:R:4" in run.export(tmp_path / "bodies.xyz").read_text()


def test_bodies_are_read_by_mdanalysis(ended):
    universe = mesokit.open(ended.directory.path).universe()
    assert universe.atoms.resnames.tolist() == ["disks"] * 3 + ["planks"]
    assert universe.atoms.radii[:3].tolist() == [1.5] * 3
    universe.trajectory[-1]
    expected = ended.seen[40]["position"]
    np.testing.assert_allclose(universe.atoms.positions[:, :2], expected, atol=1e-5)


def test_a_run_of_bodies_goes_on_with_its_bits_on_more_threads(ended, tmp_path):
    parts = Simulation(with_a_plank(trajectory=OF_BODIES), output=tmp_path / "parts", threads=2)
    parts.run(17)
    again = Simulation.resume(tmp_path / "parts", threads=3)
    assert again.step == 17
    again.run()
    state, other = ended.engine.state(), again.engine.state()
    assert state.keys() == other.keys() and "body_turn" in state
    assert [name for name in state if not np.array_equal(state[name], other[name])] == []
    whole, resumed = (mesokit.open(path).trajectory
                      for path in (ended.directory.path, tmp_path / "parts"))  # fmt: skip
    assert resumed.read("orientation").tobytes() == whole.read("orientation").tobytes()


def test_bodies_that_are_not_there_are_refused():
    with pytest.raises(CaseError, match=r"trajectory\.of = 'bodies': expected"):
        moving_disks(bodies=(), trajectory=Trajectory(every=1, of="bodies"))
    with pytest.raises(CaseError, match="fluid of method 'mpcd' have no 'orientation'"):
        moving_disks(trajectory=Trajectory(every=1, fields=("orientation",)))


def parts_of(*regions):
    return [part for (part,) in region.union(regions)]


def test_shapes_in_three_dimensions():
    one = drawn_as(parts_of(region.brick((0, 0, 0), (2, 4, 6))), 3)
    assert one["type"] == "ConvexPolyhedron" and len(one["vertices"]) == 8
    assert np.ptp(one["vertices"], axis=0).tolist() == [2, 4, 6]

    dumbbell = drawn_as(parts_of(region.ball((-1, 0, 0), 1), region.ball((2, 0, 0), 2)), 3)
    centres = [[-1, 0, 0], [2, 0, 0]]
    assert dumbbell == {"type": "SphereUnion", "diameters": [2, 4], "centers": centres}

    along = drawn_as(parts_of(region.ellipsoid((0, 0, 0), (1, 0, 0), 3, 2)), 3)
    assert along == {"type": "Ellipsoid", "a": 3, "b": 2, "c": 2}

    rod = drawn_as(parts_of(region.capsule((-2, 0, 0), (2, 0, 0), 1)), 3)
    corners = np.array(rod["vertices"])
    nearest = np.clip(corners[:, 0], -2, 2)
    away = np.hypot(np.hypot(corners[:, 0] - nearest, corners[:, 1]), corners[:, 2])
    np.testing.assert_allclose(away, 1, atol=1e-9)
    np.testing.assert_allclose(np.ptp(corners, axis=0), [6, 2, 2], atol=1e-9)


@pytest.mark.parametrize(("d", "name", "diameter"), [
    (2, "disk", 4), (2, "ellipse", 6), (2, "rectangle", 2), (2, "union", 2),
    (3, "sphere", 4), (3, "spheroid", 6), (3, "cuboid", 2), (3, "capsule", 2), (3, "union", 2),
])  # fmt: skip
def test_ovito_draws_bodies_to_scale(d, name, diameter, tmp_path):
    """It takes the radius of a particle for that of a sphere, and times it what is no ellipsoid."""
    one = body(name, d).solid(d)
    size = 2 * one.radius
    particles = Particles(
        number=np.arange(2), kind=np.array([0, 1]), mass=np.ones(2), names=("beads", name),
        diameter=np.array([0.5, size]), molecule=np.array([-1, -1]),
        bonds=np.zeros((0, 2), int), dimension=d, size=np.full(3, 12.0),
        closed=(False,) * 3, shapes={1: drawn_as(one.parts, d)},
    )  # fmt: skip
    now = Moment(0, 0.0, 0.0, np.zeros((2, 3)), None, None)
    gsd_file.write(tmp_path / "one.gsd", particles, [now])
    with gsd.hoomd.open(str(tmp_path / "one.gsd")) as file:
        found = file[0].particles
    assert found.diameter.tolist() == [0.5, diameter]
    bead, shape = found.type_shapes
    assert bead == {"type": "Sphere", "diameter": 0.5}
    if shape["type"] == "Sphere":
        assert shape["diameter"] == diameter == pytest.approx(size)
    elif shape["type"] == "Ellipsoid":
        assert 2 * max(shape[key] for key in "abc") == diameter == pytest.approx(size)


def test_a_file_has_moments_of_inertia_and_spins_of_turned_bodies(tmp_path):
    """Quaternions 2 q (0, L), L in the frame of the body."""
    from scipy.spatial.transform import Rotation

    turn = np.array([[0.5, -0.5, 0.5, 0.5], [1, 0, 0, 0]])
    spin, inertia = np.array([[0.1, -0.2, 0.3], [1, 2, 3]]), (2.0, 5.0, 4.0)
    particles = Particles(
        number=np.arange(2), kind=np.array([1, 0]), mass=np.ones(2), names=("beads", "bricks"),
        diameter=np.ones(2), molecule=np.array([-1, -1]), bonds=np.zeros((0, 2), int), dimension=3,
        size=np.full(3, 12.0), closed=(False,) * 3, inertia={1: inertia},
    )  # fmt: skip
    now = Moment(0, 0.0, 0.0, np.zeros((2, 3)), None, None, spin, turn)
    gsd_file.write(tmp_path / "one.gsd", particles, [now])
    with gsd.hoomd.open(str(tmp_path / "one.gsd")) as file:
        found = file[0].particles
    assert found.moment_inertia.tolist() == [[2, 5, 4], [0, 0, 0]]
    rotation = Rotation.from_quat(turn[0], scalar_first=True)
    momentum = inertia * rotation.inv().apply(spin[0])
    product = rotation * Rotation.from_rotvec(np.pi * momentum / np.linalg.norm(momentum))
    expected = 2 * np.linalg.norm(momentum) * product.as_quat(scalar_first=True)
    np.testing.assert_allclose(found.angmom[0], expected, rtol=1e-6)
    assert not found.angmom[1].any()


def volume_of(mesh):
    a, b, c = np.array(mesh["vertices"])[np.array(mesh["indices"])].swapaxes(0, 1)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6  # of faces that turn to the left


def test_a_union_is_a_mesh_whose_faces_look_outward():
    bricks = [region.brick((0, 0, 0), (3, 3, 3)), region.brick((2.5, 0, 0), (2, 2, 2))]
    assert volume_of(drawn_as(parts_of(*bricks), 3)) == pytest.approx(27 + 8)
    flat = drawn_as(parts_of(*bricks), 2)
    a, b, c = np.array(flat["vertices"])[np.array(flat["indices"])].swapaxes(0, 1)
    assert np.cross(b - a, c - a)[:, 2].sum() / 2 == pytest.approx(9 + 4)


def beside_beads(of):
    """A few steps of beads beside a disk and a rectangle, with all fields of bodies kept."""
    kept = Trajectory(every=5, of=of, fields=FIELDS, precision="float64")
    beads, bodies = Solutes([Polymer(number=7)], mass=5.0), [body("disk", 2), body("rectangle", 2)]
    held = {"timestep": 0.1, "thermostat": MaxwellBoltzmann()}
    case = make_case((26, 24), bodies=bodies, solutes=beads, trajectory=kept, **held)
    return dataclasses.replace(case, run=Run(steps=10))


def test_a_trajectory_of_all_that_is_suspended_has_beads_and_bodies(tmp_path):
    simulation = Simulation(beside_beads("suspended"), output=tmp_path / "run", threads=1)
    simulation.run()
    frames, engine = mesokit.open(tmp_path / "run").trajectory, simulation.engine
    assert frames.id.tolist() == (simulation.case.particles + np.arange(9)).tolist()
    assert frames.species.tolist() == [1] * 7 + [2, 3]
    np.testing.assert_array_equal(frames.read("position")[-1], engine.positions(frames.id))
    turned, spins = frames.read("orientation")[-1], frames.read("spin")[-1]
    np.testing.assert_array_equal(turned[:7], np.eye(4)[[0] * 7])
    np.testing.assert_array_equal(turned[7:], engine.bodies.orientations)
    np.testing.assert_array_equal(spins, [0.0] * 7 + engine.bodies.spins[:, 2].tolist())


def test_beads_alone_have_no_orientation():
    with pytest.raises(CaseError, match="solutes of method 'mpcd' have no 'orientation'"):
        beside_beads("solutes")
    case = beside_beads("suspended")
    with pytest.raises(CaseError, match=r"trajectory\.of = 'suspended': expected 'all'"):
        dataclasses.replace(case, bodies=())
