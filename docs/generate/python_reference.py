"""Reference of the Python names: pages of `__init__.pyi`, grouped by where they are."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path
from typing import Any

from case_reference import unfold
from mkdocs.structure.files import File, Files

from mesokit.case.component import is_component, tag_of

ROOT = Path(__file__).resolve().parents[2]
FOLDER = "reference/python"
GROUPS = (  # page, its title, where its names are; the first that fits decides
    ("errors", "Errors", ("mesokit.errors",)),
    ("fluid", "Fluid, collision rules, thermostats, forces", ("mesokit.method.mpcd",)),
    (
        "spheres",
        "Event-driven dynamics, soft spheres, contact dynamics",
        (
            "mesokit.method.spheres.hard",
            "mesokit.method.spheres.soft",
            "mesokit.method.spheres.rigid",
            "mesokit.method.spheres.common",
        ),
    ),
    ("flock", "Flocks", ("mesokit.method.flock",)),
    ("walls", "Walls", ("mesokit.geometry",)),
    ("observables", "Observables and results", ("mesokit.observe",)),
    ("potentials", "Potentials", ("mesokit.potential",)),
    ("case", "Case", ("mesokit.case",)),
    ("running", "Running, reading, reporting", ("mesokit",)),
)


def on_files(files: Files, config: Any) -> Files:
    """Add the pages, and an index of all names."""
    pages: dict[str, list[tuple[str, str]]] = {page: [] for page, _, _ in GROUPS}
    for name, place in _public().items():
        if place != "mesokit.theory":
            pages[_group(place)].append((name, place))
    index = [
        "# Python\n\nAll that `import mesokit` offers. [Theory](theory.md) has its own page.\n"
    ]
    for page, title, _ in GROUPS:
        if not pages[page]:
            continue
        blocks = [f"# {title}\n", *(_block(place) for _, place in sorted(pages[page]))]
        files.append(File.generated(config, f"{FOLDER}/{page}.md", content="\n\n".join(blocks)))
        names = ", ".join(f"[`{name}`][mesokit.{name}]" for name, _ in sorted(pages[page]))
        index.append(f"- [{title}]({page}.md): {names}\n")
    files.append(File.generated(config, f"{FOLDER}/index.md", content="\n".join(index)))
    theory = ["# Theory\n", *(f"::: {place}" for place in _theory())]
    files.append(File.generated(config, f"{FOLDER}/theory.md", content="\n\n".join(theory)))
    shown = [{title: f"{FOLDER}/{page}.md"} for page, title, _ in GROUPS if pages[page]]
    unfold(config["nav"], f"{FOLDER}/index.md", [*shown, {"Theory": f"{FOLDER}/theory.md"}])
    return files


def _block(place: str) -> str:
    """What mkdocstrings shows: of a part its parameters, for only its base has more to say."""
    module, _, name = place.rpartition(".")
    found = getattr(importlib.import_module(module), name, None)
    short = is_component(found) and tag_of(found)
    return f"::: {place}" + ("\n    options:\n      members: false" if short else "")


def _public() -> dict[str, str]:
    """Where each public name is defined."""
    table = ast.parse((ROOT / "src" / "mesokit" / "__init__.pyi").read_text(encoding="utf-8"))
    return {
        alias.name: f"{line.module}.{alias.name}"
        for line in table.body
        if isinstance(line, ast.ImportFrom)
        for alias in line.names
    }


def _group(place: str) -> str:
    return next(page for page, _, homes in GROUPS if place.startswith(homes))


def _theory() -> list[str]:
    from mesokit import theory

    found = {name: getattr(theory, name) for name in theory.__all__}
    return [f"{found[n].__module__}.{n}" for n in sorted(found) if hasattr(found[n], "__module__")]
