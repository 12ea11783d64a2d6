"""The sources, parsed once for all rules about them."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "mesokit"


@pytest.fixture(scope="package")
def texts() -> dict[str, str]:
    """The text of each file, by its path below src/mesokit."""
    files = sorted(SOURCE.rglob("*.py"))
    return {path.relative_to(SOURCE).as_posix(): path.read_text("utf-8") for path in files}


@pytest.fixture(scope="package")
def nodes(texts: dict[str, str]) -> dict[str, list[ast.AST]]:
    """All nodes of the syntax tree of each file."""
    return {name: list(ast.walk(ast.parse(text))) for name, text in texts.items()}
