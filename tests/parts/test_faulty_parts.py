"""Parts of a user's own that do not work are named in one line, with what is wrong."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mesokit import Box, Case, CaseError, Conservation, Fluid, Polymer, Run, Solutes

PARTS = '''
from typing import Literal, NamedTuple
from mesokit import CollisionRule, component, tag
from mesokit.method.mpcd.collision.protocol import coefficients, collide, contribute, freedom


class Numbers(NamedTuple):
    one: float


def rule(name, answer=None, kernel=Numbers(1.0)):
    """A rule that does nothing, by what its `coefficients` does."""

    class Kernel(NamedTuple):
        one: float

    @component
    class Rule(CollisionRule):
        rule: Literal[name] = tag(name)

        def kernel(self, dimension, kT):
            return Kernel(1.0 / KERNELS[name])

        def own_sums(self, dimension):
            return ()

        def coefficient_count(self, dimension, stretched):
            return 2

    contribute.register(Kernel)(lambda rule, counter, key, m, v, r: (v, ()))
    freedom.register(Kernel)(lambda rule, n: n)
    collide.register(Kernel)(lambda rule, c, v, r: v)
    if answer is not None:
        coefficients.register(Kernel)(answer)
    return Rule


KERNELS = {"fine": 1.0, "lacking": 1.0, "long": 1.0, "unknown-name": 1.0, "no-kernel": 0.0}


def unknown(rule, thermostat, variate, chance, cell):
    return (undefined_thing, 1.0)


Fine = rule("fine", lambda rule, thermostat, variate, chance, cell: (1.0, 1.0))
Lacking = rule("lacking")
Long = rule("long", lambda rule, thermostat, variate, chance, cell: (1.0, 1.0, 1.0))
Unknown = rule("unknown-name", unknown)
NoKernel = rule("no-kernel", lambda rule, thermostat, variate, chance, cell: (1.0, 1.0))


@component
class Abstract(CollisionRule):
    rule: Literal["abstract"] = tag("abstract")

    def kernel(self, dimension, kT):
        return Numbers(1.0)
'''
NAMES = {
    "fine": "Fine", "lacking": "Lacking", "long": "Long", "unknown-name": "Unknown",
    "no-kernel": "NoKernel", "abstract": "Abstract",
}  # fmt: skip
PATIENCE = "mesokit: reading the case"
CASE = '[run]\nsteps = 2\n[box]\nsize = [4, 4]\n[fluid]\ncollision = { rule = "fine" }\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case, and a package with these rules."""
    folder = tmp_path_factory.mktemp("faulty")
    (folder / "faulty_parts.py").write_text(PARTS)
    (folder / "case.toml").write_text(CASE)
    metadata = folder / "faulty_parts-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: faulty-parts\nVersion: 1.0\n")
    lines = [f"{name} = faulty_parts:{kind}" for name, kind in NAMES.items()]
    (metadata / "entry_points.txt").write_text("\n".join(["[mesokit.collision]", *lines]))
    return folder


def command(folder: Path, what: str, rule: str) -> subprocess.CompletedProcess[str]:
    setting = f'fluid.collision.rule="{rule}"'
    output = ["--output", f"{rule}-run", "--quiet"] if what == "run" else []
    return subprocess.run(
        [sys.executable, "-m", "mesokit", what, "case.toml", "--set", setting, *output],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
    )


def test_one_that_works(folder: Path) -> None:
    """So that those that fail do so for what is wrong with them."""
    done = command(folder, "run", "fine")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("what", "rule", "words"),
    [
        ("check", "lacking", ["fluid.collision", "registers no coefficients for Kernel"]),
        ("check", "no-kernel", ["fluid.collision", "ZeroDivisionError: float division by zero"]),
        ("check", "abstract", ["collision rule 'abstract' of faulty-parts 1.0",
                               "lacks coefficient_count, own_sums"]),
        ("run", "long", ["'long' (faulty_parts:", "not of mesokit",
                         "coefficients gives 3 numbers; coefficient_count says 2"]),
        ("run", "unknown-name", ["'unknown-name' (faulty_parts:",
                                 "NameError: name 'undefined_thing' is not defined"]),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(
    folder: Path, what: str, rule: str, words: list[str]
) -> None:
    done = command(folder, what, rule)
    assert done.returncode
    # what takes long says so
    lines = [line for line in done.stderr.strip().splitlines() if not line.startswith(PATIENCE)]
    assert len(lines) == 1, done.stderr
    assert all(word in lines[0] for word in words), lines[0]


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        (
            {"observe": [len]},
            r"observe\[#1\] = <built.*no function; Simulation\(\.\.\., callbacks=",
        ),
        ({"observe": [Conservation]}, r"expected an object, as Conservation\(\.\.\.\) is one$"),
        ({"observe": [3]}, r"observe\[#1\] = 3: expected a table$"),
    ],
)
def test_functions_and_classes_are_told_what_to_do_instead(parts, words):
    with pytest.raises(CaseError, match=words):
        Case(run=Run(1), box=Box([8, 8]), **parts)


def test_functions_are_no_forces_and_no_potentials():
    with pytest.raises(CaseError, match=r"force = .*SampledForce.from_function makes a force"):
        Fluid(force=lambda x, y: (0.0, 0.0))
    with pytest.raises(CaseError, match=r"pair = .*Table.from_function makes a potential"):
        Solutes((Polymer(2),), pair=lambda r: 1 / r)


SHAPE = """
from typing import Literal
from mesokit import component, param
from mesokit.case.component import tag
from mesokit.geometry import region
from mesokit.geometry.shape_protocol import Simple

@component
class Two(Simple):
    shape: Literal["two"] = tag("two")
    centre: tuple[float, ...] = param(doc="its centre")

    def body(self, room):
        return pair(self.centre)

    def pivot(self, room):
        return self.centre

    def vectors(self):
        return {"centre": self.centre}

def pair(centre):
    return region.ball(centre)  # line 23
"""
TWO = '[run]\nsteps = 2\n[box]\nsize = [8, 8]\n[[wall]]\nshape = "two"\ncentre = [4, 4]\n'


@pytest.mark.parametrize(
    ("old", "new", "frames", "words"),
    [
        ("", "", ["in body", "in pair"], "line 23 of {}: TypeError: ball() missing"),
        ("region.ball(centre)", "region.bal()", ["in body", "in pair"],
         "line 23 of {}: AttributeError: module 'mesokit.geometry.region' has no"),
        ("def pivot", "def pivo", [], "case.toml: wall[#1] = "),
        ("def pivot", "def pivo", [], "mine:Two lacks pivot"),
        ("@component", "region.ball()\n@component", [],
         "'centre' and 'radius' (line 8 of {})"),
    ],
)  # fmt: skip
def test_an_error_in_a_part_shows_its_own_lines(old, new, frames, words, tmp_path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(SHAPE.replace(old, new) if old else SHAPE)
    (tmp_path / "case.toml").write_text(TWO)
    done = subprocess.run(
        [sys.executable, "-m", "mesokit", "--import", "mine", "check", "case.toml"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode
    first, *rest = [line for line in done.stderr.splitlines() if not line.startswith(PATIENCE)]
    assert first.startswith("mesokit: error: ") and words.format(file) in first
    assert [line.rpartition(", ")[2] for line in rest if line.startswith("  File")] == frames
    assert not any("Traceback" in line or "site-packages" in line for line in rest)
