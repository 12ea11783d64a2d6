"""What griffe reads of the sources, with the docstrings that components describe themselves by."""

from __future__ import annotations

import importlib
from typing import Any

import griffe


class Described(griffe.Extension):
    """Fields of components are shown once, as a table, instead of as attributes."""

    def on_class(self, *, cls: griffe.Class, **_: Any) -> None:
        """A class whose fields are made by `param`."""
        if not cls.path.startswith("mesokit.") or not cls.docstring:
            return
        found: Any = importlib.import_module(cls.module.path)
        for name in cls.path.removeprefix(f"{cls.module.path}.").split("."):
            found = getattr(found, name, None)
        fields = getattr(found, "__pydantic_fields__", None)
        if fields is None:
            return
        cls.docstring.value = found.__doc__
        for name in list(cls.members):
            if name in fields or name == "__init__":
                cls.del_member(name)
