"""What `export` writes is what other programs read: GSD, dumps of LAMMPS, extended XYZ."""

from __future__ import annotations

import dataclasses
import warnings

import h5py
import numpy as np
import pytest

import mesokit
from mesokit import WCA, Plates, Uniform
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import names_and_diameters
from mesokit.cli import main
from mesokit.errors import CaseError, RunError
from mesokit.method.mpcd.fluid import Fluid, Species
from mesokit.method.mpcd.start.section import Start
from mesokit.run.simulation import Simulation
from tests.helpers.exports import TRIMERS, read, run_of

pytestmark = pytest.mark.usefixtures("no_figures")


@pytest.mark.parametrize("size, steps", [((6, 8), 0), ((6, 5, 7), 40)])
def test_gsd_has_all_that_the_run_has(size, steps, tmp_path):
    simulation = run_of(tmp_path / "run", size, steps, kT=2.0, mass=3.0)
    frames = read(mesokit.open(tmp_path / "run").export(tmp_path / "run.gsd"))
    d, n = len(size), simulation.engine.n
    deep = [1.0] * (3 - d)
    assert [frame.configuration.step for frame in frames] == list(range(0, steps + 1, 10))
    times = [frame.log["time"][0] for frame in frames]
    assert times == pytest.approx(np.arange(0, 0.1 * steps + 0.5))
    for frame, (r, v, image, bonds) in zip(frames, simulation.seen.values(), strict=True):
        frame.validate()
        assert frame.configuration.dimensions == d
        assert frame.configuration.box.tolist() == [*size, *deep, 0, 0, 0]
        x = frame.particles.position
        np.testing.assert_allclose(x[:, :d] + 0.5 * np.array(size), r, atol=2e-6)
        assert (np.abs(x) <= 0.5 * frame.configuration.box[:3]).all() and (x[:, d:] == 0).all()
        np.testing.assert_allclose(frame.particles.velocity[:, :d], v, atol=1e-5)
        np.testing.assert_array_equal(frame.particles.image[:, :d], image)
        np.testing.assert_array_equal(frame.particles.mass, np.full(n, 3.0))
        np.testing.assert_array_equal(frame.bonds.group, simulation.engine.bonds())
        whole = x[:, :d] + frame.particles.image[:, :d] * np.array(size)
        way = whole[frame.bonds.group[:, 1]] - whole[frame.bonds.group[:, 0]]
        np.testing.assert_allclose(way, bonds, atol=1e-5)


def test_a_sheared_box_leans_and_bonds_keep_their_length(tmp_path):
    """Images slide by more than a box here: unwrapped beads still hang together."""
    simulation = run_of(tmp_path / "run", (6, 6, 6), steps=60, shear_rate=0.4)
    frames = read(mesokit.open(tmp_path / "run").export(tmp_path / "run.gsd"))
    tilts = []
    for frame, (r, _, image, bonds) in zip(frames, simulation.seen.values(), strict=True):
        box, x = frame.configuration.box.astype(float), frame.particles.position
        slid = 0.4 * 6 * frame.log["time"][0]
        tilts.append(box[3] * 6)
        assert tilts[-1] == pytest.approx((slid + 3) % 6 - 3, abs=1e-5)
        edges = np.array([[6, 0, 0], [6 * box[3], 6, 0], [0, 0, 6]])
        share = x @ np.linalg.inv(edges)
        assert np.abs(share).max() < 0.5 + 1e-6
        whole = x + frame.particles.image @ edges
        a, b = frame.bonds.group.T
        np.testing.assert_allclose(whole[b] - whole[a], bonds, atol=1e-4)
        assert (image[:, 1] == frame.particles.image[:, 1]).all()
        off = (x[:, 0] + 0.5 * (6 + tilts[-1]) - r[:, 0]) / 6
        np.testing.assert_allclose(off, np.rint(off), atol=1e-5)
    assert min(tilts) < -0.5 and max(tilts) > 0.5 and slid > 12


def test_mdanalysis_reads_all_three(whole, tmp_path):
    files = mesokit.open(whole.directory.path)
    size = np.array([6, 5, 7])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import MDAnalysis

        for ending, shift in ((".gsd", 0.5 * size), (".lammpstrj", 0), (".xyz", 0)):
            path = str(files.export(tmp_path / f"run{ending}"))
            universe = MDAnalysis.Universe(
                path, **({"format": "LAMMPSDUMP"} if ending == ".lammpstrj" else {})
            )
            assert universe.trajectory.n_frames == 5
            for now, (r, *_) in zip(universe.trajectory, whole.seen.values(), strict=True):
                np.testing.assert_allclose(now.positions + shift, r, atol=1e-5)
                if ending != ".xyz":
                    assert now.dimensions.tolist() == [6, 5, 7, 90, 90, 90]
            if ending == ".gsd":
                np.testing.assert_array_equal(universe.bonds.to_indices(), whole.engine.bonds())


def test_kinds_have_names_sizes_and_molecules(mixed, tmp_path, monkeypatch):
    """No kind is called as a chemical element, and no file has other rights than those of runs."""
    names = ("fluid", "polymer-1", "polymer-2")
    sizes = (names, np.array([0.5, 0.5, 1.5]))
    assert names_and_diameters(mixed.case.groups)[0] == names
    solutes = dataclasses.replace(mixed.case.solutes, pair=WCA(sigma=1.5))
    sized = dataclasses.replace(mixed.case, solutes=solutes)
    assert names_and_diameters(sized.groups)[1].tolist() == [0.5, 1.5, 1.5]
    monkeypatch.setattr("mesokit.io.export.names_and_diameters", lambda groups: sizes)
    files = mesokit.open(mixed.directory.path)
    particles = read(files.export(tmp_path / "a.gsd"))[-1].particles
    assert particles.types == ["fluid", "polymer-1", "polymer-2"]
    assert particles.type_shapes == [{"type": "Sphere", "diameter": 0.5}] * 2 + [
        {"type": "Sphere", "diameter": 1.5}
    ]
    assert particles.diameter.tolist() == [0.5] * 78 + [1.5]
    assert particles.body.tolist() == [-1] * 72 + [-2] * 3 + [-3] * 3 + [-1]
    text = files.export(tmp_path / "a.xyz").read_text().splitlines()
    assert "species:S:1:pos:R:3:id:I:1:molecule:I:1:radius:R:1" in text[1]
    rows = [line.split() for line in text[2:81]]
    assert [row[0] for row in rows] == ["fluid"] * 72 + ["polymer-1"] * 6 + ["polymer-2"]
    assert [row[5:7] for row in rows[71:76]] == [["0", "0.25"], *[["1", "0.25"]] * 3, ["2", "0.25"]]
    rights = (mixed.directory.data_file.stat().st_mode, tmp_path.stat().st_mode)
    assert {path.stat().st_mode for path in tmp_path.iterdir()} == {rights[0]}


def test_a_dump_says_box_images_and_velocities(whole, tmp_path):
    path = mesokit.open(whole.directory.path).export(tmp_path / "run.lammpstrj")
    lines = path.read_text().splitlines()
    assert lines[4] == "ITEM: BOX BOUNDS pp pp pp" and lines[5:8] == ["0 6", "0 5", "0 7"]
    assert lines[8] == "ITEM: ATOMS id type element mol diameter mass x y z ix iy iz vx vy vz"
    n, (r, v, image, _) = whole.engine.n, whole.seen[0]
    words = [line.split() for line in lines[9 : 9 + n]]
    assert [word[2:5] for word in words] == [["fluid", str(i // 3 + 1), "0.5"] for i in range(n)]
    rows = np.array([word[:2] + word[5:] for word in words], float)
    np.testing.assert_allclose(rows[:, 3:6], r, atol=1e-5)
    np.testing.assert_array_equal(rows[:, 6:9], image)
    np.testing.assert_allclose(rows[:, 9:], v, atol=1e-5)
    assert rows[:, :3].tolist() == [[i + 1, 1, 1] for i in range(n)]
    head = mesokit.open(whole.directory.path).export(tmp_path / "a.xyz").read_text().splitlines()[1]
    assert 'Lattice="6 0 0 0 5 0 0 0 7"' in head and 'pbc="T T T"' in head


def test_plates_close_an_axis(tmp_path):
    run_of(
        tmp_path / "run", (6, 5), 0, [Plates(axis="y")], molecule=None, fields=("position",),
        force=Uniform((0.01, 0.0)),
    )  # fmt: skip
    files = mesokit.open(tmp_path / "run")
    assert "ITEM: BOX BOUNDS pp ff ff" in files.export(tmp_path / "a.lammpstrj").read_text()
    assert 'pbc="T F F"' in files.export(tmp_path / "a.xyz").read_text()


def test_a_box_in_2d_does_not_repeat_along_z(tmp_path):
    run_of(tmp_path / "run", (6, 5), 0, molecule=None, fields=("position",))
    files = mesokit.open(tmp_path / "run")
    dump, xyz = files.export(tmp_path / "a.lammpstrj"), files.export(tmp_path / "a.xyz")
    assert "ITEM: BOX BOUNDS pp pp ff\n0 6\n0 5\n0 1\n" in dump.read_text()
    assert 'pbc="T T F"' in xyz.read_text()
    with h5py.File(files.export(tmp_path / "a.h5md")) as file:
        boundary = file["particles/trajectory/box"].attrs["boundary"]
        assert list(boundary) == ["periodic", "periodic", "none"]
    import MDAnalysis

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        read_back = MDAnalysis.Universe(str(dump), format="LAMMPSDUMP")
    np.testing.assert_allclose(read_back.dimensions[:3], [6, 5, 1])
    assert (read_back.atoms.positions[:, 2] == 0).all()


def test_a_sheared_dump_leans(tmp_path):
    run_of(tmp_path / "run", (6, 6, 6), shear_rate=0.4)
    path = mesokit.open(tmp_path / "run").export(tmp_path / "run.lammpstrj")
    lines = path.read_text().splitlines()
    lines = lines[lines.index("10") - 1 :]
    assert lines[4:8] == ["ITEM: BOX BOUNDS xy xz yz pp pp pp", "0 8.4 2.4", "0 6 0", "0 6 0"]


def test_a_run_that_goes_on_gives_what_it_has_so_far(whole, tmp_path):
    """Up to its last checkpoint; the frames are those of the run that was never stopped."""
    simulation = Simulation(whole.case, output=tmp_path / "run", threads=1)
    with pytest.raises(RunError, match="has not ended"):
        mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd")
    assert not (tmp_path / "a.gsd").exists()
    simulation.run(20)
    simulation.checkpoint()
    early = read(mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd"))
    simulation.run()
    late = mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd").read_bytes()
    assert late == mesokit.open(whole.directory.path).export(tmp_path / "b.gsd").read_bytes()
    assert len(early) == 3
    for frame, other in zip(early, read(tmp_path / "b.gsd"), strict=False):
        np.testing.assert_array_equal(frame.particles.position, other.particles.position)
        np.testing.assert_array_equal(frame.bonds.group, other.bonds.group)


@pytest.mark.parametrize("ending", ["gsd", "data"])
def test_an_export_is_a_start(ending, whole, tmp_path):
    """Out and in again: places to single precision, and whole molecules."""
    path = mesokit.open(whole.directory.path).export(tmp_path / f"melt.{ending}")
    case = Case(
        run=Run(steps=1), box=whole.case.box,
        fluid=Fluid(density=9, molecule=TRIMERS, start=Start(file=str(path))),
    )  # fmt: skip
    other = Simulation(case, threads=1)
    np.testing.assert_allclose(other.engine.positions(), whole.engine.positions(), atol=1e-5)
    np.testing.assert_allclose(other.engine.velocities(), whole.engine.velocities(), atol=1e-5)
    np.testing.assert_allclose(other.engine.bond_vectors(), whole.engine.bond_vectors(), atol=1e-5)


def test_kinds_and_subsets(tmp_path):
    kinds = (Species(mass=4.0, density=1.0), Species(mass=1.0, density=8.0))
    run_of(
        tmp_path / "run", (6, 6), 0, fields=("position",), subset=50, molecule=None, species=kinds
    )
    frame = read(mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd"))[0]
    assert frame.particles.types == ["fluid-1", "fluid-2"]
    np.testing.assert_array_equal(frame.particles.typeid, np.repeat([0, 1], [36, 14]))
    np.testing.assert_array_equal(frame.particles.mass, np.repeat([4, 1], [36, 14]))
    assert (frame.particles.velocity == 0).all() and frame.bonds.N == 0
    run_of(tmp_path / "chains", (6, 6), 0, subset=7)
    frame = read(mesokit.open(tmp_path / "chains").export(tmp_path / "a.gsd"))[0]
    assert frame.bonds.group.tolist() == [[0, 1], [1, 2], [3, 4], [4, 5]]


def test_the_command(whole, tmp_path, capsys):
    with pytest.raises(SystemExit) as end:
        main(["export", str(whole.directory.path), "--to", str(tmp_path / "film.gsd")])
    assert end.value.code == 0 and capsys.readouterr().out.strip() == str(tmp_path / "film.gsd")
    assert len(read(tmp_path / "film.gsd")) == 5


def test_what_cannot_be_exported_is_one_line(whole, tmp_path):
    files = mesokit.open(whole.directory.path)
    with pytest.raises(CaseError, match=r"^[^\n]*ending '\.vtk': expected '\.gsd', .*'\.dcd'"):
        files.export(tmp_path / "run.vtk")
    with pytest.raises(RunError, match="cannot write"):
        files.export(tmp_path / "nowhere" / "run.gsd")
    case = Case(run=Run(steps=5), box=Box([4, 4]))
    Simulation(case, output=tmp_path / "bare", threads=1).run()
    with pytest.raises(RunError, match="keeps no trajectory"):
        mesokit.open(tmp_path / "bare").export(tmp_path / "a.gsd")
    assert not list(tmp_path.glob("*.gsd"))
