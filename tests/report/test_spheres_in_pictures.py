"""Disks and spheres are drawn to scale, in colours of what they do, the nearest before others."""

from __future__ import annotations

import dataclasses
import io
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

import mesokit
from mesokit import Box, Case, CaseError, HardSpheres, Plates, Run, RunError, Simulation, Trajectory
from mesokit.cli import main
from mesokit.method.spheres.common.kinds import SphereKind
from mesokit.method.spheres.common.section import Spheres
from mesokit.report.flow import KINDS, animate, disks, picture
from mesokit.report.flow.colouring import COLOURS, MOST, in_film
from mesokit.report.flow.shaded import DARK, SHADE, Balls, shaded
from mesokit.report.flow.solids import Section
from mesokit.report.flow.source import sources
from mesokit.seam.method import Enclosure, method_of
from tests.helpers.flying_spheres import METHOD

TWO = (SphereKind(0.8, share=2.0, name="small"), SphereKind(1.2, spread=0.3, name="large"))


class Frames(SimpleNamespace):
    """A trajectory in memory, read as one in a file is."""

    def __len__(self):
        return len(self.time)

    def __getitem__(self, index):
        return {name: getattr(self, name)[index] for name in self.fields}


def frames_of(position, **given):
    """Equal spheres at these places, at one time or more."""
    position = np.asarray(position, float)
    position = position if position.ndim == 3 else position[None]
    n, more = position.shape[1], {name: np.asarray(v, float) for name, v in given.items()}
    parts = {"diameter": np.ones(n), "species": np.zeros(n, int), "mass": np.ones(n)} | {
        name: more.pop(name) for name in ("diameter", "species") if name in more
    }
    return Frames(
        fields=("position", *more), position=position, id=np.arange(n),
        time=np.arange(len(position)) * 1.0, **{k: v[None] if v.ndim < 3 and k != "spin" else v
        for k, v in more.items()}, **parts,
    )  # fmt: skip


@pytest.fixture
def case_of(flying):
    def make(size, number=1, **parts):
        spheres = Spheres(number=number, **parts)
        return Case(run=Run(1, method=flying), box=Box(size), spheres=spheres)

    return make


@pytest.fixture
def run(flying, tmp_path, monkeypatch):
    """The folder of a run of so many steps."""
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])

    def make(size=(9.5, 8), fields=("position", "velocity", "spin"), **parts):
        case = Case(
            run=Run(20, method=flying),
            box=Box(size),
            spheres=Spheres(number=parts.pop("number", 30), kinds=TWO),
            trajectory=Trajectory(every=10, fields=fields, **parts),
        )
        Simulation(case, output=tmp_path / "run", threads=1).run()
        return mesokit.open(tmp_path / "run")

    return make


def pixels(figure, ax, dpi=300):
    """What is seen of one panel (rows from above, columns, 3), without its frame."""
    ax.axis("off")
    box = ax.get_position()
    data = io.BytesIO()
    figure.savefig(data, dpi=dpi)
    image = np.asarray(Image.open(data).convert("RGB"))
    height, width = image.shape[:2]
    rows = slice(round(height * (1 - box.y1)) + 1, round(height * (1 - box.y0)) - 1)
    return image[rows, round(width * box.x0) + 1 : round(width * box.x1) - 1]


def drawn_disks(figure):
    """Places, diameters and colours of the disks in the first panel."""
    (found,) = [c for c in figure.axes[0].collections if hasattr(c, "set_widths")]
    return found.get_offsets(), found.get_widths(), found.get_facecolors()


class TestScale:
    """A length in the picture is that length."""

    def test_the_white_part_is_what_disks_leave(self, case_of, monkeypatch):
        """Also of those that cross the edges of the periodic box, which come in again."""
        monkeypatch.setattr(disks, "EDGED", np.inf)  # no edges
        case = case_of((12.5, 9), number=80)
        x, y = np.meshgrid(np.arange(10) * 1.25, np.arange(8) * 1.125)
        places = np.stack([x.ravel(), y.ravel()], axis=1)  # a row on each edge
        figure = picture(case, {}, frames_of(places))
        red = pixels(figure, figure.axes[0])[..., 0] / 255
        covered = ((1 - red) / (1 - mpl.colors.to_rgb(disks.PLAIN)[0])).mean()
        assert covered == pytest.approx(80 * np.pi / 4 / (12.5 * 9), abs=0.002)

    def test_every_disk_is_where_it_is_with_its_images(self, case_of):
        case = case_of((6, 5))
        frames = frames_of([[3, 2.5], [0.2, 2], [5.9, 4.8]], diameter=[1, 0.5, 0.6])
        places, diameters, _ = drawn_disks(picture(case, {}, frames))
        found = {(*np.round(r, 9).tolist(), d) for r, d in zip(places, diameters, strict=True)}
        corner = {(x, y, 0.6) for x in (5.9, -0.1) for y in (4.8, -0.2)}
        assert found == {(3, 2.5, 1), (0.2, 2, 0.5), (6.2, 2, 0.5)} | corner

    def test_nothing_comes_in_through_a_wall(self, case_of, monkeypatch, flying):
        from tests.helpers import flying_spheres

        closed = dataclasses.replace(METHOD, enclosure=Enclosure(lambda case: {1}))
        monkeypatch.setattr(flying_spheres, "METHOD", closed)
        places, _, _ = drawn_disks(picture(case_of((6, 5)), {}, frames_of([[5.9, 4.8]])))
        assert sorted(places[:, 0].round(9)) == [-0.1, 5.9] and set(places[:, 1]) == {4.8}

    def test_a_region_shows_those_that_reach_into_it(self, case_of):
        frames = frames_of([[1, 1], [3.4, 2], [4.6, 2]])
        figure = picture(case_of((6, 5)), {}, frames, region=((0, 3), (0, 3)))
        assert drawn_disks(figure)[0].tolist() == [[1, 1], [3.4, 2]]

    def test_axes_may_be_turned(self, case_of):
        frames = frames_of([[1, 2]])
        figure = picture(case_of((6, 5)), {}, frames, axes=("y", "x"))
        assert drawn_disks(figure)[0].tolist() == [[2, 1]]


class TestShaded:
    """Spheres in 3D."""

    def balls(self, *rows, colours=None, room=(0.0, 0.0)):
        """Of rows x, y, depth, radius."""
        rows = np.array(rows, float)
        colours = np.eye(3)[: len(rows)] if colours is None else np.array(colours, float)
        return Balls(rows[:, :2], rows[:, 2], rows[:, 3], colours, room)

    def test_a_sphere_covers_a_disk(self):
        image = shaded(self.balls((2.1, 3.2, 0, 1.5)), (0, 0), (5, 6), 80) / 255
        assert image.shape == (480, 400, 4)
        assert image[..., 3].sum() / 80**2 == pytest.approx(np.pi * 1.5**2, rel=2e-3)
        y, x = np.mgrid[:480, :400] / 80 + 1 / 160
        weight = image[..., 3] / image[..., 3].sum()
        assert ((x * weight).sum(), (y * weight).sum()) == pytest.approx((2.1, 3.2), abs=0.01)

    @pytest.mark.parametrize("order", [(0, 1), (1, 0)])
    def test_the_nearer_one_is_seen_whichever_comes_first(self, order):
        rows = np.array([(1, 1, 0, 1), (1, 1, 1.5, 0.5)])[list(order)]
        image = shaded(self.balls(*rows, colours=np.eye(3)[list(order)]), (0, 0), (2, 2), 50)
        assert image[50, 50, 1] > image[50, 50, 0] and image[50, 5, 0] > image[50, 5, 1]

    def test_a_larger_one_behind_reaches_out_over_a_smaller_one(self):
        """What counts is the depth of the surface there, not of the centre."""
        image = shaded(self.balls((1, 1, 0, 1), (1.2, 1, 0.2, 0.3)), (0, 0), (2, 2), 50)
        assert image[50, 60, 0] > image[50, 60, 1]

    def test_two_that_overlap_meet_in_the_plane_between_them(self):
        image = shaded(self.balls((1, 1, 0, 0.8), (2, 1, 0, 0.8)), (0, 0), (3, 2), 50)
        red, green = image[..., 0].astype(int), image[..., 1].astype(int)
        both = image[..., 3] == 255
        assert (red > green)[:, :75][both[:, :75]].all()
        assert (red < green)[:, 75:][both[:, 75:]].all()

    def test_light_comes_from_the_upper_left_and_what_is_far_is_dark(self):
        grey = [[0.5] * 3] * 2
        near = shaded(self.balls((1, 1, 4, 1), colours=grey[:1], room=(0, 4)), (0, 0), (2, 2), 50)
        far = shaded(self.balls((1, 1, 0, 1), colours=grey[:1], room=(0, 4)), (0, 0), (2, 2), 50)
        inside = near[..., 3] == 255
        assert near[70, 30, 0] > near[30, 70, 0]
        assert near[inside][:, 0].min() >= 0.5 * 255 * SHADE - 1
        darker = near[inside].astype(float)[:, 0] * (1 - DARK)
        np.testing.assert_allclose(far[inside][:, 0], darker, atol=1.5)

    @pytest.mark.parametrize("depth", [0, 4])
    def test_a_colour_keeps_its_hue_and_is_seen_in_full_where_light_falls(self, depth):
        """So that a number can be read off the colour bar."""
        colour = np.array([0.9, 0.45, 0.3])
        ball = self.balls((1, 1, depth, 1), colours=[colour], room=(0, 4))
        image = shaded(ball, (0, 0), (2, 2), 50)
        seen = image[image[..., 3] == 255][:, :3] / 255
        np.testing.assert_allclose(
            seen / seen[:, :1], np.tile(colour / 0.9, (len(seen), 1)), atol=0.02
        )
        brightest = seen[seen[:, 0].argmax()]
        np.testing.assert_allclose(brightest, colour * (1 if depth else 1 - DARK), atol=0.01)

    @pytest.mark.parametrize(
        "axes, front", [(("x", "y"), 1), (("x", "z"), 0), (("y", "z"), 1), (("z", "y"), 0)]
    )
    def test_pictures_are_right_handed(self, case_of, axes, front, monkeypatch):
        """Two spheres one behind the other, seen along the third axis of a right-handed frame."""
        third = ({0, 1, 2} - {"xyz".index(a) for a in axes}).pop()
        places = np.full((2, 3), 3.0)
        places[:, third] = 1.0, 5.0
        frames = frames_of(places, velocity=[[0, 0, 0], [3, 0, 0]])
        figure = picture(case_of((6, 6, 6)), {}, frames, axes=axes)
        image = figure.axes[0].images[0].get_array()
        middle = image[image.shape[0] // 2, image.shape[1] // 2]
        yellow = middle[0] > middle[2]  # the fast one
        assert yellow == (front == 1)

    @pytest.mark.parametrize(("gravity", "axes"), [((0, 0, -1), "xz"), ((0, -1, 0), "xy")])
    def test_what_falls_is_seen_from_the_side(self, case_of, gravity, axes):
        frames = frames_of([[3, 3, 1], [3, 3, 5]])
        found = sources(case_of((6, 6, 6), 2, gravity=gravity), {}, frames)
        assert found.axes == tuple(axes) and found[-1].axes == tuple(axes)

    def test_a_place_along_the_third_axis_hides_what_is_before_it(self, case_of):
        places = [[3, 3, 1], [3, 3, 5]]
        frames = frames_of(places, velocity=[[0, 0, 0], [3, 0, 0]])
        figure = picture(case_of((6, 6, 6)), {}, frames, at=4.0)
        image = figure.axes[0].images[0].get_array()
        middle = image[image.shape[0] // 2, image.shape[1] // 2]
        assert middle[0] < middle[2]
        assert r"spheres at $z<4$" in " ".join(text.get_text() for text in figure.texts)


class TestColours:
    """What they mean."""

    def numbers(self, case, frames, colour):
        """The numbers that the colours of the disks stand for, by the scale of the picture."""
        figure = picture(case, {}, frames, colour=colour)
        _, _, fills = drawn_disks(figure)
        bar = figure.axes[1].get_ylim()
        return figure, fills, bar

    def expected(self, colours, low, high, values):
        norm = mpl.colors.Normalize(low, high)
        return mpl.cm.ScalarMappable(norm, colours).to_rgba(values)

    def test_speeds_and_spins(self, case_of):
        case, places = case_of((9, 5)), [[1, 2], [3, 2], [5, 2], [7, 2]]
        velocity = [[3, 4], [0, 0], [0, -1], [2, 0]]
        frames = frames_of(places, velocity=velocity, spin=[[2, -1, 0, 0.1]])
        _, fills, (low, high) = self.numbers(case, frames, "speed")
        np.testing.assert_allclose(fills, self.expected("viridis", low, high, [5, 0, 1, 2]))
        assert low == 0 and high == pytest.approx(5, rel=0.02)
        figure, fills, (low, high) = self.numbers(case, frames, "spin")
        assert low == -high and high == pytest.approx(2, rel=0.02)
        np.testing.assert_allclose(fills, self.expected("RdBu_r", low, high, [2, -1, 0, 0.1]))
        dots, crosses = figure.axes[0].lines
        assert dots.get_xydata().tolist() == [[1, 2]]
        assert crosses.get_xydata().tolist() == [[3, 2]]

    def test_a_film_of_a_gas_that_cools_has_a_logarithmic_scale(self, case_of):
        """Else all but the first frame would have one colour, or each frame a scale of its own."""
        places, hot = np.array([[[1, 2], [3, 2]]] * 2, float), np.array([[3, 0], [4, 0]], float)
        for factor, colour in ((0.25, "log-speed"), (0.5, None)):
            frames = frames_of(places, velocity=np.array([hot, factor * hot]))
            assert in_film(frames, None) == colour and in_film(frames, "spin") == "spin"
        figure = picture(case_of((9, 5), number=2), {}, frames, colour="log-speed")
        assert figure.axes[1].get_ylabel().startswith("speed  [")
        assert figure.axes[1].get_yscale() == "log"
        low, high = self.numbers(case_of((9, 5), number=2), frames, "log-speed")[2]
        assert high / low == pytest.approx(1000)
        figure = picture(case_of((9, 5), number=2), {}, frames, colour="relative-speed")
        assert "rms speed $1.8$" in " ".join(text.get_text() for text in figure.texts)
        _, fills, (low, high) = self.numbers(case_of((9, 5), number=2), frames, "relative-speed")
        usual = np.sqrt(12.5)
        np.testing.assert_allclose(
            fills, self.expected("viridis", low, high, [3 / usual, 4 / usual])
        )

    def test_neighbours_in_a_triangular_lattice_are_six(self, case_of):
        x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
        rows = 1.1 * np.stack([x + 0.5 * (y % 2), y * np.sqrt(0.75)], axis=-1).reshape(-1, 2)
        case = case_of((6.6, float(6 * 1.1 * np.sqrt(0.75))), number=36)
        rows = rows % np.array(case.box.size)
        for colour, value, step in (("neighbours", 6, (-0.5, 6.5)), ("psi6", 1.0, (0, 1))):
            _, fills, ends = self.numbers(case, frames_of(rows), colour)
            assert ends == step
            wanted = self.expected("viridis", *([0, 6] if value == 6 else [0, 1]), [value])
            np.testing.assert_allclose(fills, np.repeat(wanted, len(fills), axis=0), atol=1e-12)
        _, fills, _ = self.numbers(case, frames_of(rows, diameter=np.full(36, 0.9)), "neighbours")
        assert len(np.unique(fills, axis=0)) == 1  # none is near enough

    def test_neighbours_are_counted_by_both_radii(self, case_of):
        places, diameters = [[2, 2], [3.7, 2], [7, 2], [8.9, 2]], [2.0, 1.0, 2.0, 1.0]
        frames = frames_of(places, diameter=diameters)  # 1.7 is less than 1.2 * 1.5, 1.9 is more
        _, fills, ends = self.numbers(case_of((12, 8), number=4), frames, "neighbours")
        assert ends == (-0.5, 1.5)
        assert (fills[0] == fills[1]).all() and (fills[2] == fills[3]).all()
        assert (fills[0] != fills[2]).any()

    def test_many_neighbours_share_a_colour(self, case_of):
        angle = np.arange(14) * 2 * np.pi / 14
        ring = 3 + 1.3 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        frames = frames_of([[3, 3], *ring], diameter=[2.0, *[0.3] * 14])
        figure, _, _ = self.numbers(case_of((6, 6), number=15), frames, "neighbours")
        names = [label.get_text() for label in figure.axes[1].get_yticklabels()]
        assert names[-1] == f"{MOST}+" and len(names) == MOST + 1

    def test_kinds_have_names(self, run):
        figure = run().flow(colour="kind")
        assert [label.get_text() for label in figure.axes[1].get_yticklabels()] == [
            "small", "large",
        ]  # fmt: skip
        grey = [mpl.colors.rgb_to_hsv(mpl.colors.to_rgb(c))[2] for c in ("#1b4f8a", "#c1491d")]
        assert abs(grey[0] - grey[1]) > 0.1

    def test_without_velocities_kinds_are_told_apart_and_equal_ones_are_alike(self, case_of, run):
        files = run(fields=("position",))
        assert len(files.flow().axes) == 2  # a bar of the kinds
        figure = picture(case_of((6, 5)), {}, frames_of([[1, 2]]))
        assert len(figure.axes) == 1
        assert drawn_disks(figure)[2][0][:3] == pytest.approx(mpl.colors.to_rgb(disks.PLAIN))

    def test_spheres_turn_about_any_axis(self, run):
        figure = run((6, 6, 6)).flow(colour="spin")
        assert figure.axes[1].get_ylim()[0] == 0


class TestWhatIsDrawn:
    """Without a word it is disks."""

    @pytest.mark.parametrize("size", [(9.5, 8), (6, 6, 6)])
    @pytest.mark.parametrize("colour", [None, *COLOURS])
    def test_every_colour(self, run, size, colour):
        if (colour, len(size)) == ("psi6", 3):
            return
        files = run(size)
        data = io.BytesIO()
        files.flow(colour=colour).savefig(data, dpi=40)
        assert len(data.getvalue()) > 2000

    def test_before_the_first_step_and_from_the_command_line(self, run, tmp_path, capsys, flying):
        files = run()
        simulation = Simulation(files.case)
        figure = simulation.flow()
        assert "at $t=0" in " ".join(text.get_text() for text in figure.texts)
        assert len(drawn_disks(figure)[0]) >= 30
        for words in (
            ["plot", files.path, "--kind", "disks", "--colour", "spin", "--output", "a.png"],
            ["plot", files.path, "--region", "0:4,0:5", "--output", "b.svg"],
            ["animate", files.path, "--output", "a.gif", "--quiet"],
            ["check", files.path / "case.toml", "--picture", "c.png"],
        ):
            with pytest.raises(SystemExit) as end:
                main([str(tmp_path / w) if str(w)[1:2] == "." else str(w) for w in words])
            assert not end.value.code, capsys.readouterr().err
        assert {p.name for p in tmp_path.iterdir()} >= {"a.png", "b.svg", "a.gif", "c.png"}

    def test_a_film_has_one_scale(self, case_of, tmp_path):
        """The bar is the same in all frames, and colours are those of the fastest frame."""
        places = np.array([[[1, 2], [3, 2]]] * 3, float)
        velocity = np.array([[[1, 0], [0, 0]], [[2, 0], [0, 0]], [[4, 0], [0, 0]]], float)
        frames = frames_of(places, velocity=velocity)
        film = animate(case_of((9, 5)), {}, frames, tmp_path / "a.gif", colour="speed")
        assert film.frames == 3
        with Image.open(film.path) as image:
            shown = []
            for frame in range(3):
                image.seek(frame)
                shown.append(np.asarray(image.convert("RGB")).astype(int))
        right = int(0.85 * shown[0].shape[1])
        for picture_ in shown[1:]:
            assert abs(picture_[:, right:] - shown[0][:, right:]).max() < 40  # the bar
        assert any(abs(p[:, :right] - shown[0][:, :right]).max() > 80 for p in shown[1:])

    def test_a_part_of_them_is_said_to_be_one(self, run):
        figure = run(subset=10).flow()
        assert "10 of 30 particles" in " ".join(text.get_text() for text in figure.texts)

    def test_many_disks_are_an_image_in_a_vector_file(self, case_of):
        places = np.random.default_rng(2).random((disks.MANY + 1, 2)) * 90
        figure = picture(case_of((90, 90)), {}, frames_of(places))
        data = io.BytesIO()
        figure.savefig(data, format="svg")
        assert len(data.getvalue()) < 1e6

    def test_other_kinds_are_there_too(self, run):
        files = run()
        for kind in ("particles", "speed"):
            files.flow(kind)


class TestRefused:
    def test_particles_without_a_size(self, make_case):
        assert "disks" in KINDS
        with pytest.raises(
            CaseError, match=r"kind = 'disks': particles of method 'mpcd' have no size"
        ):
            picture(make_case((6, 6)), {}, kind="disks")

    @pytest.mark.parametrize(
        "given, error, message",
        [
            ({"colour": "sped"}, CaseError, r"colour = 'sped': expected .*; did you mean 'speed'"),
            ({"colour": "spin"}, RunError, r"colour = 'spin': the trajectory holds no 'spin'"),
            ({"colour": "neighbours"}, RunError, r"holds 10 of 30 particles"),
            ({"at": 3}, CaseError, "at = 3: a 2D box has no third axis"),
        ],
    )
    def test_what_there_is_not(self, run, given, error, message):
        files = run(fields=("position", "velocity"), subset=10)
        with pytest.raises(error, match=message):
            files.flow(**given)

    def test_hexatic_order_of_spheres_and_between_plates(self, run):
        with pytest.raises(CaseError, match="colour = 'psi6': expected disks in a periodic 2D box"):
            run((6, 6, 6)).flow(colour="psi6")

    def test_colours_of_another_kind(self, run):
        with pytest.raises(CaseError, match="colour = 'spin': not with kind 'speed'"):
            run().flow("speed", colour="spin")

    def test_no_trajectory(self, case_of):
        with pytest.raises(RunError, match=r"needs positions of spheres, .*add to the case.*traj"):
            picture(case_of((6, 6)), {})

    def test_no_trajectory_where_there_are_no_flow_frames(self):
        case = Case(run=Run(10, method="event-driven"), box=Box([9, 9]))
        with pytest.raises(RunError, match=r"needs velocities, .*: \[trajectory\] with fields"):
            picture(case, {}, kind="speed")


def test_plates_stand_where_they_are_in_a_box_of_any_lengths():
    """The hard-sphere method's: y from 0 to 7.5."""
    from mesokit.geometry.solids.solids import Solids

    solids = Solids([Plates("y")], Box([9.3, 7.5]))
    points = np.array([[9.2, 7.4], [0.1, 7.6], [5.0, 1.0], [3.3, -0.5]])
    assert solids.distance(points) == pytest.approx([0.1, -0.1, 1.0, -0.5])
    with pytest.raises(
        CaseError, match=r"wall\[#1\]: solids other than plates need a box of whole"
    ):
        Solids([mesokit.Disk(centre=(4, 4), radius=1)], Box([9.3, 7.5]))


def test_plates_that_vibrate_are_drawn_where_they_are():
    lower = {"contact": {"amplitude": 0.5, "frequency": 2.0}}
    case = Case(
        run=Run(1, method="event-driven"),
        box=Box([8, 10]),
        walls=[Plates("y", lower=lower)],
        spheres=HardSpheres(number=4),
    )
    section, x = Section(case, ("x", "y")), np.full(5, 3.0)
    y = np.array([-0.6, -0.2, 0.2, 0.6, 9.0])
    for time, shift in ((0.0, 0.0), (np.pi / 4, 0.5), (3 * np.pi / 4, -0.5)):
        found = section.distance(x, y, method_of(case).enclosure.moving_plates(case, time))
        np.testing.assert_allclose(found, [*(y[:4] - shift), 1.0], atol=1e-12)
