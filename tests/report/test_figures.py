"""Every observable has a figure that can be drawn, whatever the state of its data."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import DynamicModuli, Forces, Stress, VelocityAutocorrelation, Wake
from mesokit.errors import RunError
from mesokit.method.mpcd.observe import OBSERVABLES as OF_MPCD
from mesokit.observe import OBSERVABLES as OF_SEVERAL
from mesokit.report import plot, save, save_all
from mesokit.report.caption import mathematics
from tests.helpers.fake_fluid import FakeFluid, case_for, taken

OBSERVABLES = [kind for kind in (*OF_SEVERAL, *OF_MPCD) if not kind.methods]  # those of fluids


def result_of(kind, make_case, samples):
    observable = kind()
    case = case_for(observable, make_case, (4, 6, 4))
    accumulator, fluid = observable.accumulator(case), FakeFluid(case)
    rng = np.random.default_rng(1)
    for _ in range(samples):
        fluid.advance(observable.every)
        fluid.stress = {n: rng.normal(size=(3, 3)) for n in ("kinetic", "collisional")}
        fluid.hit_walls(taken(case, rng), 10)
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
        assert mathematics(result.comparisons[0].what) in figure._supxlabel.get_text()


@pytest.mark.filterwarnings("ignore::UserWarning:matplotlib")
@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize("kind", OBSERVABLES)
def test_short_runs_can_be_drawn(kind, samples, make_case):
    plot(result_of(kind, make_case, samples)).draw_without_rendering()


@pytest.mark.parametrize("kind", OBSERVABLES)
def test_it_draws_into_given_axes(kind, make_case):
    from matplotlib.figure import Figure

    figure = Figure()
    ax = figure.subplots()
    assert result_of(kind, make_case, 5).plot(ax) is ax
    assert ax.has_data() or ax.texts  # that nothing has happened


@pytest.mark.parametrize("kind", (Stress, DynamicModuli, Forces, VelocityAutocorrelation, Wake))
def test_two_results_in_the_same_axes_can_be_told_apart(kind, make_case):
    from matplotlib.figure import Figure

    ax, result = Figure().subplots(), result_of(kind, make_case, 5)
    for name in ("first", "second"):
        result.plot(ax, label=name)
    texts = ax.get_legend_handles_labels()[1]
    assert any(t.startswith("first") for t in texts)
    assert any(t.startswith("second") for t in texts)
    assert len(texts) == len(set(texts)) and "measured" not in " ".join(texts)


def test_colours_of_results_in_the_same_axes(make_case):
    from matplotlib.colors import to_hex
    from matplotlib.figure import Figure

    from mesokit import VelocityProfile

    result, ax = result_of(VelocityProfile, make_case, 5), Figure().subplots()
    result.plot(ax)
    seen = ax.get_ylim()
    result.plot(ax, label="other")
    result.plot(ax, label="mine", colour="#123456")
    colours = [to_hex(c.lines[0].get_color()) for c in ax.containers]
    assert len(set(colours)) == 3 and colours[2] == "#123456"
    assert ax.get_ylim()[0] <= seen[0] and ax.get_ylim()[1] >= seen[1]
    texts = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "mine" in texts and "other" in texts
    assert sum(text.startswith("theory") for text in texts) <= 1
    with pytest.raises(ValueError, match="give ax"):
        result.plot(label="alone")


def test_runs_without_samples_have_no_figure(make_case, tmp_path):
    results = [result_of(kind, make_case, 0) for kind in OBSERVABLES]
    assert save_all(results, tmp_path) == []


def test_the_legend_of_a_tensor_hides_no_data(make_case):
    from mesokit import WallStress

    figure = plot(result_of(WallStress, make_case, 40))
    figure.canvas.draw()
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert len(texts) == len(set(texts)) and "theory" in texts
    for ax in figure.axes:
        assert ax.get_legend() is None
        assert legend.get_window_extent().y0 > ax.get_window_extent().y1


@pytest.mark.parametrize(("width", "columns"), [(6.4, 4), (3.4, 1)])
def test_error_bars_of_a_tensor_are_named_once_in_a_legend_that_fits(make_case, width, columns):
    figure = plot(result_of(Stress, make_case, 30), width=width)
    (legend,) = figure.legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert sum("standard error" in text for text in texts) == 1 and texts[-1].startswith("theory")
    assert legend._ncols >= columns and legend.get_window_extent().width <= figure.bbox.width


def test_wrong_ending_and_missing_folder(make_case, tmp_path):
    result = result_of(OBSERVABLES[0], make_case, 5)
    with pytest.raises(RunError, match="choose one of"):
        save(result, tmp_path / "figure.xyz")
    with pytest.raises(RunError, match="cannot write"):
        save(result, tmp_path / "nowhere" / "figure.png")
