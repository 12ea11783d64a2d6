"""The log of a run: numbers in time, on the screen and in a file."""

import itertools
import math
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from mesokit.case.case import Case
from mesokit.io.log_file import DamagedLog, LogFile
from mesokit.report.log_lines import ERROR, LogLines
from mesokit.run.callbacks import Callback
from mesokit.seam.method import method_of
from mesokit.seam.named import find


class RunLog:
    """Writes the columns of the section [log], if the case has one.

    A run calls it like functions of the user (`callbacks`). `tell` prints a line on the screen.
    """

    def __init__(self, case: Case) -> None:
        self.every = case.log.every if case.log else 0
        self.known = method_of(case).log(case)
        self.columns = (case.log.columns or self.known.usual) if case.log else ()
        known = self.known.names  # columns of observables are followed by their errors
        names = ([name] if name in known else [name, f"{name}{ERROR}"] for name in self.columns)
        self.names = ["step", "time", *itertools.chain(*names)]
        self.lines = LogLines(self.names)
        self.file: LogFile | None = None
        self.tell: Callable[[str], Any] = lambda text: None
        self.doubts: set[str] = set()  # columns whose absence was reported

    def callbacks(self) -> list[Callback]:
        """The callback of the run, if any."""
        return [Callback(self.every, self)] if self.every else []

    def write_to(self, path: Path) -> None:
        """Write lines to this file from now on."""
        self.file = LogFile(path, self.names) if self.every else None

    def resume(self, step: int) -> None:
        """Go on from a checkpoint; a damaged file is set aside, with a warning. Raises RunError."""
        if self.file is None:
            return
        try:
            self.file.cut(step)
        except DamagedLog as error:
            kept = self.file.set_aside().name
            text = f"{error}; kept as {kept}, a new log begins at step {step}"
            warnings.warn(text, stacklevel=3)

    def sync(self) -> None:
        """Make the lines so far as safe as a checkpoint. Raises RunError."""
        if self.file is not None:
            self.file.sync()

    def __call__(self, simulation: Any) -> None:
        """Write and print the present numbers."""
        row = [simulation.step, simulation.time, *self._numbers(simulation)]
        if self.file is not None:
            self.file.append(row)
        for line in self.lines.next(row):
            self.tell(line)

    def _numbers(self, simulation: Any) -> Iterator[float]:
        own = [column for column in self.columns if column in self.known.names]
        found = self.known.read(simulation.engine, own)
        for column in self.columns:
            if column in found:
                yield found[column]
            else:
                yield from self._compared(simulation, column)

    def _compared(self, simulation: Any, column: str) -> tuple[float, float]:
        """Number and error of an observable so far; nan while it has none."""
        label, _, name = column.partition(".")
        result = simulation[label]
        try:
            comparison = find(result.comparisons, name)
        except KeyError as error:
            if result.comparisons and column not in self.doubts:
                self.doubts.add(column)
                self.tell(f"log.columns: {column}: {error.args[0]}")
            return math.nan, math.nan
        return comparison.measured, comparison.error
