"""JSON schema of case files, those of every method: `mesokit schema`."""

from typing import Any

from mesokit.case import methods
from mesokit.case.case import FIELDS, SECTIONS, case_class
from mesokit.case.checks import is_offered
from mesokit.case.component import tag_of
from mesokit.case.describe.plain import PLACE, plain_schemas
from mesokit.case.registry import FAMILIES
from mesokit.errors import CaseError

DIALECT = "http://json-schema.org/draft-07/schema#"


def schema() -> dict[str, Any]:
    """The JSON schema (draft 7) of a case file: every key, its meaning, unit, limits and default.

    It covers all methods and the parts that installed packages bring. Editors complete and check
    case files by it: Taplo and Even Better TOML where the first line is
    `#:schema ./case.schema.json`. Cases that it accepts may still be refused: it has no physics.

    Raises:
        CaseError: a method or a part that a package brings cannot be loaded.

    Examples:
        >>> found = schema()
        >>> found["definitions"]["SRD"]["properties"]["angle"]["description"]
        'rotation angle [degrees]'
        >>> sorted(found["properties"])[:4]
        ['bodies', 'box', 'brownian', 'flock']
    """
    cases = {}
    for name in methods.modules():
        try:
            cases[name] = case_class(name)
        except Exception as error:
            if name in methods.METHODS:
                raise
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise CaseError(f"run.method {name!r} cannot be loaded: {reason}") from error
    found, definitions = plain_schemas(cases)
    definitions["Run"]["properties"]["method"]["enum"] = list(cases)
    sections = {}  # of each method, by their keys in a file
    for name, each in found.items():
        keys = cases[name]._method.keys
        sections[name] = {keys.get(key, key): inner for key, inner in each["properties"].items()}
    together: dict[str, Any] = {}
    whose: dict[str, str] = {}
    for name, each in reversed(sections.items()):  # the usual method describes shared keys
        for key, inner in each.items():
            if key not in together or key in sections[methods.DEFAULT]:
                together[key], whose[key] = inner, name
            elif together[key] != inner:
                both = {whose[key]: together[key], name: inner}
                together[key] = _any_of_both(key, both, definitions)
    order = [*sections[methods.DEFAULT], *sorted(together)]
    return {
        "$schema": DIALECT,
        "title": "mesokit case",
        "description": "Everything that defines a run.",
        "type": "object",
        "properties": {key: together[key] for key in dict.fromkeys(order)},
        "required": [k for k, field in FIELDS.items() if k != SECTIONS and field[1].is_required()],
        "additionalProperties": False,
        "allOf": [_rules(name, cases[name], sections[name], together) for name in cases],
        "definitions": dict(sorted(definitions.items())),
    }


def _any_of_both(
    key: str, both: dict[str, dict[str, Any]], definitions: dict[str, Any]
) -> dict[str, Any]:
    """A section of two methods; keys of one of them alone are named in its rule below."""
    tables = {
        name: definitions[each["allOf"][0]["$ref"].removeprefix(PLACE)]
        for name, each in both.items()
    }
    joint: dict[str, Any] = {}
    for name, table in tables.items():
        for inside, inner in table["properties"].items():
            if all(inside in other["properties"] for other in tables.values()):
                known = joint.setdefault(inside, inner)
                if known != inner:
                    both_tables = [(each, t["properties"][inside]) for each, t in tables.items()]
                    described = {each: key.get("description", "") for each, key in both_tables}
                    words = "; ".join(
                        f"method '{each}': {text}" for each, text in described.items()
                    )
                    joint[inside] = {
                        "anyOf": [{**k, "title": f"method '{each}'"} for each, k in both_tables],
                        "description": inner.get("description", "")
                        if len(set(described.values())) == 1
                        else words,
                    }
            else:
                words = inner.get("description", "")
                if words.startswith("method '"):  # of a table that has been joined with another
                    joint[inside] = inner
                    continue
                joint[inside] = {**inner, "description": f"method '{name}': {words}"}
    title, names = key.capitalize(), " and ".join(f"'{name}'" for name in both)
    about = f"Of the methods {names}. Keys of one alone say so."
    first = next(iter(tables.values()))
    definitions[title] = {**first, "title": title, "description": about, "properties": joint}
    return {**next(iter(both.values())), "allOf": [{"$ref": f"{PLACE}{title}"}]}


def _rules(name: str, case: Any, own: dict[str, Any], together: dict[str, Any]) -> dict[str, Any]:
    """The rule for cases of one method: its sections and the observables that it offers."""
    named: dict[str, Any] = {"properties": {"method": {"const": name}}}
    if name != methods.DEFAULT:
        named["required"] = ["method"]
    closed: dict[str, Any] = {key: False for key in together if key not in own}
    closed |= {key: inner for key, inner in own.items() if together[key] != inner}
    offered = case._method.observables
    family = next(known for base, known in FAMILIES.items() if issubclass(offered[0], base))
    for each in family.names():
        family.find(each)
    parts = [part for part in family.parts.values() if is_offered(part, name, offered)]
    names = [found[1] for part in parts if (found := tag_of(part))]
    closed["observe"] = {"items": {"properties": {"quantity": {"enum": names}}}}
    return {"if": {"properties": {"run": named}}, "then": {"properties": closed}}
