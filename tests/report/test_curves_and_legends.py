"""Data, theory and legends of figures: they can be told apart and read."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import Comparison, Forces
from mesokit.observe import Result
from mesokit.report import plot
from mesokit.report.finish.legend import legend_above
from tests.helpers.comparisons import by_name
from tests.helpers.fake_fluid import FakeFluid


def test_plates_have_panels_of_their_own_and_no_torques(make_case):
    from mesokit import Disk, Plates

    walls = [Plates(axis="y"), Disk(centre=[8, 4], radius=1.5, name="post")]
    forces = Forces(length=3, speed=0.5, flow="x")
    case = make_case((16, 8), [forces], walls)
    accumulator, fluid = forces.accumulator(case), FakeFluid(case)
    for _ in range(5):
        fluid.hit_walls([[1, -900, 7], [1, 900, 7], [2, 1, 3]], 1)
        fluid.advance(1)
        accumulator.observe(fluid)
    result = accumulator.result()
    *panels, in_time = plot(result).axes
    solids = [[label.get_text() for label in ax.get_xticklabels()] for ax in panels]
    assert solids == 2 * [["post"]] + 2 * [["plates-1-lower", "plates-1-upper"]]
    assert panels[1].get_title("left").startswith("(b) torque")
    assert panels[1].get_title("left").endswith("about (8, 4)")
    assert "post" in in_time.get_ylabel()
    (right,) = in_time.child_axes  # the coefficient of the same force
    drag = by_name(result)["drag coefficient of post"].measured
    assert right._functions[0](result.value[2, 0]) == pytest.approx(drag)


def test_a_mode_that_has_reached_noise_ends_with_its_theory():
    lag = np.arange(6.0)
    value = np.array([1, 0.5, 0.2, 0.01, 0.3, 0.01])[:, None]
    result = Result(
        "normal-modes", "modes", {"time": lag, "mode": np.array([1])}, value, 0.05 + 0 * value,
        "mode", {"value": "", "time": "tau"}, expected=np.exp(-lag[:, None]), samples=9,
        theory="Rouse, exp(-t/tau_p)", drawing="normal modes",
    )  # fmt: skip
    ax = plot(result).axes[0]
    theory = next(line for line in ax.lines if line.get_label().startswith("theory"))
    assert list(theory.get_xdata()) == [0, 1, 2] and r"e^{-t/\tau_p}" in theory.get_label()


@pytest.mark.parametrize(("known", "drawn"), [(1.0, False), (1.2, True)])
def test_a_displacement_shows_the_better_theory_of_its_diffusion(known, drawn):
    """Molecular chaos is the curve; where the number below knows more, a line does too."""
    time = np.array([0.0, 1.0, 10.0, 100.0])
    found = Comparison("diffusion coefficient", 1.2, 0.01, known, "a^2/tau", "approximate: more")
    result = Result(
        "mean-square-displacement", "d", {"time": time}, 6 * 1.2 * time, 0.1 * time,
        "mean square displacement", {"value": "a^2", "time": "tau"}, expected=6 * time,
        fit=6 * 1.2 * time, theory="molecular chaos, approximate", comparisons=(found,),
        drawing="displacement", extra={"components": "xyz"},
    )  # fmt: skip
    upper, lower = plot(result).axes
    [*lines] = [line for line in upper.lines if line.get_label().startswith("theory: diffusion")]
    assert len(lines) == drawn and "chaos" in lower.get_ylabel()
    for line in lines:
        np.testing.assert_allclose(line.get_ydata(), 6 * known * line.get_xdata())


def test_a_displacement_without_a_curve_shows_the_diffusion_of_theory():
    time = np.array([0.0, 1, 10, 100])
    result = Result(
        "mean-square-displacement", "d", {"time": time}, 6 * time, 0.1 * time,
        "mean square displacement of centres of mass", {"value": "a^2", "time": "tau"},
        fit=np.where(time >= 10, 6 * time, np.nan), samples=9, extra={"components": "xyz"},
        comparisons=(Comparison("diffusion coefficient", 1.0, 0.1, 1.5, "a^2/tau"),),
        drawing="displacement",
    )  # fmt: skip
    ax = plot(result).axes[0]
    line = next(line for line in ax.lines if line.get_label().startswith("theory"))
    np.testing.assert_allclose(line.get_ydata(), 9 * line.get_xdata())
    assert "\n" not in ax.get_ylabel()


def test_a_legend_above_is_no_wider_than_its_axes():
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    ax = figure.subplots()
    for name in ("theory: Taylor-Couette, no slip", "measured, one standard error", "fit"):
        ax.plot([0, 1], label=name)
    legend_above(ax)
    figure.draw_without_rendering()
    assert ax.get_legend().get_window_extent().x1 <= figure.bbox.x1
    assert ax.bbox.width > 0.8 * figure.bbox.width


def test_theory_of_what_has_names_is_a_mark_for_each():
    """No line joins names, and no name stands beyond the frame."""
    names = np.array(["virial", "collision rate"])
    result = Result(
        quantity="equation-of-state", name="z", x={"by": names}, value=np.array([4.1, 4.2]),
        error=np.full(2, 0.1), label="Z", units={"value": "", "by": ""}, expected=np.full(2, 4.15),
        theory="virial series", comparisons=(), samples=9,
    )  # fmt: skip
    (ax,) = plot(result).axes
    (theory,) = (line for line in ax.lines if "virial series" in str(line.get_label()))
    assert theory.get_linestyle() == "None" and theory.get_marker() == "_"
    assert ax.get_xlim() == (-0.5, 1.5)


def test_theory_of_several_curves_says_which_it_is_of():
    time = np.arange(3.0)
    value = np.stack([1 - 0.2 * time, 0.5 - 0.1 * time], axis=1)
    result = Result(
        "bond-correlation", "bonds", {"time": time, "component": np.array(["xx", "xy"])}, value,
        0.1 + 0 * value, "bond correlation", {"value": "a^2"}, expected=value, theory="Rouse",
        samples=9,
    )  # fmt: skip
    lines = [x for x in plot(result).axes[0].lines if x.get_label().startswith("theory")]
    assert [x.get_label() for x in lines] == ["theory: Rouse, xx", "theory: Rouse, xy"]
    assert lines[0].get_linestyle() != lines[1].get_linestyle()


@pytest.mark.parametrize("lasted", [[2.0], [3.0, 3.0]])
def test_events_of_one_duration_are_one_bar(lasted):
    """Not one that is too thin to be seen, about a time that no axis can show."""
    from mesokit.method.mpcd.observe.shared.events import Durations

    events = Durations()
    for time in range(64):
        events.look(time)
    events.add(60.0, np.array(lasted), np.arange(len(lasted)))
    edges, density, _ = events.histogram()
    assert len(density) == 1 and density[0] * np.diff(edges)[0] == pytest.approx(1)
    assert 0.05 < np.diff(edges)[0] / lasted[0] < 0.2


def test_colours_differ_in_grey_and_are_dark_on_white():
    from mesokit.report.style import COLOURS

    def lightness(colour):  # CIELAB, from 0 to 100
        rgb = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        return 116 * float(linear @ [0.2126, 0.7152, 0.0722]) ** (1 / 3) - 16

    found = sorted(map(lightness, COLOURS))
    assert min(np.diff(found)) > 6 and found[-1] < 63


def test_noise_about_a_constant_fills_half_of_the_panel():
    x = np.arange(20) + 0.5
    value = 7.0 + 0.02 * np.cos(x)
    result = Result(
        "density-profile", "density-profile", {"y": x}, value, np.full(20, 0.004), "density",
        {"value": "", "y": "a"}, expected=np.full(20, 7.0), samples=9, drawing="profile",
    )  # fmt: skip
    low, high = plot(result).axes[0].get_ylim()
    assert 0.4 < np.ptp(value) / (high - low) < 0.8


@pytest.mark.parametrize(("number", "low"), [(2, True), (12, False)])
def test_few_numbers_fill_no_page(number, low):
    from mesokit.report.style import HEIGHT

    x = np.array([f"part {k}" for k in range(number)])
    value = np.ones(number)
    result = Result("q", "q", {"by": x}, value, 0.1 * value, "pressure", {"value": ""}, samples=9)
    figure = plot(result)
    assert (figure.get_figheight() < 0.7 * HEIGHT) == low
    assert figure.axes[0].get_xlabel() == ""


def test_entries_of_a_legend_read_in_rows_with_theory_last():
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.0, 3.0), layout="constrained")
    ax = figure.subplots()
    ax.plot([0, 1], label="theory: Rouse")
    names = ["kinetic", "collisional", "bond", "total"]
    for name in names:
        ax.errorbar([0, 1], [0, 1], [0.1, 0.1], label=name)
    legend_above(ax)
    figure.draw_without_rendering()
    places = {
        t.get_text(): t.get_transform().transform((0, 0)) for t in ax.get_legend().get_texts()
    }
    seen = sorted(places, key=lambda name: (-round(places[name][1]), places[name][0]))
    assert seen == [*names, "theory: Rouse"]
    assert 1 < len({round(y) for _, y in places.values()}) < 5


def test_a_part_of_a_stress_whose_theory_is_approximate_is_dashed():
    parts, axes = np.array(["kinetic", "total"]), np.array(["x", "y"])
    expected = np.array([[[np.nan, 0.1], [0.1, np.nan]], [[np.nan, 1.0], [1.0, np.nan]]])
    result = Result(
        "stress", "stress", {"part": parts, "i": axes, "j": axes}, 1.1 * np.nan_to_num(expected),
        np.full((2, 2, 2), 0.1), "stress", {"value": "m/tau^2"}, expected=expected, samples=9,
        drawing="tensor", comparisons=(
            Comparison("viscosity from the stress", 1.1, 0.1, 1.0),
            Comparison("kinetic part from the stress", 0.11, 0.01, 0.1, note="approximate: chaos"),
        ),
    )  # fmt: skip
    ax = plot(result).axes[0]
    lines = {str(line.get_label()): line for line in ax.collections}
    assert [segment[0][1] for segment in lines["theory"].get_segments()] == [1.0]
    assert [segment[0][1] for segment in lines["theory, approximate"].get_segments()] == [0.1]
