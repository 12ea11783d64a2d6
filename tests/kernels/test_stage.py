"""Stages: machine code of their own, shared by all kernels that call them; compiling ahead."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest

LAW = """
import numpy as np
from typing import NamedTuple
from mesokit.kernels.group import by_address, without
from mesokit.kernels.kernel import kernel
from mesokit.kernels.part import stage
from mesokit.scalar.jit import scalar


@by_address(in_words=True)
class Physics(NamedTuple):
    rule: tuple
    factor: float
    field: tuple


without_field = without("field")


@scalar
def grown(physics, x):
    return physics.factor * x + physics.rule[0]


@stage
def deep(physics, values):
    for i in range(len(values)):
        values[i] = grown(physics, values[i])


@stage
def grow(physics, values):
    deep(physics, values)
    deep(physics, values)


@kernel
def advance(physics, values, n):
    for _ in range(n):
        grow(without_field(physics), values)


@kernel
def advance_and_add(physics, values, n):
    for _ in range(n):
        grow(without_field(physics), values)
        values[0] += physics.field[0]
"""
PROGRAM = """
import json, sys
import numpy as np
import law
from mesokit.kernels import ahead
from mesokit.kernels.kept import counts

ahead._has_a_core = lambda: "ahead" in sys.argv
short, long = law.Physics((1.0,), 2.0, (5.0,)), law.Physics((1.0,), 2.0, (5.0, 6.0, 7.0))
one, two, three = np.ones(3), np.ones(3), np.ones(3)
law.advance.compile_ahead(short, one, 1)
law.advance(short, one, 1)
law.advance(long, two, 1)
law.advance_and_add(long, three, 1)
names = "stages_made", "stages_found", "parts_made", "kernels_made", "kernels_found"
print(json.dumps({"values": [one.tolist(), two.tolist(), three.tolist()]}
                 | {name: getattr(counts, name) for name in names}))
"""
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere nothing is compiled ahead")
EXPECTED = [[7.0] * 3, [7.0] * 3, [12.0, 7.0, 7.0]]  # 2 (2 x + 1) + 1


class Place:
    """A module with stages, and a store for it."""

    def __init__(self, root: Path) -> None:
        self.root, self.law = root, root / "law.py"
        self.law.write_text(LAW)

    def run(self, *words: str, cache: str = "cache") -> dict:
        """What a process that calls the kernels says."""
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, *words], cwd=self.root, timeout=300,
            env=os.environ | {"NUMBA_CACHE_DIR": str(self.root / cache)},
            capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    def forget(self, names: str) -> int:
        """Delete entries by their names; how many there were."""
        [file] = (self.root / "cache" / "mesokit").glob("*.sqlite")
        with sqlite3.connect(file) as disk:
            found = disk.execute("DELETE FROM entries WHERE name LIKE ?", (names,)).rowcount
        disk.close()
        return found


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Place:
    """A store with all in it."""
    place = Place(tmp_path_factory.mktemp("stages"))
    first = place.run()
    assert first["values"] == EXPECTED
    # one for all three kernels, of two kinds of group, whose further fields differ
    assert first["stages_made"] == 2 and first["kernels_made"] == 3
    return place


def test_a_second_start_finds_all(place: Place) -> None:
    again = place.run()
    assert again["values"] == EXPECTED
    assert (again["stages_made"], again["parts_made"], again["kernels_made"]) == (0, 0, 0)
    assert again["kernels_found"] == 3


def test_kernels_that_are_gone_are_made_of_stages_that_are_there(place: Place) -> None:
    assert place.forget("kernel law:%") == 3
    again = place.run()
    assert again["values"] == EXPECTED
    assert (again["stages_made"], again["stages_found"], again["kernels_made"]) == (0, 2, 3)


@pytest.mark.parametrize("name", ["grow", "deep"])
def test_a_stage_that_is_gone_is_made_again_for_kernels_that_are_there(
    place: Place, name: str
) -> None:
    assert place.forget(f"kernel stage {name}") == 1
    again = place.run()
    assert again["values"] == EXPECTED
    assert (again["stages_made"], again["kernels_made"]) == (1, 0)


def test_an_edit_below_a_stage_reaches_the_kernels(place: Place) -> None:
    text = place.law.read_text()
    place.law.write_text(text.replace("* x + physics.rule[0]", "* x + 3.0 * physics.rule[0]"))
    again = place.run()
    place.law.write_text(text)
    assert again["values"] == [[13.0] * 3, [13.0] * 3, [18.0, 13.0, 13.0]]  # 2 (2 x + 3) + 3
    assert again["stages_made"] == 2


def test_what_is_hidden_cannot_be_read(place: Place) -> None:
    text = place.law.read_text()
    place.law.write_text(text.replace("+ physics.rule[0]", "+ physics.field[0]"))
    with pytest.raises(AssertionError, match=r"Physics\.field is hidden from this stage"):
        place.run()
    place.law.write_text(text)


@LINUX
def test_compiled_ahead_it_is_the_same_and_counted(place: Place) -> None:
    ahead = place.run("ahead", cache="ahead")
    alone = place.run(cache="alone")
    assert ahead["values"] == alone["values"] == EXPECTED
    # the child's kernel is found here; what it made is counted here
    assert ahead["kernels_made"] == alone["kernels_made"] == 3
    assert ahead["parts_made"] == alone["parts_made"]
    assert ahead["kernels_found"] == 1 and alone["kernels_found"] == 0


DYING = """
import os, signal
import numpy as np
import law
from mesokit.kernels import ahead
from mesokit.kernels.kept import counts

ahead._has_a_core = lambda: True
parent, compile_ = os.getpid(), law.advance.compile
def compile(sig):
    if os.getpid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)
    return compile_(sig)
law.advance.compile = compile
values, physics = np.ones(3), law.Physics((1.0,), 2.0, (5.0,))
law.advance.compile_ahead(physics, values, 1)
law.advance(physics, values, 1)
print(values.tolist(), counts.kernels_made)
"""


@LINUX
def test_a_child_that_dies_costs_time_only(tmp_path: Path) -> None:
    place = Place(tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", DYING], cwd=place.root, timeout=300, capture_output=True, text=True,
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")},
    )  # fmt: skip
    assert (done.returncode, done.stdout.strip()) == (0, "[7.0, 7.0, 7.0] 1"), done.stderr


COPIED = """
import os, signal, sys
import numpy as np
import law
from mesokit.kernels import ahead

ahead._has_a_core = lambda: True
if sys.argv[1] == "no waiting":
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
values, physics = np.ones(3), law.Physics((1.0,), 2.0, (5.0,))
law.advance.compile_ahead(physics, values, 1)
child = os.fork() if sys.argv[1] == "copied" else None
law.advance(physics, values, 1)
if child == 0:
    os._exit(int(values.sum()))
print(values.tolist())
if child:
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""


@LINUX
@pytest.mark.parametrize(
    ("how", "said"), [("copied", {"[7.0, 7.0, 7.0]", "21"}), ("no waiting", {"[7.0, 7.0, 7.0]"})]
)
def test_a_child_is_that_of_one_process(tmp_path: Path, how: str, said: set[str]) -> None:
    """A copy of the process compiles for itself; the user may have the system end children."""
    place = Place(tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", COPIED, how], cwd=place.root, timeout=300, capture_output=True,
        text=True, env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")},
    )  # fmt: skip
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert set(done.stdout.splitlines()) == said


CELL = """
from typing import NamedTuple
import numpy as np
from mesokit.kernels.group import by_address
from mesokit.kernels.kernel import kernel
from mesokit.scalar.jit import generic

@by_address()
class Physics(NamedTuple):
    field: tuple

@generic
def push(field, x):
    'What a field adds.'

@kernel
def advance(physics, values):
    for i in range(len(values)):
        values[i] = push(physics.field, values[i])

for factor in 1.0, 3.0, 5.0:
    exec(f"class Field(NamedTuple):\\n    g: float\\n"
         f"@push.register(Field)\\ndef _(field, x):\\n    return x + {factor} * field.g")
    values = np.zeros(1)
    advance(Physics(Field(2.0)), values)
    print(values[0])
"""


def test_a_cell_of_a_notebook_that_is_defined_anew(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-"], input=CELL, capture_output=True, text=True, timeout=300,
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)},
    )  # fmt: skip
    assert done.stdout.split() == ["2.0", "6.0", "10.0"], done.stderr


THREADS = """
import threading
import numpy as np
import law
from mesokit.kernels import ahead

ahead._has_a_core = lambda: True
values, physics = np.ones(3), law.Physics((1.0,), 2.0, (5.0,))
done = threading.Event()
other = threading.Thread(target=done.wait)
other.start()
try:
    law.advance.compile_ahead(physics, values, 1)
    begun = len(ahead._in_progress)
finally:
    done.set()  # else this process would wait for the other thread
other.join()
law.advance.compile_ahead(physics, values, 1)
print(begun, len(ahead._in_progress))
"""


@LINUX
def test_no_child_beside_threads_of_the_user_and_none_outlives_us(tmp_path: Path) -> None:
    place = Place(tmp_path)
    done = subprocess.run(  # ends while the child compiles, which does not hold what it wrote to
        [sys.executable, "-c", THREADS], cwd=place.root, timeout=300, capture_output=True,
        text=True, env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")},
    )  # fmt: skip
    assert (done.returncode, done.stdout.split()) == (0, ["0", "1"]), done.stderr
