"""Every observable has a figure that can be drawn, whatever the state of its data."""

from __future__ import annotations

import dataclasses
import io
import itertools

import numpy as np
import pytest
from rich.console import Console

from mesokit import Comparison, DynamicModuli, Forces, Stress, VelocityAutocorrelation, Wake
from mesokit.errors import RunError
from mesokit.method.mpcd.observe import OBSERVABLES as OF_MPCD
from mesokit.observe import OBSERVABLES as OF_SEVERAL
from mesokit.observe import Result
from mesokit.report import plot, print_comparisons, save, save_all
from mesokit.report.caption import MOST, compared, mathematics
from mesokit.report.finish.legend import legend_above
from tests.helpers.comparisons import by_name
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


def test_captions_keep_cautions_and_say_them_once():
    lines = compared(
        [
            Comparison("viscosity", 1.0, 0.1, 0.9, "a^2/tau", "error bar is a lower bound: short"),
            Comparison("time 1", 9.0, 0.1, 10.0, "tau", "approximate: Rouse" + 20 * "!"),
            Comparison("time 2", 8.0, 0.1, 10.0, "tau", "approximate: Rouse" + 20 * "!"),
            Comparison("slope", 1.0, 0.1, 1.0, "", "independent of slip"),
        ],
        6.4,
    ).splitlines()
    assert lines[0].endswith("(theory 0.9, at most +1.0 s.e.; error bar is a lower bound: short)")
    assert lines[1].endswith("(theory 10, -10 %; approximate)") and "tau$" in lines[1]
    assert lines[3].endswith("+0.0 s.e.)") and lines[4] == "approximate: Rouse" + 20 * "!"


def test_captions_are_short_and_fit_the_figure():
    one = Comparison("drag coefficient", 1.0, 0.1, note="U = 0.5 a/tau, " + 20 * "long ")
    lines = compared([one], 6.4).splitlines()
    assert len(lines) == 2 and max(map(len, lines)) < 110 and r"$a/\tau$" in lines[0]
    many = [Comparison(f"share {i}", 1.0, 0.1) for i in range(MOST + 3)]
    assert compared(many, 6.4).splitlines()[-1] == "and 3 more, which mesokit info shows"


@pytest.mark.parametrize("text", ["velocity v_x", "N sqrt(m kT)", "exp(-t/tau_p)", "0.2(1) a/tau"])
def test_formulas_in_words_are_set_as_formulas(text):
    from matplotlib.mathtext import MathTextParser

    drawn = mathematics(text)
    assert drawn.count("$") == 2 and mathematics(drawn) == drawn
    MathTextParser("path").parse(drawn)


def test_momentum_of_a_driven_flow_has_its_theory(make_case):
    """And a number of particles that stays needs no panel."""
    from mesokit import Conservation, Plates, Uniform
    from mesokit.method.mpcd.expected.setting import transport

    case = make_case((12, 10), [Conservation()], [Plates("y")], force=Uniform([0.01, 0]))
    accumulator, fluid = Conservation().accumulator(case), FakeFluid(case)
    for _ in range(5):
        fluid.advance(1)
        accumulator.observe(fluid)
    result = accumulator.result()
    nu, mass = transport(case).viscosity, case.particles * case.fluid.mass
    np.testing.assert_allclose(result.expected[:, 1], mass * 0.01 * 10**2 / (12 * nu), rtol=1e-12)
    np.testing.assert_allclose(result.expected[:, 2], 0, atol=1e-12)
    figure = plot(result)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(labels) == 3 and "the flow" in labels[2]
    assert labels[0].startswith("momentum") and not labels[0].startswith("momentum\nchange")
    assert f"$N = {case.particles}$" in figure.axes[0].get_title("left")
    assert figure.axes[0].get_legend().get_texts()[-1].get_text() == "theory"


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


def energies(time):
    """A conservation result with rounding errors of momentum, and energies that cancel."""
    names = ["number", "momentum_x", "momentum_y", "potential_energy", "kinetic_energy"]
    swing = 3 * np.sin(time)
    value = np.stack(
        [0 * time + 900, 2e-10 * time, -1e-10 * time, 50 + swing, 850 - swing, 1 + 0.01 * swing],
        axis=1,
    )
    still = np.where(np.arange(6) < 3, value[0], np.nan * value)
    units = {n: "m a^2/tau^2" if "energy" in n else "m a/tau" for n in names}
    return Result(
        "conservation", "conservation",
        {"time": time, "component": np.array([*names, "temperature"])}, value, np.nan * value,
        "conserved quantities",
        units | {"value": "", "time": "tau", "number": "", "temperature": "m a^2/tau^2"},
        expected=still, samples=len(time),
        extra={"conserves_momentum": 1, "conserves_energy": 1}, drawing="series",
    )  # fmt: skip


def test_conserved_quantities_with_a_potential_have_their_total():
    """And no label runs into another or out of the figure."""
    figure = plot(energies(np.linspace(0, 20, 60)))
    figure.draw_without_rendering()
    labels = [ax.yaxis.label.get_window_extent() for ax in figure.axes]
    assert len(labels) == 4
    for above, below in itertools.pairwise(labels):
        assert not above.overlaps(below)
    assert all(box.x0 >= 0 and box.y0 >= 0 and box.y1 <= figure.bbox.y1 for box in labels)
    parts, total = figure.axes[1:3]
    assert [text.get_text() for text in parts.get_legend().get_texts()] == ["kinetic", "potential"]
    assert "total" in total.get_ylabel() and r"m\,a/\tau" in figure.axes[0].get_ylabel()
    np.testing.assert_allclose(total.lines[-1].get_ydata(), 0, atol=1e-12)
    assert list(total.lines[0].get_ydata()) == [0, 0] and len(total.lines[-1].get_ydata()) == 60


def test_energy_that_is_not_conserved_has_no_change_since_a_chance_sample():
    time = np.linspace(0, 20, 60)
    driven = dataclasses.replace(energies(time), extra={"conserves_momentum": 0})
    total = plot(driven).axes[2]
    np.testing.assert_allclose(total.lines[-1].get_ydata(), 1.0)
    assert "of a particle" in total.get_ylabel()


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


def test_what_is_not_known_of_molecules_has_no_panel():
    """Under shear the centre along the flow."""
    names = np.array(["gyration", "x", "vx"])
    value = np.random.default_rng(2).normal(size=(30, 2, 3))
    value[..., 1] = np.nan
    result = Result(
        "molecule-tracks", "tracks",
        {"time": np.arange(30.0), "molecule": np.arange(2), "component": names}, value,
        np.nan * value, "molecules", {"time": "tau", "gyration": "a", "x": "a", "vx": "a/tau"},
        samples=30, extra={"axis": "x", "ideal_gyration": np.nan}, drawing="tracks",
    )  # fmt: skip
    labels = [ax.get_ylabel() for ax in plot(result).axes]
    assert len(labels) == 2 and not any("centre" in label for label in labels)


def test_frames_and_the_map_of_their_mean_are_drawn_once(make_case):
    from mesokit.report.figures import drawn_once
    from tests.helpers.known_flows import FRAMES, MAPS, results_of

    case = make_case((6, 6), observe=[FRAMES, *MAPS])
    results = results_of(case, 6)
    assert [r.name for r in drawn_once(results.values())] == ["velocity-field", "density-field"]
    del results["velocity-field"]
    assert [r.name for r in drawn_once(results.values())] == ["flow-frames", "density-field"]


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


@pytest.mark.parametrize("drawing", ["displacement", "flow"])
def test_labels_are_no_longer_than_their_axes(drawing):
    if drawing == "flow":
        time = np.linspace(0, 20, 60)
        flow = {"conserves_momentum": 0, "driven": True}
        figure = plot(dataclasses.replace(energies(time), extra=flow))
    else:
        time = np.array([0.0, 1.0, 10.0])
        figure = plot(Result(
            "mean-square-displacement", "d", {"time": time}, 4 * time, 0.1 * time,
            "mean square displacement", {"value": "length^2", "time": "time"}, expected=4 * time,
            comparisons=5 * (Comparison("diffusion coefficient", 1.0, 0.1),),
            drawing="displacement", extra={"components": "xy"},
        ))  # fmt: skip
    figure.draw_without_rendering()
    for ax in figure.axes:
        assert ax.yaxis.label.get_window_extent().height <= ax.bbox.height


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
