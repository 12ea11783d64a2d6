"""The step fits on a page, and no function takes a list of arguments that nobody can read."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "mesokit"
FILES = sorted(SOURCE.rglob("*.py"))
MOST_PARAMETERS = 8


def functions(path: Path) -> Iterator[ast.FunctionDef]:
    """All functions of a file but numba's intrinsics, which are single instructions."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef) and not any(
            "intrinsic" in ast.unparse(decorator) for decorator in node.decorator_list
        ):
            yield node


def parameters(function: ast.FunctionDef) -> int:
    given = function.args
    return len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(SOURCE)))
def test_functions_take_few_parameters(path: Path) -> None:
    many = [f"{f.name} ({parameters(f)})" for f in functions(path)]
    assert not [f.name for f in functions(path) if parameters(f) > MOST_PARAMETERS], many


@pytest.mark.parametrize("name", ["step", "advance"])
def test_the_step_is_on_one_page(name: str) -> None:
    path = SOURCE / "execute" / "cpu" / "step.py"
    [function] = [f for f in functions(path) if f.name == name]
    assert parameters(function) <= 6
    assert len(function.body) - 1 <= 20  # the docstring is not counted
    assert (function.end_lineno or 0) - function.lineno <= 22


def test_no_formatting_is_switched_off_for_arguments() -> None:
    for path in FILES:
        assert ")  # fmt: skip" not in path.read_text(encoding="utf-8"), path
