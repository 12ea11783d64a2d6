"""The command line: what it writes, what it says, and how it ends."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

from mesokit.case.case import Case
from mesokit.case.methods import studies, templates
from mesokit.cli.commands import COMMANDS
from mesokit.study.study import Study
from tests.helpers.commands import SMALL, Captured, ends, refusal


@pytest.fixture(autouse=True)
def folder(empty_folder: Path) -> Path:
    """Work in an empty folder."""
    return empty_folder


FAR = '[{ quantity = "mean-square-displacement", components = ["x"], max_lag = 90_000 }]'


class TestNew:
    """`mesokit new`."""

    @pytest.mark.parametrize("name", templates())
    def test_writes_a_case_that_passes_the_check(self, name: str, capsys: Captured) -> None:
        assert ends("new", name) == 0
        assert f"mesokit run {name}.toml" in capsys.readouterr().out
        assert ends("check", f"{name}.toml") == 0
        assert "warning" not in capsys.readouterr().out

    def test_writes_a_template_under_another_name(self) -> None:
        assert ends("new", "mine", "--template", "couette") == 0
        text = Path("mine.toml").read_text()
        assert "mesokit run mine.toml" in text
        assert Case.from_toml("mine.toml").title == "Couette flow"

    def test_never_overwrites(self, capsys: Captured) -> None:
        Path("bulk.toml").write_text("mine")
        assert "bulk.toml: exists already" in refusal(capsys, "new", "bulk")
        assert Path("bulk.toml").read_text() == "mine"

    def test_suggests_a_template(self, capsys: Captured) -> None:
        assert "did you mean 'poiseuille'?" in refusal(capsys, "new", "poiseuile")
        assert not list(Path().iterdir())

    def test_says_where_it_cannot_write(self, capsys: Captured) -> None:
        assert "nowhere/bulk.toml: no such file" in refusal(capsys, "new", "nowhere/bulk")


class TestCheck:
    """`mesokit check`."""

    def test_shows_the_resolved_case_and_what_follows(self, capsys: Captured) -> None:
        ends("new", "poiseuille")
        capsys.readouterr()
        assert ends("check", "poiseuille.toml", "--threads", "1") == 0
        out = capsys.readouterr().out
        for words in ("grid_shift = 1.0", "0.7584 a^2/tau", "Reynolds", "Mach", "1 thread,"):
            assert words in out

    def test_what_it_shows_is_a_case(self, capsys: Captured) -> None:
        ends("new", "couette")
        capsys.readouterr()
        ends("check", "couette.toml")
        Path("shown.toml").write_text(capsys.readouterr().out.split("\nparticles")[0])
        assert Case.from_toml("shown.toml") == Case.from_toml("couette.toml")

    @pytest.mark.parametrize(
        ("settings", "words"),
        [
            ({"fluid.force.acceleration": "[0.01, 0]"}, "Mach number"),
            ({"fluid.collision.angle": "2.27"}, "2.27 rad is 130.06"),
            ({"fluid.grid_shift": "0"}, "Galilean"),
            ({"fluid.grid_shift": "0"}, "theory needs the full grid shift"),
            ({"fluid.thermostat.rule": "rescale"}, "reads up to 1.6 % cold"),
            ({"observe.velocity-profile.component": "y"}, "the flow is along x"),
            ({"fluid.timestep": "2"}, "mean free path is 2 cells"),
            ({"fluid.density": "2"}, "below 3"),
            ({"fluid.density": "5", "fluid.timestep": "0.5"}, "fluctuations"),
            ({"fluid.thermostat.rule": "none"}, "friction raises the temperature"),
            ({"wall": "[]"}, "speeds up for ever"),
            ({"fluid.force.acceleration": "[0, 0.1]"}, "presses the fluid"),
            ({"run.warmup": "10"}, "run.warmup = 10"),
            ({"run.steps": "5"}, "takes one sample, of the start"),
            ({"observe": FAR}, "observe[#1].max_lag = 90000: more than run.steps"),
            ({"run.steps": "500"}, "one frame, of a window cut short"),
            ({"observe": "[]"}, "no [[observe]]"),
            ({"trajectory": "{ every = 1 }", "run.steps": "10_000_000"}, "trajectory takes about"),
            ({"box.size": "[200_000, 1_000]", "observe": "[]"}, "memory"),
        ],
    )
    def test_warns(self, settings: dict[str, str], words: str, capsys: Captured) -> None:
        ends("new", "poiseuille")
        capsys.readouterr()
        options = [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]
        assert ends("check", "poiseuille.toml", *options) == 0
        warnings = [s for s in capsys.readouterr().out.splitlines() if s.startswith("warning: ")]
        assert any(words in warning for warning in warnings), warnings

    def test_missing_file(self, capsys: Captured) -> None:
        ends("new", "poiseuille")
        message = refusal(capsys, "check", "poisseuille.toml")
        assert "poisseuille.toml: no such file; did you mean 'poiseuille.toml'?" in message

    def test_folder_for_a_file(self, capsys: Captured) -> None:
        Path("case").mkdir()
        assert "case" in refusal(capsys, "check", "case")

    def test_not_text(self, capsys: Captured) -> None:
        Path("case.toml").write_bytes(b"title = '\xff'")
        assert "byte 9: not UTF-8" in refusal(capsys, "check", "case.toml")


class TestRun:
    """`mesokit run`, up to the point where the run starts."""

    @pytest.fixture(autouse=True)
    def case(self) -> None:
        Path("case.toml").write_text(SMALL)

    @pytest.mark.parametrize(
        ("options", "words"),
        [
            (["--set", "fluid.density"], "--set fluid.density: expected key=value"),
            (["--set", "fluid.densty=3"], "fluid.densty: unknown key; did you mean 'density'?"),
            (["--threads", "0"], "--threads"),
            (["--threads", "many"], "--threads"),
            (["--seed", "-1"], "--seed"),
            (["--outptu", "x"], "--output"),
        ],
    )
    def test_wrong_options(self, options: list[str], words: str, capsys: Captured) -> None:
        assert words in refusal(capsys, "run", "case.toml", *options)
        assert [p.name for p in Path().iterdir()] == ["case.toml"]

    def test_refuses_a_folder_with_other_files(self, capsys: Captured) -> None:
        Path("case").mkdir()
        Path("case/thesis.tex").write_text("precious")
        for options in ([], ["--overwrite"]):
            assert "thesis.tex" in refusal(capsys, "run", "case.toml", *options)
        assert Path("case/thesis.tex").read_text() == "precious"

    def test_refuses_a_file_for_a_folder(self, capsys: Captured) -> None:
        Path("out").write_text("precious")
        assert "out" in refusal(capsys, "run", "case.toml", "--output", "out")
        assert Path("out").read_text() == "precious"

    def test_refuses_an_earlier_run_unless_told(self, capsys: Captured) -> None:
        Path("case").mkdir()
        Path("case/case.toml").write_text(SMALL)
        message = refusal(capsys, "run", "case.toml")
        assert "resume" in message
        assert "--overwrite" in message
        assert Path("case/case.toml").read_text() == SMALL


@pytest.mark.parametrize("command", ["resume", "plot", "info"])
def test_commands_on_a_run_need_one(command: str, capsys: Captured) -> None:
    assert "nowhere: no such folder" in refusal(capsys, command, "nowhere")
    Path("empty").mkdir()
    assert "empty: " in refusal(capsys, command, "empty")


def test_help_and_mistyped_commands(capsys: Captured) -> None:
    assert ends("--help") == 0
    assert "_MESOKIT_COMPLETE" in capsys.readouterr().out
    assert ends() == 2
    assert "Usage" in capsys.readouterr().out
    assert "chekc" in refusal(capsys, "chekc")


@pytest.mark.parametrize(
    ("observed", "words"),
    [
        ((1,), "; samples of density, up to every step, may add much to it"),
        ((19, 2), "; samples of 2 observables, up to every 2 steps, may add much to it"),
        ((20, 50), ""),
        ((), ""),
    ],
)
def test_frequent_samples_are_said_to_add_to_the_run_time(observed, words, capsys, tmp_path):
    tables = [
        f'[[observe]]\nquantity = "density-profile"\naxis = "y"\nevery = {every}\n'
        f'name = "density{i or ""}"\n'
        for i, every in enumerate(observed)
    ]
    case = tmp_path / "case.toml"
    case.write_text("[run]\nsteps = 100\n[box]\nsize = [8, 8]\n[fluid]\n" + "".join(tables))
    assert ends("check", str(case)) == 0
    (line,) = [row for row in capsys.readouterr().out.splitlines() if row.startswith("run time")]
    assert line.endswith(words) and ("may add" in line) == bool(words)


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_options_without_bounds_names_none(command: str, capsys: Captured) -> None:
    assert ends(command, "--help") == 0
    said = capsys.readouterr().out
    assert "None" not in said
    if command == "plot":
        assert "--at FLOAT  " in said and "[2<=x<=20]" in said


class TestNewStudies:
    """`mesokit new studies/NAME`."""

    @pytest.mark.parametrize("name", studies())
    def test_writes_a_study_and_its_case(self, name: str, capsys: Captured) -> None:
        """Some studies have the name of their case, and lie beside it all the same."""
        assert ends("new", name) == 0
        file = f"{name.removeprefix('studies/')}_study.toml"
        assert f"mesokit study {file}" in capsys.readouterr().out
        text = Path(file).read_text()
        assert len(Study.open(file, output="s")) > 1 and f"mesokit study {file}" in text
        case = tomllib.loads(text)["case"]
        assert ends("check", case) == 0
        assert f"{file}: exists already" in refusal(capsys, "new", name)
        Path(file).unlink()
        assert f"{case}: exists already" in refusal(capsys, "new", name)
        assert not Path(file).exists()

    @pytest.mark.parametrize(("given", "wanted"), [
        ("permeabilty", "did you mean 'studies/permeability'?"), ("kolmogorow", "'kolmogorov'?"),
    ])  # fmt: skip
    def test_lists_names_only_where_none_is_near(self, given, wanted, capsys: Captured) -> None:
        told = refusal(capsys, "new", given)
        assert wanted in told and "give one of them" not in told
        assert "give one of them, or --template: aggregation," in refusal(capsys, "new", "zzz")


@pytest.mark.parametrize(("given", "wanted"), [
    ("visocsity", "visocsity: no key of a case; 'viscosity' is explained at observe.flow-rate"),
    ("restituton", "'restitution' is explained at spheres"),
    ("bodys", "bodys: unknown key; did you mean 'bodies'?"),
    ("denisty", "denisty: unknown key; did you mean 'density'?"),
    ("box.toml", "box.toml: expected a key of a case, such as run.steps"),
    ("zzz", "zzz: unknown key; mesokit explain lists the sections of a case"),
])  # fmt: skip
def test_explain_proposes_what_it_can_explain(given, wanted, capsys: Captured) -> None:
    assert wanted in refusal(capsys, "explain", given)


@pytest.mark.parametrize(("text", "wanted"), [
    ("class A(", "--import mine: SyntaxError: "),
    ("1 / 0", "--import mine: ZeroDivisionError: division by zero"),
    ("import sys; sys.exit(4)", "--import mine: SystemExit: 4"),
    ("import nowhere_at_all", "--import mine: No module named 'nowhere_at_all'"),
])  # fmt: skip
def test_a_module_that_cannot_be_imported(text, wanted, capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "path", sys.path.copy())
    monkeypatch.delitem(sys.modules, "mine", raising=False)
    Path("mine.py").write_text(text)
    assert wanted in refusal(capsys, "--import", "mine", "schema")


@pytest.mark.parametrize("name", ["parts_here", "parts_here.py"])
def test_a_module_of_this_folder_is_imported(name, capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "path", sys.path.copy())
    monkeypatch.delitem(sys.modules, "parts_here", raising=False)
    Path("parts_here.py").write_text("KNOWN = True")
    assert "none.toml: no such file" in refusal(capsys, "--import", name, "check", "none.toml")
    assert sys.modules["parts_here"].KNOWN


@pytest.mark.parametrize("name", ["", "..mine", "mine/parts", "mine.py-"])
def test_what_is_no_name_of_a_module(name: str, capsys: Captured) -> None:
    told = refusal(capsys, "--import", name, "schema")
    assert f"--import {name!r}: expected the name of a module, such as mine" in told
