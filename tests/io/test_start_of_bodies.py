"""Bodies that start where an earlier run, a file or arrays have them."""

from __future__ import annotations

from dataclasses import replace

import gsd.hoomd
import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, CaseError, Fluid, Run, Start
from mesokit.case.trajectory import Trajectory
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.protocol import BodyStart
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.start.bodies import first_bodies
from mesokit.run.simulation import Simulation
from tests.helpers.moving_disks import with_a_plank

pytestmark = pytest.mark.usefixtures("no_figures")
FIELDS = ("position", "velocity", "orientation", "spin")
OF_BODIES = Trajectory(every=20, of="bodies", fields=FIELDS, precision="float64")
STATE = ("body_place", "body_turn", "body_velocity", "body_spin")


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A run of disks and a plank that has ended, and its exported trajectory."""
    folder = tmp_path_factory.mktemp("runs") / "bodies"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        simulation = Simulation(with_a_plank(trajectory=OF_BODIES), output=folder, threads=1)
        simulation.run()
    simulation.gsd = mesokit.open(folder).export(folder.parent / "bodies.gsd")
    return simulation


def starting(case, *, fluid=None, **keys):
    """The case with these starts of its kinds of bodies."""
    one = BodyStart(**keys)
    bodies = tuple(replace(kind, start=one) for kind in case.bodies)
    fluid = case.fluid if fluid is None else replace(case.fluid, start=fluid)
    return replace(case, bodies=bodies, fluid=fluid)


def test_a_start_from_a_run_goes_on_with_the_same_bodies(ended, tmp_path):
    """To the last bit, with its fluid, of which no particle is in a body then."""
    run = str(ended.directory.path)
    case = starting(ended.case, rule="run", run=run, fluid=Start(run=run))
    file = tmp_path / "case.toml"
    file.write_text(case.to_toml())
    assert Case.from_toml(file) == case
    later = Simulation(case, output=tmp_path / "later", threads=1)
    before, state = ended.engine.state(), later.engine.state()
    for name in STATE:
        np.testing.assert_array_equal(state[name], before[name], err_msg=name)
    momentum = ended.engine.totals()[1]
    np.testing.assert_allclose(later.engine.totals()[1], momentum, rtol=0, atol=1e-10)
    later.run(5)
    assert abs(later.engine.state()["body_place"] - before["body_place"]).max() > 1e-4


def test_bodies_of_a_run_may_start_among_a_new_fluid(ended):
    run = str(ended.directory.path)
    bodies = ended.engine.bodies
    found = first_bodies(starting(ended.case, rule="run", run=run))
    np.testing.assert_array_equal(found.places, bodies.places())
    np.testing.assert_array_equal(found.spins, bodies.spins)
    at_rest = first_bodies(starting(ended.case, rule="run", run=run, moving=False))
    np.testing.assert_array_equal(at_rest.turns, bodies.orientations)
    assert not at_rest.moving and abs(at_rest.velocities - bodies.velocities).min() > 0
    held = starting(ended.case, rule="run", run=run)
    kinds = [replace(kind, fixed=("y", "orientation")) for kind in held.bodies]
    found = first_bodies(replace(held, bodies=kinds))
    np.testing.assert_array_equal(found.velocities[:, 0], bodies.velocities[:, 0])
    assert not found.velocities[:, 1].any() and not found.spins.any()


def test_a_quaternion_of_three_digits_is_a_unit_one():
    start = BodyStart(rule="given", positions=[[4, 4, 4]], orientations=[[0.707, 0, 0, -0.707]])
    case = Case(run=Run(steps=1), box=Box([9, 9, 9]), bodies=(SphereBody(radius=2, start=start),))
    root = np.sqrt(0.5)
    np.testing.assert_allclose(first_bodies(case).turns, [[root, 0, 0, -root]], rtol=1e-15)


@pytest.mark.parametrize("frame", [None, 1])
def test_a_frame_of_a_file_has_bodies(ended, frame):
    trajectory = mesokit.open(ended.directory.path).trajectory
    case = starting(ended.case, rule="file", file=str(ended.gsd), frame=frame)
    found, at = first_bodies(case), -1 if frame is None else frame
    # lengths in single precision
    np.testing.assert_allclose(found.places, trajectory.read("position")[at], atol=1e-5)
    np.testing.assert_allclose(found.turns, trajectory.read("orientation")[at], atol=1e-6)
    np.testing.assert_allclose(found.velocities, trajectory.read("velocity")[at], atol=1e-6)
    np.testing.assert_allclose(found.spins[:, 2], trajectory.read("spin")[at], atol=1e-6)


def test_a_file_of_another_program_has_spins_of_bodies_of_any_shape(tmp_path):
    """Quaternions 2 q (0, L) with three moments of inertia."""
    from mesokit.io.gsd_file import read

    turn = np.array([0.5, -0.5, 0.5, 0.5])  # x to -z, y to -x and z to y
    momentum, inertia = np.array([1.0, 2.0, 3.0]), np.array([2.0, 5.0, 4.0])
    w, v = turn[0], turn[1:]
    angmom = 2 * np.append(-v @ momentum, w * momentum + np.cross(v, momentum))
    frame = gsd.hoomd.Frame()
    frame.configuration.box = [9, 9, 9, 0, 0, 0]
    frame.particles.N, frame.particles.position = 1, [[0, 0, 0]]
    frame.particles.orientation, frame.particles.angmom = [turn], [angmom]
    frame.particles.moment_inertia = [inertia]
    with gsd.hoomd.open(str(tmp_path / "one.gsd"), mode="w") as file:
        file.append(frame)
    own = momentum / inertia
    twist = 2 * np.cross(v, own)
    expected = own + w * twist + np.cross(v, twist)
    np.testing.assert_allclose(read(str(tmp_path / "one.gsd")).spins[0], expected, rtol=1e-6)


def test_a_kind_that_is_named_must_be_in_the_file(tmp_path):
    frame, path = gsd.hoomd.Frame(), str(tmp_path / "one.gsd")
    frame.configuration.box = [9, 9, 9, 0, 0, 0]
    frame.particles.N, frame.particles.position, frame.particles.types = 1, [[0, 0, 0]], ["A"]
    with gsd.hoomd.open(path, mode="w") as file:
        file.append(frame)

    def places(**more):
        ball = SphereBody(radius=2, start=BodyStart(rule="file", file=path, **more))
        return first_bodies(Case(run=Run(steps=1), box=Box([9, 9, 9]), bodies=(ball,))).places

    np.testing.assert_allclose(places(), [[4.5, 4.5, 4.5]])
    np.testing.assert_allclose(places(kind="A"), [[4.5, 4.5, 4.5]])
    with pytest.raises(CaseError, match=r"it has no particles of type 'zz'; it has 'A'$"):
        places(kind="zz")


def test_a_file_of_spheres_is_refused_in_two_dimensions(tmp_path):
    frame, path = gsd.hoomd.Frame(), str(tmp_path / "two.gsd")
    frame.configuration.box = [9, 14, 9, 0, 0, 0]
    frame.particles.N, frame.particles.position = 2, [[0, 0, 0], [0, 0, 3]]
    with gsd.hoomd.open(path, mode="w") as file:
        file.append(frame)
    disks = DiskBody(radius=2, number=2, start=BodyStart(rule="file", file=path))
    case = Case(run=Run(steps=1), box=Box([9, 9]), bodies=(disks,))
    with pytest.raises(CaseError, match=r"its particles differ in z; expected a 2D box as in this"):
        first_bodies(case)


def wrong_velocities(name, array):
    frame = gsd.hoomd.Frame()
    frame.configuration.box = [9, 9, 9, 0, 0, 0]
    frame.particles.N, frame.particles.position = 2, [[0, 0, 0], [4, 4, 4]]
    if name == "velocities":
        frame.particles.velocity = array
    else:
        frame.log = {"particles/angular_velocity": np.array(array, float)}
    return frame


SLOW = [0, 0, 0.1]
NO_START = {
    "a velocity that is none": (
        "velocities", [SLOW, [np.nan, 0, 0]],
        "velocities: row 1 = [nan, 0, 0]: expected finite numbers",
    ),
    "an infinite spin": (
        "spins", [[0, np.inf, 0], SLOW], "spins: row 0 = [0, inf, 0]: expected finite numbers",
    ),
    "fast": (
        "velocities", [SLOW, [0, 30, 40]], "velocities: row 1 = [0, 30, 40]: it moves by 5 cells "
        "in a timestep; expected at most 0.35",
    ),
    "fast spins": (
        "spins", [SLOW, [0, 3, 4]], "spins: row 1 = [0, 3, 4]: it moves by 0.5 cells in a "
        "timestep; expected at most 0.35",
    ),
    "one row": (
        "spins", [SLOW], "log/particles/angular_velocity has shape (1, 3); expected (2, 3)"
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", NO_START)
def test_velocities_of_a_file_must_be_fit_to_start_from(what, tmp_path):
    name, array, line = NO_START[what]
    path = str(tmp_path / "two.gsd")
    with gsd.hoomd.open(path, mode="w") as file:
        file.append(wrong_velocities(name, array))
    start = BodyStart(rule="file", file=path)
    ball = SphereBody(radius=1, number=2, start=start)
    fluid = Fluid(timestep=0.1)
    case = Case(run=Run(steps=1), box=Box([9, 9, 9]), bodies=(ball,), fluid=fluid)
    with pytest.raises(CaseError) as error:
        first_bodies(case)
    assert str(error.value) == f"bodies[#1].start.file = '{path}': {line}"


def test_a_run_whose_images_have_slid_is_refused(ended, tmp_path):
    sheared = replace(ended.case, box=replace(ended.case.box, shear_rate=0.01))
    early = Simulation(sheared, output=tmp_path / "early", threads=1)
    early.run(3)
    early.checkpoint()
    case = starting(sheared, rule="run", run=str(tmp_path / "early"))
    with pytest.raises(CaseError, match=r"its images have slid by .* along x, and at a start"):
        first_bodies(case)


def test_arrays_have_bodies(ended, tmp_path):
    bodies, n = ended.engine.bodies, 3
    arrays = {
        "positions": bodies.places()[:n],
        "orientations": np.degrees(2 * np.arctan2(*bodies.orientations[:n, [3, 0]].T))[:, None],
        "velocities": bodies.velocities[:n],
        "spins": bodies.spins[:n, 2:],
    }
    files = {}
    for name, array in arrays.items():
        np.save(tmp_path / f"{name}.npy", array)
        files[name] = str(tmp_path / f"{name}.npy")
    case = replace(ended.case, bodies=ended.case.bodies[:1])
    for given in (arrays, files):
        found = first_bodies(starting(case, rule="given", **given))
        np.testing.assert_array_equal(found.places, bodies.places()[:n])
        np.testing.assert_allclose(found.turns, bodies.orientations[:n], atol=1e-12)
        np.testing.assert_array_equal(found.velocities, bodies.velocities[:n])
        np.testing.assert_array_equal(found.spins, bodies.spins[:n])


def test_what_does_not_fit_is_refused_in_one_line(ended, tmp_path):
    run, file, case = str(ended.directory.path), str(ended.gsd), ended.case
    np.save(tmp_path / "two.npy", np.ones((2, 2)))
    np.save(tmp_path / "out.npy", [[1.0, 2.0], [3.0, 15.0], [5.0, 6.0]])
    two, out = str(tmp_path / "two.npy"), str(tmp_path / "out.npy")
    more = replace(case, bodies=(replace(case.bodies[0], number=4),))
    wide = replace(case, bodies=(replace(case.bodies[0], radius=1.25),))
    plank = replace(case, bodies=(replace(case.bodies[0], number=1),))
    where = "bodies[#1].start."
    wrong = [
        (case, {"rule": "run", "run": run, "kind": "dsks"},
         f"{where}run = '{run}': that run has no bodies 'dsks'; it has 'disks' or 'planks'"),
        (more, {"rule": "run", "run": run},
         f"{where}run = '{run}': that run has 3 bodies 'disks', this case 4"),
        (wide, {"rule": "run", "run": run},
         f"{where}run = '{run}': its bodies 'disks' have another shape or size than in this case"),
        (case, {"rule": "run", "run": two}, None),
        (replace(case, box=replace(case.box, size=(15, 14))), {"rule": "run", "run": run},
         f"{where}run = '{run}': that run has a box of [14, 14], this case [15, 14]"),
        (case, {"rule": "file", "file": file, "frame": 9},
         f"{where}file = '{file}': frame = 9: it has 3, from 0 on"),
        (case, {"rule": "file", "file": file, "kind": "rods"},
         f"{where}file = '{file}': it has no particles of type 'rods'; it has 'disks' or 'planks'"),
        (more, {"rule": "file", "file": file},
         f"{where}file = '{file}': it has 3 particles of type 'disks', this case 4 bodies"),
        (wide, {"rule": "file", "file": file},
         f"{where}file = '{file}': its particles of type 'disks' have another shape or size than "
         "the bodies of this case"),
        (plank, {"rule": "file", "file": file, "kind": "planks"}, None),
        (case, {"rule": "file", "file": two},
         f"{where}file = '{two}': ending '.npy': expected '.gsd'"),
        (case, {"rule": "given", "positions": two},
         f"{where}positions = '{two}': shape (2, 2): expected (3, 2)"),
        (case, {"rule": "given", "positions": out},
         f"{where}positions = '{out}': row 1 = [3, 15] lies outside the box along y; expected 0 "
         "to 14"),
    ]  # fmt: skip
    for one, keys, line in wrong:
        with pytest.raises(CaseError) as error:
            first_bodies(starting(one, **keys))
        found = str(error.value)
        assert "\n" not in found and (found == line if line else found.startswith(where))
