"""The log of a run: a line of numbers every so many steps, which anybody may read meanwhile.

Each line is in the file as soon as it is known. A run that goes on from a checkpoint drops the
lines that came after it, so that the file is that of a run which never stopped.
"""

from __future__ import annotations

import csv
import io
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
        """Drop all lines after this step, at 0 also its own, which comes anew. Raises RunError."""
        if not self.path.exists():
            return
        header, *rows = _whole_lines(self.path) or [""]
        kept = [row for row in rows if 0 < step >= int(row.split(",", 1)[0])]
        write_text(self.path, "".join([header, *kept]))

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
    except ValueError:
        raise RunError(
            f"{path}: damaged: expected the same number of numbers in each line"
        ) from None
    return np.array(numbers, types)


def _whole_lines(path: Path) -> list[str]:
    """The last line may be half written. Raises RunError."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    except OSError as error:
        raise RunError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError as error:
        raise RunError(
            f"{path}: damaged: byte {error.start} is not UTF-8; expected numbers"
        ) from None
    return [line for line in lines if line.endswith("\n")]


def _line(words: Sequence[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(words)
    return text.getvalue()
