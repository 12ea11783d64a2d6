"""Whatever a step does to a particle or a cell can be compiled for a GPU, with the CPU's bits."""

from __future__ import annotations

import hashlib
import importlib
import pkgutil
import re
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import mesokit
from mesokit.kernels.store import folder
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import scalar, seldom
from tests.helpers import gpu_compiler, gpu_examples

pytestmark = pytest.mark.long

# What CUDA has in a library of its own, and rounds in its own way.
LIBRARY = ("sin", "cos", "tan", "exp", "log", "pow", "powi", "cbrt", "hypot", "atan", "atan2")
READ_ONLY = {"Finite": ["log"]}  # the energy of FENE bonds: no motion depends on it


def library_functions(name: str) -> list[str]:
    """Functions of that library in what is compiled under a name; kept beside the kernels."""
    key = hashlib.sha256(name.encode() + version("numba-cuda").encode())
    sources = sorted(Path(mesokit.__file__).parent.rglob("*.py"))
    for path in (Path(gpu_examples.__file__), Path(gpu_compiler.__file__), *sources):
        key.update(path.read_bytes())
    kept = folder() / "ptx" / key.hexdigest()
    if not kept.exists():
        ir = gpu_compiler.compile_for_gpu(gpu_examples.CALLS[name]).ir
        found = [f for f in LIBRARY if f"@__nv_{f}(" in ir or f'@"__nv_{f}"(' in ir]
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(" ".join(found))
    return kept.read_text().split()


def modules() -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(mesokit.__path__, "mesokit."):
        if not found.name.endswith("__main__"):
            yield importlib.import_module(found.name)


# Of these the implementations are loops over lanes of a strip, or over lists: the CPU's own.
LOOPS = (
    "mesokit.method.kinetic_monte_carlo.engine.change",
    "mesokit.method.kinetic_monte_carlo.engine.choice",
    "mesokit.method.mpcd.engine.beads.links",
    "mesokit.method.mpcd.engine.beads.verlet",
    "mesokit.method.spheres.rigid.engine.collect",
    "mesokit.method.spheres.rigid.engine.find",
    "mesokit.method.spheres.rigid.engine.finish",
    "mesokit.method.spheres.soft.engine.acting",
    "mesokit.method.spheres.soft.engine.contact.collect",
)


def generic_functions() -> set[Callable]:
    everything = (value for module in modules() for value in vars(module).values())
    found = {value for value in everything if hasattr(value, "implementations")}
    return {function for function in found if function.__module__ not in LOOPS}


@pytest.mark.parametrize("name", gpu_examples.CALLS)
def test_it_compiles_for_a_gpu_without_its_own_library(name: str) -> None:
    assert library_functions(name) == READ_ONLY.get(name.split()[0], [])


def test_every_implementation_is_among_what_is_compiled() -> None:
    assert generic_functions() == set(gpu_examples.ASKED)
    shown = {type(part) for d in gpu_examples.DIMENSIONS for part in gpu_examples.parts(d)}
    assert [
        f"{function.__name__} of {kind.__name__}"
        for function in gpu_examples.ASKED
        for kind in function.implementations  # type: ignore[attr-defined]
        if kind.__module__.startswith("mesokit.") and kind not in shown
    ] == []


def test_what_a_gpu_does_not_know_is_found() -> None:
    @scalar
    def rounded_down(x):  # type: ignore[no-untyped-def]
        return np.floor(x)

    with pytest.raises(KeyError, match="floor"):
        gpu_compiler.compile_for_gpu([(rounded_down, (1.5,))])


def test_products_and_sums_are_rounded_one_by_one_unless_they_are_one_instruction() -> None:
    @scalar
    def apart(a, b, c):  # type: ignore[no-untyped-def]
        return a * b + c

    @scalar
    def at_once(a, b, c):  # type: ignore[no-untyped-def]
        return mul_add(a, b, c)

    for function, expected in ((apart, ["mul", "add"]), (at_once, ["fma"])):
        _, text = gpu_compiler.compile_for_gpu([(function, (1.0, 2.0, 3.0))], optimised=True)
        found = re.findall(r"(mul|add|fma)[.\w]*\.f64", text)
        assert found == expected


@pytest.mark.parametrize(("how", "calls"), [(scalar, 0), (seldom, 2)])
def test_what_is_seldom_needed_is_called_and_all_else_inlined(how: Callable, calls: int) -> None:
    @how
    def half(x):  # type: ignore[no-untyped-def]
        return 0.5 * x

    @scalar
    def both(x, y):  # type: ignore[no-untyped-def]
        return half(x) - half(y)

    _, text = gpu_compiler.compile_for_gpu([(both, (1.0, 2.0))], optimised=True)
    assert len(re.findall(r"\bcall\b", text)) == calls
