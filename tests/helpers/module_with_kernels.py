"""A module with two kernels, in a store of its own, whose processes say what they made."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

LAW = """
import numpy as np
from numba import njit
from mesokit.kernels.kernel import kernel
from mesokit.scalar.jit import by_type, generic, scalar
from typing import NamedTuple

FACTOR = 3.0


class Line(NamedTuple):
    slope: float


class Curve(NamedTuple):
    power: float


@generic
def height(shape, x):
    '''Height of a shape at x.'''


@height.register(Line)
def _(shape, x):
    return shape.slope * x


@height.register(Curve)
def _(shape, x):
    return x**shape.power


@njit
def same(x):
    return x + 0.0


@scalar
def twice(x):
    return 2.0 * same(x)


@scalar
def scaled(x):
    return FACTOR * x


@scalar
def unused(x):
    return x + 1.0


def is_long(rows):
    return len(rows) > 1


@by_type
def reduced(rows, x):
    return (lambda rows, x: twice(x)) if is_long(rows) else (lambda rows, x: x)


@kernel
def add(shape, rows, out):
    for i in range(len(out)):
        out[i] = scaled(reduced(rows, height(shape, float(i))))


@kernel
def double(out):
    for i in range(len(out)):
        out[i] = twice(out[i])
"""
PROGRAM = """
import json, sys
import numpy as np
import law
from mesokit.kernels.kept import counts, kept

out = np.zeros(4)
law.add(law.Line(1.0), (1.0, 2.0), out)
law.double(out)
names = "parts_made", "parts_found", "kernels_made", "kernels_found"
print(json.dumps({"sum": float(out.sum()), "trouble": kept().trouble}
                 | {name: getattr(counts, name) for name in names}))
"""


class Place:
    """A module with two kernels, and a store for it."""

    def __init__(self, root: Path) -> None:
        self.root, self.law = root, root / "law.py"
        self.law.write_text(LAW)
        self.store = root / "cache" / "mesokit" / "compiled-1.sqlite"

    def run(
        self, before: str = "", program: str = PROGRAM, within: Sequence[str] = (), **more: str
    ) -> dict:
        """What a process that calls both kernels says.

        `before`: lines that come first; `within`: a command that runs it.
        """
        done = subprocess.run(
            [*within, sys.executable, "-c", before + program], env=self.environment | more,
            cwd=self.root, capture_output=True, text=True, timeout=300,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert not done.stderr
        return json.loads(done.stdout)

    @property
    def environment(self) -> dict[str, str]:
        """Variables of the process."""
        return os.environ | {"NUMBA_CACHE_DIR": str(self.root / "cache")}

    def edit(self, before: str, after: str) -> None:
        """Change the module."""
        text = self.law.read_text()
        assert text.count(before) == 1
        self.law.write_text(text.replace(before, after))
        shutil.rmtree(self.root / "__pycache__", ignore_errors=True)


NOTHING_MADE = {"kernels_made": 0, "kernels_found": 2, "parts_made": 0}


def damage(file: Path, how: str) -> None:
    """What happens to files."""
    data = bytearray(file.read_bytes())
    if how == "empty":
        data = bytearray()
    elif how == "cut":
        data = data[: len(data) // 2]
    elif how == "foreign":
        data = bytearray(b"these are my notes\n" * 1000)
    elif how == "garbage":
        data[4096:] = os.urandom(len(data) - 4096)
    else:  # bits that flip in rows of code
        for at in range(5000, len(data), 997):
            data[at] ^= 16
    file.write_bytes(data)
    for end in ("-wal", "-shm"):
        file.with_name(file.name + end).unlink(missing_ok=True)
