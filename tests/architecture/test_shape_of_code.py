"""The step fits on a page, and functions take lists of arguments that can be read."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

import pytest

MOST_PARAMETERS = 8


def functions(nodes: Iterable[ast.AST]) -> Iterator[ast.FunctionDef]:
    """All functions of a file but numba's intrinsics, which are single instructions."""
    for node in nodes:
        if isinstance(node, ast.FunctionDef) and not any(
            "intrinsic" in ast.unparse(decorator) for decorator in node.decorator_list
        ):
            yield node


def parameters(function: ast.FunctionDef) -> int:
    given = function.args
    return len(given.posonlyargs) + len(given.args) + len(given.kwonlyargs)


def with_many(nodes: Iterable[ast.AST]) -> list[str]:
    """Functions with more parameters than are allowed."""
    found = ((f, parameters(f)) for f in functions(nodes))
    return [f"{f.name} ({n}), line {f.lineno}" for f, n in found if n > MOST_PARAMETERS]


def test_functions_take_few_parameters(nodes: dict[str, list[ast.AST]]) -> None:
    found = {name: with_many(of_file) for name, of_file in nodes.items()}
    assert not {name: many for name, many in found.items() if many}


def test_many_parameters_are_seen() -> None:
    text = "def f(a, b, /, c, d, *, e, f, g, h, i): ..."
    assert with_many(ast.walk(ast.parse(text))) == ["f (9), line 1"]
    assert not with_many(ast.walk(ast.parse("def f(a, b, c, d, e, f, g, h): ...")))


@pytest.mark.parametrize("name", ["step", "advance"])
def test_the_step_is_on_one_page(name: str, nodes: dict[str, list[ast.AST]]) -> None:
    [function] = [f for f in functions(nodes["method/mpcd/engine/cpu/step.py"]) if f.name == name]
    assert parameters(function) <= 6
    assert len(function.body) - 1 <= 20  # the docstring is not counted
    assert (function.end_lineno or 0) - function.lineno <= 22


def test_no_formatting_is_switched_off_for_arguments(texts: dict[str, str]) -> None:
    assert not [name for name, text in texts.items() if ")  # fmt: skip" in text]
