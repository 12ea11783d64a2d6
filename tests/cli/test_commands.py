"""The command line: what it writes, what it says, and how it ends."""

from __future__ import annotations

import errno
import io
import os
import re
import subprocess
import sys
import threading
import tomllib
from pathlib import Path

import pytest

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.methods import studies, templates
from mesokit.cli import main
from mesokit.cli.commands import COMMANDS
from mesokit.study.study import Study

Captured = pytest.CaptureFixture[str]
ROOT = Path(__file__).parents[2]
SOURCE = str(ROOT / "src")
SMALL = """
[run]
steps = 20
[box]
size = [8, 8]
[fluid]
density = 4
[[observe]]
quantity = "conservation"
every = 2
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ends(*arguments: str) -> int:
    """Exit status of a command."""
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


def refusal(capsys: Captured, *arguments: str, status: int = 2) -> str:
    """The one line that a wrong command ends with."""
    capsys.readouterr()
    assert ends(*arguments) == status
    captured = capsys.readouterr()
    assert captured.err.startswith("mesokit: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


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


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--density", "-1"], "--density"),
        (["--density", "nan"], "--density = nan: expected a finite number"),
        (["--timestep", "1e9"], "--timestep = 1000000000: expected a number of at most 1000"),
        (["--timestep", "1e-7"], "--timestep = 1e-07: expected a number of at least 1e-06"),
        (["--kT", "1e7"], "--kT = 10000000: expected a number of at most 1e+06"),
        (["--mass", "0"], "--mass = 0: expected a number of at least 0.001"),
        (["--angle", "400"], "--angle"),
        (["--rule", "at", "--angle", "90"], "--angle"),
        (["--angle-distribution", "uniform"], "--angle-distribution = 'uniform'"),
        (["--rule", "sdr"], "--rule"),
        (["--dimension", "4"], "--dimension"),
        (["--rule", "none"], "no coefficients: there are none without collisions"),
        (["--set", "fluid.densty=5"], "fluid.densty: unknown key"),
        (["--length", "3"], "--length, --K, --stress-time: expected a length, and with it one"),
        (["--length", "3", "--K", "1", "--stress-time", "1"], "with it one of the others"),
        (["--K", "1"], "expected a length"),
        (["--length", "2", "--K", "-1"], "'--K': -1"),
        (["--frequency", "1"], "--frequency: only with --length"),
        (["nowhere.toml"], "nowhere.toml: no such file"),
    ],
)
def test_theory_refuses(options: list[str], words: str, capsys: Captured) -> None:
    assert words in refusal(capsys, "theory", *options)


@pytest.mark.parametrize(
    "option", ["plot", "draw", "wave-length", "until", "bond-length", "radius"]
)
def test_theory_names_the_script_for_figures(option: str, capsys: Captured) -> None:
    said = refusal(capsys, "theory", "--length", "3", "--K", "1", f"--{option}", "1")
    (script,) = re.findall(r"examples/\w+\.py", said)
    assert f"--{option}: unknown option" in said and (ROOT / script).exists()


def test_theory_takes_the_fluid_of_a_case(capsys: Captured) -> None:
    """Its values, those that options replace, and its chains."""
    chains = str(ROOT / "examples" / "viscoelastic" / "fig_5_6.toml")
    assert ends("theory", chains, "--density", "5", "--frequency", "0.1") == 0
    said = capsys.readouterr().out
    fluid = [
        "--density",
        "5",
        "--angle",
        "130.0614",
        "--thermostat",
        "maxwell-boltzmann",
        "--frequency",
        "0.1",
    ]
    assert ends("theory", *fluid, "--length", "10", "--K", "1") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in said.splitlines() if "of a fluid of molecules" not in line] == lines
    spheres = str(ROOT / "examples" / "hard_disks.toml")
    assert "hard_disks.toml: run.method = 'event-driven'" in refusal(capsys, "theory", spheres)
    assert "--dimension: only" in refusal(capsys, "theory", chains, "--dimension", "2")
    mixture = ["[[fluid.species]]", "density = 5", "mass = 2"]
    mixture += ["[[fluid.species]]", "density = 5", "mass = 1"]
    Path("mixture.toml").write_text("\n".join(["run.steps = 1", "box.size = [8, 8]", *mixture]))
    assert "mixture.toml: fluid.collision.rule = 'srd': no coefficients: no theory of a mix" in (
        refusal(capsys, "theory", "mixture.toml")
    )


def test_theory_asks_rules_of_ones_own(tmp_path: Path) -> None:
    """By the name of theory that they have, and by coefficients that they compute."""
    (tmp_path / "mine.py").write_text(
        "from typing import Literal\n"
        "from mesokit.case.component import component, tag\n"
        "from mesokit.method.mpcd.collision.at import AT\n"
        "@component\n"
        "class Named(AT):\n"
        "    rule: Literal['named'] = tag('named')\n"
        "    def in_theory(self): return {'rule': 'srd', 'angle': 90.0}\n"
        "@component\n"
        "class Computed(Named):\n"
        "    rule: Literal['computed'] = tag('computed')\n"
        "    def in_theory(self): return None\n"
        "    def transport(self, gas): return Named().transport(gas)\n"
    )
    (tmp_path / "case.toml").write_text(
        "run.steps = 1\nbox.size = [8, 8]\nfluid.collision.rule = 'named'\n"
    )
    known = theory.transport("srd", 2, 10, 0.1, angle=90)
    for given, source in (
        (["case.toml"], "sum of both parts"),
        (["--rule", "computed", "--dimension", "2"], "of this collision rule"),
    ):
        words = [sys.executable, "-m", "mesokit", "--import", "mine", "theory", *given]
        run = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
        row = next(line for line in run.stdout.splitlines() if line.startswith("kinematic"))
        assert row.split()[2:] == [f"{known.viscosity:.4g}", "a^2/tau", *source.split()]


def test_theory_knows_fluids_of_chains(capsys: Captured) -> None:
    """Beside the functions of theory, which have tests of their own."""
    chain = ["--length", "10", "--K", "0.5"]
    assert ends("theory", "--thermostat", "maxwell-boltzmann", *chain) == 0
    said = {line[:20].strip(): line[20:] for line in capsys.readouterr().out.splitlines()}
    free = theory.transport(
        dimension=3, density=10, timestep=0.1, angle=130, rule="srd",
        thermostat="maxwell-boltzmann",
    )  # fmt: skip
    stirring = theory.self_diffusion(3, free.diffusion, free.viscosity, 10)
    times = theory.rouse_times(theory.linear_modes(10), 1 / stirring, K=0.5)
    rows = list(said)  # a time of modes with one of modes, half of it after both
    assert rows.index("with hydrodynamics") == rows.index("slowest mode time") + 1
    assert float(said["slowest mode time"].split()[0]) == pytest.approx(times.mode[0], rel=1e-3)
    bonds = times.stress.sum() / 10  # kT per molecule, over the mass density
    assert float(said["viscosity of bonds"].split()[0]) == pytest.approx(bonds, rel=1e-3)
    assert ends("theory", "--length", "4", "--stress-time", "30", "--frequency", "0.1") == 0
    said = {line[:20].strip(): line[20:] for line in capsys.readouterr().out.splitlines()}
    assert float(said["slowest stress time"].split()[0]) == 30.0
    rates = theory.linear_modes(4).eigenvalues[1:]
    turns = 0.1 * 30.0 * rates[0] / rates
    stored = 10 / 4 * (turns**2 / (1 + turns**2)).sum()
    assert float(said["storage modulus"].split()[0]) == pytest.approx(stored, rel=1e-3)


def test_theory_says_what_a_thermostat_changes(capsys: Captured) -> None:
    ends("theory", "--dimension", "2", "--density", "16", "--timestep", "1", "--angle", "90")
    said = capsys.readouterr().out.splitlines()[1]
    assert said.startswith("thermostat") and "with others: maxwell-boltzmann +15 %, resc" in said


def test_theory_prints_coefficients_and_sources(capsys: Captured) -> None:
    assert ends("theory", "--angle", "130.06") == 0
    out = capsys.readouterr().out
    assert "0.8705" in out
    assert "Gompper" in out
    assert "holds: grid shift 1" in out


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


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (OSError(errno.ENOSPC, "No space left on device", "run.h5"), 2, "no space left"),
        (PermissionError(errno.EACCES, "Permission denied", "x"), 2, "x: permission denied"),
        (MemoryError(), 1, "memory"),
    ],
)
def test_failures_end_in_one_line(
    error: BaseException, status: int, words: str, capsys: Captured,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(Case, "from_toml", fail)
    assert ends("check", "case.toml") == status
    message = capsys.readouterr().err.strip()
    assert "\n" not in message
    assert words in message


INTERRUPT_ON_IMPORT = """
import runpy, signal, sys
module = sys.argv.pop(1)
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job has none
class Interrupt:
    def find_spec(self, name, *rest):
        if name == module:
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Interrupt())
sys.argv += ["run", "case.toml"]
runpy.run_module("mesokit", run_name="__main__")
"""


@pytest.mark.parametrize("module", ["click", "pydantic", "numba", "h5py", "mesokit.run.simulation"])
def test_ctrl_c_while_starting(module: str) -> None:
    Path("case.toml").write_text(SMALL)
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPT_ON_IMPORT, module],
        env=os.environ | {"PYTHONPATH": SOURCE}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 130
    assert done.stderr.splitlines()[-1] == "mesokit: interrupted"
    assert "Traceback" not in done.stderr


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("quiet", [False, True])
def test_what_takes_long_says_so(quiet: bool, monkeypatch, capsys) -> None:
    from mesokit.cli import words

    said = threading.Event()
    monkeypatch.setattr(words, "SILENT", 0.001)
    monkeypatch.setattr(words, "say", lambda text: (print(text), said.set()))
    with words.patience("looking for something", quiet):
        assert quiet or said.wait(60)
    assert capsys.readouterr().out == ("" if quiet else "mesokit: looking for something ...\n")


class TestProgress:
    """What a run says while it goes."""

    def test_plain_lines_start_at_once_and_are_few(self, monkeypatch) -> None:
        from mesokit.report import progress

        clock = iter(range(10_000))
        monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock) * 0.1)
        stream = io.StringIO()
        reporter = progress.Reporter(stream=stream)
        reporter.start(1000, particles=500)
        reporter.compiling("compiling (once)")
        for step in range(10, 1001, 10):  # 100 steps a second
            reporter.update(step)
        reporter.finish()
        lines = stream.getvalue().splitlines()
        assert lines[0] == "running: 1000 steps of 500 particles"
        assert lines[1] == "compiling (once)"
        assert "%, 100 steps/s, 0.05 M particle-steps/s, 8.9 s left" in lines[2]
        assert lines[-1].startswith("running: step 1000 of 1000 after")
        assert len(lines) == 5

    def test_the_time_left_comes_from_the_recent_past(self, monkeypatch) -> None:
        from mesokit.report import progress

        now = [0.0]
        monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
        reporter = progress.Reporter(stream=io.StringIO())
        reporter.start(1000, particles=5)
        for second in range(1, 101):
            now[0] += 1
            reporter.update(second if second < 50 else 50 + 10 * (second - 50))
        assert reporter.rate() == pytest.approx(10)

    def test_no_time_left_is_said_of_what_is_being_compiled(self, monkeypatch) -> None:
        """The first sample of an observable takes long, and says nothing about the others."""
        from mesokit.report import progress

        now = [0.0]
        monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
        stream = io.StringIO()
        reporter = progress.Reporter(stream=stream)
        reporter.start(10_000, particles=500)
        for step in range(100, 10_001, 100):
            now[0] += 12.0 if step == 300 else 0.1  # 1000 steps a second but for one
            reporter.update(step)
        left = [line for line in stream.getvalue().splitlines() if "left" in line]
        assert left and all(" min" not in line for line in left)
        assert all("1000 steps/s" in line for line in left)

    def test_slow_steps_are_no_stall(self, monkeypatch) -> None:
        from mesokit.report import progress

        now = [0.0]
        monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
        stream = io.StringIO()
        reporter = progress.Reporter(stream=stream)
        reporter.start(20, particles=500)
        for step in range(1, 21):
            now[0] += 3.0
            reporter.update(step)
        assert "0.3333 steps/s" in stream.getvalue()

    def test_a_terminal_gets_a_bar(self) -> None:
        from mesokit.report.progress import Reporter

        stream = Terminal()
        reporter = Reporter(stream=stream)
        reporter.start(10, particles=5)
        reporter.compiling("compiling (once)")
        reporter.update(10)
        reporter.finish()
        assert "%" in stream.getvalue()

    def test_quiet_is_quiet(self, capsys: Captured) -> None:
        from mesokit.report.progress import Reporter

        reporter = Reporter(quiet=True)
        reporter.start(10, particles=5)
        reporter.compiling("compiling (once)")
        reporter.update(10)
        reporter.finish()
        captured = capsys.readouterr()
        assert captured.out + captured.err == ""


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
        assert "give one of them, or --template: brownian," in refusal(capsys, "new", "zzz")


@pytest.mark.parametrize(("given", "wanted"), [
    ("visocsity", "visocsity: no key of a case; 'viscosity' is explained at observe.flow-rate"),
    ("restituton", "'restitution' is explained at spheres"),
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
