"""Contacts of each frame in all that is written, and back."""

import csv

import h5py
import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, CaseError, LennardJones, Run, RunError, Simulation, SoftSpheres
from mesokit import every as every_steps
from mesokit.case.trajectory import Trajectory, stored_bytes
from mesokit.method.spheres.common.section import Spheres
from tests.helpers.grains import grains

NAMES = ("pair", "normal", "force", "place", "gap")


@pytest.fixture(autouse=True, scope="module")
def no_figures():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        yield


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A run that has ended, and the contacts that its engine had at each frame."""
    folder, seen = tmp_path_factory.mktemp("ended") / "run", []
    look = every_steps(2500, lambda simulation: seen.append(simulation.engine.contacts()))
    simulation = Simulation(grains(warmup=0), output=folder, threads=1, callbacks=[look])
    simulation.run()
    return folder, seen


def same(one, other):
    """Whether two lists of records have the same bits."""
    pairs = zip(one, other, strict=True)
    return [bool(np.array_equal(a, b)) and len(a) == len(b) for a, b in pairs]


def test_frames_have_the_contacts_of_the_engine(ended):
    folder, seen = ended
    reader = mesokit.open(folder).trajectory
    assert reader.fields == ("position", "contact")
    found = reader.read("contact")
    assert len(found) == len(seen) == 5
    for name, column in zip(NAMES, range(5), strict=True):
        wanted = [contacts[column] for contacts in seen]
        assert same([records[name] for records in found], wanted) == [True] * 5
    assert [len(records) for records in found] == [len(contacts.gaps) for contacts in seen]
    assert len(found[0]) < 3 < len(found[2]) < len(found[-1])
    assert same([reader[-1]["contact"]], [found[-1]]) == [True]
    assert same(reader.read("contact", slice(1, 3)), found[1:3]) == [True] * 2


def test_the_file_has_elements_of_h5md(ended):
    folder, seen = ended
    numbers = [len(contacts.gaps) for contacts in seen]
    with h5py.File(folder / "run.h5") as file:
        group = file["particles/spheres"]
        pairs, rest = file["connectivity/contacts"], file["contacts"]
        assert file[pairs.attrs["particles_group"]] == group
        assert pairs["value"].shape == (5, max(numbers), 2)
        assert rest["force/value"].shape == (5, max(numbers), 3)
        assert rest["number"][()].tolist() == numbers
        filled = pairs["value"][()] == pairs["value"].fillvalue
        assert filled.all(axis=2).sum(axis=1).tolist() == [max(numbers) - n for n in numbers]
        assert np.isnan(rest["gap/value"][()]).sum() == filled.all(axis=2).sum()
        assert np.nanmax(np.abs(rest["force/value"][-1, :, 2])) == 0.0
        assert rest["force/value"].attrs["reduced_unit"] == "mass length/time^2"
        for name in ("force", "normal", "place", "gap"):
            assert rest[name]["step"] == group["position/step"]
            assert rest[name]["time"] == group["position/time"]


def test_a_run_that_stops_and_goes_on_has_the_same_contacts(ended, tmp_path):
    folder, _ = ended
    whole = mesokit.open(folder).trajectory.read("contact")
    first = Simulation(grains(steps=6000, warmup=0), output=tmp_path / "run", threads=1)
    first.run(3500)
    first.checkpoint()
    first.run(2000)  # and frames of step 5000, which the checkpoint does not have
    del first
    second = Simulation.resume(tmp_path / "run", threads=1)
    second.run()
    parts = mesokit.open(tmp_path / "run").trajectory.read("contact")
    assert same(parts, whole[:3]) == [True] * 3
    third = Simulation.resume(tmp_path / "run", threads=1, steps=10_000)  # frames of the data file
    third.run()
    assert same(mesokit.open(tmp_path / "run").trajectory.read("contact"), whole) == [True] * 5


def test_a_data_file_written_again_keeps_them(ended, tmp_path):
    simulation = Simulation(grains(steps=2500), output=tmp_path / "run", threads=1)
    simulation.run()
    before = mesokit.open(tmp_path / "run").trajectory.read("contact")
    Simulation.resume(tmp_path / "run", threads=1).run()
    after = mesokit.open(tmp_path / "run").trajectory.read("contact")
    assert same(after, before) == [True] * 2
    with h5py.File(tmp_path / "run" / "run.h5") as file:
        linked = file["connectivity/contacts"].attrs["particles_group"]
        assert file[linked] == file["particles/spheres"]


def test_single_precision_and_a_subset(ended, tmp_path):
    whole = mesokit.open(ended[0]).trajectory.read("contact")[-1]
    case = grains(warmup=0, precision="float32", subset=30)
    Simulation(case, output=tmp_path / "run", threads=1).run()
    few = mesokit.open(tmp_path / "run").trajectory[-1]["contact"]
    wanted = whole[(whole["pair"] < 30).all(axis=1)]
    assert 0 < len(few) == len(wanted) < len(whole)
    assert np.array_equal(few["pair"], wanted["pair"])
    assert few["force"].dtype == np.float32
    assert few["force"] == pytest.approx(wanted["force"], rel=1e-6)


def test_a_table_has_a_line_for_each_contact(ended, tmp_path):
    folder, seen = ended
    path = mesokit.open(folder).export(tmp_path / "a.csv")
    with path.open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == sum(len(contacts.gaps) for contacts in seen)
    last = [row for row in rows if row["step"] == "10000"]
    pairs = [[int(row["first"]), int(row["second"])] for row in last]
    assert pairs == seen[-1].pairs.tolist()
    forces = [[float(row["force_x"]), float(row["force_y"])] for row in last]
    assert np.array(forces) == pytest.approx(seen[-1].forces, rel=1e-7)
    normal = [float(row["normal_force"]) for row in last]
    assert normal == pytest.approx(seen[-1].normal_forces, rel=1e-7)
    tangential = [float(row["tangential_force"]) for row in last]
    size = np.abs(seen[-1].forces).max()
    assert tangential == pytest.approx(seen[-1].tangential_forces, rel=1e-6, abs=1e-6 * size)


def test_a_dump_of_local_data_has_pairs_from_one(ended, tmp_path):
    folder, seen = ended
    text = mesokit.open(folder).export(tmp_path / "a.local").read_text()
    frames = text.split("ITEM: TIMESTEP\n")[1:]
    assert [int(frame.split("\n")[0]) for frame in frames] == [0, 2500, 5000, 7500, 10000]
    between = [contacts.pairs[~contacts.at_walls] for contacts in seen]
    assert [int(frame.split("\n")[2]) for frame in frames] == [len(pairs) for pairs in between]
    head, *lines = frames[-1].strip().split("\n")[7:]
    assert head == "ITEM: ENTRIES batom1 batom2 nx ny fx fy rx ry gap fn ft"
    pairs = [[int(word) for word in line.split()[:2]] for line in lines]
    assert pairs == (between[-1] + 1).tolist()


def test_the_estimate_of_a_trajectory_counts_contacts():
    case = grains()
    bare = grains(fields=("position",))
    sizes = [stored_bytes(each.trajectory, each.groups, 2, 10_000) for each in (case, bare)]
    # 60 disks with two contacts each: two numbers of 8 bytes, and 7 of 8 bytes; 0.9 compressed
    assert sizes[0] - sizes[1] == round(0.9 * 5 * 60 * 2 * (16 + 7 * 8))


def refused(**given):
    with pytest.raises(CaseError) as caught:
        Case(
            box=Box([12.0, 12.0]), trajectory=Trajectory(every=10, fields=["contact"]), **given
        )  # fmt: skip
    return str(caught.value)


def test_particles_without_lasting_contacts_have_none():
    hard = refused(run=Run(10, method="event-driven"))
    lennard = SoftSpheres(number=9, pair=LennardJones(), timestep=0.001)
    atoms = refused(run=Run(10, method="soft-spheres"), spheres=lennard)
    fluid = refused(run=Run(10))
    key = "trajectory.fields = ['contact']: "
    assert key + "spheres of method 'event-driven' have no 'contact'; expected some of" in hard
    assert key + "spheres of method 'soft-spheres' have no 'contact'" in atoms
    assert key + "fluid of method 'mpcd' have no 'contact'" in fluid
    assert [text.count("\n") for text in (hard, atoms, fluid)] == [0, 0, 0]
    assert not Spheres().touching


def test_tables_of_contacts_need_contacts(tmp_path):
    case = grains(steps=0, warmup=0, fields=("position",))
    Simulation(case, output=tmp_path / "run", threads=1).run()
    with pytest.raises(RunError, match=r"fields = .*: exports need 'contact'"):
        mesokit.open(tmp_path / "run").export(tmp_path / "a.csv")
    with pytest.raises(CaseError, match=r"ending '.cvs': expected .*'.csv'\?"):
        mesokit.open(tmp_path / "run").export(tmp_path / "a.cvs")
