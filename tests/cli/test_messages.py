"""Messages of commands: progress, failures in one line, and Ctrl-C."""

from __future__ import annotations

import errno
import io
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from mesokit.case.case import Case
from tests.helpers.commands import SMALL, SOURCE, Captured, ends


@pytest.fixture(autouse=True)
def folder(empty_folder: Path) -> Path:
    """Work in an empty folder."""
    return empty_folder


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
