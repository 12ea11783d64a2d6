"""Pictures of studies: points, theory between them, axes, legends and figures for papers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mesokit import Study
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.seam.result import Comparison
from mesokit.study.axes import Axis
from mesokit.study.plot import plot
from mesokit.study.table import Pooled
from tests.helpers.studies import FORCE, said


def test_pictures(study):
    """Points with error bars, theory, and a fit that finds what the data say."""
    from mesokit.study.dependence import Curve, fitted

    figure = study.plot("acceleration", "flow-rate.mean", fit="line")
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels[1] == "each run" and labels[3] == "theory of the steady flow, not reached"
    assert labels[2].startswith("fit: $y = ") and labels[0].startswith("3 runs pooled")
    assert figure._supxlabel.get_text() == "not steady at all points" and len(labels) == 4
    assert figure.axes[0].get_xlabel() == r"acceleration $g$  [$a/\tau^2$]"
    [dots] = [line for line in figure.axes[0].lines if line.get_label() == "each run"]
    row = study.table()[-1]
    wanted = [run.files["flow-rate"]["mean velocity"].measured for run in study.runs]
    assert sorted(dots.get_ydata()) == pytest.approx(sorted(wanted)) and len(row.each) == 3
    x = np.array([1.0, 2.0, 4.0, 8.0])
    curve = Curve("", x, 3 * x**-0.5, 0.01 * x, np.full(4, np.nan))
    found = fitted(curve, "power")
    assert found.fit.coefficients == pytest.approx([np.log(3), -0.5])
    assert found.formula.startswith("y = 3.00") and " x^-0.500(" in found.formula
    assert r"\,x^{-0.500(" in found.legend
    assert found(x) == pytest.approx(3 * x**-0.5)
    [line] = study.fit("acceleration", "flow-rate.mean", "line")
    assert line.formula.replace(" x", r"\,x") in labels[2]
    with pytest.raises(CaseError, match=r"density: not varied; expected 'acceleration'"):
        study.plot("density", "flow-rate.mean")
    with pytest.raises(CaseError, match=r"did you mean 'flow-rate\.mean-velocity"):
        study.plot("acceleration", "flow-rate.man-velocity-along-x")
    with pytest.raises(CaseError, match=r"fit = 'cubic': expected 'line' or 'power'"):
        study.plot("acceleration", "flow-rate.mean", fit="cubic")


@pytest.mark.parametrize(("log", "power", "joined"), [
    (False, 1, True), (True, 2, True), (False, 2, False), (True, 0, True), (False, 0, True),
])  # fmt: skip
def test_theory_is_drawn_between_points_where_it_is_straight(log, power, joined):
    """Elsewhere straight pieces would be what no theory says."""
    from mesokit.study.dependence import Curve, Theory, draw

    x = np.array([1.0, 2.0, 4.0, 8.0])
    curve = Curve("", x, 3 * x**power, 0.1 * x, 3 * x**power)
    ax = draw([curve], ("x", ""), ("y", ""), log=log).axes[0]
    [theory] = [line for line in ax.lines if line.get_label().startswith("theory")]
    assert (theory.get_label() == "theory") == joined and (theory.get_marker() == "None") == joined
    dense = Theory(np.linspace(1, 8, 50), np.linspace(1, 8, 50) ** power)
    asked = []
    curve = curve._replace(between=lambda log: asked.append(log) or dense)
    ax = draw([curve], ("x", ""), ("y", ""), log=log).axes[0]
    [theory] = [line for line in ax.lines if line.get_label() == "theory"]
    assert (len(theory.get_xdata()) == 50) != joined and asked == [log] * (not joined)


def test_theory_has_gaps_where_there_is_none():
    from mesokit.study.dependence import Curve, draw

    x = np.arange(1.0, 7.0)
    for expected in ([0.8, 0.8, np.nan, np.nan, 0.5, np.nan], [1, 1, np.nan, 1, 1, 1]):
        curve = Curve("", x, x, 0.1 * x, np.array(expected))
        ax = draw([curve], ("x", ""), ("y", "")).axes[0]
        drawn = [line for line in ax.lines if line.get_color() == "black"]
        np.testing.assert_array_equal(drawn[0].get_ydata(), expected)
        np.testing.assert_array_equal(drawn[1].get_ydata(), [0.5] * (expected[0] == 0.8))


def test_theory_is_dashed_where_alone_it_is_approximate():
    from mesokit.study.dependence import Curve, Theory, draw

    x, fine = np.array([1.0, 2.0, 3.0, 4.0]), np.linspace(1, 4, 31)
    rough = np.array([False, False, True, True])
    curve = Curve("", x, x**2, 0.5 * x, x**2, rough=rough, between=lambda _: Theory(fine, fine**2))
    ax = draw([curve], ("x", ""), ("y", "")).axes[0]
    lines = {str(line.get_label()): line for line in ax.lines}
    for label, low, high, dash in (("theory", 1, 2, "-"), ("theory, approximate", 2, 4, "--")):
        seen = fine[np.isfinite(lines[label].get_ydata())]
        assert (seen[0], seen[-1]) == pytest.approx((low, high))
        assert lines[label].get_linestyle() == dash
    ax = draw([curve._replace(rough=np.ones(4, bool))], ("x", ""), ("y", "")).axes[0]
    assert "theory" not in [text.get_text() for text in ax.get_legend().get_texts()]


@pytest.mark.parametrize("error", [0.001, 1.0])
def test_deviations_that_symbols_hide_have_a_panel(error):
    """Of points without theory, and of what is not steady, there is no ratio."""
    from mesokit.study.dependence import Curve, draw

    x = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    expected = np.array([1, 2, np.nan, 4, 5])
    curve = Curve("", x, 1.01 * x, 0 * x + error, expected, steady=x != 4)
    axes = draw([curve], ("x", ""), ("y", "")).axes
    assert len(axes) == 1 + (error < 0.1) and axes[-1].get_xlabel() == "$x$"
    if len(axes) > 1:
        [points] = axes[1].containers
        ratio = points.lines[0].get_ydata()
        np.testing.assert_allclose(ratio, [1.01, 1.01, np.nan, np.nan, 1.01])


@pytest.mark.parametrize(("x", "y", "scales"), [
    ([1.0, 2.0, 4.0], [1.0, 2.0, 4.0], ("log", "linear")),  # a geometric list
    ([0.02, 0.0437344, 0.0956352], [0.001, 0.01, 0.1], ("log", "log")),
    ([0.02, 0.0437344, 0.0956352], [-0.001, 0.01, 0.1], ("log", "linear")),
    ([0.5, 1.4, 2.3, 3.2, 4.1, 5.0], [1.0, 2.0, 4.0, 8.0, 16.0, 32.0], ("linear", "linear")),
    ([1.0, 10.0], [1.0, 10.0], ("linear", "linear")),  # two points have any ratio
])  # fmt: skip
def test_axes_are_logarithmic_where_values_are_geometric(x, y, scales):
    from mesokit.study.dependence import Curve, draw

    x, y = np.array(x), np.array(y)
    curve = Curve("", x, y, 0.01 * abs(y), np.full(len(x), np.nan))
    ax = draw([curve], ("x", ""), ("y", "")).axes[0]
    assert (ax.get_xscale(), ax.get_yscale()) == scales
    for log, wanted in (("x", ("log", "linear")), (False, ("linear", "linear"))):
        ax = draw([curve], ("x", ""), ("y", ""), log=log).axes[0]
        assert (ax.get_xscale(), ax.get_yscale()) == wanted
    with pytest.raises(CaseError, match="log = 'z': expected x, y or x,y"):
        draw([curve], ("x", ""), ("y", ""), log="z")
    with pytest.raises(CaseError, match="log = 'y': -1 is among its values; expected all above 0"):
        draw([curve._replace(value=-np.ones(len(x)))], ("x", ""), ("y", ""), log="x,y")


def test_wild_and_undetermined_points_do_not_set_the_axis():
    from mesokit.study.dependence import Curve, draw

    x = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    value = np.array([2e4, 1.1, np.nan, 0.9, 1.0])
    error = np.array([3e4, 0.1, np.nan, 0.2, 0.1])
    ax = draw([Curve("", x, value, error, np.full(5, 0.8))], ("x", ""), ("y", "")).axes[0]
    low, high = ax.get_ylim()
    assert 0.6 < low < 0.7 and 1.2 < high < 1.3
    notes = ax.figure._supxlabel.get_text().splitlines()
    assert notes == ["undetermined at 3", "error bar beyond the axis: 2.0(30)e+04 at 1"]
    calm = draw([Curve("", x, value, 0.01 * error, value)], ("x", ""), ("y", "")).axes[0]
    assert calm.get_ylim()[1] > 2e4  # a number that is known well is shown


def test_theory_is_evaluated_between_points(case_file, tmp_path, here):
    """That of cases which were not run, also where keys change together."""
    case = tmp_path / "c.toml"
    case.write_text(f'{case_file.read_text()}\n[[observe]]\nquantity = "conservation"\n')
    linked = {("fluid.timestep", "run.steps"): [(0.1, 60), (0.4, 30), (1.6, 20)]}
    study = Study(case, linked, seeds=2, output=tmp_path / "s")
    study.run()
    rows = [row for row in study.table() if row.key == "viscosity-from-curvature"]
    theory = study.theory_between(rows, study.axes[0].keys, True)
    assert len(theory.x) == 3 + 2 * 20
    assert theory.x[1] == pytest.approx(0.1 * 4 ** (1 / 21))
    for timestep, expected in zip(theory.x, theory.expected, strict=True):
        made = study.base.case({"fluid.timestep": float(timestep)}, 1)
        assert expected == pytest.approx(setting.transport(made).viscosity)
    figure = study.plot("timestep", "velocity-profile.viscosity")
    [line] = [line for line in figure.axes[0].lines if len(line.get_xdata()) == len(theory.x)]
    assert line.get_label().startswith("theory")


def test_several_numbers_in_one_picture(study):
    """Each has points and a name of its own; two units have no common axis."""
    names = [row.name for row in study.table() if row.number.unit == "a/tau"][:2]
    both = ",".join(names)
    ax = study.plot("acceleration", both).axes[0]
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    whats = [next(row.number.what for row in study.table() if row.name == n) for n in names]
    for what in whats:
        assert any(label.startswith(what) for label in labels), labels
    together = " and ".join(whats)
    assert ax.get_ylabel().replace("\n", " ").startswith(together if len(together) < 45 else "[")
    picture = study.save_picture("acceleration", both)
    assert picture.name.startswith("-and-".join(names))
    other = next(row.name for row in study.table() if row.number.unit == "a^2/tau")
    with pytest.raises(CaseError, match=r"is in 'a/tau' and .* in 'a\^2/tau'; expected numbers of"):
        study.plot("acceleration", f"{names[0]},{other}")


def test_figures_for_a_paper(study, tmp_path, capsys):
    """A study is drawn again in another form and width, as a run is."""
    figure = study.plot("acceleration", "flow-rate.mean", width=3.1)
    assert figure.get_size_inches()[0] == pytest.approx(3.1)
    [legend] = [figure.axes[0].get_legend()]
    figure.canvas.draw()
    assert legend.get_window_extent().y0 >= figure.axes[0].bbox.y1 - 3  # above, not on the data
    code, out, _ = said(capsys, "plot", study.path, "--format", "svg", "--width", 3.1)
    files = [Path(line) for line in out.splitlines()]
    assert code == 0 and len(files) > 3 and all(b"<svg" in file.read_bytes() for file in files)
    for file in files:
        assert file.parent == study.path and "-against-acceleration" in file.name
        file.unlink()
    one = tmp_path / "one.pdf"
    y = ["--y", "flow-rate.mean", "--fit", "line"]
    code, out, _ = said(capsys, "plot", study.path, *y, "--output", one)
    assert code == 0 and out.startswith("fit: y = ") and one.read_bytes()[:4] == b"%PDF"
    run = study.runs[0].path
    for arguments, words in (
        ([study.path, "--result", "flow-rate"], "--result: only of a run"),
        ([study.path, "--region", "0:2,0:2"], "--region: only of a run"),
        ([study.path, "--output", one], "there are many pictures; add --y"),
        ([study.path, "--fit", "line"], "--fit: of which number? add --y"),
        ([run, "--y", "flow-rate.mean"], "--y: only of a study"),
    ):
        code, _, err = said(capsys, "plot", *arguments)
        assert code == 2 and words in err, err


def test_legends_say_what_theory_is_in_the_words_of_the_field():
    note = "independent of slip; error bar is a lower bound: short"
    numbers = [Comparison("viscosity", 0.5 * k, 0.1, 0.6 * k**2, "a^2/tau", note) for k in (1, 2)]
    rows = [
        Pooled({FORCE: 0.1 * c.expected}, "velocity-profile", "viscosity", c, (c,), 1, 0.1, None)
        for c in numbers
    ]
    axes = [Axis.parse(f"{FORCE}=0.06,0.24")]
    figure = plot(rows, axes, FORCE, "velocity-profile.viscosity")
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels[-1].startswith("theory, independent of slip")
    assert figure._supxlabel.get_text() == "error bar is a lower bound at all points"
