"""Sites of a lattice in files for other programs: extended XYZ, VTK ImageData and images."""

from __future__ import annotations

import base64
import re
import warnings
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import mesokit
from mesokit import CaseError, Simulation, Trajectory
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.report.flow.palette import colours
from tests.helpers.lattices import lattice_case
from tests.helpers.refusals import has_words, refused

pytestmark = pytest.mark.usefixtures("no_figures")
KEPT = Trajectory(every=2, fields=("site",))
SIZE = (6, 4)


def run_of(folder, model, kind="square", size=SIZE, steps=4, **lattice):
    """Files of a run that has ended."""
    case = lattice_case(size, model, kind, steps=steps, trajectory=KEPT, **lattice)
    Simulation(case, output=folder, threads=1).run()
    return mesokit.open(folder)


@pytest.fixture(scope="module")
def spins(tmp_path_factory):
    """Spins on a triangular lattice that ends along x."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        folder = tmp_path_factory.mktemp("runs")
        yield {
            kind: run_of(folder / kind, Ising(kT=3.0), kind, ends=("x",))
            for kind in ("square", "triangular")
        }


@pytest.fixture(scope="module")
def surface(tmp_path_factory):
    """A surface that grows."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        yield run_of(tmp_path_factory.mktemp("runs") / "grown", Family())


def frames_of(path: Path):
    """Heads and columns by name of all frames of an extended XYZ file."""
    lines, found = path.read_text().splitlines(), []
    while lines:
        count, head = int(lines[0]), lines[1]
        rows = [line.split() for line in lines[2 : 2 + count]]
        declared = re.search(r"Properties=(\S+)", head)[1].split(":")
        columns, at = {}, 0
        for name, kind, width in zip(*(declared[k::3] for k in range(3)), strict=True):
            read = {"S": str, "R": float, "I": int}[kind]
            columns[name] = np.array([[read(x) for x in row[at : at + int(width)]] for row in rows])
            at += int(width)
        found.append((head, columns))
        del lines[: 2 + count]
    return found


def test_xyz_has_places_and_states(spins, tmp_path):
    files = spins["triangular"]
    path = files.export(tmp_path / "run.xyz")
    read, kept = frames_of(path), list(files.trajectory)
    assert len(read) == len(kept) == 3
    places, root = KINDS["triangular"].places(SIZE), 0.75**0.5
    for (head, columns), frame in zip(read, kept, strict=True):
        assert f'Lattice="6 0 0 0 {4 * root:.9g} 0 0 0 1"' in head and 'pbc="F T F"' in head
        assert f"Time={frame['time']:g} Step={frame['step']}" in head
        np.testing.assert_allclose(columns["pos"], np.pad(places, ((0, 0), (0, 1))), atol=1e-8)
        np.testing.assert_array_equal(columns["state"][:, 0], frame["site"])
        assert columns["species"][:, 0].tolist() == [("down", "up")[s] for s in frame["site"]]
        np.testing.assert_array_equal(columns["id"][:, 0], np.arange(24) + 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import MDAnalysis

        universe = MDAnalysis.Universe(str(path))
        assert universe.trajectory.n_frames == 3
        np.testing.assert_allclose(universe.atoms.positions[:, :2], places, atol=1e-6)


def test_sites_in_some_states_alone(spins, tmp_path):
    files = spins["square"]
    read = frames_of(files.export(tmp_path / "up.xyz", states=["up"]))
    for (_, columns), frame in zip(read, files.trajectory, strict=True):
        there = np.flatnonzero(frame["site"])
        np.testing.assert_array_equal(columns["id"][:, 0], there + 1)
        np.testing.assert_array_equal(columns["pos"][:, :2], np.stack(np.divmod(there, 4), axis=1))
    assert 0 < len(read[-1][1]["id"]) < 24


def test_heights_are_a_coordinate(surface, tmp_path):
    read = frames_of(surface.export(tmp_path / "grown.xyz"))
    for (_, columns), frame in zip(read, surface.trajectory, strict=True):
        np.testing.assert_array_equal(columns["height"][:, 0], frame["site"])
        np.testing.assert_array_equal(columns["pos"][:, 2], frame["site"])
    assert columns["height"].mean() > 2


def cells_of(path: Path):
    """Attributes of the image in a file, its time, and the numbers of its cells."""
    root = ElementTree.parse(path).getroot()
    (image,) = root
    types = {"Int32": "<i4", "Float64": "<f8"}
    arrays = {}
    for array in root.iter("DataArray"):
        raw = base64.b64decode(array.text)
        assert np.frombuffer(raw[:8], "<u8")[0] == len(raw) - 8
        arrays[array.get("Name")] = np.frombuffer(raw[8:], types[array.get("type")])
    return image.attrib, arrays


def test_vti_has_a_cell_for_each_site(spins, tmp_path):
    files = spins["square"]
    series = files.export(tmp_path / "run.vti")
    assert series == tmp_path / "run.pvd"
    listed = [
        (float(one.get("timestep")), one.get("file"))
        for one in ElementTree.parse(series).getroot().iter("DataSet")
    ]
    assert listed == [(2.0 * k, f"run-0000{k}.vti") for k in range(3)]
    for (time, name), frame in zip(listed, files.trajectory, strict=True):
        image, arrays = cells_of(tmp_path / name)
        assert image["WholeExtent"] == "0 6 0 4 0 0" and image["Spacing"] == "1 1 1"
        assert image["Origin"] == "-0.5 -0.5 0"
        assert arrays["TimeValue"].tolist() == [time]
        x_first = np.reshape(frame["site"], SIZE).T.ravel()
        np.testing.assert_array_equal(arrays["state"], x_first)


def test_vtk_reads_the_same(spins, tmp_path):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    files = spins["square"]
    files.export(tmp_path / "run.vti")
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(tmp_path / "run-00002.vti"))
    reader.Update()
    image = reader.GetOutput()
    states = vtk_to_numpy(image.GetCellData().GetArray("state"))
    assert image.GetBounds() == (-0.5, 5.5, -0.5, 3.5, 0, 0)
    np.testing.assert_array_equal(
        states.reshape(SIZE[::-1]).T.ravel(), files.trajectory[-1]["site"]
    )


def test_images_have_a_block_of_pixels_for_each_site(spins, surface, tmp_path):
    files = spins["square"]
    assert files.export(tmp_path / "run.png", pixels=3) == tmp_path / "run-00000.png"
    image = Image.open(tmp_path / "run-00002.png")
    numbers, states = np.asarray(image), np.reshape(files.trajectory[-1]["site"], SIZE)
    assert numbers.shape == (12, 18)
    np.testing.assert_array_equal(numbers[::-3, ::3].T, states)  # y upwards
    np.testing.assert_array_equal(numbers[1::3, 1::3], numbers[::3, ::3])
    wanted = 255 * colours(2)(states.T[::-1])[..., :3]
    np.testing.assert_allclose(np.asarray(image.convert("RGB"))[::3, ::3], wanted, atol=1)
    surface.export(tmp_path / "grown.png")
    heights = surface.trajectory.read("site")
    shades = [np.asarray(Image.open(tmp_path / f"grown-0000{k}.png")) for k in range(3)]
    np.testing.assert_array_equal(shades[-1][::-1].T.ravel(), heights[-1] - heights.min())


def test_frames_up_to_a_checkpoint(tmp_path):
    case = lattice_case(SIZE, Ising(), steps=8, trajectory=KEPT)
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    simulation.run(5)
    read = frames_of(mesokit.open(tmp_path / "run").export(tmp_path / "run.xyz"))
    assert [re.search(r"Step=(\d+)", head)[1] for head, _ in read] == ["0", "2", "4"]
    assert {len(columns["id"]) for _, columns in read} == {24}


def test_exports_that_make_no_sense_are_refused(spins, surface, tmp_path, capsys):
    square, triangular = (spins[kind].path for kind in ("square", "triangular"))
    for run, given, words in [
        (square, ("a.gsd",), ("ending '.gsd'", "'.xyz'", "'.vti'", "'.png'")),
        (square, ("a.xyz", "--states", "left"), ("states = ['left']", "'down' or 'up'")),
        (surface.path, ("a.xyz", "--states", "up"), ("states = ['up']", "heights")),
        (square, ("a.vti", "--states", "up"), ("states", "'.xyz'")),
        (square, ("a.xyz", "--pixels", "2"), ("pixels = 2", ".png")),
        (square, ("a.png", "--pixels", "99"), ("pixels = 99", "64")),
        (triangular, ("a.vti",), ("shifted", "'.xyz'")),
        (triangular, ("a.png",), ("shifted", "'sites'")),
    ]:
        has_words(refused(capsys, "export", run, "--to", tmp_path / given[0], *given[1:]), words)
    assert not list(tmp_path.iterdir())
    with pytest.raises(mesokit.RunError, match="no particles; export writes them"):
        mesokit.open(square).universe()


def test_states_are_those_of_a_lattice(whole, tmp_path):
    with pytest.raises(CaseError, match="only of sites of a lattice"):
        mesokit.open(whole.directory.path).export(tmp_path / "a.xyz", states=["up"])
