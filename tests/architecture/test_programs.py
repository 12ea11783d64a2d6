"""Programs beside the package import names that exist: no suite runs all of them."""

import ast
import importlib
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("benchmarks", "docs/generate", "examples", "tests", "validation")


def imported() -> Iterator[tuple[str, str, str]]:
    """Each file, module of the package and name that it imports from there, "" for the module."""
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ImportFrom):
                    for one in node.names:
                        yield str(path), node.module or "", one.name
                elif isinstance(node, ast.Import):
                    for one in node.names:
                        yield str(path), one.name, ""
    for path in sorted((ROOT / "docs").rglob("*.md")):
        found = re.findall(
            r"^from (mesokit[\w.]*) import ([\w, ]+)$", path.read_text(), re.MULTILINE
        )
        for module, names in found:
            for name in names.split(","):
                yield str(path), module, name.strip()


def test_every_imported_name_of_the_package_exists() -> None:
    rows = [row for row in imported() if row[1].split(".")[0] == "mesokit"]
    missing = []
    for path, module, name in rows:
        there = importlib.import_module(module)
        if name and not hasattr(there, name):
            try:
                importlib.import_module(f"{module}.{name}")
            except ModuleNotFoundError:
                missing.append(f"{path}: {module}.{name}")
    assert len(rows) > 1000 and not missing
