"""What editors, `help` and type checkers say of components is what holds."""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import mesokit
from mesokit.case.component import component, is_component, param

ROOT = Path(__file__).parents[2]
CACHE = ROOT / ".mypy_cache" / "users"  # seconds instead of a quarter of a minute
PUBLIC = [getattr(mesokit, name) for name in mesokit.__all__]
COMPONENTS = [part for part in PUBLIC if is_component(part)]


def test_signatures_can_be_read() -> None:
    assert len(COMPONENTS) > 60
    for part in COMPONENTS:
        text = str(inspect.signature(part))
        assert not re.search(r"Annotated|Validator|0x|Undefined|Any\b|mesokit\.", text), text
    assert str(inspect.signature(mesokit.Fluid)).startswith(
        "(density: float = 10.0, timestep: float = 0.1, kT: float = 1.0, mass: float = 1.0, "
        "collision: CollisionRule = SRD(), thermostat: Thermostat = NoThermostat(), "
    )
    assert str(inspect.signature(mesokit.Disk)).startswith(
        "(centre: tuple[float, ...], radius: float, *, virtual: Literal["
    )


NEED_ONE = {
    "BodyTrap",
    "CounterForce",
    "Squirming",
}  # of several parameters, so that defaults alone are refused


def test_defaults_are_those_that_hold() -> None:
    for part in [part for part in COMPONENTS if part.__name__ not in NEED_ONE]:
        given = inspect.signature(part).parameters
        if inspect.isabstract(part) or any(p.default is p.empty for p in given.values()):
            continue
        made = part()
        for name, parameter in given.items():
            value = getattr(made, name)
            shown = parameter.default
            if not isinstance(shown, str) or isinstance(value, str):
                assert value == shown, f"{part.__name__}.{name}"
            else:  # a component, as it is written
                assert eval(shown, {type(value).__name__: type(value)}) == value


def test_a_part_of_ones_own_has_a_signature_too() -> None:
    @component
    class Mine:
        number: int = param(doc="how many", unit="a", ge=1)
        spring: mesokit.Harmonic = param(mesokit.Harmonic(K=3.0), doc="a spring")

    @component
    class More(Mine):
        more: tuple[float, ...] | None = param(None, doc="and more")

    spring = "spring: Harmonic = Harmonic(K=3.0)"
    assert str(inspect.signature(Mine)) == f"(number: int, {spring})"
    more = "more: tuple[float, ...] | None = None"
    assert str(inspect.signature(More)) == f"(number: int, {spring}, {more})"
    assert More(2, more=[1, 2]).more == (1.0, 2.0)


USES = """
from mesokit import Case, Cylinder, Disk, Harmonic, MeanSquareDisplacement, Plates, Polymer
from mesokit import Probe, Solutes, Union, Uniform
import numpy as np

disk = Disk([4, 4], 1, surface=mesokit.Surface(), name="first", fluid="outside")
case = Case(
    run=Run(steps=5), box=Box((20, 20)), fluid=Fluid(force=Uniform([0.1, 0])),
    walls=[Plates("y"), Disk(np.array([4.0, 4.0]), radius=1), Union([disk])],
    observe=[Probe(centre=[1, 2], every=3, name="here"), MeanSquareDisplacement(components=["x"])],
)
solutes = Solutes([Polymer(2, length=3)], bond=Harmonic(K=2.0))
rod = Cylinder([1, 2, 3], 1.0, axis=[0, 0, 1])
size: tuple[int, ...] = case.box.size
centre: tuple[float, ...] = disk.centre
place: tuple[float, ...] | None = Probe().centre
"""
WRONG = """
Disk([4, 4], "one")
Disk([4, "a"], 1)
Disk([4, 4], 1, 2)
Fluid(densty=3)
SRD(angle="a")
Probe(3, 4, 5, 6)
disk.radius = 3.0
"""


@pytest.mark.long
def test_type_checkers_know_what_users_may_write(tmp_path: Path) -> None:
    """The script of the README and what guides show is right, and what is wrong is told."""
    [script, *_] = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text("utf-8"),
                              re.DOTALL | re.MULTILINE)  # fmt: skip
    right = f"import mesokit\n{script}{USES}"
    (tmp_path / "right.py").write_text(right, "utf-8")
    (tmp_path / "wrong.py").write_text(right + WRONG, "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file=", "--follow-imports=silent",
         "--ignore-missing-imports", f"--cache-dir={CACHE}", "right.py", "wrong.py"],
        cwd=tmp_path, env=os.environ | {"MYPYPATH": str(ROOT / "src"), "PYTHONPATH": ""},
        capture_output=True, text=True,
    )  # fmt: skip
    told = [line for line in done.stdout.splitlines() if ": error:" in line]
    assert not [line for line in told if line.startswith("right.py")], done.stdout
    lines = {int(line.split(":")[1]) for line in told}
    last = (right + WRONG).count("\n")
    assert lines == set(range(last - WRONG.count("\n") + 2, last + 1)), done.stdout
