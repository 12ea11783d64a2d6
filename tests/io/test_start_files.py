"""Starts from files of other programs: the same particles, or one line that says what is wrong."""

from __future__ import annotations

import dataclasses
import sys
import warnings
from pathlib import Path

import gsd.hoomd
import numpy as np
import pytest

from mesokit import Box, Case, Harmonic, Plates, Run
from mesokit.cli import main
from mesokit.errors import CaseError
from mesokit.method.brownian.method import first_state as walkers_at
from mesokit.method.brownian.section import Brownian
from mesokit.method.flock.section import Flock, FlockStart
from mesokit.method.flock.start import first_state as birds_at
from mesokit.method.mpcd.fluid import Species
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.first_state import first_state
from mesokit.method.mpcd.start.section import Start
from tests.helpers.small_fluids import make_case, make_fluid

BOND = Harmonic(K=3.0)
MOLECULES = {
    "dimers": Molecule(bond=BOND),
    "chains": Molecule(length=5, bond=BOND),
    "rings": Molecule(topology="ring", length=5, bond=BOND),
    "stars": Molecule(topology="star", length=7, arms=3, bond=BOND),
    "stars of two arms": Molecule(topology="star", length=5, arms=2, bond=BOND),
    "stars of one arm": Molecule(topology="star", length=3, arms=1, bond=BOND),
}
SIZE = (7, 6, 5)


def write_gsd(path, r, box, bonds=(), v=None, image=None, mass=None):
    """As HOOMD-blue writes it: the middle of the box is the origin."""
    frame, d = gsd.hoomd.Frame(), r.shape[1]
    deep = [0.0] * (3 - d)
    frame.configuration.box = [*box, *deep, 0, 0, 0]
    frame.configuration.dimensions = d
    frame.particles.N = len(r)
    frame.particles.position = np.pad(r - 0.5 * np.array(box), ((0, 0), (0, 3 - d)))
    if v is not None:
        frame.particles.velocity = np.pad(v, ((0, 0), (0, 3 - d)))
    if image is not None:
        frame.particles.image = np.pad(image, ((0, 0), (0, 3 - d)))
    frame.particles.mass = mass
    frame.bonds.N, frame.bonds.group = len(bonds), np.reshape(bonds, (-1, 2))
    with gsd.hoomd.open(str(path), "w") as file:
        file.append(frame)
    return path


def write_data(path, r, box, bonds=(), v=None, low=(-3.0, 2.0, 0.5), numbers=None, image=None):
    """A LAMMPS data file, as `write_data` of LAMMPS makes it."""
    n = len(r)
    numbers = np.arange(1, n + 1) if numbers is None else numbers
    lines = ["LAMMPS data file", "", f"{n} atoms", f"{len(bonds)} bonds", "1 atom types", ""]
    for axis, start, length in zip("xyz", low, box, strict=True):
        lines.append(f"{start} {start + length} {axis}lo {axis}hi")
    lines += ["", "Masses", "", "1 1", "", "Atoms # bond", ""]
    images = np.zeros((n, 3), int) if image is None else image
    for i, place, boxes in zip(numbers, r + np.array(low), images, strict=True):
        lines.append(" ".join(map(str, [i, 1, 1, *place.tolist(), *boxes.tolist()])))
    if v is not None:
        lines += ["", "Velocities", ""]
        lines += [" ".join(map(str, [i, *w.tolist()])) for i, w in zip(numbers, v, strict=True)]
    lines += ["", "Bonds", ""]
    lines += [f"{k + 1} 1 {numbers[a]} {numbers[b]}" for k, (a, b) in enumerate(bonds)]
    path.write_text("\n".join(lines) + "\n")
    return path


def started(path, size=SIZE, **parts):
    """Positions and velocities that a case takes from a file."""
    return first_state(make_case(size, start=Start(file=str(path)), **parts))[:2]


def melt(molecule, size=SIZE):
    """A fluid of molecules that has moved a little."""
    fluid = make_fluid(size, density=10, molecule=molecule)
    fluid.advance(5)
    return fluid


def around(r, bonds, size):
    """Bond vectors between nearest images."""
    way = r[bonds[:, 1]] - r[bonds[:, 0]]
    return way - np.rint(way / size) * size


@pytest.mark.parametrize("images", [True, False])
@pytest.mark.parametrize("size", [SIZE, (14, 15)])
@pytest.mark.parametrize("molecule", MOLECULES.values(), ids=MOLECULES.keys())
def test_gsd_keeps_order_velocities_and_bonds(molecule, size, images, tmp_path):
    fluid = melt(molecule, size)
    r, v, bonds = fluid.positions(), fluid.velocities(), fluid.bonds()
    image = fluid.images() if images else None
    path = write_gsd(tmp_path / "melt.gsd", r, size, bonds, v, image)
    places, speeds = started(path, size, density=10, molecule=molecule)
    assert np.abs((places - r + 0.1) % size - 0.1).max() < 1e-5
    np.testing.assert_allclose(speeds, v, atol=1e-6)
    other = make_fluid(size, places, speeds, density=10, molecule=molecule)
    short = np.abs(fluid.bond_vectors()).max(axis=1) < 0.5 * min(size)
    assert short.all()
    np.testing.assert_allclose(other.bond_vectors(), fluid.bond_vectors(), atol=1e-5)


@pytest.mark.parametrize("molecule", MOLECULES.values(), ids=MOLECULES.keys())
@pytest.mark.parametrize("ending", [".gsd", ".data"])
def test_beads_in_any_order_are_put_in_order(molecule, ending, tmp_path):
    """Every molecule of the file is one of the case: its beads, its velocities, its bonds."""
    fluid, rng = melt(molecule), np.random.default_rng(3)
    order = rng.permutation(fluid.n)
    r, v = fluid.positions()[order], np.outer(np.arange(fluid.n), [1.0, 0.5, 0.0])
    bonds = rng.permutation(np.argsort(order)[fluid.bonds()])
    bonds[::2] = bonds[::2, ::-1]
    if ending == ".gsd":
        path = write_gsd(tmp_path / "melt.gsd", r, SIZE, bonds, v)
    else:
        numbers = 3 * rng.permutation(fluid.n) + 5
        path = write_data(tmp_path / "melt.data", r, SIZE, bonds, v, numbers=numbers)
    places, speeds = started(path, density=10, molecule=molecule)
    row = np.rint(speeds[:, 0]).astype(int)  # of the file, that each particle was
    assert np.abs((places - r[row] + 0.1) % SIZE - 0.1).max() < 1e-5
    linked = {frozenset(pair) for pair in bonds.tolist()}
    assert {frozenset(pair) for pair in row[fluid.bonds()].tolist()} == linked


def test_what_mdanalysis_writes_is_read(tmp_path):
    """Single precision, its own heading, no images."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import MDAnalysis

        molecule = MOLECULES["chains"]
        fluid = melt(molecule)
        universe = MDAnalysis.Universe.empty(fluid.n, trajectory=True)
        universe.atoms.positions = fluid.positions()
        universe.dimensions = [*SIZE, 90, 90, 90]
        universe.add_TopologyAttr("type", ["1"] * fluid.n)
        universe.add_TopologyAttr("mass", np.ones(fluid.n))
        universe.add_TopologyAttr("resid", [1])
        universe.add_TopologyAttr("charge", np.zeros(fluid.n))
        pairs = [tuple(pair) for pair in fluid.bonds().tolist()]
        universe.add_TopologyAttr(MDAnalysis.core.topologyattrs.Bonds(pairs, ["1"] * len(pairs)))
        for name in ("angles", "dihedrals", "impropers"):
            universe.add_TopologyAttr(name, [])
        universe.atoms.write(str(tmp_path / "melt.data"))
    places, speeds = started(tmp_path / "melt.data", density=10, molecule=molecule)
    assert speeds is None
    np.testing.assert_allclose(places % SIZE, fluid.positions(), atol=1e-4)


def test_images_tell_which_way_a_bond_goes(tmp_path):
    """Half a box and more by the places alone; the images say that it is short."""
    molecule, r = MOLECULES["dimers"], np.tile([[0.5, 3, 3], [6.5, 3, 3]], (105, 1))
    bonds, image = np.arange(210).reshape(-1, 2), np.zeros((210, 3), int)
    image[1::2, 0] = -1
    path = write_data(tmp_path / "melt.data", r, SIZE, bonds, image=image)
    places, _ = started(path, density=1, molecule=molecule)
    np.testing.assert_allclose(places[1::2] - places[::2], [[-1, 0, 0]] * 105)


def test_single_particles_and_kinds(tmp_path):
    """Kinds are found by their mass, wherever they are in the file."""
    rng = np.random.default_rng(1)
    kinds = (Species(mass=4.0, density=1.0), Species(mass=1.0, density=3.0))
    mass = rng.permutation(np.repeat([4.0, 1.0], [210, 630]))
    r = rng.random((840, 3)) * SIZE
    path = write_gsd(tmp_path / "a.gsd", r, SIZE, mass=mass)
    places, speeds = started(path, species=kinds)
    assert speeds is None
    np.testing.assert_allclose(places[:210], r[mass == 4.0], atol=1e-5)
    np.testing.assert_allclose(places[210:], r[mass == 1.0], atol=1e-5)
    with pytest.raises(CaseError, match=r"mass 4; expected 1 as in this case"):
        started(path, density=4)


def test_a_slit_is_not_periodic(tmp_path):
    """Between plates no bond leads through them, and nobody is in a wall."""
    molecule, walls = MOLECULES["dimers"], [Plates(axis="y")]
    fluid = make_fluid(SIZE, density=10, molecule=molecule, walls=walls)
    r = fluid.positions()
    path = write_gsd(tmp_path / "slit.gsd", r, SIZE, fluid.bonds())
    places, _ = started(path, density=10, molecule=molecule, walls=walls)
    np.testing.assert_allclose(places[:, 1], r[:, 1], atol=1e-5)
    r[6:8] = [[1, 5.8, 1], [1, 6.5, 1]]
    write_gsd(path, r, SIZE, fluid.bonds())
    with pytest.raises(CaseError, match=r"slit.gsd': positions: row 7 .* lies in a wall"):
        started(path, density=10, molecule=molecule, walls=walls)


CASE = """
[run]
steps = 10
[box]
size = [7, 6, 5]
[fluid]
density = 1
molecule = { length = 5, bond = { rule = "harmonic", K = 3 } }
start = { file = "melt.gsd" }
"""


def chains(lengths, ring=False):
    """Bonds of chains of these lengths, one after the other."""
    starts = np.cumsum([0, *lengths[:-1]])
    return [
        (s + k, s + (k + 1) % n)
        for s, n in zip(starts.tolist(), lengths, strict=True)
        for k in range(n if ring else n - 1)
    ]


FIVES = chains([5] * 42)
BAD = {
    "unequal chains": ({"bonds": chains([4, 6] + [5] * 40)}, "molecules of 4, 5, 6 particles; exp"),
    "other length": ({"bonds": chains([7] * 30)}, "molecules of 7 particles; expected 5 in each"),
    "rings": ({"bonds": chains([5] * 42, ring=True)}, "bonds differ from those of the case"),
    "stars": ({"bonds": [(k - k % 5, k) for k in range(210) if k % 5]}, "to be a chain of 5"),
    "a branch": ({"bonds": [b if b != (3, 4) else (2, 4) for b in FIVES]}, "to be a chain of 5"),
    "no bonds": ({"bonds": []}, "it has no bonds"),
    "a stranger": ({"bonds": [*FIVES[:-1], (208, 210)]}, "links particle 210, of 210"),
    "a long bond": ({"far": True}, "the bond of particles 3 and 4 is 4.003 long, more than half"),
    "a longer bond": ({"image": True}, "the bond of particles 1 and 2 is 7.201 long, more than"),
    "another number": ({"n": 205}, "it has 205 particles, this case 210 (fluid.density = 1); flui"),
    "a broken number": ({"n": 207}, "it has 207 particles, this case 210 (fluid.density = 1)"),
    "another box": ({"box": (7, 6, 5.5)}, "it has a box of [7, 6, 5.5], this case [7, 6, 5]"),
    "heavy beads": ({"mass": 2.5}, "particle 0 has mass 2.5; expected 1 as in this case"),
    "not finite": ({"nan": True}, "positions: row 2 is not finite"),
}


def write_bad(path, bonds=FIVES, n=210, box=SIZE, far=False, image=False, mass=None, nan=False):
    r = np.arange(n)[:, None] // 5 * 0.1 + np.arange(n)[:, None] % 5 * [[0.2, 0.1, 0.1]]
    r, images = r % box, np.zeros((n, 3), int)
    r[3:5] = [[1, 1, 1], [3.83, 3.83, 1.05]] if far else r[3:5]
    r[2] = np.nan if nan else r[2]
    images[2:5, 0] = int(image)
    mass = None if mass is None else np.full(n, mass)
    bonds = [b for b in bonds if max(b) < n] if n < 210 else bonds
    return write_gsd(path, r, box, bonds, image=images, mass=mass)


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_one_line_and_nothing_is_lost(
    name, command, tmp_path, capsys, monkeypatch
) -> None:
    monkeypatch.chdir(tmp_path)
    given, words = BAD[name]
    write_bad(tmp_path / "melt.gsd", **given)
    before = Path("melt.gsd").read_bytes()
    assert words in refused(capsys, command)
    assert Path("melt.gsd").read_bytes() == before


def refused(capsys, command="check", *options):
    """The line that a command ends with, which names file and key; no file is made or lost."""
    Path("case.toml").write_text(CASE)
    Path("case").mkdir(exist_ok=True)  # an earlier run, which must outlive the refusal
    Path("case/case.toml").write_text(CASE)
    before = sorted(Path().rglob("*"))
    overwrite = ["--overwrite"] if command == "run" else []
    with pytest.raises(SystemExit) as end:
        main([command, "case.toml", *overwrite, *options])
    said = capsys.readouterr().err
    said = said.removeprefix(said[: said.index("mesokit: error")])
    assert end.value.code == 2 and said.count("\n") == 1
    assert "case.toml: fluid.start.file = " in said
    assert sorted(Path().rglob("*")) == before
    return said


def test_the_good_file_is_good(tmp_path):
    write_bad(tmp_path / "melt.gsd")
    places, _ = started(tmp_path / "melt.gsd", density=1, molecule=MOLECULES["chains"])
    assert places.shape == (210, 3)
    with pytest.raises(CaseError, match=r"it has 168 bonds, this case no fluid\.molecule"):
        started(tmp_path / "melt.gsd", density=1)


@pytest.mark.parametrize(
    ("name", "contents", "words"),
    [
        ("melt.gsd", b"half a file", "cannot be read as a GSD file"),
        ("melt.data", b"\xff", "cannot be read as a LAMMPS"),
        ("melt.data", b"", "no section Atoms"),
        ("melt.data", b"Atoms\n\n1 atoms\n\nAtoms\n\n1 1 1 0 0 0\n", "no line of 'xlo xhi'"),
        (
            "melt.data",
            b"title\n\n1 atoms\n\nAtoms # ellipsoid\n\n1 1 1 1 0 0 0\n",
            "'ellipsoid': expected",
        ),
        ("melt.data", b"title\n\n2 atoms\n\nAtoms # bond\n\n1 1 1 0 0 0\n", "it has 1 lines of"),
        ("melt.data", b"title\n\n2 atoms\n\nAtoms\n\n1 1 1 0 0 0\n2 1 1 0 0\n", "is damaged"),
        ("melt.xyz", b"", "ending '.xyz': expected '.gsd'"),
    ],
)
def test_damaged_files_are_one_line(name, contents, words, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path(name).write_bytes(contents)
    assert words in refused(capsys, "check", "--set", f"fluid.start.file={name}")


def test_a_missing_package_is_named(tmp_path, monkeypatch):
    (tmp_path / "a.gsd").write_text("")
    monkeypatch.setitem(sys.modules, "gsd.hoomd", None)
    with pytest.raises(CaseError, match=r"need the package gsd: pip install 'mesokit\[files\]'"):
        started(tmp_path / "a.gsd")


def test_lengths_of_a_file_are_scaled(tmp_path):
    size = (16, 14, 12)
    r, v = np.random.default_rng(2).random((2, 90, 3)) * np.array(size) / 4
    path = write_data(tmp_path / "a.data", r, np.array(size) / 4, v=v)
    density = 90 / np.prod(size)
    case = make_case(size, start=Start(file=str(path), scale=4.0), density=density)
    places, speeds = first_state(case)[:2]
    np.testing.assert_allclose(places, 4 * r, atol=1e-12)
    np.testing.assert_allclose(speeds, 4 * v, atol=1e-12)
    with pytest.raises(CaseError, match=r"scale = 4: only with file, positions or velocities"):
        Start(run="a", scale=4.0)


@pytest.mark.parametrize("kind", ["npy", "npz", "whole numbers"])
def test_lengths_of_arrays_are_scaled(tmp_path, kind):
    """As those of a file of another program: places and velocities alike."""
    size, scale = (12, 10), 2.5
    r, v = np.random.default_rng(5).random((2, 60, 2)) * np.array(size) / scale
    r, v = (r, v) if kind != "whole numbers" else (np.floor(r).astype(int), np.floor(v).astype(int))
    paths = [tmp_path / f"{name}.{'npz' if kind == 'npz' else 'npy'}" for name in "rv"]
    for path, array in zip(paths, (r, v), strict=True):
        np.savez(path, a=array) if kind == "npz" else np.save(path, array)
    places, speeds = map(str, paths)
    mpcd = make_case(size, density=0.5, start=Start(positions=places, velocities=speeds, scale=2.5))
    np.testing.assert_allclose(first_state(mpcd)[:2], scale * np.stack([r, v]), atol=1e-12)
    birds = FlockStart(positions=places, scale=2.5)
    flock = Case(
        run=Run(steps=1, method="flock"), box=Box(size), flock=Flock(number=60, start=birds)
    )
    walkers = Brownian(density=0.5, positions=places, scale=2.5)
    brownian = Case(run=Run(steps=1, method="brownian"), box=Box(size), brownian=walkers)
    np.testing.assert_allclose(birds_at(flock, {}).positions, scale * r, atol=1e-12)
    np.testing.assert_allclose(walkers_at(brownian, {}), scale * r, atol=1e-12)


def test_scales_of_nothing_are_refused():
    for made in (Start, FlockStart, Brownian):
        with pytest.raises(CaseError, match=r"scale = 2: only with "):
            made(scale=2.0)


def test_two_states_are_refused():
    for other in ({"run": "a"}, {"positions": "r.npy"}):
        with pytest.raises(CaseError, match=r"fluid.start.file = .*: not with (run|positions)"):
            make_case(start=Start(file="a.gsd", **other))
    case = make_case(start=Start(file="a.gsd"))
    with pytest.raises(CaseError, match="not with an array of positions"):
        first_state(case, positions=np.zeros((640, 2)))


def test_the_file_is_found_from_the_folder_of_the_case(tmp_path):
    from mesokit.case.case import Case

    (tmp_path / "case.toml").write_text(CASE)
    case = Case.from_toml(tmp_path / "case.toml")
    assert case.fluid.start.file == str((tmp_path / "melt.gsd").resolve())
    assert case.missing_files()
    assert dataclasses.replace(case, title="a").fluid.start == case.fluid.start
