"""No part is known by its name: what others ask of it, its class answers."""

from __future__ import annotations

import ast
import typing
from collections.abc import Iterable, Iterator

import pytest

from mesokit.case.case import case_class
from mesokit.case.component import TAGS, is_component, names_of
from mesokit.case.methods import METHODS
from mesokit.case.registry import FAMILIES, Family

# words that mean something else as well: what a step sums, a primitive of solids, keys of a start
OTHERS = {"stress", "sampled", "file", "run"}
CASES = [case_class(method) for method in METHODS]
NAMES = {name for family in FAMILIES.values() for name in family.parts}


def options(hint: typing.Any, within: tuple[Family, ...] = ()) -> Iterator[str]:
    """Words that a component takes as an option, such as the end of a bond or a side.

    A part may have another of its family in it, such as a force that it changes in time.
    """
    if isinstance(hint, Family):
        for part in hint.parts.values() if hint not in within else ():
            yield from options(part, (*within, hint))
    elif is_component(hint):
        for name, field in hint.__pydantic_fields__.items():
            if name not in TAGS or not names_of(hint):
                yield from options(field.annotation, within)
                for mark in field.metadata:
                    yield from options(mark, within)
    elif typing.get_origin(hint) is typing.Literal:
        yield from (word for word in typing.get_args(hint) if isinstance(word, str))
    else:
        for arg in typing.get_args(hint):
            yield from options(arg, within)


OPTIONS = {word for case in CASES for word in options(case)}


def words(node: ast.expr) -> set[str]:
    """The texts that a constant, or a list, set or tuple of constants, says."""
    if isinstance(node, ast.Tuple | ast.List | ast.Set):
        return {word for element in node.elts for word in words(element)}
    return {node.value} if isinstance(node, ast.Constant) and isinstance(node.value, str) else set()


def tagged(node: ast.expr) -> bool:
    """Whether an expression is the tag of a part, such as `wall.shape`; a surface is no part."""
    if isinstance(node, ast.Subscript):
        return bool(words(node.slice) & set(TAGS))
    if not isinstance(node, ast.Attribute) or node.attr not in TAGS:
        return False
    return not ast.unparse(node.value).endswith("surface")


def comparisons(nodes: Iterable[ast.AST]) -> Iterator[tuple[int, str]]:
    """Lines where a name of a part, or the tag of one, is compared with a text."""
    for node in nodes:
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            said = {word for side in sides for word in words(side)} & NAMES
            if said - OPTIONS - OTHERS or (said and any(map(tagged, sides))):
                yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.Dict):
            keys = {word for key in node.keys if key is not None for word in words(key)} & NAMES
            if len(keys) > 1 and keys - OPTIONS:
                yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            cut = ("startswith", "endswith", "removesuffix", "removeprefix")
            if node.func.attr in cut and tagged(node.func.value):
                yield node.lineno, ast.unparse(node)
        elif isinstance(node, ast.MatchValue) and words(node.value) & NAMES:
            yield node.value.lineno, ast.unparse(node)
        elif isinstance(node, ast.Subscript) and tagged(node.slice):
            yield node.lineno, ast.unparse(node)


def test_no_part_is_known_by_its_name(nodes: dict[str, list[ast.AST]]) -> None:
    # `theory` knows nothing of parts: its functions take the names of published rules
    files = {name: of_file for name, of_file in nodes.items() if not name.startswith("theory/")}
    found = {name: list(comparisons(of_file)) for name, of_file in files.items()}
    assert not {name: lines for name, lines in found.items() if lines}


@pytest.mark.parametrize(
    "line",
    [
        'rule.rule == "srd"',
        'wall.shape in ("disk", "sphere")',
        'rule.rule.endswith("+a")',
        'DRAW = {"wake": 1, "probe": 2}',
        "DRAW[result.quantity]",
        'given["rule"].startswith("srd")',
        'fluid.thermostat.rule != "none"',
    ],
)
def test_it_sees_what_it_should(line: str) -> None:
    assert list(comparisons(ast.walk(ast.parse(line))))


@pytest.mark.parametrize("line", ['surface.rule == "slip"', 'solutes.solvent == "random"'])
def test_options_may_be_compared(line: str) -> None:
    assert not list(comparisons(ast.walk(ast.parse(line))))
