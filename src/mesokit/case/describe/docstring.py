"""Docstrings of components: what their authors wrote, and their keys, described when asked for."""

import inspect
from typing import Any

from mesokit.case.describe.keys import Key, keys_of
from mesokit.case.describe.plain import PLAIN, plain_schemas


class Documented:
    """The `__doc__` of a component, made when `help` looks: imports stay quick."""

    def __init__(self, text: str | None) -> None:
        self.text = inspect.cleandoc(text or "")
        self.whole = ""

    def __get__(self, instance: Any, owner: type) -> str:
        if PLAIN.get():  # a schema has no room for code
            return self.text.partition("\nExamples:")[0].rstrip()
        self.whole = self.whole or self._described(owner)
        return self.whole

    def keys(self, owner: type) -> list[Key]:
        """The keys of the component but its tag."""
        found, definitions = plain_schemas({"": owner})
        return [key for key in keys_of(found[""], definitions) if not key.tag]

    def _described(self, owner: type) -> str:
        keys = self.keys(owner)
        if not keys or "Parameters" in self.text:
            return self.text
        summary, end, examples = self.text.partition("\nExamples:")
        table = "\n".join(_line(key) for key in keys)
        parts = [summary.rstrip(), f"Parameters:\n{table}", (end + examples).strip()]
        return "\n\n".join(filter(None, parts)) + "\n"


def _line(key: Key) -> str:
    return f"    {key.name} ({key.values}): {key.meaning}"
