"""A plugin of pytest writes what each test takes to a file; as a program it prints such files.

    python -m pytest -p tests.durations --durations-file build/durations/test.csv
    python tests/durations.py build/durations/*.csv

Seconds are of the clock, CPU seconds those of the worker and of the processes that ended meanwhile.
"""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Generator
from pathlib import Path
from typing import NamedTuple

import pytest

SLOWEST = 30


class Row(NamedTuple):
    """What one test takes, with its fixtures."""

    test: str
    seconds: float
    cpu: float

    @property
    def folder(self) -> str:
        """The folder of tests, such as tests/laws; src for all examples in docstrings."""
        parts = self.test.split("::")[0].split("/")
        return "/".join(parts[:2]) if parts[0] == "tests" else parts[0]


def cpu_seconds() -> float:
    """CPU seconds of this process and of its children that have ended."""
    return sum(os.times()[:4])


class Durations:
    """Adds up the setup, call and teardown of each test, and writes a row when it has ended.

    So the rows are there too if the tests are killed.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path  # None in workers: they measure, the controller writes
        self.rows: dict[str, Row] = {}
        if path is not None:
            begin(path)
        self.before = cpu_seconds()

    def pytest_runtest_logstart(self) -> None:
        self.before = cpu_seconds()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        now = cpu_seconds()
        report.cpu_seconds, self.before = now - self.before, now
        return report

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        old = self.rows.get(report.nodeid, Row(report.nodeid, 0.0, 0.0))
        cpu = old.cpu + getattr(report, "cpu_seconds", 0.0)  # a worker that died measured none
        self.rows[report.nodeid] = Row(report.nodeid, old.seconds + report.duration, cpu)
        if self.path is not None and report.when == "teardown":
            add(self.path, self.rows[report.nodeid])

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        if self.path is not None:
            # workers have ended and are counted, with their imports and collections
            terminalreporter.write_line(f"{cpu_seconds() / 60:.1f} CPU minutes: see {self.path}")


def begin(path: Path) -> None:
    """A table with a header and no row yet, in a folder that is made."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerow(Row._fields)


def add(path: Path, row: Row) -> None:
    """Add a row to the table."""
    with path.open("a", encoding="utf-8", newline="") as file:
        csv.writer(file).writerow((row.test, f"{row.seconds:.3f}", f"{row.cpu:.2f}"))


def read(path: Path) -> list[Row]:
    """The rows of a file that `begin` and `add` made."""
    with path.open(encoding="utf-8", newline="") as file:
        return [
            Row(row["test"], float(row["seconds"]), float(row["cpu"]))
            for row in csv.DictReader(file)
        ]


def text(rows: list[Row]) -> str:
    """The slowest tests, and what each folder takes."""
    folders: dict[str, list[Row]] = {}
    for row in rows:
        folders.setdefault(row.folder, []).append(row)
    folders["all"] = rows
    lines = [f"{'seconds':>9} {'CPU s':>9}  slowest tests"]
    for row in sorted(rows, key=lambda row: row.seconds, reverse=True)[:SLOWEST]:
        lines.append(f"{row.seconds:9.1f} {row.cpu:9.1f}  {row.test}")
    lines.append(f"{'seconds':>9} {'CPU s':>9} {'tests':>6}  folder")
    for folder, of_it in folders.items():
        seconds, cpu = sum(r.seconds for r in of_it), sum(r.cpu for r in of_it)
        lines.append(f"{seconds:9.1f} {cpu:9.1f} {len(of_it):6d}  {folder}")
    return "\n".join(lines)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--durations-file", type=Path, help="a table of what each test takes")


def pytest_configure(config: pytest.Config) -> None:
    path = config.getoption("durations_file")
    if path is not None:
        worker = hasattr(config, "workerinput")
        config.pluginmanager.register(Durations(None if worker else path), "what-tests-take")


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(f"{name}\n{text(read(Path(name)))}")
