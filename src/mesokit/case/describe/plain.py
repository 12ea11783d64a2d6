"""JSON schema of components from pydantic, made plain for the editors of case files.

Draft 7, which editors of TOML understand: nothing beside a `$ref`, no `null` (TOML has none), units
at the end of descriptions, and tags required wherever they tell parts apart.
"""

from collections.abc import Iterable, Mapping
from contextvars import ContextVar
from typing import Any

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

Schema = dict[str, Any]
PLAIN = ContextVar("PLAIN", default=False)  # docstrings as written, for they are described here
PLACE = "#/definitions/"
TAGS = ("rule", "shape", "quantity", "substance")  # keys whose value names a component
LIMITS = {  # as pydantic leaves them beside a choice that has None
    "gt": "exclusiveMinimum",
    "ge": "minimum",
    "lt": "exclusiveMaximum",
    "le": "maximum",
    "min_length": "minLength",
    "max_length": "maxLength",
}


def plain_schemas(components: Mapping[str, Any]) -> tuple[dict[str, Schema], dict[str, Schema]]:
    """The schema of each component by its name here, and the definitions that they refer to."""
    wanted = [(name, _inputs, TypeAdapter(cls)) for name, cls in components.items()]
    token = PLAIN.set(True)
    try:
        found, rest = TypeAdapter.json_schemas(
            wanted, ref_template=f"{PLACE}{{model}}", schema_generator=_Untitled
        )
    finally:
        PLAIN.reset(token)
    definitions = rest.get("$defs", {})
    for tag, parts in _choices([*found.values(), *definitions.values()]):
        for name, place in parts.items():
            definition = definitions[place]
            definition["properties"][tag] |= {"const": name}  # also where its author wrote `str`
            if len(parts) > 1:  # the only part need not be named
                definition["required"] = sorted({*definition.get("required", ()), tag})
    schemas = {}
    for name in components:
        schema = found[name, _inputs]
        if "$ref" in schema:  # and no more
            schema = definitions[schema["$ref"].removeprefix(PLACE)]
        schemas[name] = _plain(schema)
    return (
        schemas,
        {name: _plain(schema) for name, schema in definitions.items()},
    )


_inputs: Any = "validation"


class _Untitled(GenerateJsonSchema):
    """Classes have titles, which are their names; keys need none."""

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def _choices(node: Any) -> Iterable[tuple[str, dict[str, str]]]:
    """Each choice among parts: the tag, and the definition of each part by its name."""
    if isinstance(node, dict):
        if isinstance(choice := node.get("discriminator"), dict) and "mapping" in choice:
            places = choice["mapping"].items()
            yield choice["propertyName"], {name: p.removeprefix(PLACE) for name, p in places}
        node = list(node.values())
    if isinstance(node, list):
        for inner in node:
            yield from _choices(inner)


def _plain(node: Schema) -> Schema:
    made: Schema = {}
    for key, value in node.items():
        if key == "properties":
            made[key] = {name: _plain(inner) for name, inner in value.items()}
        elif key in ("anyOf", "oneOf", "allOf"):
            made[key] = [_plain(inner) for inner in value if inner != {"type": "null"}]
        elif key == "items":
            made[key] = _plain(value)
        elif key == "prefixItems":
            items = [_plain(inner) for inner in value]
            made["items"] = items[0] if items.count(items[0]) == len(items) else items
        elif key != "discriminator":
            made[LIMITS.get(key, key)] = value
    for key in ("anyOf", "oneOf"):
        if len(made.get(key, ())) == 1:
            made = {**made.pop(key)[0], **made}
    _settle_default(made)
    made.pop("symbol", None)  # of figures
    if made.get("unit"):
        made["description"] = f"{made['description']} [{made['unit']}]"
    else:
        made.pop("unit", None)
    if "$ref" in made and len(made) > 1:
        made["allOf"] = [{"$ref": made.pop("$ref")}]
    return made


def _settle_default(made: Schema) -> None:
    """Leave out a default without a meaning: a table of defaults, or what stands for one that is
    found later."""
    default = made.pop("default", None)
    default = made.pop("unless_said", default)
    if isinstance(default, dict):
        named = any(tag in default for tag in TAGS)
        default = {key: each for key, each in default.items() if named and each not in (None, [])}
    if isinstance(default, list):  # tables in a list, without values that are not given
        default = [
            {k: v for k, v in each.items() if v not in (None, [])}
            if isinstance(each, dict)
            else each
            for each in default
        ]
    limited = isinstance(default, float | int) and (
        default <= made.get("exclusiveMinimum", float("-inf"))
        or default < made.get("minimum", float("-inf"))
    )
    if default not in (None, [], {}, "") and not limited:
        made["default"] = default
