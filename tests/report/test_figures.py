"""Every observable has a figure that can be drawn, whatever the state of its data."""

from __future__ import annotations

import io

import numpy as np
import pytest
from fake_fluid import FakeFluid, case_for, taken
from rich.console import Console

from mesokit.errors import RunError
from mesokit.observe import OBSERVABLES, Comparison, Result
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
    from mesokit.observe import WallStress

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
