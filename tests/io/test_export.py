"""What `export` writes is what other programs read: GSD, dumps of LAMMPS, extended XYZ."""

from __future__ import annotations

import dataclasses
import re
import shutil
import warnings
from pathlib import Path

import gsd.hoomd
import h5py
import numpy as np
import pytest

import mesokit
from mesokit import WCA, Harmonic, MaxwellBoltzmann, Plates, Uniform, every
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import Trajectory, names_and_diameters
from mesokit.cli import main
from mesokit.errors import CaseError, RunError
from mesokit.io import h5md
from mesokit.method.mpcd.fluid import Fluid, Species
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.method.mpcd.start.section import Start
from mesokit.run.simulation import Simulation

TRIMERS = Molecule(length=3, bond=Harmonic(K=2.0))
ALL = ("position", "velocity", "image")
EVERYONE = np.arange(79)  # in the mixed run


@pytest.fixture(autouse=True)
def no_figures(monkeypatch):
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])


def watched(case, folder):
    """A run that remembers what it was like at each frame."""
    seen = {}

    def look(simulation):
        fluid = simulation.engine
        seen[simulation.step] = (
            fluid.positions(), fluid.velocities(), fluid.images(), fluid.bond_vectors(),
        )  # fmt: skip

    callbacks = [every(case.trajectory.every, look)] if case.trajectory else []
    simulation = Simulation(case, output=folder, threads=1, callbacks=callbacks)
    simulation.seen = seen
    return simulation


def run_of(folder, size=(6, 6, 6), steps=40, walls=(), fields=ALL, subset=None, **parts):
    """A run that has ended, in the folder."""
    box = {key: parts.pop(key) for key in ("shear_rate",) if key in parts}
    parts = {"molecule": TRIMERS, "thermostat": MaxwellBoltzmann()} | parts
    case = Case(
        run=Run(steps=steps, seed=5),
        box=Box(size, **box),
        fluid=Fluid(density=9, **parts),
        walls=walls,
        trajectory=Trajectory(every=10, fields=fields, subset=subset),
    )
    simulation = watched(case, folder)
    simulation.run()
    return simulation


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A run of trimers in a box whose lengths differ."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        folder = tmp_path_factory.mktemp("runs") / "run"
        return run_of(folder, (6, 5, 7))


def read(path):
    with gsd.hoomd.open(str(path)) as file:
        return list(file)


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


@pytest.fixture(scope="module")
def mixed(tmp_path_factory):
    """A run of a fluid with polymers and a monomer."""
    solutes = Solutes((Polymer(2, length=3), Polymer()), mass=5.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(density=2), solutes=solutes,
        trajectory=Trajectory(every=10, fields=ALL),
    )  # fmt: skip
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        folder = tmp_path_factory.mktemp("runs") / "mixed"
        simulation = Simulation(case, output=folder, threads=1)
        simulation.run()
    return simulation


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


def test_a_universe_has_all_that_the_run_has(mixed):
    universe = mesokit.open(mixed.directory.path).universe()
    assert [universe.trajectory.n_frames, *(now.time for now in universe.trajectory)] == [
        3,
        0,
        1,
        2,
    ]
    assert universe.dimensions.tolist() == [6, 6, 1, 90, 90, 90]
    assert universe.residues.resnames.tolist() == ["fluid", "polymer-1", "polymer-1", "polymer-2"]
    assert [len(residue.atoms) for residue in universe.residues] == [72, 3, 3, 1]
    beads = universe.select_atoms("name polymer-1")
    assert beads.masses.tolist() == [5.0] * 6 and beads.radii.tolist() == [0.25] * 6
    assert universe.bonds.to_indices().tolist() == [[72, 73], [73, 74], [75, 76], [76, 77]]
    universe.trajectory[-1]
    np.testing.assert_allclose(
        universe.atoms.positions[:, :2], mixed.engine.positions(EVERYONE), atol=1e-5
    )
    found = universe.atoms.velocities[:, :2]
    np.testing.assert_allclose(found, mixed.engine.velocities(EVERYONE), atol=1e-5)


@pytest.mark.parametrize("warmup, every, steps", [(7, 3, 9), (5, 4, 8), (11, 20, 15)])
def test_times_of_a_dcd(warmup, every, steps, tmp_path):
    """Also where frames do not begin at a multiple of the steps between them, and of one alone."""
    import MDAnalysis

    case = Case(
        run=Run(steps, warmup=warmup),
        box=Box([6, 6]),
        fluid=Fluid(density=2, timestep=0.3),
        trajectory=Trajectory(every=every),
    )
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run()
    files = mesokit.open(tmp_path / "run")
    wanted = [0.3 * step for step in range(warmup, warmup + steps + 1, every)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        top, path = (str(files.export(tmp_path / f"a.{end}")) for end in ("gsd", "dcd"))
        times = [float(now.time) for now in MDAnalysis.Universe(top, path).trajectory]
    assert times == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("ending", ["h5md", "dcd", "xtc", "trr", "data"])
def test_files_of_mdanalysis(ending, mixed, tmp_path):
    """Read again by themselves, or beside a GSD file that says what the particles are."""
    import MDAnalysis

    files = mesokit.open(mixed.directory.path)
    path = str(files.export(tmp_path / f"run.{ending}"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if ending in ("h5md", "data"):
            unit = {"convert_units": False} if ending == "data" else {}  # LAMMPS has fs
            universe = MDAnalysis.Universe(path, **unit)
        else:
            top = str(files.export(tmp_path / "run.gsd"))
            universe = MDAnalysis.Universe(top, path)
        times = [float(now.time) for now in universe.trajectory]
        universe.trajectory[-1]
    assert times == ([0.0] if ending == "data" else pytest.approx([0.0, 1.0, 2.0]))
    near = 0.0051 if ending == "xtc" else 1e-5
    found = universe.atoms.positions[:, :2]
    np.testing.assert_allclose(found, mixed.engine.positions(EVERYONE), atol=near)
    assert universe.dimensions.tolist() == [6, 6, 1, 90, 90, 90]
    if ending == "data":
        assert universe.bonds.to_indices().tolist() == [[72, 73], [73, 74], [75, 76], [76, 77]]
        assert universe.atoms.masses.tolist() == [1.0] * 72 + [5.0] * 7
    if ending in ("h5md", "trr", "data"):
        found = universe.atoms.velocities[:, :2]
        np.testing.assert_allclose(found, mixed.engine.velocities(EVERYONE), atol=1e-5)


def test_a_data_file_is_as_lammps_reads_it(mixed, tmp_path):
    """Numbers as they stand in the file: velocities of the last frame, molecules from 1."""
    path = mesokit.open(mixed.directory.path).export(tmp_path / "run.data")
    sections = re.split(r"\n+([A-Z][a-z]+)\n+", path.read_text())
    rows = {
        name: np.array([line.split() for line in text.splitlines()], float)
        for name, text in zip(sections[1::2], sections[2::2], strict=True)
    }
    assert rows["Atoms"][:, 1].tolist() == [0] * 72 + [1] * 3 + [2] * 3 + [0]
    speeds = rows["Velocities"][:, 1:]
    np.testing.assert_allclose(speeds[:, :2], mixed.engine.velocities(EVERYONE), atol=1e-5)
    assert (speeds[:, 2] == 0).all()


def among_molecules(folder, start=None):
    """Two chains and a bead in a fluid of dimers: 48 particles and 7 beads."""
    solutes = Solutes(
        (Polymer(2, length=3, name="chain"), Polymer()), mass=5.0, bond=Harmonic(K=2.0),
        start=Start(run=start),
    )  # fmt: skip
    dimers = Molecule(bond=Harmonic(K=2.0), propagation="exact")
    case = Case(
        run=Run(steps=20, seed=2),
        box=Box([4, 4, 3]),
        fluid=Fluid(density=1, molecule=dimers, thermostat=MaxwellBoltzmann(),
                    start=Start(run=start)),
        solutes=solutes,
        observe=[
            mesokit.MoleculeSize(kind=kind, name=f"size-{kind}", every=5)
            for kind in ("fluid", "chain")
        ] + [mesokit.BondLength(kind="fluid"), mesokit.Conservation(),
             mesokit.RadialDistribution(kinds=("fluid", "chain"), every=5)],
        trajectory=Trajectory(every=10, fields=ALL),
    )  # fmt: skip
    return Simulation(case, output=folder, threads=1)


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        simulation = among_molecules(tmp_path_factory.mktemp("runs") / "among")
        simulation.run()
    return simulation


class TestSolutesAmongMolecules:
    """Both have their bonds, names and masses in all that is written, and go on with their bits."""

    def test_files_for_others(self, ended, tmp_path):
        import MDAnalysis

        everyone, files = np.arange(55), mesokit.open(ended.directory.path)
        bonds = ended.engine.bonds()
        assert bonds[:24].tolist() == [[2 * k, 2 * k + 1] for k in range(24)]
        assert bonds[24:].tolist() == [[48, 49], [49, 50], [51, 52], [52, 53]]
        frame = read(files.export(tmp_path / "a.gsd"))[-1]
        assert frame.particles.types == ["fluid", "chain", "polymer-2"]
        assert frame.particles.typeid.tolist() == [0] * 48 + [1] * 6 + [2]
        assert frame.particles.mass.tolist() == [1.0] * 48 + [5.0] * 7
        np.testing.assert_array_equal(frame.bonds.group, bonds)
        bodies = -2 - frame.particles.body
        assert bodies.tolist() == [*np.repeat(np.arange(26), [2] * 24 + [3, 3]), -1]
        size = np.array([4, 4, 3])
        whole = frame.particles.position + frame.particles.image * size
        way = whole[bonds[:, 1]] - whole[bonds[:, 0]]
        np.testing.assert_allclose(way, ended.engine.bond_vectors(), atol=1e-5)
        paths = [str(files.export(tmp_path / f"a.{ending}")) for ending in ("data", "h5md")]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = [MDAnalysis.Universe(path) for path in paths] + [files.universe()]
            for universe in found:
                universe.trajectory[-1]
                places = universe.atoms.positions
                np.testing.assert_allclose(places, ended.engine.positions(everyone), atol=1e-5)
        for universe in (found[0], found[2]):
            np.testing.assert_array_equal(universe.bonds.to_indices(), bonds)
        assert [len(f) for f in found[2].select_atoms("name chain").fragments] == [3, 3]
        with h5py.File(ended.directory.data_file) as file:
            np.testing.assert_array_equal(file["connectivity/bonds"], bonds)

    def test_both_are_measured(self, ended):
        fluid, chain = (ended[f"size-{kind}"].comparisons for kind in ("fluid", "chain"))
        # sub-steps add less than 0.3 %
        assert [c.expected for c in fluid] == pytest.approx([0.75 / 4, 0.75], rel=3e-3)
        assert [c.expected for c in chain] == pytest.approx([1.5 * 8 / 36, 1.5], rel=3e-3)
        assert all(c.measured > 0 for c in (*fluid, *chain))
        square = (ended.engine.bond_vectors()[:24] ** 2).sum(axis=1)
        assert 0.3 < ended["bond-length"].comparisons[0].measured / square.mean() < 3
        assert (
            ended.engine.totals()[0] == 55
            and ended.engine.potential_energy() > 2 * square.sum() > 0
        )

    def test_a_run_that_is_resumed_has_the_same_bits(self, ended, tmp_path):
        simulation = among_molecules(tmp_path / "run")
        simulation.run(5)
        simulation.checkpoint()
        again = Simulation.resume(tmp_path / "run", threads=2)
        assert again.step == 5
        again.run()
        state, wanted = again.engine.state(), ended.engine.state()
        for name in ("positions", "velocities", "images", "solute_r", "solute_v"):
            np.testing.assert_array_equal(state[name], wanted[name])

    def test_a_run_that_starts_where_it_ended(self, ended, tmp_path):
        other = among_molecules(tmp_path / "run", start=str(ended.directory.path))
        for read_of in ("bond_vectors", "potential_energy", "velocities"):
            found, wanted = (getattr(one.engine, read_of)() for one in (other, ended))
            np.testing.assert_allclose(found, wanted, atol=1e-12)
        np.testing.assert_array_equal(other.engine.solutes.places, ended.engine.solutes.places)


def recipe(word):
    """The block of the guide that has the word."""
    guide = Path(__file__).parents[2] / "docs" / "guide"
    page = (guide / "keep-trajectories.md").read_text("utf-8")
    blocks = re.findall(r"^```text\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    (found,) = [block for block in blocks if word in block]
    return found


@pytest.fixture
def melt(mixed, tmp_path, monkeypatch):
    """A working directory with the run that the guide speaks of."""
    shutil.copytree(mixed.directory.path, tmp_path / "melt")
    monkeypatch.chdir(tmp_path)
    mesokit.open("melt").export("melt.gsd")


@pytest.fixture
def folded(mixed, melt):
    """The run of the guide, moved until the first chain lies over the edge; where beads are."""
    whole = mixed.engine.positions(EVERYONE, unwrapped=True)
    aside = whole[72:74].mean(axis=0)  # the middle of a bond becomes the corner
    with h5py.File("melt/run.h5", "r+") as file:
        particles = h5md.particles_of(file)
        place, image = particles["position/value"], particles["image/value"]
        moved = place[..., :2] - aside
        place[..., :2] = moved % 6
        image[..., :2] += np.floor(moved / 6).astype(int)
        ends = place[-1, 72:74, :2]
    assert np.ptp(ends, axis=0).max() > 3
    return whole - aside


def gyration(beads):
    """The root of the mean squared distance from the middle."""
    return np.sqrt(((beads - beads.mean(axis=0)) ** 2).sum(axis=1).mean())


def test_the_recipe_for_mdanalysis(folded, capsys):
    """Chains over the edge have their true size."""
    exec(recipe(".universe()"), {"mesokit": mesokit})
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert [float(time) for time, _ in rows] == [0.0, 1.0, 2.0]
    size = np.mean([gyration(folded[72:75]), gyration(folded[75:78])])
    assert float(rows[-1][1]) == pytest.approx(size, rel=1e-5)


def test_the_recipe_with_images(folded):
    space = {"mesokit": mesokit}
    exec(recipe("unfolded ="), space)
    np.testing.assert_allclose(space["unfolded"][-1], folded, atol=1e-5)


def test_the_recipe_for_freud(melt):
    pytest.importorskip("freud")
    space = {}
    exec(recipe("freud"), space)
    assert space["rdf"].rdf.max() > 0


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


def test_solutes_come_after_the_fluid(tmp_path):
    """Kinds and masses are the same from the segments of a run as from its data file."""
    solutes = Solutes(polymers=(Polymer(), Polymer(2, 3)), mass=7.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(), solutes=solutes,
        trajectory=Trajectory(every=10),
    )  # fmt: skip
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run(10)
    simulation.checkpoint()
    files, seen = mesokit.open(tmp_path / "run"), []
    seen.append(read(files.export(tmp_path / "a.gsd"))[0])
    simulation.run()
    seen.append(read(mesokit.open(tmp_path / "run").export(tmp_path / "a.gsd"))[0])
    for frame in seen:
        assert (
            frame.particles.types == ["fluid", "polymer-1", "polymer-2"]
            and frame.particles.N == 367
        )
        assert frame.particles.typeid[360:].tolist() == [1, 2, 2, 2, 2, 2, 2]
        assert frame.particles.mass[359:].tolist() == [1, 7, 7, 7, 7, 7, 7, 7]
        assert frame.bonds.group.tolist() == [
            [361, 362],
            [362, 363],
            [364, 365],
            [365, 366],
        ]


@pytest.mark.parametrize("of", ["fluid", "solutes"])
def test_the_fluid_or_the_solutes_alone(of, tmp_path):
    """Kinds, masses and bonds of either, while the run goes on and after it."""
    solutes = Solutes((Polymer(3), Polymer(2, length=3)), mass=5.0, bond=Harmonic(K=2.0))
    case = Case(
        run=Run(steps=20), box=Box([6, 6]), fluid=Fluid(density=2), solutes=solutes,
        trajectory=Trajectory(every=10, of=of, fields=("position", "image")),
    )  # fmt: skip
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run(10)
    simulation.checkpoint()
    files = mesokit.open(tmp_path / "run")
    early = read(files.export(tmp_path / "early.gsd"))
    simulation.run()
    late = read(mesokit.open(tmp_path / "run").export(tmp_path / "late.gsd"))
    ids = {"fluid": range(72), "solutes": range(72, 81)}[of]
    kinds = np.repeat([0, 1, 2], [72, 3, 6])[ids]
    links = {"fluid": [],
             "solutes": [[3, 4], [4, 5], [6, 7], [7, 8]]}[of]  # fmt: skip
    assert (len(early), len(late)) == (2, 3)
    for frame in (*early, *late):
        frame.validate()
        assert frame.particles.typeid.tolist() == kinds.tolist()
        assert frame.particles.mass.tolist() == np.array([1.0, 5.0, 5.0])[kinds].tolist()
        assert (frame.bonds.group.tolist() if frame.bonds.N else []) == links
    np.testing.assert_array_equal(early[0].particles.position, late[0].particles.position)
    where = simulation.engine.positions(np.array(ids), unwrapped=True)
    last = late[-1].particles
    found = last.position[:, :2] + 3.0 + 6 * last.image[:, :2]
    np.testing.assert_allclose(found, where, atol=1e-5)


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
