"""Explanations of the keys of a case file: `mesokit explain`."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from mesokit.case.component import closest, nearest, one_of, show
from mesokit.case.describe.kept import kept_schema
from mesokit.case.describe.keys import Key, keys_of, parts_of
from mesokit.errors import CaseError

NEAR = 0.75  # likeness of two words, one of which may be a slip of the pen
MANY = 8  # keys of one name that are explained together
MOST = 4  # paths that are named


class Explanation(NamedTuple):
    """A key or a part, where it is in a case, what it means, and the keys inside."""

    path: str
    meaning: str
    keys: Sequence[Key]


class Place(NamedTuple):
    """A place that a path leads to: the schema of a key, and the tables that it may be."""

    path: str
    node: Mapping[str, Any]
    tables: Mapping[str, Any]  # by the name of the part
    key: Key | None = None


def explain(path: str = "") -> list[Explanation]:
    """Meaning of a key or a part of a case, such as "wall.disk" or "fluid.force.acceleration".

    The name of a part alone, such as "wake", is looked for everywhere, and so is that of a key,
    such as "pulls" of [solutes]. Without a path: sections.

    Raises:
        CaseError: there is no such key; it names the nearest.

    Examples:
        >>> (found,) = explain("run.seed")
        >>> found.meaning
        'the same seed gives the same bits'
        >>> explain("wake")[0].path
        'observe.wake'
        >>> explain("pulls")[0].path
        'solutes.pulls'
    """
    if path.endswith(".toml"):
        raise CaseError(
            f"{path}: expected a key of a case, such as run.steps; mesokit check explains a file"
        )
    whole = kept_schema()
    definitions = whole["definitions"]
    if not path:
        return [Explanation("", whole["description"], keys_of(whole, definitions))]
    start = Place("", whole, {"": whole})
    first, *rest = path.split(".")
    places = list(_inside(start, first, definitions))
    if not places:
        places = [p for p in _everywhere(start, definitions) if p.path.endswith(f".{first}")]
        places.sort(key=lambda place: place.path.count("."), reverse=True)
        places = list({id(place.node): place for place in places}.values())  # where it is nearest
    if not places:
        named = sorted(_named(start, first, definitions), key=lambda place: place.path.count("."))
        places = list({id(place.node): place for place in reversed(named)}.values())[::-1]
        keys = [place.key for place in places if place.key is not None]
        if len({key.meaning for key in keys}) > MANY or any(key.tag for key in keys):
            places = []
    if not places:
        raise _unknown(path, first, start, definitions)
    for word in rest:
        found = [inner for place in places for inner in _inside(place, word, definitions)]
        if not found:
            raise _unknown(path, word, places[0], definitions)
        places = found
    paths: dict[tuple[Any, ...], list[str]] = {}  # the same meaning in several parts is listed once
    for place in places:
        where, *said = _explained(place, definitions)
        paths.setdefault((said[0], tuple(said[1])), []).append(where)
    return [Explanation(_listed(where), *said) for said, where in paths.items()]


def _listed(paths: Sequence[str]) -> str:
    return ", ".join([*paths[:MOST], *(["..."] if len(paths) > MOST else [])])


def _sections(start: Place, definitions: Any) -> list[Place]:
    """The sections of a case that are one table each."""
    names = start.node["properties"]
    places = [place for name in names for place in _inside(start, name, definitions)]
    return [place for place in places if len(place.tables) == 1]


def _inside(place: Place, word: str, definitions: Any) -> Iterator[Place]:
    """The part of that name, or else the keys of that name in any of the tables."""
    if word.isdecimal() and "items" in place.node:
        yield place  # one of several, as --set names it
        return
    if word in place.tables and place.path:
        yield Place(f"{place.path}.{word}", place.tables[word], {word: place.tables[word]})
        return
    for name, table in place.tables.items():
        for key in keys_of(table, definitions):
            if key.name == word:
                node = table["properties"][word]
                path = [place.path] if len(place.tables) == 1 else [place.path, name]
                parts = parts_of(node, definitions)
                inner = ".".join([*filter(None, path), word])
                yield Place(inner, node, parts[1] if parts else {}, key)


def _named(place: Place, word: str, definitions: Any, deep: int = 5) -> Iterator[Place]:
    """All keys of that name below a place."""
    several = len(place.tables) > 1
    for name, table in place.tables.items() if deep else ():
        path = ".".join(filter(None, [place.path, name if several else ""]))
        here = Place(path, table, {"": table})
        for key in table["properties"]:
            for inner in _inside(here, key, definitions):
                yield from _named(inner, word, definitions, deep - 1)
        if word in table["properties"]:
            yield from _inside(here, word, definitions)


def _everywhere(place: Place, definitions: Any, deep: int = 4) -> Iterator[Place]:
    """All parts of a case, by the path of each."""
    for table in place.tables.values() if deep else ():
        for key in table["properties"]:
            for inner in _inside(Place(place.path, place.node, {"": table}), key, definitions):
                for name, part in inner.tables.items():
                    path = f"{inner.path}.{name}" if name else inner.path
                    found = Place(path, part, {name: part})
                    if name:
                        yield found
                    yield from _everywhere(found, definitions, deep - 1)


def _explained(place: Place, definitions: Any) -> Explanation:
    if place.key is None:  # a part
        meaning, keys = place.node.get("description", ""), keys_of(place.node, definitions)
        return Explanation(place.path, meaning, keys)
    meaning = place.key.meaning
    if len(place.tables) == 1:
        (table,) = place.tables.values()
        text = "\n\n".join([meaning, table.get("description", "")])
        return Explanation(place.path, text, keys_of(table, definitions))
    if place.tables:
        rows = [
            Key(name, "", "", "", " ".join(table["description"].split("\n\n")[0].split()))
            for name, table in place.tables.items()
        ]
        return Explanation(place.path, meaning, rows)
    return Explanation(place.path, meaning, [place.key])


def _unknown(path: str, word: str, place: Place, definitions: Any) -> CaseError:
    known = [name for name in place.tables if name and len(place.tables) > 1]
    known += [key for table in place.tables.values() for key in table["properties"]]
    if not place.path:
        known += [p.path.rpartition(".")[2] for p in _everywhere(place, definitions)]
        tables = (table for p in _sections(place, definitions) for table in p.tables.values())
        known += [key for table in tables for key in table["properties"]]
    known = list(dict.fromkeys(known))
    if not known:
        return CaseError(f"{path}: {place.path} has no keys inside")
    if place.path:
        deeper = {  # keys of that name within the keys of the place
            f"{place.path}.{key}.{word}": None
            for table in place.tables.values()
            for key in table["properties"]
            for inner in _inside(Place(place.path, place.node, {"": table}), key, definitions)
            if any(word in part["properties"] for part in inner.tables.values())
        }
        if deeper:
            return CaseError(f"{path}: unknown key; did you mean {one_of(list(deeper))}?")
        hint = nearest(word, known) or f"; valid here: {', '.join(known)}"
        return CaseError(f"{path}: unknown key{hint}")
    # keys of parts, and the words by which these are described, each with its paths
    found: dict[str, dict[str, None]] = {}
    for part in _everywhere(place, definitions):
        for key in part.node.get("properties", ()):
            found.setdefault(key, {})[f"{part.path}.{key}"] = None
        for each in re.findall(r"[a-z]{5,}", part.node.get("description", "").lower()):
            found.setdefault(each, {})[part.path] = None
    close = closest(word, [*known, *found], NEAR)
    if not close:
        return CaseError(f"{path}: unknown key; mesokit explain lists the sections of a case")
    if close in known:
        return CaseError(f"{path}: unknown key; did you mean {show(close)}?")
    where = ", ".join(sorted(found[close], key=lambda path: path.count("."))[:MOST])
    return CaseError(f"{path}: no key of a case; {show(close)} is explained at {where}")
