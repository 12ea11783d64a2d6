"""Methods of simulation: a folder for each and one line here, or an installed package.

A package brings a method by an entry point of the group `mesokit.methods`, whose name is what
`run.method` says and whose value is the module that holds its `METHOD`.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.resources
import pathlib
from typing import Any

METHODS = {  # what `run.method` says: the module that holds the METHOD
    "mpcd": "mesokit.method.mpcd.method",
    "brownian": "mesokit.method.brownian.method",
    "flock": "mesokit.method.flock.method",
    "event-driven": "mesokit.method.event_driven.method",
}
DEFAULT = next(iter(METHODS))


def modules() -> dict[str, str]:
    """The module of each method by its name, those of installed packages included."""
    installed = importlib.metadata.entry_points(group="mesokit.methods")
    return {point.name: point.value for point in installed} | METHODS


def load(name: str) -> Any:
    """The `Method` of that name. Raises KeyError if there is none."""
    place = METHODS[name] if name in METHODS else modules()[name]
    return importlib.import_module(place).METHOD


def templates() -> dict[str, Any]:
    """The files that `mesokit new` starts from, by name: those in `templates/` of each method."""
    packages = [importlib.resources.files(place.rpartition(".")[0]) for place in modules().values()]
    folders = [package / "templates" for package in packages if (package / "templates").is_dir()]
    files = [file for folder in folders for file in folder.iterdir()]
    return {file.name.removesuffix(".toml"): file for file in sorted(files, key=lambda f: f.name)}


def examples() -> dict[str, Any]:
    """Commented cases from a channel with a cylinder to thinning dumbbells, by name.

    Wheels carry them inside the package; in a clone they lie beside `src`.
    """
    package = importlib.resources.files("mesokit")
    folder = package / "examples"
    if not folder.is_dir():
        folder = pathlib.Path(str(package)).parents[1] / "examples"
    found, within = {}, ("viscoelastic", "rheometer")
    for place, start in ((folder, ""), *((folder / name, f"{name}/") for name in within)):
        files = place.iterdir() if place.is_dir() else ()
        for file in sorted(files, key=lambda f: f.name):
            if file.name.endswith(".toml"):
                found[start + file.name.removesuffix(".toml")] = file
    return found
