"""Wrong walls: each is refused by `check` with one line that names the key."""

from __future__ import annotations

import sys
import zlib
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from mesokit import Array, Box, Case, CaseError, Disk, Fluid, Run
from mesokit.cli import main
from mesokit.geometry.solids import survey
from tests.helpers.refusals import has_words, refused

PLANE = "[run]\nsteps = 1\n[box]\nsize = [12, 10]\n"
SPACE = "[run]\nsteps = 1\n[box]\nsize = [12, 10, 8]\n"
DISK = 'shape = "disk"\ncentre = [6, 5]\nradius = 2\n'
BALL = 'shape = "sphere"\ncentre = [6, 5, 4]\nradius = 2\n'
BOX = 'shape = "rectangle"\ncentre = [6, 5]\nsize = [4, 3]\n'
OVAL = 'shape = "ellipse"\ncentre = [6, 5]\nsize = [4, 3]\n'
GRAIN = 'shape = "spheroid"\ncentre = [6, 5, 4]\nradius = 2\nhalf_length = 3\naxis = [0, 0, 1]\n'
FLOOR = 'shape = "half-space"\npoint = [0, 3]\nnormal = [0, 1]\n'
WAVES = 'shape = "cosine-channel"\nwidth = 4\namplitude = 1\n'
BALL_FILE = 'shape = "mesh"\nfile = "ball.ply"\nposition = [6, 5, 4]\n'
ONE = '{ shape = "disk", centre = [2, 2], radius = 1 }'
ARRAY = f'shape = "array"\nrepeat = [2, 2]\nof = {ONE}'
HEAVY = "[fluid]\nspecies = [{ mass = 1, density = 5 }, { mass = 5, density = 5 }]\n"

# name: (the case without its walls, its walls, what the message must say)
BAD: dict[str, tuple[str, list[str], tuple[str, ...]]] = {
    # shapes and their numbers
    "a disk in 3D": (SPACE, [DISK], ("wall[#1].shape = 'disk'", "not in 3D", "'sphere'")),
    "a sphere in 2D": (PLANE, [BALL], ("wall[#1].shape = 'sphere'", "not in 2D", "'disk'")),
    "a picture in 3D": (SPACE, ['shape = "picture"\nfile = "disk.png"'], ("not in 3D",)),
    "unknown shape": (PLANE, [DISK.replace("disk", "disc")], ("'disc'", "did you mean 'disk'?")),
    "no shape": (PLANE, ["radius = 2"], ("wall[#1].shape: missing", "'disk'")),
    "negative radius": (PLANE, [DISK.replace("= 2", "= -2")], ("wall[#1].radius = -2", "above 0")),
    "no radius": (PLANE, [DISK.replace("radius = 2", "")], ("wall[#1].radius: missing",)),
    "unknown key": (PLANE, [DISK + "radus = 4"], ("wall[#1].radus: unknown key", "'radius'")),
    "surface of plates": (
        PLANE, ['shape = "plates"\naxis = "y"\nsurface = { rule = "slip" }'],
        ("wall[#1].surface: unknown key of shape 'plates'; did you mean 'lower' or 'upper'?",),
    ),
    "plate of a disk": (
        PLANE, [DISK + 'lower = { rule = "slip" }'],
        ("wall[#1].lower: unknown key of shape 'disk'; did you mean 'surface'?",),
    ),
    "radius of plates": (
        PLANE, ['shape = "plates"\naxis = "y"\nradius = 2'],
        ("unknown key of shape 'plates'; valid here: ", ", axis, lower, upper"),
    ),
    "long centre": (PLANE, [DISK.replace("6, 5", "6, 5, 4")], ("wall[#1].centre", "2 numbers")),
    "short centre": (SPACE, [BALL.replace(", 4]", "]")], ("wall[#1].centre", "3 numbers")),
    "negative side": (PLANE, [BOX.replace("4, 3", "4, -3")], ("wall[#1].size", "positive")),
    "no direction": (PLANE, [FLOOR.replace("0, 1", "0, 0")], ("wall[#1].normal", "direction")),
    "capsule without length": (
        PLANE, ['shape = "capsule"\nstart = [1, 1]\nend = [1, 1]\nradius = 1'],
        ("end = start", "another place"),
    ),
    "an ellipse in 3D": (SPACE, [OVAL], ("not in 3D", "'spheroid'")),
    "an ellipse without width": (PLANE, [OVAL.replace("3]", "0]")], ("wall[#1].size", "positive")),
    "a spheroid without an axis": (
        SPACE, [GRAIN.replace("0, 1", "0, 0")], ("wall[#1].axis", "three numbers, not all zero"),
    ),
    "a spheroid along a plane": (
        SPACE, [GRAIN.replace("0, 1]", "1]")], ("wall[#1].axis", "three numbers, not all zero"),
    ),
    "a spheroid without length": (
        SPACE, [GRAIN.replace("= 3", "= 0")], ("wall[#1].half_length = 0", "above 0"),
    ),
    "a spheroid without a radius": (
        SPACE, [GRAIN.replace("radius = 2", "radius = -2")], ("wall[#1].radius = -2", "above 0"),
    ),
    "closed channel": (PLANE, [WAVES.replace("= 1", "= 2")], ("amplitude", "half the width")),
    "channel along itself": (PLANE, [WAVES + 'across = "x"'], ("across = 'x'", "another axis")),
    "channel across z in 2D": (PLANE, [WAVES + 'across = "z"'], ("wall[#1].across = 'z'", "2D")),
    "no copies": (
        PLANE, [f'shape = "array"\nrepeat = [0, 2]\nof = {{ {DISK.strip()} }}'.replace("\n", ", ")
                .replace('"array", ', '"array"\n').replace("2], ", "2]\n")],
        ("wall[#1].repeat", "at least 1"),
    ),
    "a part with a surface": (
        PLANE,
        ['shape = "union"\nparts = [{ shape = "disk", centre = [5, 5], radius = 1, '
         'surface = { rule = "slip" } }]'],
        ("parts[#1].surface", "of the union"),
    ),
    "an array's part with a surface": (
        PLANE, [ARRAY.replace("radius = 1", 'radius = 1, surface = { rule = "slip" }')],
        ("bad.toml: wall[#1].of.surface: give the surface of the array",),
    ),
    "a part's part with a name": (
        PLANE, [ARRAY.replace(ONE, f'{{ shape = "union", parts = [{ONE}] }}')
                .replace("radius = 1", 'radius = 1, name = "a"')],
        ("bad.toml: wall[#1].of.parts[#1].name: give that of the union",),
    ),
    "unknown shape in an array": (
        PLANE, [ARRAY.replace("disk", "dsk")], ("wall[#1].of.shape = 'dsk'", "did you mean 'disk'?")
    ),
    "an array of arrays": (
        PLANE, [ARRAY.replace('of = { shape = "disk"', 'of = { shape = "array"')],
        ("wall[#1].of.shape = 'array'", "'disk'"),
    ),
    "no shape in an array": (
        PLANE, [ARRAY.replace('shape = "disk", ', "")], ("wall[#1].of.shape: missing", "'disk'"),
    ),
    "an array in a union": (
        PLANE, [f'shape = "union"\nparts = [{ONE}, {{ shape = "array", repeat = [2, 2] }}]'],
        ("wall[#1].parts[#2].shape = 'array'", "'disk'"),
    ),
    "far too many copies": (
        PLANE, [ARRAY.replace("[2, 2]", "[1000000, 1000000]")],
        ("wall[#1].repeat = [1000000, 1000000]", "at most 65536"),
    ),
    "copies on copies": (
        PLANE, [ARRAY.replace("[2, 2]", "[2, 11]")],
        ("wall[#1].repeat = [2, 11]", "less than a cell apart", "[12, 10]"),
    ),
    "unknown side": (PLANE, [DISK + 'fluid = "left"'], ("wall[#1].fluid", "'inside'")),
    "unknown surface": (
        PLANE, [DISK + 'surface = { rule = "sticky" }'], ("wall[#1].surface.rule", "'no-slip'"),
    ),
    # walls and the box
    "a floor that the box repeats": (PLANE, [FLOOR], ("do not fit the periodic box", "along y")),
    "an inclined wall": (
        PLANE, [FLOOR.replace("0, 1", "1, 4")], ("do not fit the periodic box", "along x"),
    ),
    "no room": (PLANE, [BOX.replace("4, 3", "20, 20")], ("the solids leave", "to the fluid")),
    "nothing inside": (
        PLANE, [DISK.replace("= 2", "= 0.1") + 'fluid = "inside"'], ("the solids leave",),
    ),
    "beside the box": (
        PLANE, [DISK.replace("[6, 5]", "[60, 5]")],
        ("wall[#1].centre = [60, 5]: no surface in the box [12, 10]",),
    ),
    "the second beside the box": (
        PLANE, [DISK, DISK.replace("[6, 5]", "[60, 5]")], ("wall[#2].centre = [60, 5]",),
    ),
    "a vessel around the box": (
        PLANE, [DISK.replace("= 2", "= 9") + 'fluid = "inside"'],
        ("wall[#1].radius = 9: no surface in the box", "fluid = 'inside'"),
    ),
    "nothing in common": (
        PLANE, [f'shape = "intersection"\nparts = [{ONE}, {ONE.replace("2, 2", "4.1, 2")}]'],
        ("wall[#1].parts: no surface in the box", "nothing in common"),
    ),
    "a name twice": (
        PLANE, [DISK + 'name = "a"', DISK.replace("6, 5", "2, 5") + 'name = "a"'],
        ("wall[#2].name", "'a' is also the name of wall[#1]"),
    ),
    "a name that the first has by its number": (
        PLANE, [DISK, DISK.replace("6, 5", "2, 5") + 'name = "disk-1"'], ("wall[#2].name",),
    ),
    "plates twice": (
        PLANE, ['shape = "plates"\naxis = "y"', 'shape = "plates"\naxis = "y"'],
        ("wall[#2].axis = 'y'", "wall[#1] closes it"),
    ),
    "two rules of virtual particles": (
        PLANE, [DISK, DISK.replace("6, 5", "2, 5").replace("= 2\n", '= 1\nvirtual = "fill"\n')],
        ("wall[#2].virtual = 'fill'", "one rule"),
    ),
    "top-up of a mixture": (
        PLANE + HEAVY, [DISK + 'virtual = "top-up"'], ("wall[#1].virtual = 'top-up'", "mass"),
    ),
    # surfaces that move
    "a post that drifts": (
        PLANE, [DISK + "surface = { velocity = [0.1, 0] }"], ("wall[#1].surface", "across itself"),
    ),
    "a block that turns": (
        PLANE, [BOX + "surface = { rotation = 0.1 }"], ("wall[#1].surface", "across itself"),
    ),
    "slip that turns": (
        PLANE, [DISK + 'surface = { rule = "slip", rotation = 0.1 }'],
        ("wall[#1].surface.rotation", "drags nothing"),
    ),
    "three rates in 2D": (
        PLANE, [DISK + "surface = { rotation = [0, 0, 1] }"],
        ("wall[#1].surface.rotation", "one number in 2D"),
    ),
    "two rates in 3D": (
        SPACE, [BALL + "surface = { rotation = [0, 1] }"],
        ("wall[#1].surface.rotation", "a number or three"),
    ),
    "no finite rate": (
        PLANE, [DISK + "surface = { rotation = nan }"],
        ("wall[#1].surface.rotation = nan", "a finite number"),
    ),
    "an absurd rate": (
        PLANE, [DISK + "surface = { rotation = 1e300 }"],
        ("wall[#1].surface.rotation = 1e+300", "at most 1e+06"),
    ),
    "long velocity": (
        PLANE, [DISK + "surface = { velocity = [0, 0, 0] }"],
        ("wall[#1].surface.velocity", "2 numbers"),
    ),
    # files
    "no picture": (PLANE, ['shape = "picture"\nfile = "x.png"'],
                   ("wall[#1].file = ", "x.png'", "no such file")),
    "a folder": (PLANE, ['shape = "picture"\nfile = "."'], ("wall[#1].file", "cannot be read")),
    "text for a picture": (PLANE, ['shape = "picture"\nfile = "text.png"'],
                           ("wall[#1].file", "expected a picture")),
    "a program of PostScript for a picture": (
        PLANE, ['shape = "picture"\nfile = "drawing.png"'], ("wall[#1].file", "expected a picture"),
    ),
    "a picture of 4 thousand million pixels": (
        PLANE, ['shape = "picture"\nfile = "huge.png"'], ("wall[#1].file", "at most 16777216"),
    ),
    "a picture of 64 million pixels": (
        PLANE, ['shape = "picture"\nfile = "large.png"'], ("wall[#1].file", "at most 16777216"),
    ),
    "white picture": (PLANE, ['shape = "picture"\nfile = "white.png"'],
                      ("wall[#1].file", "no surface")),
    "picture of other proportions": (
        PLANE, ['shape = "picture"\nfile = "disk.png"\nsize = [4, 6]'],
        ("wall[#1].file", "120 x 100 pixels", "proportions"),
    ),
    "flat picture": (PLANE, ['shape = "picture"\nfile = "disk.png"\nsize = [4, 0]'],
                     ("wall[#1].size", "positive")),
    "no array": (PLANE, ['shape = "sampled"\nfile = "x.npy"\nspacing = 1'],
                 ("wall[#1].file", "no such file")),
    "text for an array": (PLANE, ['shape = "sampled"\nfile = "text.png"\nspacing = 1'],
                          ("wall[#1].file", ".npy file of numbers")),
    "several arrays": (PLANE, ['shape = "sampled"\nfile = "two.npz"\nspacing = 1'],
                       ("wall[#1].file", ".npy file of numbers")),
    "array of another dimension": (SPACE, ['shape = "sampled"\nfile = "post.npy"\nspacing = 0.5'],
                                   ("wall[#1].file", "2D, in a 3D box")),
    "array without a surface": (PLANE, ['shape = "sampled"\nfile = "ones.npy"\nspacing = 1'],
                                ("wall[#1].file", "one sign")),
    "array that is not finite": (PLANE, ['shape = "sampled"\nfile = "nan.npy"\nspacing = 1'],
                                 ("wall[#1].file", "finite")),
    "array in other units": (PLANE, ['shape = "sampled"\nfile = "post.npy"\nspacing = 0.1'],
                             ("wall[#1].file", "gradient", "signed distance")),
    "array that is cut off": (PLANE, ['shape = "sampled"\nfile = "cut.npy"\nspacing = 0.5'],
                              ("wall[#1].file", "reaches the first samples along x")),
    "no spacing": (PLANE, ['shape = "sampled"\nfile = "post.npy"'],
                   ("wall[#1].spacing: missing",)),
    "no mesh": (SPACE, ['shape = "mesh"\nfile = "x.stl"'], ("wall[#1].file", "no such file")),
    "mesh of another format": (SPACE, ['shape = "mesh"\nfile = "text.png"'],
                               ("wall[#1].file", ".stl, .obj or .ply")),
    "text for a mesh": (SPACE, ['shape = "mesh"\nfile = "text.stl"'],
                        ("wall[#1].file", "triangle mesh")),
    "mesh with a hole": (SPACE, ['shape = "mesh"\nfile = "open.stl"\nposition = [6, 5, 4]'],
                         ("wall[#1].file", "not watertight")),
    "section beside the mesh": (PLANE, ['shape = "mesh"\nfile = "ball.ply"\nheight = 9'],
                                ("wall[#1].height = 9", "lies between -2 and 2")),
    "no scale": (SPACE, ['shape = "mesh"\nfile = "ball.ply"\nscale = 0'],
                 ("wall[#1].scale = 0", "above 0")),
    "far too fine": (SPACE, ['shape = "mesh"\nfile = "ball.ply"\nspacing = 0.001'],
                     ("wall[#1].spacing = 0.001", "samples")),
    "far too coarse": (SPACE, [BALL_FILE + "spacing = 3"],
                       ("wall[#1].spacing = 3: too coarse", "ball.ply'", "4 x 4 x 4 cells")),
    "far too small": (SPACE, [BALL_FILE + "scale = 0.001"],
                      ("wall[#1].spacing = 0.25: too coarse", "ball.ply'", "larger scale")),
    "far too small a section": (PLANE, ['shape = "mesh"\nfile = "ball.ply"\nscale = 0.001'],
                                ("wall[#1].spacing = 0.25: too coarse",)),
    "a section in 3D": (SPACE, [BALL_FILE + "height = 1"],
                        ("wall[#1].height = 1: only in 2D",)),
    "ends of an array that differ": (
        PLANE, ['shape = "sampled"\nfile = "ends.npy"\nspacing = 0.5'],
        ("wall[#1].file", "first and the last samples along x", "differ by up to"),
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Files for the walls."""
    path = tmp_path_factory.mktemp("walls")
    x, y = np.meshgrid(np.arange(120) / 10 - 6, np.arange(100) / 10 - 5)
    Image.fromarray(np.where(np.hypot(x, y) > 2, 255, 0).astype(np.uint8)).save(path / "disk.png")
    Image.new("L", (120, 100), 255).save(path / "white.png")
    (path / "drawing.png").write_text(
        "%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n%%EndComments\nshowpage\n%%EOF\n"
    )
    Image.new("1", (8000, 8000)).save(path / "large.png")
    drawn = bytearray((path / "large.png").read_bytes())
    drawn[16:24] = (60_000).to_bytes(4, "big") * 2
    drawn[29:33] = zlib.crc32(drawn[12:29]).to_bytes(4, "big")
    (path / "huge.png").write_bytes(drawn)
    for name in ("text.png", "text.stl"):
        (path / name).write_text("neither picture nor mesh")
    x, y = np.meshgrid(np.arange(-3, 3.1, 0.5), np.arange(-3, 3.1, 0.5), indexing="ij")
    post = np.hypot(x, y) - 2
    np.save(path / "post.npy", post)
    np.save(path / "cut.npy", post[5:])
    np.save(path / "ones.npy", np.ones((5, 5)))
    np.save(path / "nan.npy", np.full((5, 5), np.nan))
    np.savez(path / "two.npz", a=post, b=post)
    x, y = np.meshgrid(np.linspace(0, 12, 25), np.linspace(0, 10, 21), indexing="ij")
    np.save(path / "turned.npy", (np.hypot(x - 9, y - 5) - 2).T)
    np.save(path / "ends.npy", 2 - np.hypot(x - 5, y - 5))
    disk = Image.open(path / "disk.png")
    disk.save(path / "disk.jpg")
    disk.resize((24, 20)).save(path / "few.png")
    disk.point(lambda level: max(level, 100)).save(path / "grey.png")
    Image.fromarray(np.tile(np.linspace(0, 255, 120).astype(np.uint8), (100, 1))).save(
        path / "ramp.png"
    )
    ball = trimesh.creation.icosphere(subdivisions=3, radius=2)
    ball.export(path / "ball.ply")
    ball.update_faces(np.arange(len(ball.faces)) > 3)
    ball.export(path / "open.stl")
    return path


@pytest.mark.parametrize("name", BAD)
def test_bad_walls_are_refused(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    start, walls, expected = BAD[name]
    text = start + "".join(f"[[wall]]\n{wall.strip()}\n" for wall in walls)
    (folder / "bad.toml").write_text(text)
    has_words(refused(capsys, "check", folder / "bad.toml"), ["bad.toml: ", *expected])


GOOD = {
    "disk": (PLANE, DISK),
    "sphere": (SPACE, BALL),
    "waves": (PLANE, WAVES),
    "picture": (PLANE, 'shape = "picture"\nfile = "disk.png"'),
    "array": (PLANE, 'shape = "sampled"\nfile = "post.npy"\nspacing = 0.5\norigin = [2, 2]'),
    "mesh": (SPACE, 'shape = "mesh"\nfile = "ball.ply"\nposition = [6, 5, 4]'),
    "section": (PLANE, 'shape = "mesh"\nfile = "ball.ply"\nposition = [6, 5]\nheight = 1'),
}


# name: (the case without its walls, its walls, what a warning says; none is about a solid if empty)
WARNED: dict[str, tuple[str, list[str], tuple[str, ...]]] = {
    "one behind another": (PLANE, [DISK, DISK.replace("= 2", "= 1")], ()),
    "from end to end": (PLANE, ['shape = "rectangle"\ncentre = [6, 5]\nsize = [4, 10]'], ()),
    "along the box": (PLANE, ['shape = "rectangle"\ncentre = [6, 5]\nsize = [12, 4]'], ()),
    "a step on a plate": (
        PLANE, ['shape = "rectangle"\ncentre = [6, 1.5]\nsize = [4, 3]',
                'shape = "plates"\naxis = "y"'], (),
    ),
    "a gap": (PLANE, [BOX.replace("4, 3", "10, 3")], ("the gap at",)),
    "a thin wall": (PLANE, [BOX.replace("4, 3", "1, 5")], ("cells thick",)),
    "far too fast": (
        PLANE, [DISK + "surface = { rotation = 100 }"],
        ("Mach number", "friction raises the temperature", "run.warmup"),
    ),
    "far too fast, with a force": (
        PLANE + '[fluid]\nforce = { rule = "uniform", acceleration = [0.001, 0] }\n',
        [DISK + "surface = { rotation = 100 }"],
        ("surfaces move at Mach number", "friction raises the temperature"),
    ),
    "far too fast, between plates": (
        PLANE, ['shape = "plates"\naxis = "y"', DISK + "surface = { rotation = 100 }"],
        ("Mach number", "friction raises the temperature", "run.warmup"),
    ),
    "a coarse mesh": (
        SPACE, [BALL_FILE + "spacing = 1"],
        ("wall[#1].spacing = 1: the sampled solid has", "the mesh 33."),
    ),
    "a mesh longer than the box": (
        SPACE, [BALL_FILE + "scale = 2.2"], ("wall[#1].file", "by 0.8 cells along z"),
    ),
    "a fine mesh": (SPACE, [BALL_FILE], ()),
    "a good picture": (PLANE, ['shape = "picture"\nfile = "disk.png"'], ()),
    "few pixels": (
        PLANE, ['shape = "picture"\nfile = "few.png"'], ("wall[#1].file", "2 pixels a cell"),
    ),
    "a grey picture": (
        PLANE, ['shape = "picture"\nfile = "grey.png"'], ("% of what is drawn is neither black",)
    ),
    "a ramp of grey": (
        PLANE, ['shape = "picture"\nfile = "ramp.png"', 'shape = "plates"\naxis = "x"'],
        ("% of what is drawn is neither black",),
    ),
    "a JPEG": (PLANE, ['shape = "picture"\nfile = "disk.jpg"'], ("a JPEG, which blurs edges",)),
    "a picture larger than the box": (
        PLANE, ['shape = "picture"\nfile = "disk.png"\nsize = [18, 15]'],
        ("wall[#1].size = [18, 15]", "by 5 cells along y"),
    ),
    "a turned array": (
        PLANE, ['shape = "sampled"\nfile = "turned.npy"\nspacing = 0.5'],
        ("wall[#1].file", "by 2 cells along y", "the first axis of the array is x"),
    ),
    "an array over the end": (
        PLANE, ['shape = "sampled"\nfile = "post.npy"\nspacing = 0.5\norigin = [9, 8]'], (),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WARNED)
def test_warnings_about_solids(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    start, walls, expected = WARNED[name]
    text = start + "".join(f"[[wall]]\n{wall.strip()}\n" for wall in walls)
    (folder / "warned.toml").write_text(text)
    with pytest.raises(SystemExit) as end:
        main(["check", str(folder / "warned.toml")])
    assert end.value.code == 0
    said = [s for s in capsys.readouterr().out.splitlines() if s.startswith("warning: ")]
    for words in expected:
        assert any(words in warning for warning in said), said
    assert expected or not any("wall" in warning for warning in said), said


@pytest.mark.parametrize("name", GOOD)
def test_good_walls_are_good(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    start, wall = GOOD[name]
    (folder / "good.toml").write_text(f"{start}[[wall]]\n{wall}\n")
    with pytest.raises(SystemExit) as end:
        main(["check", str(folder / "good.toml")])
    assert end.value.code == 0
    assert "particles" in capsys.readouterr().out


def test_without_trimesh_the_error_says_what_to_install(folder: Path, capsys, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    wall = GOOD["mesh"][1].replace("[6, 5, 4]", "[5, 5, 5]")  # not one that was read before
    (folder / "mesh.toml").write_text(f"{SPACE}[[wall]]\n{wall}\n")
    with pytest.raises(SystemExit):
        main(["check", str(folder / "mesh.toml")])
    assert "pip install 'mesokit[mesh]'" in capsys.readouterr().err


@pytest.mark.parametrize("size", [[30_000_000, 60], [2**62, 2**62]])
def test_tables_of_solids_have_a_bound(size):
    """Refused before any memory is asked for."""
    case = {"run": Run(steps=1), "box": Box(size), "fluid": Fluid(density=1e-3)}
    with pytest.raises(CaseError, match=r"box.size = .*at most 134217728 cells among solids"):
        Case(**case, walls=(Disk(centre=(10, 10), radius=3),))


def test_many_copies_are_held_against_few_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    """So many that every copy cannot be held against every cell."""
    near_blocks, held = survey.near_blocks, []

    def counted(kernel, pattern, away, above, blocks):
        held.append(len(above.near) * (above.edge / blocks.edge) ** len(pattern))
        near_blocks(kernel, pattern, away, above, blocks)

    monkeypatch.setattr(survey, "near_blocks", counted)
    posts = Array(of=Disk(centre=(4, 4), radius=2), repeat=(64, 64))
    Case(run=Run(steps=1), box=Box([512, 512]), fluid=Fluid(), walls=(posts,))
    assert 64**2 < sum(held) < 64**2 * 512**2 / 100
