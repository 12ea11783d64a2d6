"""Parts of a case that are not of mesokit: their records, and a check that they are here."""

import contextlib
import dataclasses
import importlib
import re
from collections.abc import Iterator
from typing import Any

from mesokit.case import methods
from mesokit.case.component import is_component, name_of, tag_of
from mesokit.case.registry import FAMILIES, address, family_of
from mesokit.errors import MesokitError, RunError


def outside_parts(case: Any) -> list[dict[str, str]]:
    """Record of each such part: family, name, class, and the distribution with its version.

    A part that a script defines has no distribution.
    """
    found = []
    for part in _components(case):
        if is_outside(part) and tag_of(type(part)):
            family, name = family_of(part), name_of(part)
            record = {"family": address(family.base), "name": name, "class": address(type(part))}
            found.append(record | dict(family.brought_by(name)))
    return [record for i, record in enumerate(found) if record not in found[:i]]


def is_outside(part: Any) -> bool:
    """True if the class of a part is not of mesokit."""
    return type(part).__module__.split(".")[0] != "mesokit"


@contextlib.contextmanager
def blaming(case: Any) -> Iterator[None]:
    """Errors inside become a RunError that names the parts from outside, if there are any."""
    try:
        yield
    except (MesokitError, OSError, MemoryError):
        raise
    except Exception as error:
        parts = outside_parts(case)
        if not parts:
            raise
        names = ", ".join(f"{part['name']!r} ({part['class']})" for part in parts)
        # Of many lines of a compiler, the last that names an error; numba's may be coloured.
        text = re.sub(r"\x1b\[[0-9;]*m", "", str(error))
        lines = [f"{type(error).__name__}: {text}".splitlines()[0], *text.splitlines()]
        found = [line for line in lines if re.search(r"\b(?!Typing)[A-Z][a-z]\w*Error: ", line)]
        gist = " ".join((found or lines)[-1 if found else 0].split())
        raise RunError(f"{names}, not of mesokit: {gist}") from error


def require_parts(record: Any) -> None:
    """Raise RunError for the first part of `outside_parts` that is not here."""
    for part in record if isinstance(record, list) else []:
        module, _, base = part["family"].partition(":")
        if not module.startswith("mesokit."):
            raise RunError(f"{part['family']} is no family of parts")
        try:
            family = FAMILIES[getattr(importlib.import_module(module), base)]
        except (ImportError, AttributeError, KeyError, TypeError):
            raise RunError(f"{part['family']} is no family of parts") from None
        module = part["class"].partition(":")[0]
        for method in methods.modules().values():  # one from outside brings parts of its own
            if method.split(".")[0] == module.split(".")[0]:
                importlib.import_module(method)
        if family.find(part["name"]) is None:
            cure = f"import it first: `import {module}`, or mesokit --import {module} ..."
            if "distribution" in part:
                cure = f"install {part['distribution']} {part['version']}"
            raise RunError(
                f"{family.title} {part['name']!r} of this run, {part['class']}, is not here; {cure}"
            )


def _components(part: Any) -> Iterator[Any]:
    if isinstance(part, tuple):
        for element in part:
            yield from _components(element)
    elif is_component(type(part)):
        yield part
        for field in dataclasses.fields(part):
            yield from _components(getattr(part, field.name))
