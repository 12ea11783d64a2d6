"""Files that a case names: of another kind, or larger than they seem, they are refused unread."""

import io
import os
import sys
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest

from mesokit.case.given.array_file import array_in_file, array_of_contents
from mesokit.cli import main

FLUID = "[run]\nsteps = 4\n[box]\nsize = [9, 8]\n"
BIRDS = '[run]\nsteps = 4\nmethod = "flock"\n[box]\nsize = [9, 8]\n[flock]\nnumber = 90\n'
FREE = '[run]\nsteps = 4\nmethod = "brownian"\n[box]\nsize = [9, 8]\n'
SPHERES = FREE.replace("brownian", "soft-spheres") + "[spheres]\nnumber = 9\n"
KEYS = {
    "array of a fluid": (FLUID, "fluid.start.positions"),
    "file of a fluid": (FLUID, "fluid.start.file"),
    "array of birds": (BIRDS, "flock.start.positions"),
    "array of particles": (FREE, "brownian.positions"),
    "file of spheres": (SPHERES, "spheres.start"),
    "table": (SPHERES, "spheres.pair"),
    "solid": (FLUID, "wall"),
}
TEXTS = {
    "spheres.start": '[spheres.start]\nrule = "file"\nfile = "{}"\n',
    "spheres.pair": '[spheres.pair]\nrule = "table"\nfile = "{}"\n',
    "wall": '[[wall]]\nshape = "mesh"\nfile = "{}"\n',
}


def refused(capsys, name, file):
    """The line with which a case that names a file is refused."""
    case, key = KEYS[name]
    if key in TEXTS:
        text, arguments = case + TEXTS[key].format(file), []
    else:
        text, arguments = case, ["--set", f"{key}={file}"]
    Path("case.toml").write_text(text)
    with pytest.raises(SystemExit) as end, warnings.catch_warnings():
        warnings.simplefilter("error")
        main(["check", "case.toml", *arguments])
    said = capsys.readouterr().err
    assert end.value.code == 2 and said.count("\n") == 1
    assert said.startswith("mesokit: error: case.toml: ")
    return said


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="has no pipes in folders")
@pytest.mark.parametrize("name", KEYS)
@pytest.mark.parametrize("kind", ["pipe", "device", "loop"])
def test_other_kinds_of_files(kind, name, capsys):
    if kind == "pipe":
        os.mkfifo("a.npy")
    elif kind == "loop":
        os.symlink("b.npy", "a.npy")
        os.symlink("a.npy", "b.npy")
    said = refused(capsys, name, "/dev/zero" if kind == "device" else "a.npy")
    assert ("a loop of links" if kind == "loop" else "a pipe or device") in said


ARRAYS = [name for name in KEYS if name.startswith("array")]


def packed(array, name="positions"):
    """A small file of a large array."""
    with (
        zipfile.ZipFile("a.npz", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open(f"{name}.npy", "w") as member,
    ):
        np.lib.format.write_array(member, array)


@pytest.mark.parametrize("name", ARRAYS)
def test_the_shape_is_looked_at_first(name, capsys, monkeypatch):
    packed(np.zeros((10**7, 2), np.int8))
    monkeypatch.setattr("numpy.lib.format.read_array", lambda *given, **more: 1 / 0)
    assert "shape (10000000, 2): expected" in refused(capsys, name, "a.npz")


@pytest.mark.parametrize("name", ARRAYS)
def test_objects_and_headers_that_lie(name, capsys):
    np.savez("a.npz", positions=np.array([[None, 1]] * 3, object))
    assert "not of object" in refused(capsys, name, "a.npz")
    with open("b.npy", "wb") as file:
        header = {"descr": "<f8", "fortran_order": False, "shape": (2**40, 2**40)}
        np.lib.format.write_array_header_1_0(file, header)
    assert "expected" in refused(capsys, name, "b.npy")


def test_contents_have_as_many_numbers_as_they_say():
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        stream, {"descr": "<f8", "fortran_order": False, "shape": (2**40, 2**40)}
    )
    with pytest.raises(ValueError, match="not as many numbers"):
        array_of_contents(stream.getvalue())


def test_arrays_are_read_as_they_are():
    rows = np.random.default_rng(1).random((5, 2))
    np.save("a.npy", rows)
    np.savez("b.npz", other=rows[:1], velocities=rows)
    packed(rows, "whatever")
    for file in ("a.npy", "b.npz", "a.npz"):
        np.testing.assert_array_equal(array_in_file(file, "velocities", (5, 2)), rows)
