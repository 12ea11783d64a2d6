"""Maps with the solids of their case, and snapshots of particles."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit.observe import Result
from mesokit.report import plot


def snapshots_in(width, height):
    """A result of two looks into a box of that size."""
    seen = np.zeros((2, 4, 4))
    return Result(
        quantity="snapshots",
        drawing="snapshots",
        name="snapshots",
        x={"step": np.array([0, 1]), "particle": np.arange(4), "component": np.array(list("xyuv"))},
        value=seen,
        error=np.full(seen.shape, np.nan),
        label="positions and velocities",
        units={"value": "", "position": "a", "velocity": "a/tau", "time": "tau"},
        samples=2,
        extra={
            "time": np.array([0.0, 0.1]),
            "species": np.array([0, 0, 1, 1]),
            "size": np.array([width, height], float),
        },
    )


@pytest.mark.parametrize(("width", "height"), [(40, 20), (20, 20), (10, 15)])
def test_snapshots_have_the_shape_of_the_box(width, height):
    figure = plot(snapshots_in(width, height))
    figure.draw_without_rendering()
    places, velocities = figure.axes[0], figure.axes[2]
    for ax, ratio in ((places, height / width), (velocities, 1.0)):
        shown = ax.get_window_extent()
        assert shown.height / shown.width == pytest.approx(ratio, abs=0.06)
        whole = ax.get_position(original=True)  # the room of the panel is filled
        assert shown.height > 0.8 * whole.height * figure.bbox.height


def test_species_of_snapshots_are_named_and_times_have_units():
    figure = plot(snapshots_in(4, 4))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["species 1", "species 2"]
    assert [ax.get_title() for ax in figure.axes[:2]] == [
        r"0 steps, $t = 0\,\tau$",
        r"1 step, $t = 0.1\,\tau$",
    ]


class TestMaps:
    """The pictures that a run draws of its maps."""

    def results(self, make_case):
        from mesokit import Disk, Plates
        from tests.helpers.known_flows import FRAMES, MAPS, results_of

        walls = [Plates(axis="y"), Disk(centre=[6, 5], radius=2)]
        case = make_case((24, 10), [FRAMES, *MAPS], walls, density=20)
        return case, results_of(case)

    def test_the_case_adds_the_solids_and_the_page_is_cut_to_the_panels(self, make_case):
        case, results = self.results(make_case)
        for result in results.values():
            bare, full = plot(result), plot(result, case=case)
            assert full.axes[0].get_ylim()[0] < 0 and bare.axes[0].get_ylim() == (0, 10)
            outlines = [c for c in full.axes[0].collections if hasattr(c, "levels")]
            assert len(outlines) == 2
            width, height = full.get_size_inches()
            filled = sum(ax.get_position().height for ax in full.axes if ax.get_xlim()[1] > 20)
            assert filled > 0.5 and width <= 8.3 and height < 5

    def test_a_bin_that_is_mostly_solid_sets_no_colours(self, make_case):
        case, results = self.results(make_case)
        result = results["velocity-field"]
        share = case_share(case)
        cut = np.argwhere((share > 0) & (share < 0.5))[0]
        result.value[tuple(cut)] = 50.0
        image = plot(result, case=case).axes[0].images[0]
        assert image.norm.vmax < 5

    def test_density_is_that_of_the_open_part_and_names_its_dimension(self, make_case):
        case, results = self.results(make_case)
        result, share = results["density-field"], case_share(case)
        result.value[:] = 20 * share
        figure = plot(result, case=case)
        shown = np.ma.masked_invalid(figure.axes[0].images[0].get_array())
        np.testing.assert_allclose(shown.compressed(), 20)
        assert shown.mask.T[6, 5] and figure.axes[0].images[0].get_cmap().name == "cividis"
        labels = [ax.get_ylabel() for ax in figure.axes]
        assert any("[$a^{-2}$]" in label for label in labels)
        result.value[:] = np.where(share == 1, 20 + np.arange(10) / 10, 0)
        image = plot(result).axes[0].images[0]
        assert image.norm.vmin > 15 and np.ma.masked_invalid(image.get_array()).mask.any()


def case_share(case):
    from mesokit.geometry.solids.solids import solids_of

    return solids_of(case).open_share((0, 1), tuple(case.box.size[:2]))


def test_frames_and_the_map_of_their_mean_are_drawn_once(make_case):
    from mesokit.report.figures import drawn_once
    from tests.helpers.known_flows import FRAMES, MAPS, results_of

    case = make_case((6, 6), observe=[FRAMES, *MAPS])
    results = results_of(case, 6)
    assert [r.name for r in drawn_once(results.values())] == ["velocity-field", "density-field"]
    del results["velocity-field"]
    assert [r.name for r in drawn_once(results.values())] == ["flow-frames", "density-field"]
