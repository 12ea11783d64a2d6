"""Solids from files: arrays, pictures and meshes, and how true they are to what was drawn."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from PIL import Image

from mesokit import CaseError, Mesh, Picture, Plates, Sampled, Solids
from tests.helpers.shapes import solids_of

CENTRE = np.array([6.1, 4.9])


def drawn(radius, pixels=8, fine=1, centre=CENTRE, size=(12, 10)):
    """A black disk on white, with so many pixels a cell; smooth where fine > 1."""
    shape = [n * pixels for n in size]
    x, y = (
        (np.arange(n * fine) + 0.5) / (pixels * fine) - c
        for n, c in zip(shape, centre, strict=True)
    )
    off = [c - n * np.round(c / n) for c, n in zip(np.meshgrid(x, y), size, strict=True)]
    white = (np.hypot(*off) > radius).astype(float)
    grey = white.reshape(shape[1], fine, shape[0], fine).mean(axis=(1, 3))
    return np.round(255 * grey[::-1]).astype(np.uint8)


def radii(solids, centre, d=2):
    """Distances of the surface from a place, in all directions of the first two axes."""
    angle = np.linspace(0, 2 * np.pi, 500, endpoint=False)
    u = np.zeros((len(angle), d))
    u[:, 0], u[:, 1] = np.cos(angle), np.sin(angle)
    low, high = np.full(len(u), 0.5), np.full(len(u), 4.0)
    for _ in range(50):
        middle = 0.5 * (low + high)
        inside = solids.distance(centre + middle[:, None] * u) < 0
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return low


@pytest.mark.parametrize("radius", [1.0, 2.0, 3.3])
@pytest.mark.parametrize("fine", [1, 8], ids=["staircase", "smooth"])
@pytest.mark.parametrize("centre", [CENTRE, (0.0, 9.9)], ids=["middle", "edge"])
def test_a_drawn_disk_has_its_radius(radius, fine, centre, tmp_path):
    Image.fromarray(drawn(radius, fine=fine, centre=centre)).save(tmp_path / "a.png")
    solids = solids_of((Picture(str(tmp_path / "a.png")),), 2)
    found = radii(solids, np.array(centre))
    assert abs(found.mean() - radius) < 0.02
    assert np.ptp(found) < (0.1 if fine == 1 else 0.02)  # steps of 0.125 are smoothed
    exact = np.pi * radius**2
    assert abs(120 - solids.free_volume - exact) < 0.02 * 2 * np.pi * radius


def test_the_top_of_a_picture_is_the_top_of_the_box(tmp_path):
    picture = np.full((100, 120), 255, np.uint8)
    picture[:30, :40] = 0
    Image.fromarray(picture).save(tmp_path / "a.png")
    solids = solids_of((Picture(str(tmp_path / "a.png")),), 2)
    assert solids.distance([[2.0, 8.5]]) < 0 < solids.distance([[2.0, 1.5]]).item()
    assert solids.distance([[10.0, 8.5]]) > 0


def test_colours_and_transparency(tmp_path):
    """All these pictures show the same disk."""
    grey = drawn(2.0, fine=8)
    clear = np.zeros((*grey.shape, 4), np.uint8)
    clear[..., 3] = 255 - grey  # black, but transparent where the fluid is
    pictures = {
        "grey": Image.fromarray(grey),
        "colour": Image.fromarray(np.stack([grey] * 3, axis=-1)),
        "alpha": Image.fromarray(clear),
        "sixteen": Image.fromarray(257 * grey.astype(np.uint16)),
        "palette": Image.fromarray(grey).convert("P"),
    }
    r = np.random.default_rng(1).random((500, 2)) * (12, 10)
    found = []
    for name, picture in pictures.items():
        picture.save(tmp_path / f"{name}.png")
        found.append(solids_of((Picture(str(tmp_path / f"{name}.png")),), 2).distance(r))
    for distance in found[1:]:
        np.testing.assert_allclose(distance, found[0], atol=2e-3)
    bits = Image.fromarray(grey).convert("1", dither=Image.Dither.NONE)
    bits.save(tmp_path / "bits.png")
    assert (
        abs(radii(solids_of((Picture(str(tmp_path / "bits.png")),), 2), CENTRE).mean() - 2) < 0.02
    )


def test_a_picture_may_be_put_anywhere(tmp_path):
    """A post that fills its picture, which is white around it."""
    Image.fromarray(np.zeros((32, 48), np.uint8)).save(tmp_path / "a.png")
    wall = Picture(str(tmp_path / "a.png"), origin=(10, 2), size=(6, 4))
    solids = solids_of((wall,), 2)
    got = solids.distance([[3.5, 4.0], [5.0, 4.0], [9.5, 4.0], [1.0, 6.5], [1.0, 4.0]])
    np.testing.assert_allclose(got[:4], [-0.5, 1.0, 0.5, 0.5], atol=0.1)
    assert got[4] < -0.9
    assert abs(120 - solids.free_volume - 24) < 0.2


def test_a_picture_between_plates_is_not_repeated(tmp_path):
    picture = np.full((100, 120), 255, np.uint8)
    picture[-20:] = 0
    Image.fromarray(picture).save(tmp_path / "a.png")
    solids = solids_of((Plates("y"), Picture(str(tmp_path / "a.png"))), 2)
    np.testing.assert_allclose(
        solids.distance([[3, 2.5], [3, 9.9], [3, 9.99]]), [0.5, 0.1, 0.01], atol=0.01
    )
    assert solids.distance([[3.0, 1e-3]]) < 0
    assert abs(solids.free_volume - 96) < 0.1


@pytest.mark.parametrize("kind", ["stl", "obj", "ply"])
def test_a_mesh_of_a_cylinder_has_its_radius(kind, tmp_path):
    mesh = trimesh.creation.cylinder(radius=200, height=1400, sections=256)
    mesh.export(tmp_path / f"a.{kind}")
    wall = Mesh(str(tmp_path / f"a.{kind}"), position=(6, 5, 4.5), scale=0.01)
    solids = solids_of((wall,), 3)
    for z in (0.1, 4.4):
        found = radii(solids, np.array([6, 5, z]), 3)
        assert np.abs(found - 2).max() < 0.02
    assert abs(1080 - solids.free_volume - 9 * 4 * np.pi) < 0.02 * 9 * 4 * np.pi
    section = solids_of((Mesh(wall.file, position=(6, 5), scale=0.01, height=3.0),), 2)
    assert np.abs(radii(section, np.array([6, 5])) - 2).max() < 0.02


def test_a_mesh_may_have_caves(tmp_path):
    """A sphere in a sphere: fluid between them and the solid shell is not, and in the middle is."""
    outer = trimesh.creation.icosphere(subdivisions=3, radius=3)
    inner = trimesh.creation.icosphere(subdivisions=3, radius=1.5)
    inner.invert()
    trimesh.util.concatenate([outer, inner]).export(tmp_path / "a.stl")
    for side, sign in (("outside", 1), ("inside", -1)):
        wall = Mesh(str(tmp_path / "a.stl"), position=(6, 5, 4.5), fluid=side)
        solids = solids_of((wall,), 3)
        r = np.array([[6, 5, 4.5], [6, 5, 6.7], [6, 5, 8.5]])
        assert (np.sign(solids.distance(r)) == sign * np.array([1, -1, 1])).all()


@pytest.mark.parametrize("turned", ["outwards", "inwards"])
def test_bodies_of_a_mesh_may_overlap(turned, tmp_path):
    """What is in any of them is solid, and what is far inside of it is deep inside."""
    one, two, three = (trimesh.creation.icosphere(subdivisions=3, radius=2) for _ in range(3))
    two.apply_translation((1.5, 0, 0))
    three.apply_translation((-4.5, 0, 0))
    both = trimesh.util.concatenate([one, two, three])
    if turned == "inwards":
        both.invert()
    both.export(tmp_path / "a.stl")
    for d in (2, 3):
        middle = np.array((6.5, 5, 4.5)[:d])
        solids = solids_of((Mesh(str(tmp_path / "a.stl"), position=tuple(middle)),), d)
        at = middle + np.outer([-6.75, -2.25, -1.95, 0, 0.75, 1.5, 3.45, 3.6], np.eye(d)[0])
        assert (np.sign(solids.distance(at)) == [1, 1, -1, -1, -1, -1, -1, 1]).all()
        assert (solids.distance(at[3:6]) < -0.9).all()


def test_a_body_in_a_cave_of_a_mesh(tmp_path):
    """The file lists the smallest first; its name for the cave is that it is inside out."""
    core, cave, shell = (
        trimesh.creation.icosphere(subdivisions=3, radius=r) for r in (0.8, 2.0, 3.0)
    )
    r = np.array([[6, 5, 4.5], [6, 5, 5.9], [6, 5, 7.0], [6, 5, 8.5]])
    for inside_out, expected in ((True, [-1, 1, -1, 1]), (False, [-1, -1, -1, 1])):
        if inside_out:
            cave.invert()
        trimesh.util.concatenate([core, cave, shell]).export(tmp_path / f"{inside_out}.stl")
        wall = Mesh(str(tmp_path / f"{inside_out}.stl"), position=(6, 5, 4.5))
        assert (np.sign(solids_of((wall,), 3).distance(r)) == expected).all()
        cave.invert()


def test_triangles_that_are_turned_change_nothing(tmp_path):
    """Each closed surface is the way round that most of its triangles are; the volume is known."""
    shell, cave = (trimesh.creation.icosphere(subdivisions=2, radius=r) for r in (3.0, 1.4))
    plate = trimesh.creation.box((1.0, 7.0, 0.6))
    plate.apply_translation((-4.5, 0, 0))
    cave.invert()
    whole = trimesh.util.concatenate([shell, cave, plate])
    turned = whole.copy()
    some = np.random.default_rng(3).choice(len(whole.faces), 60, replace=False)
    faces = turned.faces.copy()
    faces[some] = faces[some, ::-1]
    turned.faces = faces
    walls = []
    for name, mesh in (("whole", whole), ("turned", turned)):
        mesh.export(tmp_path / f"{name}.stl")
        walls.append(Mesh(str(tmp_path / f"{name}.stl"), position=(6, 5, 4.5), spacing=0.5))
    good, bad = ([(part.hollow, part.size) for part in wall.closed] for wall in walls)
    assert [hollow for hollow, _ in bad] == [hollow for hollow, _ in good] == [False, True, False]
    np.testing.assert_allclose([x for _, x in bad], [x for _, x in good], rtol=1e-6)
    one, other = (solids_of((wall,), 3) for wall in walls)
    assert one.free_volume == pytest.approx(other.free_volume, rel=1e-9)
    places = np.random.default_rng(1).random((300, 3)) * (12, 10, 9)
    np.testing.assert_allclose(one.distance(places), other.distance(places), atol=1e-6)


@pytest.mark.parametrize("turned", [0, 3])
def test_samples_that_miss_a_plate_are_told(turned, tmp_path):
    plate = trimesh.creation.box((6.0, 5.0, 0.6))
    faces = plate.faces.copy()
    faces[:turned] = faces[:turned, ::-1]
    plate.faces = faces
    plate.export(tmp_path / "a.stl")
    wall = Mesh(str(tmp_path / "a.stl"), position=(6, 5, 4.5), spacing=0.5)
    solids = solids_of((wall,), 3)
    (note,) = wall.notes(solids.room, wall.distances(solids.room).values)
    assert note.startswith("spacing = 0.5: the sampled solid has") and "the mesh 18;" in note


@pytest.mark.parametrize("more", [0, 1], ids=["without its image", "with its image"])
@pytest.mark.parametrize("sign", [1, -1], ids=["post", "vessel"])
def test_arrays_may_end_with_the_image_of_the_first_samples(more, sign, tmp_path):
    x, y = np.meshgrid(np.arange(48 + more) / 4, np.arange(40 + more) / 4, indexing="ij")
    file = tmp_path / "a.npy"
    wall = Sampled.from_array(sign * (np.hypot(x - 6, y - 5) - 2), file, spacing=0.25)
    solids = solids_of((wall,), 2)
    assert len(solids.bodies[0].pieces) == 1  # no images
    assert max(solids.misfit(axis) for axis in (0, 1)) < 1e-6
    assert solids.distance([[6, 5]]) * sign < 0
    assert solids.distance([[11.99, 5], [6, 9.99]]).min() * sign > 0


def test_arrays_in_one_line(tmp_path):
    x, y = np.meshgrid(np.arange(24) / 2, np.arange(20) / 2, indexing="ij")
    wall = Sampled.from_array(np.hypot(x - 6, y - 5) - 2, tmp_path / "post.npy", spacing=0.5)
    solids = solids_of((wall,), 2)
    assert abs(radii(solids, np.array([6, 5])).mean() - 2) < 0.03


def test_arrays_that_span_the_box_repeat(tmp_path):
    x, y = np.meshgrid(np.arange(48) / 4, np.arange(40) / 4, indexing="ij")
    away = [np.minimum(c, n - c) for c, n in ((x, 12), (y, 10))]
    file = tmp_path / "corner.npy"
    wall = Sampled.from_array(np.hypot(*away) - 2, file, spacing=0.25)
    solids = solids_of((wall,), 2)
    assert abs(radii(solids, np.array([0.0, 0.0])).mean() - 2) < 0.02
    assert max(solids.misfit(axis) for axis in (0, 1)) < 1e-6
    assert len(solids.bodies[0].pieces) == 1  # no images


def test_a_file_that_changes_makes_another_solid(make_case, tmp_path):
    from mesokit.geometry.solids.solids import solids_of as kept

    file = str(tmp_path / "a.png")
    Image.fromarray(drawn(2.0)).save(file)
    before = make_case((12, 10), walls=(Picture(file),))
    Image.fromarray(drawn(3.0)).save(file)
    after = make_case((12, 10), walls=(Picture(file),))
    assert abs(kept(before).free_volume - (120 - np.pi * 4)) < 0.3
    assert abs(kept(after).free_volume - (120 - np.pi * 9)) < 0.3
    assert isinstance(kept(before), Solids)


def test_a_picture_starts_no_program(tmp_path, monkeypatch):
    """Pillow hands PostScript to Ghostscript, whatever the name of the file."""
    program, started = tmp_path / "gs", tmp_path / "started"
    program.write_text(f"#!/bin/sh\ntouch {started}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    monkeypatch.setattr("PIL.EpsImagePlugin.gs_binary", None)
    drawing = "%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n%%EndComments\nshowpage\n%%EOF\n"
    (tmp_path / "a.png").write_text(drawing)
    with pytest.raises(CaseError, match="expected a picture"):
        solids_of((Picture(str(tmp_path / "a.png")),), 2)
    assert not started.exists()
