"""Reference of the case file, a page for each section, from the schema of `mesokit explain`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from mkdocs.structure.files import File, Files

from mesokit.case.describe.keys import Key, keys_of, parts_of
from mesokit.case.describe.plain import PLACE
from mesokit.case.describe.schema import schema

FOLDER = "reference/case"
HEAD = """# Case file

Every key of a case file: what it takes, its unit, its default and what it means. On the command
line, `mesokit explain wall.disk` shows the same; editors show it while you type
([how](../../guide/find-the-right-key.md)).

| section | what it is |
|---|---|
"""


class Part:
    """A table of a case file: its definition, its page, the key that first takes it, its tag."""

    def __init__(self, definition: dict[str, Any], page: str, key: str, tag: str) -> None:
        self.definition, self.page, self.tag = definition, page, tag
        self.name: str = definition["title"]
        if tag:
            chosen = f'{tag} = "{definition["properties"][tag]["const"]}"'
            self.title = chosen if key == page else f"{key}: {chosen}"
        else:
            self.title = key
        self.anchor = re.sub(r"[^a-z0-9+]+", "-", self.title.lower()).strip("-")


def on_files(files: Files, config: Any) -> Files:
    """Add the pages."""
    whole = schema()
    parts: dict[str, Part] = {}
    for section, node in whole["properties"].items():
        for name, key, tag in _found(section, node, whole["definitions"]):
            if name not in parts:
                parts[name] = Part(whole["definitions"][name], section, key, tag)
    rows = [f"| [`{_brackets(s, n)}`]({s}.md) | {_meaning(n)} |" for s, n in _sections(whole)]
    files.append(File.generated(config, f"{FOLDER}/index.md", content=HEAD + "\n".join(rows)))
    for section, node in _sections(whole):
        text = "\n".join(_page(section, node, parts, whole["definitions"]))
        files.append(File.generated(config, f"{FOLDER}/{section}.md", content=text))
    pages = [{_brackets(s, n): f"{FOLDER}/{s}.md"} for s, n in _sections(whole)]
    unfold(config["nav"], f"{FOLDER}/index.md", pages)
    return files


def unfold(nav: list[Any], index: str, pages: list[dict[str, str]]) -> None:
    """Put pages below the one that lists them."""
    for entry in nav:
        for title, inside in entry.items() if isinstance(entry, dict) else ():
            if inside == index:
                entry[title] = [index, *pages]
            elif isinstance(inside, list):
                unfold(inside, index, pages)


def _sections(whole: Mapping[str, Any]) -> list[tuple[str, Any]]:
    return list(whole["properties"].items())


def _brackets(section: str, node: Mapping[str, Any]) -> str:
    if "items" in node:
        return f"[[{section}]]"
    return f"[{section}]" if "allOf" in node or "$ref" in node else section


def _meaning(node: Mapping[str, Any]) -> str:
    return str(node.get("description", ""))


def _found(key: str, node: Any, definitions: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    """Names of the definitions below a key, each with its key and its tag, the outer first."""
    chosen = parts_of(node, definitions)
    options = node.get("items", node)
    places = [each.get("$ref") for each in options.get("oneOf", options.get("allOf", [options]))]
    names = [place.removeprefix(PLACE) for place in places if place] if chosen else []
    for name in names:
        yield name, key, chosen[0] if chosen else ""
    for name in names:
        for deeper, inner in definitions[name]["properties"].items():
            yield from _found(deeper, inner, definitions)


def _page(
    section: str, node: Any, parts: Mapping[str, Part], definitions: Mapping[str, Any]
) -> Iterator[str]:
    yield f"# `{_brackets(section, node)}`\n\n{_sentence(_meaning(node))}\n"
    own = [part for part in parts.values() if part.page == section]
    if not own:
        yield from _table(keys_of({"properties": {section: node}}, definitions), {}, parts)
    for part in own:
        plain = not part.tag and part is own[0]
        yield "" if plain else f"## `{part.title}` {{ #{part.anchor} }}\n"
        yield f"{part.definition.get('description', '')}\n"
        yield f"In Python: [`{part.name}`][mesokit.{part.name}].\n" if _public(part.name) else ""
        properties = part.definition["properties"]
        yield from _table(keys_of(part.definition, definitions), properties, parts)


def _table(
    keys: list[Key], properties: Mapping[str, Any], parts: Mapping[str, Part]
) -> Iterator[str]:
    if not keys:
        return
    yield "| key | takes | default | meaning |\n|---|---|---|---|"
    for key in keys:
        links = _links(properties.get(key.name, {}), parts)
        unit = f" [{key.unit}]" if key.unit else ""
        default = key.default if key.default in ("", "required") else f"`{key.default}`"
        takes = f"table: {links}" if links else f"{key.takes}{unit}"
        takes = (
            takes.replace("table:", "list of tables:")
            if "items" in properties.get(key.name, {})
            else takes
        )
        cells = (f"`{key.name}`", takes, default, key.meaning)
        yield "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
    yield ""


def _links(node: Mapping[str, Any], parts: Mapping[str, Part]) -> str:
    """The parts that a key takes, each with a link to its table."""
    options = node.get("items", node)
    if not isinstance(options, dict):
        return ""
    places = [each.get("$ref") for each in options.get("oneOf", options.get("allOf", [options]))]
    found = [parts[place.removeprefix(PLACE)] for place in places if place]
    return ", ".join(f"[{_short(part)}]({part.page}.md#{part.anchor})" for part in found)


def _short(part: Part) -> str:
    return f"`{part.definition['properties'][part.tag]['const']}`" if part.tag else part.name


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def _public(name: str) -> bool:
    import mesokit

    return name in mesokit.__all__
