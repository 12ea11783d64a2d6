"""Methods of simulation: a folder for each and one line here, or an installed package.

A package brings a method by an entry point of the group `mesokit.methods`, whose name is what
`run.method` says and whose value is the module that holds its `METHOD`.
"""

import importlib
import pathlib
from typing import Any

from mesokit.errors import CaseError

METHODS = {  # value of `run.method`: the module that holds the METHOD
    "mpcd": "mesokit.method.mpcd.method",
    "brownian": "mesokit.method.brownian.method",
    "flock": "mesokit.method.flock.method",
    "event-driven": "mesokit.method.spheres.hard.method",
    "soft-spheres": "mesokit.method.spheres.soft.method",
    "contact-dynamics": "mesokit.method.spheres.rigid.method",
    "kinetic-monte-carlo": "mesokit.method.kinetic_monte_carlo.method",
}
DEFAULT = next(iter(METHODS))


def modules() -> dict[str, str]:
    """The module of each method by its name, those of installed packages included."""
    import importlib.metadata

    installed = importlib.metadata.entry_points(group="mesokit.methods")
    return {point.name: point.module for point in installed} | METHODS


def load(name: str) -> Any:
    """The `Method` of that name.

    Raises KeyError if there is none, and CaseError if that of a package cannot be imported.
    """
    if name in METHODS:
        return importlib.import_module(METHODS[name]).METHOD
    place = modules()[name]
    try:
        return importlib.import_module(place).METHOD
    except (ImportError, AttributeError) as error:
        reason = " ".join(str(error).split())
        raise CaseError(
            f"run.method = {name!r}: module {place!r} of its package cannot be imported: {reason}"
        ) from error


def templates() -> dict[str, Any]:
    """The files that `mesokit new` starts from, by name: those in `templates/` of each method."""
    import importlib.resources
    import importlib.util

    files: list[Any] = []
    for module in modules().values():
        package = module.rpartition(".")[0]  # which is not imported
        spec = importlib.util.find_spec(package) if package else None
        if spec is not None:
            folder = importlib.resources.files(importlib.util.module_from_spec(spec)) / "templates"
            files += folder.iterdir() if folder.is_dir() else ()
    return {file.name.removesuffix(".toml"): file for file in sorted(files, key=lambda f: f.name)}


def examples() -> dict[str, Any]:
    """Commented cases from a channel with a cylinder to thinning dumbbells, by name."""
    return _examples_in("") | _examples_in("viscoelastic/") | _examples_in("rheometer/")


def studies() -> dict[str, Any]:
    """Commented study files, by name: each names one of the examples as its case."""
    return _examples_in("studies/")


def _examples_in(start: str) -> dict[str, Any]:
    """The examples in a folder, by name with the folder before it.

    Wheels carry them inside the package; in a clone they lie beside `src`.
    """
    import importlib.resources

    package = importlib.resources.files("mesokit")
    folder = package / "examples"
    if not folder.is_dir():
        folder = pathlib.Path(str(package)).parents[1] / "examples"
    place = folder / start if start else folder
    files = sorted(place.iterdir(), key=lambda f: f.name) if place.is_dir() else []
    named = {file.name.removesuffix(".toml"): file for file in files}
    return {start + name: file for name, file in named.items() if file.name.endswith(".toml")}
