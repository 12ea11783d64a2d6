"""Every observable has a figure that can be drawn, whatever the state of its data."""

from __future__ import annotations

import io

import numpy as np
import pytest
from fake_fluid import FakeFluid, case_for, taken
from rich.console import Console

from mesokit import Comparison
from mesokit.errors import RunError
from mesokit.observe import OBSERVABLES, Result
from mesokit.report import plot, print_comparisons, save, save_all


def result_of(kind, make_case, samples):
    observable = kind()
    case = case_for(observable, make_case, (4, 6, 4))
    accumulator, fluid = observable.accumulator(case), FakeFluid(case)
    rng = np.random.default_rng(1)
    for _ in range(samples):
        fluid.advance(observable.every)
        fluid.stress = {n: rng.normal(size=(3, 3)) for n in ("kinetic", "collisional")}
        fluid.wall_impulse, fluid.wall_steps = taken(case, rng), 10
        accumulator.observe(fluid)
    return accumulator.result()


@pytest.mark.parametrize("kind", OBSERVABLES)
def test_every_observable_has_a_figure(kind, make_case, tmp_path):
    result = result_of(kind, make_case, 30)
    path = save(result, tmp_path / "figure.png")
    assert path.read_bytes()[:4] == b"\x89PNG" and path.stat().st_size > 5000
    figure = plot(result)
    axis = figure.axes[0]
    assert axis.get_xlabel() or figure.axes[-1].get_xlabel() or axis.get_xticklabels()
    if result.comparisons:
        assert result.comparisons[0].what in figure._supxlabel.get_text()


@pytest.mark.filterwarnings("ignore::UserWarning:matplotlib")
@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize("kind", OBSERVABLES)
def test_short_runs_can_be_drawn(kind, samples, make_case):
    plot(result_of(kind, make_case, samples)).savefig(io.BytesIO(), dpi=20)


@pytest.mark.parametrize("kind", OBSERVABLES)
def test_it_draws_into_given_axes(kind, make_case):
    from matplotlib.figure import Figure

    figure = Figure()
    ax = figure.subplots()
    assert result_of(kind, make_case, 5).plot(ax) is figure
    assert ax.has_data()


def test_runs_without_samples_have_no_figure(make_case, tmp_path):
    results = [result_of(kind, make_case, 0) for kind in OBSERVABLES]
    assert save_all(results, tmp_path) == []


def test_the_legend_of_a_tensor_hides_no_data(make_case):
    from mesokit import WallStress

    figure = plot(result_of(WallStress, make_case, 40))
    figure.canvas.draw()
    for ax in figure.axes:
        assert ax.get_legend().get_window_extent().y1 < ax.get_window_extent().y0


def test_wrong_ending_and_missing_folder(make_case, tmp_path):
    result = result_of(OBSERVABLES[0], make_case, 5)
    with pytest.raises(RunError, match="choose one of"):
        save(result, tmp_path / "figure.xyz")
    with pytest.raises(RunError, match="cannot write"):
        save(result, tmp_path / "nowhere" / "figure.png")


COMPARED = Result(
    "stress", "mine", {}, np.array(0.88), np.array(0.01), "stress", {"value": ""},
    comparisons=(
        Comparison("viscosity", 0.88, 0.01, 0.87, "a^2/tau"),
        Comparison("drift", 0.0, 0.0, 0.0),
        Comparison("far off", 2.0, 0.1, 1.0),
    ),
)  # fmt: skip


def test_comparisons_are_plain_lines_in_a_file():
    out = io.StringIO()
    print_comparisons([COMPARED], Console(file=out, width=40))
    lines = out.getvalue().splitlines()
    assert lines[0] == (
        "mine: viscosity: 0.880(10) a^2/tau, expected 0.8700: +1.0 standard errors, +1.1 %"
    )
    assert lines[1] == "mine: drift: 0, expected 0"
    assert len(lines) == 3


def test_comparisons_are_a_table_on_a_terminal():
    out = io.StringIO()
    print_comparisons([COMPARED], Console(file=out, width=120, force_terminal=True))
    assert "measured" in out.getvalue() and "+1.0 s.e. (+1.1 %)" in out.getvalue()
    assert "\x1b[1;33m" in out.getvalue()  # the one that is far off stands out
    print_comparisons([], Console(file=out))


def test_plates_have_panels_of_their_own_and_no_torques(make_case):
    from mesokit import Disk, Forces, Plates

    walls = [Plates(axis="y"), Disk(centre=[8, 4], radius=1.5, name="post")]
    case = make_case((16, 8), [Forces()], walls)
    accumulator, fluid = Forces().accumulator(case), FakeFluid(case)
    for _ in range(5):
        fluid.wall_impulse, fluid.wall_steps = np.array([[1, -900, 7], [1, 900, 7], [2, 1, 3]]), 1
        fluid.advance(1)
        accumulator.observe(fluid)
    figure = plot(accumulator.result())
    panels = [ax for ax in figure.axes if ax.axison]
    solids = [[label.get_text() for label in ax.get_xticklabels()] for ax in panels]
    assert solids == 3 * [["post"]] + 2 * [["plates-1-lower", "plates-1-upper"]]
    assert panels[2].get_title().endswith("about (8, 4)")


class TestMaps:
    """The pictures that a run draws of its maps."""

    def results(self, make_case):
        from flows import FRAMES, MAPS, results_of

        from mesokit import Disk, Plates

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
