"""Bodies that move are drawn to scale, turned and with their images; in space the nearest first."""

from __future__ import annotations

import math
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest

import mesokit
from mesokit import CaseError, Disk, Plates, RunError, Simulation, Trajectory
from mesokit.geometry import primitive
from mesokit.geometry.region import brick, capsule, ellipsoid
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.protocol import Squirming
from mesokit.method.mpcd.body.rectangle import RectangleBody
from mesokit.method.mpcd.body.union import UnionBody
from mesokit.report.flow import KINDS, animate, body_panel, picture
from mesokit.report.flow.bodies import COLOURS, BodyFrames, outlines
from mesokit.report.flow.body_distance import distance
from mesokit.report.flow.film import _smeared
from mesokit.report.flow.shaded import Balls, shaded
from mesokit.report.flow.shaded_parts import CAP_SHADE, Placed, shaded_parts
from mesokit.report.flow.solids import Section
from mesokit.scalar.pointer import address
from mesokit.seam.method import BodyShape
from tests.helpers.bodies import SHAPES, body
from tests.helpers.known_flows import FRAMES, results_of
from tests.helpers.moving_disks import moving_disks
from tests.helpers.small_fluids import make_case

SIZE, ROOM = (16, 18), (16, 18, 20)
SWIM = Squirming(B1=0.1)
QUARTER = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))  # a quarter of a turn about z
THIRD = (0.5, 0.5, 0.5, 0.5)  # x to y, y to z, z to x


class Frames(SimpleNamespace):
    """A trajectory in memory, read as one in a file is."""

    diameter = None

    def __len__(self):
        return len(self.frames)

    def __getitem__(self, index):
        return self.frames[index]


def frames_of(case, *places, turns=None, kinds=None):
    """Bodies at these places, at one time or more; one of each kind unless said."""
    kinds = np.arange(len(places[0])) if kinds is None else np.asarray(kinds)
    frames = [{"position": np.asarray(r, float)} for r in places]
    if turns is not None:
        frames = [frame | {"orientation": np.asarray(turns, float)} for frame in frames]
    return Frames(
        frames=frames, fields=tuple(frames[0]), time=np.arange(len(places)) * 1.0,
        id=case.particles + np.arange(len(kinds)), species=1 + kinds, mass=np.ones(len(kinds)),
    )  # fmt: skip


def area_of(line):
    """Area within a closed line, positive if that turns to the left."""
    x, y = line.T
    return 0.5 * (x[:-1] * y[1:] - x[1:] * y[:-1]).sum()


# --- distance ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "d"), SHAPES, ids=lambda x: str(x))
def test_distances_are_those_of_compiled_code(name, d):
    parts = body(name, d).solid(d).parts
    places = np.random.default_rng(1).uniform(-5, 5, (200, d))
    places[0] = 0.0
    tables = [(part.code, np.array(part.numbers)) for part in parts]
    expected = [
        min(primitive.distance(code, address(p), 0, tuple(r.tolist())) for code, p in tables)
        for r in places
    ]
    np.testing.assert_allclose(distance(parts, places), expected, atol=1e-9)
    assert min(expected) < 0 < max(expected)


@pytest.mark.parametrize(("along", "across"), [(4.0, 0.5), (0.5, 4.0), (2.0, 2.0)])
def test_flat_and_long_ellipses(along, across):
    (parts,) = ellipsoid((0.5, 0.0), (0.6, 0.8), along, across)
    places = np.array([0.5, 0.0]) + np.outer([along, along + 1, along - 0.01], [0.6, 0.8])
    np.testing.assert_allclose(distance(parts, places), [0, 1, -0.01], atol=1e-9)


# --- outlines ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name, d in SHAPES if d == 2])
def test_outlines_have_the_area_and_the_place_of_the_body(name):
    """Turned by a quarter, and mirrored where the axes of the picture are."""
    case = make_case(SIZE, bodies=[body(name, 2)])
    frames = frames_of(case, [[8, 9]], turns=[QUARTER])
    solid = body(name, 2).solid(2)
    for axes, middle in ((("x", "y"), (8, 9)), (("y", "x"), (9, 8))):
        ((line,),) = BodyFrames(case, frames, axes).at().outlines
        assert abs(area_of(line - middle)) == pytest.approx(solid.volume, rel=2e-3)
        across = line[:, axes.index("x")] - 8, line[:, axes.index("y")] - 9
        own = np.stack([across[1], -across[0]], axis=1)  # turned back
        assert abs(distance(solid.parts, own)).max() < 0.02 * solid.radius


def test_a_hole_of_a_union_stays_open():
    """Four rectangles around nothing."""
    ring = [((0, 2), (5, 1)), ((0, -2), (5, 1)), ((2, 0), (1, 5)), ((-2, 0), (1, 5))]
    parts = tuple(brick(*side)[0][0] for side in ring)
    lines = outlines(BodyShape(parts, 4.0), np.eye(2))
    areas = [area_of(line) for line in lines]
    assert sorted(np.abs(areas).round(1)) == [9, 25] and areas[0] * areas[1] < 0


def test_images_are_drawn_over_the_edges_that_are_open():
    case = make_case(SIZE, bodies=[body("disk", 2)])
    shown = BodyFrames(case, frames_of(case, [[1, 17]]), ("x", "y")).at()
    middles = sorted(tuple(line.mean(axis=0).round(1)) for (line,) in shown.outlines)
    np.testing.assert_allclose(middles, [(1, -1), (1, 17), (17, -1), (17, 17)], atol=0.05)
    case = make_case(SIZE, bodies=[body("disk", 2)], walls=[Plates(axis="y")])
    shown = BodyFrames(case, frames_of(case, [[1, 9]]), ("x", "y")).at()
    assert len(shown.outlines) == 2


def test_traces_are_drawn_on_both_sides_of_an_edge():
    case = make_case(SIZE, bodies=[body("disk", 2)])
    frames = frames_of(case, [[9, 9]], [[15, 9]], [[1, 10]])
    pieces = BodyFrames(case, frames, ("x", "y"), traces=1.0).at().traces
    np.testing.assert_allclose(pieces, [[[-1, 9], [1, 10]], [[15, 9], [17, 10]]])
    assert len(BodyFrames(case, frames, ("x", "y"), traces=5).at().traces) == 3
    assert len(BodyFrames(case, frames, ("x", "y"), traces=5).at(1.0).traces) == 1
    drawn = picture(case, {}, frames, "bodies", traces=50.0)
    said = " ".join(text.get_text() for text in reversed(drawn.texts))
    assert f"their paths of ${frames.time[-1]:g}" in said, said
    lines = picture(case, {}, frames, "bodies", traces=2.0).axes[0].collections
    found = [c for c in lines if isinstance(c, mpl.collections.LineCollection)]
    assert [len(c.get_segments()) for c in found] == [3, 3]  # black over white
    with pytest.raises(CaseError, match=r"^traces = 0: expected a time above 0$"):
        picture(case, {}, frames, "bodies", traces=0)
    with pytest.raises(CaseError, match=r"^traces = 5: the case has no bodies that move"):
        picture(
            make_case(SIZE, observe=[FRAMES]),
            results_of(make_case(SIZE, observe=[FRAMES]), 5),
            None,
            traces=5,
        )


@pytest.mark.parametrize(("slid", "expected"), [(0.9, [-0.1, 15.9]), (15.9, [-1.1, 14.9])])
def test_images_above_have_slid_under_shear(slid, expected):
    """Also by nearly a box, where one more lies over the edge."""
    case = make_case(SIZE, bodies=[body("disk", 2)], shear_rate=slid / 18)
    shown = BodyFrames(case, frames_of(case, [[15, 9]], [[15, 1]]), ("x", "y")).at()
    middles = np.array([line.mean(axis=0) for (line,) in shown.outlines])
    above = np.sort(middles[middles[:, 1] > 10][:, 0])
    np.testing.assert_allclose(above, expected, atol=0.05)


def test_round_bodies_need_no_orientation_and_others_do(tmp_path):
    disks = moving_disks()
    frames = frames_of(disks, [[3, 3], [7, 7], [3, 9]], kinds=[0, 0, 0])
    figure = picture(disks, {}, frames)
    assert len(figure.axes) == 1
    for one in (body("ellipse", 2), body("disk", 2, swim=SWIM)):
        case = make_case(SIZE, bodies=[one])
        needed, more = "this picture needs places and orientations of bodies", "add to the case and"
        with pytest.raises(RunError, match=r'fields = \["position", "orientation"\]$') as error:
            picture(case, {}, frames_of(case, [[8, 9]]), "bodies")
        said = f"bodies: {needed}, and the run kept their places alone; {more}"
        assert str(error.value).startswith(said)
        with pytest.raises(RunError, match=f"^bodies: {needed}, and the run kept none of them"):
            picture(case, {}, None, "bodies")
    case = make_case(SIZE)
    with pytest.raises(CaseError, match=r"^kind = 'bodies': the case has no bodies"):
        picture(case, {}, None, "bodies")


@pytest.mark.parametrize("kind", ["speed", "bodies"])
def test_kinds_without_their_orientation_are_left_out_alone(kind, tmp_path):
    """And the caption says so; of all others both picture and film are as ever."""
    planks = RectangleBody(size=(5, 3), name="planks")
    swimmers = DiskBody(radius=1.5, name="swimmers", swim=SWIM)
    case = make_case(SIZE, observe=[FRAMES], bodies=[planks, DiskBody(radius=2), swimmers])
    results = results_of(make_case(SIZE, observe=[FRAMES]), 5)
    places = [[5, 5], [11, 12], [12, 3]]
    figure = picture(case, results, frames_of(case, places), kind)
    ((path,),) = [drawn.get_paths() for drawn in filled(figure.axes[0])]
    np.testing.assert_allclose(path.vertices.mean(axis=0), (11, 12), atol=0.1)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["disk-1"]
    (handle,) = legend.legend_handles
    assert handle.get_color() == body_panel.FILLS[1]
    said = " ".join(text.get_text() for text in reversed(figure.texts))
    assert "left out: planks, swimmers, whose orientation was not kept" in said
    assert "arrows" not in said
    whole = picture(case, results, frames_of(case, places, turns=[QUARTER] * 3), kind)
    assert len(filled(whole.axes[0])[0].get_paths()) == 3
    assert "left out" not in " ".join(text.get_text() for text in reversed(whole.texts))
    alone = make_case(SIZE, observe=[FRAMES], bodies=[planks])
    if kind == "speed":
        figure = picture(alone, results, frames_of(alone, [[5, 5]]), kind)
        said = " ".join(text.get_text() for text in reversed(figure.texts))
        assert filled(figure.axes[0]) == []
        assert "left out: planks, whose orientation was not kept" in said
    else:
        frames = frames_of(case, places, places)
        assert animate(case, results, frames, tmp_path / "a.gif", kind).frames == 2


# --- over the flow -------------------------------------------------------------------------------


def filled(ax):
    """Collections of outlines that are filled: faces and paths."""
    found = [c for c in ax.collections if type(c) is mpl.collections.PathCollection]
    return [c for c in found if len(c.get_facecolor())]


@pytest.mark.parametrize("kind", ["speed", "quiver", "four", "bodies"])
def test_they_are_drawn_over_every_panel(kind):
    """Each kind in a colour of its own, above the solids; the caption says when."""
    bodies = [body("disk", 2), RectangleBody(size=(5, 3), name="planks")]
    case = make_case(SIZE, observe=[FRAMES], bodies=bodies)
    frames = frames_of(case, [[5, 5], [11, 12]], [[5, 6], [11, 12]], turns=[QUARTER] * 2)
    results = results_of(make_case(SIZE, observe=[FRAMES]), 5)
    figure = picture(case, results, frames, kind)
    for ax in figure.axes[: len(KINDS[kind])]:
        (drawn,) = filled(ax)
        middles = [path.vertices.mean(axis=0) for path in drawn.get_paths()]
        np.testing.assert_allclose(middles, [(5, 6), (11, 12)], atol=0.1)
        assert len({tuple(face) for face in drawn.get_facecolor()}) == 2
        assert drawn.get_zorder() > 5
    said = " ".join(text.get_text() for text in reversed(figure.texts))
    assert r"bodies at $t=1\,\tau$" in said and "swim" not in said
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["disk-1", "planks"]


def test_kinds_differ_in_grey():
    rgb = np.array([mpl.colors.to_rgb(colour) for colour in body_panel.FILLS])
    assert len(rgb) == COLOURS
    grey = np.sort(rgb @ [0.299, 0.587, 0.114])
    assert (np.diff(grey) > 0.13).all()


def test_arrows_point_along_the_axis_of_those_that_swim():
    case = make_case(SIZE, bodies=[body("disk", 2, swim=SWIM), body("ellipse", 2)])
    frames = frames_of(case, [[5, 5], [11, 12]], turns=[QUARTER] * 2)
    shown = BodyFrames(case, frames, ("x", "y")).at()
    ((tail, tip),) = shown.arrows
    np.testing.assert_allclose(tip - tail, (0, 2 * 0.6 * 2), atol=1e-12)
    np.testing.assert_allclose(tip + tail, (10, 10))
    figure = picture(case, {}, frames, "bodies")
    drawn = [c for c in figure.axes[0].collections if isinstance(c, mpl.quiver.Quiver)]
    assert len(drawn) == 1 and drawn[0].N == 1
    said = " ".join(text.get_text() for text in reversed(figure.texts))
    assert "arrows: the way they swim" in said


@pytest.mark.parametrize(
    ("name", "more", "expected"),
    [
        ("disk", {"swim": Squirming(B1=-0.1)}, (-2.4, 0)),
        ("ellipse", {"swim": Squirming(B1=-0.1)}, (-1.2 * body("ellipse", 2).half_axis, 0)),
        ("disk", {"swim": Squirming(B2=0.1)}, None),  # it stirs, and goes nowhere
        ("disk", {"force": (0, -3), "frame": "body"}, (0, -2.4)),
        ("disk", {"force": (0, -3)}, None),  # along the axes of the box
    ],
)
def test_arrows_point_where_bodies_are_headed(name, more, expected):
    """Backwards with a negative mode, and along a force that turns with the body."""
    case = make_case(SIZE, bodies=[body(name, 2, **more)])
    shown = BodyFrames(case, frames_of(case, [[8, 9]], turns=[(1, 0, 0, 0)]), ("x", "y")).at()
    found = [tuple(tip - tail) for tail, tip in shown.arrows]
    assert found == ([] if expected is None else [pytest.approx(expected, abs=1e-12)])


def test_an_arrow_along_a_force_stays_in_the_body():
    """Across an L it is shorter, and not about its centre; both of its ends are in the body."""
    long, short = (
        make_case(SIZE, bodies=[body("union", 2, force=force, frame="body")])
        for force in ((5, 0), (0, 5))
    )
    lengths = []
    for case in (long, short):
        shown = BodyFrames(case, frames_of(case, [[8, 9]], turns=[(1, 0, 0, 0)]), ("x", "y")).at()
        ((tail, tip),) = shown.arrows
        parts = case.bodies[0].solid(2).parts
        assert (distance(parts, np.array([tail, tip]) - (8, 9)) < 0).all()
        lengths.append(np.hypot(*(tip - tail)))
    assert lengths[0] > 2 * lengths[1] > 3


def test_an_arrow_crosses_the_gap_of_two_parts():
    parts = [Disk(centre=(x, 0), radius=2) for x in (-3, 3)]
    case = make_case(SIZE, bodies=[UnionBody(parts=parts, force=(0, 4), frame="body")])
    shown = BodyFrames(case, frames_of(case, [[8, 9]], turns=[(1, 0, 0, 0)]), ("x", "y")).at()
    ((tail, tip),) = shown.arrows
    np.testing.assert_allclose(tip - tail, (0, 2 * 0.6 * 5), atol=1e-12)


@pytest.mark.parametrize(
    "names", [["a", "b"], ["long-name-" * 3] * 4, [f"kind-{k}" for k in "abcdefghi"]]
)
def test_a_legend_of_many_kinds_stays_in_the_figure(names):
    disks = [DiskBody(radius=2, name=f"{name}-{k}") for k, name in enumerate(names)]
    case = make_case((60, 60), bodies=disks)
    places = [[6 + 6 * k, 30] for k in range(len(names))]
    figure = picture(case, {}, frames_of(case, places), "bodies")
    figure.canvas.draw()
    (legend,) = figure.legends
    assert len(legend.texts) == len(names)
    found, whole = legend.get_window_extent(), figure.bbox
    assert whole.x0 <= found.x0 and found.x1 <= whole.x1
    below = min(ax.get_tightbbox().y0 for ax in figure.axes)
    assert whole.y0 <= found.y0 and found.y1 <= below


def test_beads_are_not_taken_for_bodies_nor_bodies_for_beads():
    case = moving_disks()
    frames = frames_of(case, [[3, 3], [7, 7], [3, 9]], kinds=[0, 0, 0])
    axes = picture(case, {}, frames, "particles").axes[0]
    assert len(filled(axes)[0].get_paths()) == 3
    assert all(len(line.get_xdata()) == 0 for line in axes.lines)


def test_films_of_a_run(tmp_path):
    """And pictures: of its file, and of the simulation in memory."""
    kept = Trajectory(every=10, of="bodies", fields=("position", "orientation"))
    case = moving_disks(trajectory=kept, observe=[FRAMES])
    simulation = Simulation(case, output=tmp_path / "run", threads=1)
    begun = simulation.flow("bodies")
    assert len(filled(begun.axes[0])[0].get_paths()) >= 3
    simulation.run()
    files = mesokit.open(tmp_path / "run")
    assert files.animate(tmp_path / "a.gif", "bodies").frames == 5
    assert len(filled(files.flow("bodies").axes[0])) == 1


def test_films_say_where_bodies_go_far_while_the_flow_is_averaged():
    """A disk of radius 2 goes 3 cells from frame to frame, over the edge of the box."""
    case = make_case(SIZE, bodies=[body("disk", 2)])
    frames = frames_of(case, *([[(1.0 + 3.0 * k) % 16, 5.0]] for k in range(6)))
    bodies = BodyFrames(case, frames, ("x", "y"))
    assert bodies.gone(2.0) == pytest.approx(6 / 4)
    assert bodies.gone(0.5) == pytest.approx(1.5 / 4)
    assert _smeared(bodies, frames.time, 1) == ""
    assert _smeared(bodies, frames.time, 4) == (
        "flow smeared: bodies go 3 times their size in the time of a mean"
    )
    alone = BodyFrames(case, frames_of(case, [[1.0, 5.0]]), ("x", "y"))
    assert np.isnan(alone.gone(2.0))


def test_a_film_shows_bodies_where_they_are_at_each_time(tmp_path, monkeypatch):
    case = make_case(SIZE, bodies=[body("disk", 2)])
    frames, seen = frames_of(case, [[5, 5]], [[6, 5]], [[7, 5]]), []
    draw = body_panel.draw_over
    monkeypatch.setattr(body_panel, "draw_over", lambda ax, b: seen.append(b) or draw(ax, b))
    assert animate(case, {}, frames, tmp_path / "a.gif").frames == 3
    assert [b.time for b in seen] == [0, 1, 2]
    middles = [b.outlines[0][0].mean(axis=0)[0] for b in seen]
    np.testing.assert_allclose(middles, [5, 6, 7], atol=0.05)


# --- in space ------------------------------------------------------------------------------------


def test_maps_in_space_show_sections():
    """A sphere of radius 2 at z = 9, cut at 10; beyond its end; and over the end of the box."""
    case = make_case(ROOM, bodies=[body("sphere", 3)])
    frames = frames_of(case, [[8, 9, 9]])
    ((line,),) = BodyFrames(case, frames, ("x", "y"), plane=10.0).at().outlines
    np.testing.assert_allclose(np.hypot(*(line - (8, 9)).T), math.sqrt(3), atol=0.01)
    assert BodyFrames(case, frames, ("x", "y"), plane=11.5).at().outlines == ()
    frames = frames_of(case, [[8, 9, 19.5]])
    ((line,),) = BodyFrames(case, frames, ("x", "y"), plane=0.5).at().outlines
    np.testing.assert_allclose(np.hypot(*(line - (8, 9)).T), math.sqrt(3), atol=0.01)
    results = results_of(make_case(ROOM, observe=[FRAMES]), 5)
    case = make_case(ROOM, bodies=[body("sphere", 3)], observe=[FRAMES])
    figure = picture(case, results, frames, "density", at=0.5)
    said = " ".join(text.get_text() for text in reversed(figure.texts))
    assert "cut at" in said and len(filled(figure.axes[0])[0].get_paths()) == 1


@pytest.mark.parametrize("axes", [("x", "y"), ("z", "x"), ("z", "y")])
def test_sections_of_turned_bodies(axes):
    """The cuboid 4 x 3 x 3 has its long axis along y after the turn."""
    case = make_case(ROOM, bodies=[body("cuboid", 3)])
    frames = frames_of(case, [[8, 9, 10]], turns=[THIRD])
    plane = Section(case, axes).plane
    ((line,),) = BodyFrames(case, frames, axes, plane).at().outlines
    widths = dict(zip(axes, np.ptp(line, axis=0), strict=True))
    expected = {"x": 3, "y": 4, "z": 3}
    for axis, width in widths.items():
        assert width == pytest.approx(expected[axis], abs=0.01)


def test_an_arrow_is_shown_where_the_section_holds_it():
    case = make_case(ROOM, bodies=[body("spheroid", 3, swim=SWIM)])
    frames = frames_of(case, [[8, 9, 10]], turns=[(1, 0, 0, 0)])
    for plane, number in ((10.0, 1), (11.4, 0)):
        shown = BodyFrames(case, frames, ("x", "y"), plane).at()
        assert len(shown.outlines) == 1 and len(shown.arrows) == number


def image_of(part, turn=((1, 0, 0), (0, 1, 0), (0, 0, 1)), forward=(), size=8.0):
    """A part about the middle of an image of 40 dots per length."""
    middle = np.array([0.5 * size, 0.5 * size, 0.0])
    placed = [Placed(part, middle, np.array(turn, float), 0, forward)]
    return shaded_parts(placed, np.ones((1, 3)), (-1, 0), (0.0, 0.0), (size, size), 40)


def test_spheres_are_shaded_as_spheres_are():
    """One before the other, to rounding."""
    (part,) = body("sphere", 3).solid(3).parts
    places = np.array([[3.0, 4.0, -1.0], [4.5, 4.0, 0.5]])
    colours = np.array([[1.0, 0.5, 0.2], [0.2, 0.5, 1.0]])
    room = (-3.0, 2.0)
    placed = [Placed(part, r, np.eye(3), n, ()) for n, r in enumerate(places)]
    found = shaded_parts(placed, colours, room, (0, 0), (8, 8), 20)
    balls = Balls(places[:, :2], places[:, 2], np.full(2, 2.0), colours, room)
    assert abs(found.astype(int) - shaded(balls, (0.0, 0.0), (8.0, 8.0), 20)).max() <= 1


@pytest.mark.parametrize("name", ["sphere", "spheroid", "capsule", "cuboid"])
def test_shaded_bodies_cover_their_own_shadow(name):
    """Where the line of sight meets them: the least distance along it is negative."""
    (part,) = body(name, 3).solid(3).parts
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    image = image_of(part, turn)
    n, heights = len(image), np.linspace(-4, 4, 161)
    along = (np.arange(n) + 0.5) / 40 - 4.0
    u, v = np.meshgrid(along[::8], along[::8])
    places = np.stack(np.broadcast_arrays(u[..., None], v[..., None], heights), axis=-1)
    away = distance([part], places.reshape(-1, 3) @ turn).reshape(*u.shape, -1).min(axis=2)
    clear = abs(away) > 0.1
    np.testing.assert_array_equal(image[::8, ::8, 3][clear] > 127, away[clear] < 0)
    assert (away < 0).sum() > 50


def test_the_sides_and_ends_of_a_capsule_meet_smoothly():
    (parts,) = capsule((-2, 0, 0), (2, 0, 0), 1)
    row = image_of(parts[0])[160, 100:220, 0].astype(int)
    assert (row > 0).all() and abs(np.diff(row)).max() <= 3


def test_the_front_of_those_that_swim_is_dark():
    (part,) = body("sphere", 3).solid(3).parts
    bare, capped = image_of(part)[160, :, 0], image_of(part, forward=(2, 0, 0))[160, :, 0]
    dark, behind = capped.astype(int) < bare, image_of(part, forward=(-2, 0, 0))[160, :, 0]
    np.testing.assert_array_equal(behind.astype(int) < bare, dark[::-1])
    np.testing.assert_allclose(capped[dark] / bare[dark], CAP_SHADE, atol=0.02)
    first, last = np.flatnonzero(dark)[[0, -1]]
    assert first == pytest.approx(40 * (4 + 0.8 * 2), abs=1) and last >= 40 * 5.9


def test_bodies_in_space_are_an_image_of_what_is_behind_a_place():
    case = make_case(ROOM, bodies=[body("sphere", 3), body("capsule", 3, swim=None)])
    frames = frames_of(case, [[8, 9, 5], [8, 9, 15]], turns=[THIRD] * 2)
    whole = picture(case, {}, frames)
    behind = picture(case, {}, frames, "bodies", at=10)
    images = [figure.axes[0].images[0].get_array() for figure in (whole, behind)]
    assert images[0].shape == images[1].shape and (images[0] != images[1]).any()
    said = " ".join(text.get_text() for text in reversed(behind.texts))
    assert r"those at $z<10\,a$" in said
