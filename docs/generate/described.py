"""What griffe reads of the sources, with the docstrings that components describe themselves by."""

from __future__ import annotations

import importlib
import inspect
import re
from typing import Any

import griffe

from mesokit.case.describe.keys import Documented, Key

DOCTEST = re.compile(r"^>>> .*(?:\n.+)*", re.MULTILINE)


class Described(griffe.Extension):
    """Fields of components are shown once, as a table, instead of as attributes; examples that
    stand by themselves are code."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Whatever has a docstring."""
        if obj.docstring and "Examples" not in obj.docstring.value:
            text = inspect.cleandoc(obj.docstring.value)
            obj.docstring.value = DOCTEST.sub(r"```pycon\n\g<0>\n```", text)

    def on_class(self, *, cls: griffe.Class, **_: Any) -> None:
        """A class whose fields are made by `param`."""
        if not cls.path.startswith("mesokit.") or not cls.docstring:
            return
        found: Any = importlib.import_module(cls.module.path)
        for name in cls.path.removeprefix(f"{cls.module.path}.").split("."):
            found = getattr(found, name, None)
        fields = getattr(found, "__pydantic_fields__", None)
        described = vars(found).get("__doc__") if fields is not None else None
        if not isinstance(described, Documented):
            return
        summary, end, examples = described.text.partition("\nExamples:")
        table = _table(described.keys(found))
        cls.docstring.value = f"{summary.rstrip()}\n\n{table}\n{end}{examples}"
        for name in list(cls.members):
            if name in fields or name == "__init__":
                cls.del_member(name)


def _default(key: Key) -> str:
    return f"`{key.default}`" if key.default not in ("", "required") else key.default


def _table(keys: list[Key]) -> str:
    """The fields, as in the reference of the case file."""
    rows = [
        (
            f"`{key.name}`",
            f"{key.takes} [{key.unit}]".removesuffix(" []"),
            _default(key),
            key.meaning,
        )
        for key in keys
    ]
    head = ["| field | takes | default | meaning |", "|---|---|---|---|"] if rows else []
    cells = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    return "\n".join([*head, *(f"| {' | '.join(row)} |" for row in cells)]) + "\n"
