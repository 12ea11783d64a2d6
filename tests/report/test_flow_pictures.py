"""Pictures of flows that are known: the numbers in them, and what they refuse."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest

from mesokit import FlowFrames, Plates
from mesokit.case.trajectory import Trajectory
from mesokit.errors import CaseError, RunError
from mesokit.io import h5md
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report import save_figure
from mesokit.report.flow import KINDS, picture, quiver, solids
from mesokit.report.flow.data import Flow
from mesokit.report.flow.maps import speed, vorticity, vorticity_of
from mesokit.report.flow.noise import averaged, smooth, smoothing
from mesokit.report.flow.quiver import arrows
from mesokit.report.flow.region import Region, region_of
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.source import sources
from tests.helpers.fake_fluid import FakeFluid
from tests.helpers.known_flows import FRAMES, MAPS, SPIN, Disk, results_of

SIZE = (12, 10)
OF_GRAINS = ("disks", "force-chains")
OF_FLUIDS = [kind for kind in KINDS if kind not in (*OF_GRAINS, "flock", "bodies", "sites")]


@pytest.fixture
def rotation(make_case):
    """A case, and the frames of a fluid that turns like a rigid body."""
    case = make_case(SIZE, observe=[FRAMES], density=50)
    return case, results_of(case)


def exact(shape, flow, periodic=(False, False), size=(12.0, 10.0)):
    """A flow given by its velocity (u, v) at the middle of each bin."""
    x, y = ((np.arange(n) + 0.5) * length / n for n, length in zip(shape, size, strict=True))
    velocity = np.stack(np.broadcast_arrays(*flow(*np.meshgrid(x, y, indexing="ij"))), axis=-1)
    return Flow(("x", "y"), size, 2, periodic, velocity=velocity)


def drawn(figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=40)
    return buffer.getvalue()


class TestNumbers:
    """What is in a picture."""

    def test_a_rigid_rotation_has_twice_its_angular_velocity(self, rotation):
        case, results = rotation
        source = sources(case, results, None)[0]
        flow = source.flow(np.arange(len(source.time)))
        flow = Flow(flow.axes, flow.size, 2, (False, False), velocity=flow.velocity)
        assert abs(vorticity_of(flow) - 2 * SPIN).max() < 0.1 * SPIN

    @pytest.mark.parametrize("shape", [(12, 10), (24, 30)])
    def test_vorticity_of_a_linear_flow_is_exact(self, shape):
        flow = exact(shape, lambda x, y: (-SPIN * y + 0.1 * x, SPIN * x - 0.1 * y))
        np.testing.assert_allclose(vorticity_of(flow), 2 * SPIN)

    def test_vorticity_goes_on_across_a_periodic_box(self):
        k = 2 * np.pi / 12
        flow = exact((48, 10), lambda x, y: (0 * x, np.sin(k * x)), periodic=(True, True))
        x = (np.arange(48) + 0.5) / 4
        expected = k * np.cos(k * x)[:, None] * np.ones(10)
        np.testing.assert_allclose(vorticity_of(flow), expected, atol=0.003 * k)

    def test_no_vorticity_in_and_next_to_bins_without_fluid(self):
        flow = exact((12, 10), lambda x, y: (-y, x))
        flow.velocity[5, 5] = np.nan
        missing = np.isnan(vorticity_of(flow))
        assert np.argwhere(missing).tolist() == [[4, 5], [5, 4], [5, 5], [5, 6], [6, 5]]

    @pytest.mark.parametrize("cells", [2, 8])
    def test_arrows_are_the_velocity_where_they_stand(self, cells):
        flow = exact((12 * cells, 10 * cells), lambda x, y: (-SPIN * y, SPIN * x))
        x, y, velocity = arrows(flow, Region((0.0, 0.0), (12.0, 10.0)))
        assert 20 <= len(x) <= 32
        np.testing.assert_allclose(velocity[..., 0], np.broadcast_to(-SPIN * y, (len(x), len(y))))
        np.testing.assert_allclose(velocity[..., 1].T, np.broadcast_to(SPIN * x, (len(y), len(x))))

    def test_arrows_leave_out_bins_without_fluid(self):
        flow = exact((120, 100), lambda x, y: (0 * x + 1, 0 * y))
        flow.velocity[:3] = np.nan
        flow.velocity[3:12] = np.nan
        velocity = arrows(flow, Region((0.0, 0.0), (12.0, 10.0)))[2]
        assert np.isnan(velocity[0]).all()
        np.testing.assert_array_equal(velocity[-1, :, 0], 1)

    def test_long_channels_have_arrows_across(self):
        flow = exact((300, 20), lambda x, y: (y, 0 * y), size=(300.0, 20.0))
        x, y, _ = arrows(flow, Region((0.0, 0.0), (300.0, 20.0)))
        assert len(x) > 20 and len(y) >= 6

    def test_frames_average_to_the_maps_of_the_whole_run(self, make_case):
        case = make_case(SIZE, observe=[FRAMES, *MAPS])
        found = sources(case, results_of(case), None)
        frames, velocity, density = found
        mean = frames.flow(np.arange(len(frames.time)))
        whole = np.zeros(0, int)
        np.testing.assert_allclose(mean.velocity, velocity.flow(whole).velocity, rtol=1e-4)
        np.testing.assert_allclose(mean.density, density.flow(whole).density, rtol=1e-6)

    def test_a_window_selects_its_frames(self, rotation):
        case, results = rotation
        time = results["flow-frames"].x["time"]
        result = results["flow-frames"].value
        ax = picture(case, results, kind="density", window=(time[1] - 0.1, time[1] + 0.1)).axes[0]
        np.testing.assert_allclose(ax.images[0].get_array(), result[1, ..., 0].T)
        both = picture(case, results, kind="density", window=(time[1] - 0.1, time[2] + 0.1))
        np.testing.assert_allclose(
            both.axes[0].images[0].get_array(), result[1:3, ..., 0].mean(axis=0).T
        )

    def test_a_region_selects_its_bins_and_particles(self, rotation):
        case, results = rotation
        region = ((2, 6), (3.5, 8))
        ax = picture(case, results, kind="density", region=region).axes[0]
        assert ax.get_xlim() == (2, 6) and ax.get_ylim() == (3.5, 8)
        assert ax.images[0].get_array().shape == (5, 4)
        assert ax.images[0].get_extent() == [2, 6, 3, 8]
        ax = picture(case, results, kind="particles", region=region).axes[0]
        x, y = ax.lines[0].get_data()
        positions = results["flow-frames"].extra["positions"][-1]
        low, high = np.transpose(region)
        inside = ((positions >= low) & (positions <= high)).all(axis=1)
        np.testing.assert_array_equal(np.stack([x, y], axis=1), positions[inside])
        assert 0 < inside.sum() < len(positions)

    def test_flow_goes_on_across_the_ends_of_the_box_that_nothing_closes(self, make_case):
        plates, sheared = {"walls": [Plates(axis="y")]}, {"shear_rate": 0.1}
        for rest, expected in (
            ({}, (True, True)),
            (plates, (True, False)),
            (sheared, (True, False)),
        ):
            assert Setting.of(make_case(SIZE, **rest), ("x", "y")).periodic == expected
        assert Setting.of(make_case((4, 4, 4), **plates), ("z", "x")).periodic == (True, True)

    def test_bins_inside_a_solid_stay_white(self):
        flow = exact((12, 10), lambda x, y: (np.where(abs(x - 6) < 2, np.nan, 1.0), 0 * y))
        from matplotlib.figure import Figure

        ax = Figure().subplots()
        speed.draw(ax, flow, Region((0.0, 0.0), (12.0, 10.0)), 1.0)
        shown = np.ma.getmaskarray(np.ma.masked_invalid(ax.images[0].get_array()))
        np.testing.assert_array_equal(shown, np.isnan(flow.speed).T)

    def test_colours_span_both_signs_of_vorticity_alike(self, rotation):
        case, results = rotation
        image = picture(case, results, kind="vorticity").axes[0].images[0]
        assert image.norm.vmin == -image.norm.vmax < 0


class TestNoise:
    """What shows a velocity is smoothed until it stands out of the noise, if anything does."""

    def noisy(self, size, noise):
        flow = exact(
            (48, 40), lambda x, y: (np.sin(2 * np.pi * y / size), 0 * x), size=(48.0, 40.0)
        )
        rng = np.random.default_rng(3)
        kicks, example = noise * rng.normal(size=(2, *flow.velocity.shape))
        return replace(flow, velocity=flow.velocity + kicks, noise=example)

    def test_a_clear_flow_stays_as_it_is(self):
        flow = self.noisy(20, 0.001)
        for panel in (vorticity, speed, quiver):
            assert smoothing([panel], [flow], Region((0.0, 0.0), flow.size)) == (0.0, True)

    def test_a_noisy_one_is_smoothed(self):
        flow = self.noisy(20, 0.3)
        region = Region((0.0, 0.0), flow.size)
        width, clear = smoothing([vorticity], [flow], region)
        assert clear and 0 < width <= 3
        y = np.arange(40) + 0.5
        expected = -2 * np.pi / 20 * np.cos(2 * np.pi * y / 20)
        found = vorticity_of(smooth(flow, width))[8:40, 5:35]
        assert np.std(found - expected[5:35]) < 0.5 * np.std(expected)
        assert np.std(vorticity_of(flow)[8:40, 5:35] - expected[5:35]) > np.std(expected)

    def test_so_is_a_map_of_its_speed(self):
        flow = self.noisy(20, 0.6)
        region = Region((0.0, 0.0), flow.size)
        width, clear = smoothing([speed], [flow], region)
        assert clear and 0 < width <= 3
        true = abs(np.sin(2 * np.pi * (np.arange(40) + 0.5) / 20))
        off = [np.std((f.speed - true)[8:40, 5:35]) for f in (flow, smooth(flow, width))]
        assert off[1] < 0.5 * off[0]

    def test_a_film_averages_until_there_is_a_flow(self):
        """A quarter of the frames at most; clear ones are shown as they are."""
        rng, region = np.random.default_rng(5), Region((0.0, 0.0), (48.0, 40.0))
        true = self.noisy(20, 0.0).velocity

        class Frames:
            def __init__(self, noise):
                self.kicks = noise * rng.normal(size=(64, *true.shape))

            def flow(self, frames):
                shape, few = true.shape, np.sqrt(len(frames))
                example = self.kicks.std() / few * rng.normal(size=shape)
                velocity = true + self.kicks[frames].mean(axis=0)
                return replace(exact(shape[:2], lambda x, y: (x, y)), velocity=velocity,
                               noise=example)  # fmt: skip

        numbers = [
            averaged([speed], Frames(noise), np.arange(64), region) for noise in (0.05, 0.2, 0.3, 9)
        ]
        assert numbers[0] == 1 and 1 < numbers[1] < numbers[2] < 16 and numbers[3] == 16
        assert averaged([speed], Frames(9), np.arange(3), region) == 1

    def test_noise_alone_is_said_to_be_noise(self, make_case):
        case = make_case((16, 16), observe=[FRAMES], density=5)
        results = results_of(case, 20, FakeFluid(case))
        texts = picture(case, results, kind="vorticity").texts
        note = " ".join(text.get_text() for text in texts)
        assert "noise" in note and "longer" in note

    def test_halves_of_the_frames_know_the_noise(self, make_case):
        case = make_case((16, 16), observe=[FlowFrames(window=10)], density=5)
        (source,) = sources(case, results_of(case, 40, FakeFluid(case)), None)
        for frames in (np.arange(40), np.array([3]), np.array([39])):
            flow = source.flow(frames)
            expected = np.sqrt(1 / (5 * len(frames)))
            assert np.nanstd(flow.noise) == pytest.approx(expected, rel=0.3)
            assert np.nanstd(flow.velocity) == pytest.approx(expected, rel=0.3)


class TestTrajectories:
    """Pictures of a run that kept only particles."""

    @pytest.fixture
    def reader(self, make_case, tmp_path):
        """A case, and its trajectory, of as many particles as wanted."""

        def make(fields=("position", "velocity"), subset=None, size=SIZE):
            from tests.helpers.known_flows import Rotating

            trajectory = Trajectory(every=10, fields=fields, subset=subset)
            case = make_case(size, trajectory=trajectory, density=20)
            fluid, writer = Rotating(case), TrajectoryWriter(trajectory, tmp_path, case.particles)
            for _ in range(5):
                fluid.jump(10)
                writer.record(fluid)
            h5md.write(tmp_path / "run.h5", case, {}, [], writer)
            return case, TrajectoryReader(tmp_path / "run.h5")

        return make

    @pytest.mark.parametrize("size", [SIZE, (12, 10, 4)])
    def test_they_give_velocity_density_and_particles(self, reader, size):
        case, frames = reader(size=size)
        (source,) = sources(case, {}, frames)
        flow = source.flow(np.arange(5))
        assert flow.density.mean() == pytest.approx(20)
        x, y = np.arange(12) + 0.5, np.arange(10) + 0.5
        assert abs(flow.velocity[..., 0] + SPIN * (y - 5)).max() < 0.3 * SPIN
        assert abs(flow.velocity[..., 1] - SPIN * (x - 6)[:, None]).max() < 0.3 * SPIN
        assert len(flow.particles) == case.particles
        assert len(picture(case, {}, frames).axes) == 6

    def test_part_of_the_particles_has_no_density(self, reader):
        case, frames = reader(subset=50)
        picture(case, {}, frames, kind="speed")
        with pytest.raises(RunError, match="needs densities, and the run kept none of them"):
            picture(case, {}, frames, kind="density")

    def test_positions_alone_have_no_velocity(self, reader):
        case, frames = reader(fields=("position",))
        picture(case, {}, frames, kind="particles")
        with pytest.raises(RunError, match=r'needs velocities.*quantity = "flow-frames"'):
            picture(case, {}, frames, kind="quiver")


class TestLooks:
    """That every kind is drawn, whatever the box."""

    @pytest.mark.parametrize("size", [(12, 10), (40, 6), (6, 40), (8, 6, 4)])
    @pytest.mark.parametrize("kind", OF_FLUIDS)
    def test_every_kind_of_every_shape(self, make_case, kind, size):
        case = make_case(size, observe=[FRAMES], walls=[Plates(axis="y")])
        figure = picture(case, results_of(case, 7), kind=kind)
        assert len(drawn(figure)) > 2000
        labels = [ax.get_xlabel() for ax in figure.axes] + [ax.get_ylabel() for ax in figure.axes]
        assert any("$x$" in label and "[$a$]" in label for label in labels)
        assert all(ax.get_aspect() == 1 for ax in figure.axes[: len(KINDS[kind])])

    def test_the_size_of_a_figure_fits_a_page(self, make_case):
        for size in ((12, 10), (300, 4), (4, 90)):
            case = make_case(size, observe=[FRAMES], density=2)
            width, height = picture(case, results_of(case, 5)).get_size_inches()
            assert width <= 8.3 and height <= 9

    def test_plates_are_drawn_beyond_the_end_of_the_box(self, make_case):
        case = make_case(SIZE, observe=[FRAMES], walls=[Plates(axis="y")])
        results = results_of(case, 5)
        low, high = picture(case, results, kind="speed").axes[0].get_ylim()
        assert low < 0 and high > 10
        inside = picture(case, results, kind="speed", region=((0, 12), (2, 6))).axes[0]
        assert inside.get_ylim() == (2, 6)

    @pytest.mark.parametrize("kind", OF_FLUIDS)
    def test_solids_are_drawn_over_every_panel(self, make_case, monkeypatch, kind):
        case = make_case(SIZE, observe=[FRAMES])
        results = results_of(case, 5)
        bare = drawn(picture(case, results, kind=kind))
        monkeypatch.setattr(solids, "solids_of", lambda case: Disk())
        figure = picture(case, results, kind=kind)
        assert drawn(figure) != bare
        for ax in figure.axes[: len(KINDS[kind])]:
            edges = [c for c in ax.collections if getattr(c, "levels", None) is not None]
            assert len(edges) >= 2
            outline = next(c for c in edges if len(c.levels) == 1).get_paths()[0].vertices
            radius = np.linalg.norm(outline - (6, 5), axis=1)
            np.testing.assert_allclose(radius, 3, atol=0.01)

    def test_in_3d_solids_are_cut_where_it_was_asked(self, make_case, monkeypatch):
        class Ball:
            def distance(self, points):
                return np.linalg.norm(points - (4, 4, 2), axis=1) - 2

        monkeypatch.setattr(solids, "solids_of", lambda case: Ball())
        case = make_case((8, 8, 8), observe=[FRAMES])
        results = results_of(case, 5)
        counts = [
            len(picture(case, results, kind="particles", at=at).axes[0].collections)
            for at in (None, 2.5, 7.0)
        ]
        assert counts == [0, 2, 0]  # the middle, z = 4, only touches it

    def test_in_3d_it_says_what_is_a_mean_and_what_a_cut(self, make_case):
        case = make_case((8, 8, 8), observe=[FRAMES], walls=[Plates(axis="y")])
        texts = [t.get_text() for t in picture(case, results_of(case, 5), kind="speed").texts]
        assert r"mean along $z$; solids at $z=4\,a$; mean of the run" in " ".join(texts)

    def test_maps_over_the_axes_in_the_other_order_are_turned(self, rotation):
        case, results = rotation
        images = [
            picture(case, results, kind=kind, axes=axes).axes[0].images[0].get_array()
            for kind in ("speed", "vorticity")
            for axes in (("x", "y"), ("y", "x"))
        ]
        np.testing.assert_allclose(images[0], images[1].T)
        assert images[3].mean() == pytest.approx(-images[2].mean(), rel=0.2)

    def test_a_notebook_shows_the_figure(self, rotation):
        case, results = rotation
        assert picture(case, results, kind="speed")._repr_png_()[:4] == b"\x89PNG"
        assert results["flow-frames"].plot()._repr_png_()[:4] == b"\x89PNG"

    @pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
    def test_it_is_saved_as_journals_take_it(self, rotation, tmp_path, ending):
        case, results = rotation
        path = save_figure(picture(case, results), tmp_path / f"four.{ending}")
        assert path.stat().st_size > 10_000


class TestRefusals:
    """What a picture cannot show, and the line that says so."""

    @pytest.mark.parametrize(
        ("choices", "words"),
        [
            ({"kind": "sped"}, "kind = 'sped': expected .*; did you mean 'speed'"),
            ({"region": ((0, 30), (0, 10))}, "x from 0 to 12 and y from 0 to 10"),
            ({"region": ((5, 5), (0, 10))}, "expected parts of the box"),
            ({"region": ((0, 12),)}, "expected \\(\\(x0, x1\\), \\(y0, y1\\)\\)"),
            ({"region": "all"}, "region = 'all': expected"),
            ({"region": ((2, 3), (0, 10))}, "at least 2 bins along each axis"),
            ({"window": (5, 3)}, "window = \\[5, 3\\]: expected the earlier time first"),
            ({"window": 5}, "window = 5: expected \\(t0, t1\\)"),
            ({"window": (900, 901)}, "no frame in it; there are 4, from t = "),
            ({"axes": ("x", "z")}, "axes = \\['x', 'z'\\]: expected two of x, y"),
            ({"at": 3}, "at = 3: a 2D box has no third axis"),
            ({"average": 3}, "average = 3: only of films; a picture has a window"),
        ],
    )
    def test_choices(self, rotation, choices, words):
        case, results = rotation
        with pytest.raises(CaseError, match=words) as error:
            picture(case, results, **({"kind": "speed"} | choices))
        assert "\n" not in str(error.value)

    def test_a_place_outside_the_box(self, make_case):
        case = make_case((8, 8, 8), observe=[FRAMES])
        with pytest.raises(CaseError, match="at = 9: expected a place along z, from 0 to 8"):
            picture(case, results_of(case, 5), kind="speed", at=9)

    def test_maps_over_other_axes(self, make_case):
        case = make_case((8, 8, 8), observe=[FRAMES])
        words = r'the run kept maps over x,y, not over x,z; .* axes = \["x", "z"\]'
        with pytest.raises(RunError, match=words):
            picture(case, results_of(case, 5), kind="vorticity", axes=("x", "z"))

    def test_runs_without_data_say_what_to_add(self, make_case):
        for kind in OF_FLUIDS:
            with pytest.raises(RunError, match='\\[\\[observe\\]\\] quantity = "flow-frames"'):
                picture(make_case(SIZE), {}, kind=kind)

    def test_maps_of_the_whole_run_have_no_window(self, make_case):
        case = make_case(SIZE, observe=MAPS)
        results = results_of(case)
        picture(case, results, kind="vorticity")
        with pytest.raises(RunError, match="in time, and the run kept only their mean over the"):
            picture(case, results, kind="vorticity", window=(0, 100))

    def test_regions_are_given_as_pairs_of_anything_like_a_number(self):
        region = region_of(np.array([[0, 2], [1, 3]]), ("x", "y"), (4.0, 4.0))
        assert region == Region((0.0, 1.0), (2.0, 3.0))
