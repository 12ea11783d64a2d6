"""Studies: runs that are those of their cases, a table, pictures, stops."""

from __future__ import annotations

import contextlib
import csv
import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import mesokit
from mesokit import Study
from mesokit.cli import main
from mesokit.errors import CaseError, RunError
from mesokit.method.mpcd.expected import setting
from mesokit.seam.result import Comparison
from mesokit.study import local
from mesokit.study.axes import Axis
from mesokit.study.drive import StudyReporter
from mesokit.study.plot import plot
from mesokit.study.table import Pooled

FORCE = "fluid.force.acceleration"
EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "studies"
LONG = 300  # seconds after which a test has failed


def said(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main([str(a) for a in arguments])
    out = capsys.readouterr()
    return int(end.value.code or 0), out.out, out.err


@pytest.fixture(scope="module")
def study(case_file, tmp_path_factory) -> Study:
    """Two forces, three seeds, two at once; the flow has not built up, and is weak."""
    output = tmp_path_factory.mktemp("studies") / "study"
    study = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=3, output=output)
    study.run(jobs=2)
    return study


def test_runs_are_those_of_their_cases(study, case_file):
    """Each to the bit, in a folder as any run has it."""
    assert study.ended and len(study) == 6
    for run in (study.runs[0], study.runs[-1]):
        case = mesokit.Case.from_toml(case_file, {FORCE: run.point[FORCE], "run.seed": run.seed})
        alone = mesokit.Simulation(case, threads=2)
        alone.run()
        assert mesokit.open(run.path).results == alone.results
        assert mesokit.open(run.path).provenance["resumed"] == []
    assert not list(study.path.rglob(".progress*"))


def test_what_has_ended_is_not_repeated(study, monkeypatch, case_file):
    """Nor when the study is opened, made again, or made larger."""
    before = {path: path.stat().st_mtime_ns for path in study.path.rglob("run.h5")}
    record = (study.path / "study.toml").read_text()

    def nobody(*given):
        raise AssertionError("a run was handed out")

    with monkeypatch.context() as patch:
        patch.setattr(local.Processes, "submit", nobody)
        study.run()
        Study.open(study.path).run()
    larger = Study(case_file, {FORCE: [0.02, 0.04, 0.06]}, seeds=3, output=study.path)
    assert [run.ended for run in larger.runs] == [True] * 6 + [False] * 3
    assert {path: path.stat().st_mtime_ns for path in study.path.rglob("run.h5")} == before
    with pytest.raises(RunError, match=r"holds a study with other runs, such as runs.acc.*=0\.06"):
        Study(case_file, {FORCE: [0.02, 0.04]}, seeds=3, output=study.path)
    for path in study.path.glob("runs/*=0.06"):
        shutil.rmtree(path)
    (study.path / "study.toml").write_text(record)  # as it was


def test_table_pools_the_seeds(study, tmp_path):
    rows = {(row.point[FORCE], row.name): row for row in study.table()}
    merged = mesokit.merge([run.path for run in study.runs[3:]], tmp_path / "merged")
    assert {(point, name) for point, name in rows if point == 0.04} == {
        (0.04, name) for name in merged.comparisons()
    }
    for name, number in merged.comparisons().items():  # ratios are those of all samples
        assert rows[0.04, name].number == number, name
    row = rows[0.04, "flow-rate.mean-velocity-along-x"]
    each = [
        mesokit.open(run.path)["flow-rate"]["mean velocity"]
        for run in study.runs
        if run.point[FORCE] == 0.04
    ]
    values, errors = np.array([(c.measured, c.error) for c in each]).T
    assert row.runs == 3 and row.each == tuple(each)
    assert row.number.measured == pytest.approx(values.mean())
    assert row.scatter == pytest.approx(values.std(ddof=1) / np.sqrt(3))
    assert row.seeds.dof == 2
    least = np.average(values, weights=1 / errors**2)
    assert row.seeds.chi2 == pytest.approx((((values - least) / errors) ** 2).sum())
    pandas = pytest.importorskip("pandas")
    frame = study.to_dataframe()
    with open(study.to_csv(tmp_path / "t.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(frame) == len(lines) == len(rows)
    assert float(lines[0][FORCE]) == 0.02 and lines[0]["result"] == "velocity-profile"
    assert [float(line["measured"]) for line in lines] == list(frame["measured"])
    assert "" in {line["deviation"] for line in lines}  # no theory yet: the flow had not built up
    assert "nan" not in {text for line in lines for text in line.values()}
    again = pandas.read_csv(tmp_path / "t.csv")
    numbers = ["measured", "error", "expected", "deviation", "percent", "scatter", "chi2", "p"]
    pandas.testing.assert_frame_equal(again[numbers], frame[numbers])


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


def test_another_case_in_its_place_is_refused(study, case_file, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(case_file.read_text().replace("density = 9.52", "density = 5"))
    with pytest.raises(RunError, match=r"holds a run with fluid\.density = 9\.52, not 5"):
        Study(other, {FORCE: [0.02, 0.04]}, seeds=3, output=study.path)


def test_runs_become_longer(case_file, tmp_path, study, here):
    """A study that is made again with more steps goes on; to fewer it cannot come."""
    first = Study(case_file, output=tmp_path / "s", settings={"run.steps": 60})
    first.run()
    longer = Study(case_file, output=tmp_path / "s")
    assert not longer.ended and not longer.runs[0].files.ended
    longer.run()
    assert longer.runs[0].files.results == study.runs[0].files.results
    assert "steps = 120" in longer.runs[0].files.provenance["case"]
    with pytest.raises(RunError, match=r"run\.steps = 120, which cannot be 60"):
        Study(case_file, output=tmp_path / "s", settings={"run.steps": 60})


def test_a_folder_that_was_removed_is_made_again(case_file, tmp_path, here):
    made = Study(case_file, output=tmp_path / "s", settings={"run.steps": 30})
    shutil.rmtree(made.runs[0].path)
    Study.open(tmp_path / "s").run()
    assert made.ended


def test_bad_values_make_no_folder(case_file, tmp_path):
    with pytest.raises(CaseError, match=r"with fluid\.density = -1: fluid\.density = -1"):
        Study(case_file, {"fluid.density": [5, -1]}, output=tmp_path / "s")
    with pytest.raises(CaseError, match="did you mean 'density'"):
        Study(case_file, {"fluid.densty": [5]}, output=tmp_path / "s")
    assert not (tmp_path / "s").exists()
    with pytest.raises(CaseError, match="seeds = 0: expected how many"):
        Study(case_file, seeds=0, output=tmp_path / "s")


def test_one_that_fails_does_not_stop_the_others(case_file, tmp_path, capsys):
    study = Study(case_file, {FORCE: [5000.0, 0.02]}, output=tmp_path / "s")
    told: list[int] = []

    class Watching(StudyReporter):
        def update(self, step: int) -> None:
            told.append(step)

    with pytest.raises(RunError, match=r"acceleration=5000/seed=5: .*particle moves at"):
        study.run(jobs=1, progress=Watching(quiet=True))
    one = 130 * sum(group.number for group in study.runs[0].files.case.groups)
    assert one <= max(told) < 2 * one  # the one that failed has not been carried to its end
    assert [run.ended for run in study.runs] == [False, True]
    code, out, err = said(capsys, "study", study.path, "--jobs", 1)
    assert code == 1 and "flow-rate: mean velocity" in out and "table:" in out
    assert "particle moves at" in err
    assert "particle moves at" in study.runs[0].failed
    assert len(study.table()) > 0


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


def test_info_prints_the_pooled_numbers(study, capsys):
    code, out, _ = said(capsys, "info", study.path)
    assert code == 0 and "6 of 6 runs have ended" in out
    assert all(line in out.splitlines() for line in study.lines())
    record = json.loads(said(capsys, "info", study.path, "--json")[1])
    assert record["varied"] == {FORCE: [0.02, 0.04]} and len(record["numbers"]) == len(
        study.table()
    )


def test_a_list_of_runs_writes_nothing(case_file, tmp_path, capsys, monkeypatch):
    """So that a later study of other settings finds no folder in its way."""
    monkeypatch.chdir(tmp_path)
    vary = ["study", case_file, "--vary", f"{FORCE}=0.01:0.03:5"]
    code, out, _ = said(capsys, *vary, "--set", "run.warmup=40", "--list")
    assert code == 0 and out.count("not begun") == 5 and not list(tmp_path.iterdir())
    with pytest.raises(CaseError, match=r"with .*acceleration = 1e\+400|acceleration = inf"):
        Study(case_file, {FORCE: [0.01, float("inf")]}, output="s", write=False)
    study = Study(case_file, {FORCE: [0.01, 0.03]}, output="s", write=False)
    assert [run.state for run in study.runs] == ["not begun"] * 2 and not Path("s").exists()
    monkeypatch.setattr("mesokit.study.study.drive", lambda runs, *rest: [])
    study.run()
    assert Study.open("s").keys == [FORCE] and all(run.files.case for run in study.runs)
    code, out, _ = said(capsys, *vary, "--list", "--output", "s")
    assert code == 0 and len(list(Path("s/runs").iterdir())) == 2


def test_study_files_and_the_command(case_file, tmp_path, capsys, monkeypatch, here):
    monkeypatch.chdir(tmp_path)
    text = f'case = "{case_file.as_posix()}"\nseeds = [5]\n[set]\n"run.steps" = 60\n'
    Path("forces.toml").write_text(f'{text}[[vary]]\n"{FORCE}" = "0.02:0.04:2"\n')
    code, out, _ = said(capsys, "study", "forces.toml", "--list")
    assert code == 0 and out.count("not begun") == 2 and "acceleration=0.04" in out
    code, out, _ = said(capsys, "study", "forces.toml", "--only", 2)
    assert code == 0 and said(capsys, "study", "forces", "--list")[1].count("ended") == 1
    code, out, err = said(capsys, "study", "forces", "--jobs", 1)
    assert code == 0 and "study: 2 of 2 runs" in err
    assert "acceleration = 0.04 (1 run)" in out and "table: forces" in out
    assert Path("forces/flow-rate.mean-velocity-along-x-against-acceleration.png").exists()
    assert Study.open("forces").runs[0].files.case.run.steps == 60
    y = "flow-rate.mean-velocity"
    code, out, _ = said(capsys, "study", "forces", "--y", y, "--fit", "line", "--quiet")
    assert (
        code == 0 and "fit: y = " in out and "mean-velocity-along-x-against-acceleration.png" in out
    )
    code, out, _ = said(capsys, "study", "forces", "--job-array", "--threads", 2)
    script = Path("forces/job-array.sh").read_text()
    assert "--array=1-2" in script and "--cpus-per-task=2" in script
    assert subprocess.run(["bash", "-n", "forces/job-array.sh"]).returncode == 0
    for arguments, words in (
        (["forces", "--seeds", 2], "--seeds: only with a case file"),
        (["forces", "--only", 3], "--only 3: the study has 2 runs"),
        (["forces", "--fit", "line"], "--fit: of which number?"),
        (["forces", "--y", "flow-rat.mean"], "expected 'velocity-profile' or 'flow-rate'"),
        (["forces", "--x", "nix", "--y", y], "nix: not varied; expected 'acceleration'"),
        ([tmp_path / "nowhere"], "no such file"),
    ):
        code, _, err = said(capsys, "study", *arguments)
        assert code == 2 and words in err and "\n" not in err.strip(), err


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_can_be_run(file, tmp_path):
    study = Study.open(file, output=tmp_path / "s")
    assert len(study) > 1 and not any("average over the start" in w for w in study.warnings())


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("seeds = 2", "case = None: expected the name of a case file"),
        ('case = "c.toml"\nsead = 2', "sead: unknown key; did you mean 'seeds'"),
        ('case = "c.toml"\nvary = 3', r"expected \[\[vary\]\], in double brackets"),
        ('case = "nowhere.toml"', "nowhere.toml: no such file"),
        ('case = "c.toml"\nset = "steps"', r"s.toml: set = 'steps': expected a table \[set\]"),
        ('case = "c.toml"\nfolder = [1]', r"s.toml: folder = \[1\]: expected the name of a folder"),
        ('case = "c.toml"\nseeds = 5_000_000', "s.toml: seeds = 5000000: expected at most 100000"),
        ('case = "c.toml"\n[set]\nbox = 2', "s.toml: box = 2: expected a table"),
        ('case = "c.toml"\n[set]\nrun = "a"', "s.toml: run = 'a': expected a table, with seed"),
        ('case = "c.toml"\n[[vary]]\nrun = [2]', "s.toml: with run = 2: run = 2: expected a table"),
        (
            'case = "c.toml"\n[[vary]]\n"run.seed" = [2]',
            "vary run.seed: expected seeds of the study",
        ),
    ],
)
def test_poor_study_files(case_file, tmp_path, text, words):
    (tmp_path / "c.toml").write_text(case_file.read_text())
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises((CaseError, RunError), match=words):
        Study.open(tmp_path / "s.toml")


def test_settings_of_a_study_file_need_no_quotes(case_file, tmp_path):
    """They replace values of a table, not the table."""
    (tmp_path / "c.toml").write_text(case_file.read_text())
    (tmp_path / "s.toml").write_text('case = "c.toml"\n[set]\nrun.steps = 30\nfluid.density = 7')
    case = Study.open(tmp_path / "s.toml", tmp_path / "s").runs[0].files.case
    assert (case.run.steps, case.run.warmup, case.fluid.density) == (30, 10, 7)
    assert Study.open(tmp_path / "s").base.case({}, 5) == case


def test_runs_of_a_study_have_a_bound(case_file, tmp_path):
    """It is looked at before lists are made."""
    with pytest.raises(CaseError, match=r"seeds = 1000000000000: expected at most 100000"):
        Study(case_file, seeds=10**12, output=tmp_path / "s")
    vary = {"fluid.density": "1:2:1000", "fluid.timestep": "0.1:0.2:1000"}
    with pytest.raises(CaseError, match=r"1000000 runs: expected at most 100000 in a study"):
        Study(case_file, vary, output=tmp_path / "s")
    assert not (tmp_path / "s").exists()


def test_seeds_of_one_case(case_file, tmp_path, capsys, here):
    """`run --seeds` runs them, and shows what they say as one."""
    output = tmp_path / "seeds"
    steps = ["--set", "run.steps=60"]
    code, out, err = said(capsys, "run", case_file, "--seeds", 2, "--output", output, *steps)
    assert code == 0 and "mean velocity along x" in out
    assert "study: 2 of 2 runs to do" in err
    again = ["run", case_file, "--seeds", 2, "--output", output, "--overwrite"]
    code, _, err = said(capsys, *again)
    assert code == 2 and f"to begin anew, remove the folder {output}, or choose another" in err
    merged = mesokit.open(output / "runs" / "merged")
    assert merged["flow-rate"].samples == 14
    assert [entry["seed"] for entry in merged.provenance["merged"]] == [5, 6]


def test_progress_is_told_once(capsys):
    """Not again where nothing has changed, as while figures are drawn."""
    reporter = StudyReporter(seconds=0.0)
    reporter.runs = 3
    reporter.start(100, 1, "study")
    reporter.began = 0.0
    for ended in (0, 0, 0, 1, 1):
        reporter.ended, reporter.next = ended, 0.0
        reporter.update(100)
    lines = capsys.readouterr().err.splitlines()
    what = "runs have ended, the last results and figures are being written"
    assert lines == [
        "study: 3 of 3 runs to do",
        *(f"study: 100 %, {n} of 3 {what}" for n in (0, 1)),
    ]


def begun(study: Path, number: int, process: subprocess.Popen[str]) -> list[Path]:
    """Waits until so many runs have gone some steps."""
    end = time.monotonic() + LONG
    while time.monotonic() < end:
        found = [path for path in study.rglob(".progress") if int(path.read_text() or 0) > 50]
        if len(found) >= number:
            return [path.parent for path in found]
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.05)
            raise AssertionError("it ended too early")
    raise AssertionError("no run has begun")


def start(case_file: Path, output: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "mesokit", "study", str(case_file), "--seeds", "2"]
    command += ["--set", "run.steps=60000", "--output", str(output), "--jobs", "2"]
    return subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_stopped_study_goes_on(case_file, tmp_path, study):
    """Runs in hand end at a checkpoint; the status says which signal it was."""
    process = start(case_file, tmp_path / "s")
    runs = begun(tmp_path / "s", 2, process)
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=LONG)
    assert process.returncode == 143, err
    assert "stopped by SIGTERM: 0 of 2 runs have ended; go on with: mesokit study" in err
    for run in runs:
        files = mesokit.open(run)
        assert not files.ended and files.results["flow-rate"].samples > 1
    assert not list(tmp_path.rglob(".progress"))


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_runs_do_not_outlive_a_study_that_is_killed(case_file, tmp_path, study):
    """When nobody is there to ask them, workers end their runs at a checkpoint."""
    process = start(case_file, tmp_path / "s")
    runs = begun(tmp_path / "s", 2, process)
    process.kill()
    process.communicate(timeout=LONG)
    end = time.monotonic() + LONG
    while list((tmp_path / "s").rglob(".progress")):
        assert time.monotonic() < end
    for run in runs:
        assert not mesokit.open(run).ended and (run / "checkpoint.npz").exists()


def test_parts_of_a_script_run_in_its_own_process(case_file, tmp_path, monkeypatch):
    from mesokit.study import study as module

    monkeypatch.setattr(module, "outside_parts", lambda case: [{"class": "__main__:Mine"}])
    made = Study(case_file, seeds=2, output=tmp_path / "s", settings={"run.steps": 30})
    with pytest.raises(CaseError, match="put them into a module"):
        made.run(jobs=2)
    monkeypatch.setattr(local.Processes, "submit", None)
    made.run()
    assert made.ended


def test_dask(case_file, tmp_path, study):
    """The same bits by way of a cluster of Dask on this machine."""
    other = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=1, output=tmp_path / "s")
    other.run(jobs=2, cluster="local")
    assert [run.files.results for run in other.runs] == [
        run.files.results for run in study.runs if run.seed == 5
    ]


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
