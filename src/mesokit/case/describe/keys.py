"""The keys of a component, read from its JSON schema: rows of tables, and part of its docstring."""

import inspect
import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from mesokit.case.describe.plain import PLACE, PLAIN, Schema, plain_schemas

KINDS = {
    "number": "number",
    "integer": "whole number",
    "string": "text",
    "boolean": "true or false",
}
BOUNDS = (
    ("exclusiveMinimum", "above"),
    ("minimum", "at least"),
    ("exclusiveMaximum", "below"),
    ("maximum", "at most"),
)
REQUIRED = "required"
MOST_DIGITS = 10**9
Parts = tuple[str, dict[str, Schema]]  # the tag, and the parts by their names
FEW = 4  # parts that are named one by one


class Key(NamedTuple):
    """A key: what it takes, its unit and default (as in a case file), and what it means."""

    name: str
    takes: str
    unit: str
    default: str
    meaning: str
    tag: bool = False  # whether it names the component

    @property
    def values(self) -> str:
        """Its values, unit and default: 'number above 0 [a], default 1'."""
        takes = f"{self.takes} [{self.unit}]" if self.unit else self.takes
        complete = self.default in ("", REQUIRED)
        return ", ".join(
            filter(None, [takes, self.default if complete else f"default {self.default}"])
        )


class Documented:
    """The `__doc__` of a component with a table of its keys, made when it is read."""

    def __init__(self, text: str | None) -> None:
        self.text = inspect.cleandoc(text or "")
        self.whole = ""

    def __get__(self, instance: Any, owner: type) -> str:
        if PLAIN.get():  # a schema has no room for code
            return self.text.partition("\nExamples:")[0].rstrip()
        if not self.whole:
            summary, end, examples = self.text.partition("\nExamples:")
            keys = [] if "Parameters" in self.text else self.keys(owner)
            table = "\n".join(f"    {key.name} ({key.values}): {key.meaning}" for key in keys)
            parts = [summary.rstrip(), f"Parameters:\n{table}", (end + examples).strip()]
            self.whole = "\n\n".join(filter(None, parts)) + "\n" if keys else self.text
        return self.whole

    def keys(self, owner: type) -> list[Key]:
        """The keys of the component but its tag."""
        found, definitions = plain_schemas({"": owner})
        return [key for key in keys_of(found[""], definitions) if not key.tag]


def keys_of(definition: Mapping[str, Any], definitions: Mapping[str, Schema]) -> list[Key]:
    """The keys of a component, its tag first."""
    required = definition.get("required", ())
    found: list[Key] = []
    for name, inner in definition["properties"].items():
        meaning, unit = inner.get("description", ""), inner.get("unit", "")
        named = "const" in inner  # the tag: it has no other value
        default = "" if named else REQUIRED if name in required else _text(inner.get("default"))
        meaning = meaning.removesuffix(f" [{unit}]")
        key = Key(name, takes(inner, definitions), unit, default, meaning, named)
        found.insert(0 if named else len(found), key)
    return found


def takes(node: Schema, definitions: Mapping[str, Schema]) -> str:
    """Values that a key takes, in words, such as 'number above 0'."""
    if "const" in node:
        return _text(node["const"])
    if "enum" in node:
        return _listed([_text(word) for word in node["enum"]])
    if parts := parts_of(node, definitions):
        tag, names = parts
        words = [_text(name) for name in names]
        if not tag:
            found = "table"
        elif len(words) > FEW:
            found = f"table with one of {len(words)} names as {tag}"
        else:
            found = f"table with {tag} = {_listed(words)}"
        return f"list of {plural(found)}" if "items" in node else found
    if "anyOf" in node:
        words = [takes(each, definitions) for each in node["anyOf"]]
        if len(set(words)) > 1 and all("title" in each for each in node["anyOf"]):
            pairs = zip(node["anyOf"], words, strict=True)
            return "; ".join(f"{each['title']}: {complete}" for each, complete in pairs)
        return _listed(list(dict.fromkeys(words)))
    if "items" in node:
        number = f"{node['minItems']} " if node.get("minItems", 0) == node.get("maxItems") else ""
        return f"list of {number}{plural(takes(node['items'], definitions))}"
    words = [f"{words} {_number(node[limit])}" for limit, words in BOUNDS if limit in node]
    return " ".join([KINDS[node["type"]], ", ".join(words)]).strip()


def plural(words: str) -> str:
    """'numbers above 0' from 'number above 0'."""
    for word in ("number", "table", "text"):
        if words.startswith((word, f"whole {word}")):
            return words.replace(word, f"{word}s", 1)
    return words


def parts_of(node: Schema, definitions: Mapping[str, Schema]) -> Parts | None:
    """The tag and the parts, by name, that a key chooses from; without a tag, a plain table."""
    node = node.get("items", node)
    options: list[Any] = node.get("oneOf") or node.get("allOf") or [node]
    places = [option["$ref"].removeprefix(PLACE) for option in options if "$ref" in option]
    if not places or len(places) < len(options):
        return None
    found = [definitions[place] for place in places]
    tag = next((key for key, inner in found[0]["properties"].items() if "const" in inner), "")
    if not tag:
        return "", {"": found[0]}
    return tag, {each["properties"][tag]["const"]: each for each in found}


def _listed(words: list[str]) -> str:
    return " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _text(value: Any) -> str:
    """A value as in a case file; nothing for None."""
    if value is None:
        return ""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_text(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else _number(value)


def _number(value: float) -> str:
    bits = math.frexp(value)
    if value > MOST_DIGITS and bits[0] == 0.5:
        return f"2^{bits[1] - 1}"
    return f"{value:.12g}"
