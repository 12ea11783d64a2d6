"""The log of a run: a line of numbers every so many steps, which can be read meanwhile.

Each line is written at once. A run that goes on from a checkpoint drops later lines, so the file is
that of a run without a stop.
"""

import csv
import io
import itertools
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError
from mesokit.io.atomic import write_text

DIGITS = 10  # of each number
ASIDE = "log-damaged"  # start of the names of files that were set aside


class DamagedLog(RunError):
    """A log whose lines are not numbers, or not as many as its columns."""


class LogFile:
    """Lines of numbers, of which the first is the step, under these names.

    >>> import tempfile
    >>> file = LogFile(Path(tempfile.mkdtemp()) / "log.csv", ["step", "temperature"])
    >>> for row in [(0, 1.0), (10, 1.25), (20, 1.5)]:
    ...     file.append(row)
    >>> file.cut(10)
    >>> read(file.path)["temperature"].tolist()
    [1.0, 1.25]
    """

    def __init__(self, path: Path, names: Sequence[str]) -> None:
        self.path, self.names = path, tuple(names)

    def append(self, row: Sequence[float]) -> None:
        """Write a line. Raises RunError."""
        with self._appending() as file:
            if file.tell() == 0:
                file.write(_line(self.names))
            file.write(_line([f"{number:.{DIGITS}g}" for number in row]))

    def sync(self) -> None:
        """Make what was written survive a loss of power. Raises RunError."""
        with self._appending() as file:
            os.fsync(file.fileno())

    def cut(self, step: int) -> None:
        """Drop all lines after a step; at step 0 all, as its line comes again. Raises RunError."""
        if not self.path.exists() or not (lines := _whole_lines(self.path)):
            return
        table = read(self.path)
        if table.dtype.names != self.names:
            raise DamagedLog(f"{self.path}: damaged: expected columns {', '.join(self.names)}")
        kept = [row for row, at in zip(lines[1:], table["step"], strict=True) if 0 < step >= at]
        write_text(self.path, "".join([lines[0], *kept]))

    def set_aside(self) -> Path:
        """Rename the file to a free name, which is returned, and begin a new one."""
        names = (f"{ASIDE}{number}.csv" for number in itertools.chain([""], itertools.count(2)))
        free = next(path for name in names if not (path := self.path.with_name(name)).exists())
        kept = self.path.rename(free)
        write_text(self.path, _line(self.names))
        return kept

    @contextmanager
    def _appending(self) -> Iterator[Any]:
        try:
            with self.path.open("a", encoding="utf-8", newline="") as file:
                yield file
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise RunError(f"cannot write {self.path}: {reason}") from None


def read(path: Path) -> NDArray[Any]:
    """The lines so far, a field for each column. Raises RunError if it is missing or damaged."""
    header, *rows = _whole_lines(path) or [""]
    names = next(csv.reader([header]), [])
    types = [(name, np.int64 if name == "step" else np.float64) for name in names]
    try:
        numbers = [tuple(map(float, row.split(","))) for row in rows]
        if not names or any(len(row) != len(names) for row in numbers):
            raise ValueError
        return np.array(numbers, types)
    except (ValueError, OverflowError):
        why = "expected the same number of numbers in each line"
        raise DamagedLog(f"{path}: damaged: {why}") from None


def _whole_lines(path: Path) -> list[str]:
    """Lines of a file, without a last one that is not complete. Raises RunError."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    except OSError as error:
        raise RunError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError as error:
        why = f"byte {error.start} is not UTF-8; expected numbers"
        raise DamagedLog(f"{path}: damaged: {why}") from None
    return [line for line in lines if line.endswith("\n")]


def _line(words: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(words)
    return text.getvalue()
