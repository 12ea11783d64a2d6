"""One word for one idea: names of the code follow the table of words in docs/conventions.md."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from mesokit.method import __path__ as methods

METHODS = Path(methods[0])
CONVENTIONS = Path(__file__).parents[2] / "docs" / "conventions.md"
# What a heap of events does is called so everywhere; and the impulse along the normal of a contact.
ELSEWHERE = {("push", "method/spheres/hard/engine/queue.py")}
RIGID = "method/spheres/rigid/"
FOLDERS = {
    "mpcd": ("mpcd",),
    "flock": ("flock",),
    "brownian": ("brownian",),
    "hard": ("spheres/hard", "spheres/common"),
    "soft": ("spheres/soft", "spheres/common"),
    "rigid": ("spheres/rigid", "spheres/common"),
}


def words() -> dict[str, list[str]]:
    """Each word of the table, and those that it replaces."""
    section = CONVENTIONS.read_text("utf-8").split("## Words")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in section.splitlines() if line.startswith("| ")]
    return {row[0]: re.findall(r"`(\w+)`", row[-1]) if len(row) > 2 else [] for row in rows[1:]}


def names_in(node: ast.AST) -> Iterator[str]:
    """Names that a piece of code gives: functions, classes, parameters, variables, fields."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        yield node.name
    elif isinstance(node, ast.arg):
        yield node.arg
    elif isinstance(node, ast.Name):
        yield node.id
    elif isinstance(node, ast.Attribute):
        yield node.attr


def replaced(nodes: dict[str, list[ast.AST]]) -> set[tuple[str, str]]:
    """Words of the third column that names are made of, and the files of these names."""
    banned = {word for row in words().values() for word in row}
    found = set()
    for file, of_file in nodes.items():
        for name in {name for node in of_file for name in names_in(node)}:
            pieces = {name, *re.split("_+", name.strip("_").lower())} & banned
            if not name.endswith("_like"):  # NumPy's
                found |= {(word, file) for word in pieces}
    return found


def test_the_table_has_some_forty_words() -> None:
    assert len(words()) >= 40


def test_names_use_the_words_of_the_table(nodes: dict[str, list[ast.AST]]) -> None:
    found = replaced(nodes) - ELSEWHERE
    assert {word for word, file in found if file.startswith(RIGID)} <= {"push"}
    assert {(word, file) for word, file in found if not file.startswith(RIGID)} == set()


@pytest.mark.parametrize(
    "line", ["def f(like): ...", "guest_cell = 1", "one.roster", "def torn(): ..."]
)
def test_it_sees_a_word_that_was_replaced(line: str) -> None:
    assert replaced({"some.py": list(ast.walk(ast.parse(line)))})


def definitions(path: Path) -> Iterator[str]:
    """Public functions and classes of a module, without implementations of protocols."""
    for node in ast.parse(path.read_text("utf-8")).body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
            continue
        if not any(".register" in ast.unparse(one) for one in node.decorator_list):
            yield node.name


@pytest.mark.parametrize("method", FOLDERS)
def test_a_name_has_one_meaning_in_a_method(method: str) -> None:
    where = defaultdict(list)
    for folder in FOLDERS[method]:
        for path in sorted((METHODS / folder).rglob("*.py")):
            for name in definitions(path):
                where[name].append(str(path.relative_to(METHODS)))
    assert len(where) > 5
    assert {name: files for name, files in where.items() if len(files) > 1} == {}
