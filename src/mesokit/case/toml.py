"""TOML of a case: read with messages that name the place, written with every default."""

import contextlib
import dataclasses
import difflib
import json
import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mesokit.case.component import TAGS, is_component, show
from mesokit.errors import CaseError

# --- reading ------------------------------------------------------------------------------------


def parse(text: str) -> dict[str, Any]:
    """TOML as dictionaries. Raises CaseError with line and column."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)", str(error))
        reason = str(error)[: place.start()] if place else str(error)
        where = (
            "at the end"
            if place is None or place[1] is None
            else (f"line {place[1]}, column {place[2]}")
        )
        raise CaseError(f"{where}: not valid TOML: {reason}") from None
    except RecursionError:
        raise CaseError("not valid TOML: nested too deeply") from None


def read(path: Path) -> str:
    """The text of a case file. Raises CaseError with the nearest file that is there."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        there = [p.stem for p in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        close = difflib.get_close_matches(path.stem, there, 1, 0.6)
        hint = f"; did you mean {show(close[0] + '.toml')}?" if close else ""
        raise CaseError(f"no such file{hint}") from None
    except UnicodeDecodeError as error:
        raise CaseError(f"byte {error.start}: not UTF-8 text") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise CaseError(reason[0].lower() + reason[1:]) from None


def override(data: dict[str, Any], key: str, value: Any) -> None:
    """Set one value by its key path."""
    here: Any = data
    *parents, last = key.split(".")
    for done, part in enumerate(parents):
        here = _step(here, part, ".".join(parents[: done + 1]))
    if isinstance(value, str):
        with contextlib.suppress(tomllib.TOMLDecodeError):  # a bare word is a text
            value = tomllib.loads(f"value = {value}")["value"]
    if isinstance(here, list) and last:
        raise _which(key, here)
    if parents and last and not isinstance(here, dict):
        raise CaseError(f"{'.'.join(parents)} = {show(here)}: expected a table, with {last}")
    if not isinstance(here, dict) or not last:
        raise CaseError(f"{key} = {show(value)}: expected a key path such as fluid.density")
    here[last] = _along(here.get(last), value)


def _along(vector: Any, value: Any) -> Any:
    """A number for a vector with one component that is not zero takes the place of that one.

    >>> _along([0.01, 0.0], 0.02), _along([1.0, 2.0], 0.02), _along(3, 4)
    ([0.02, 0.0], 0.02, 4)
    """
    if isinstance(vector, list) and _is_number(value) and all(map(_is_number, vector)):
        there = [i for i, component in enumerate(vector) if component]
        if len(there) == 1:
            return [value if i == there[0] else component for i, component in enumerate(vector)]
    return value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _step(here: Any, part: str, path: str) -> Any:
    if isinstance(here, list):
        tables = [item if isinstance(item, dict) else {} for item in here]
        found = [i for i, t in enumerate(tables) if part in (t.get("name"), t.get("quantity"))]
        index = int(part) - 1 if part.isdecimal() else found[0] if len(found) == 1 else -1
        if not 0 <= index < len(here):
            raise _which(path, here)
        return here[index]
    if not isinstance(here, dict):
        raise CaseError(f"{path}: no such table")
    return here.setdefault(part, {})


def _which(path: str, items: list[Any]) -> CaseError:
    """The error of a path whose last part does not choose an item of a list."""
    start, _, last = path.rpartition(".")
    example = f"{start}.1" if last.isdecimal() else f"{start}.1.{last}"
    known = f"a number from 1 to {len(items)}" if len(items) != 1 else "the number 1"
    return CaseError(f"{path}: expected {known} or a unique name after {start}, as in {example}")


# --- writing ------------------------------------------------------------------------------------


def write(case: Any, keys: Mapping[str, str], folder: Path | None = None) -> str:
    """A case as a file; `keys` are names of sections where they differ from those of its fields.

    Files in the folder that the file is for are named without it: they may be moved together.
    """
    title = [f"title = {_value(case.title)}\n"] if case.title else []
    tables = []
    for field in _fields(case):
        value, key = getattr(case, field.name), keys.get(field.name, field.name)
        if isinstance(value, tuple):
            tables += [f"[[{key}]]\n{_lines(item)}" for item in value]
        elif is_component(type(value)):
            tables.append(f"[{key}]\n{_lines(value)}")
    text = "\n".join([*title, *tables])
    if folder is None:
        return text
    return text.replace(f"file = {_value(f'{folder.resolve()}{os.sep}')[:-1]}", 'file = "')


def given(case: Any, keys: Mapping[str, str]) -> list[tuple[str, str]]:
    """Sections of a case, with those of their values that are not the defaults."""
    rows = []
    for field in _fields(case):
        value, key = getattr(case, field.name), keys.get(field.name, field.name)
        for part in value if isinstance(value, tuple) else (value,):
            known = getattr(type(part), "__pydantic_fields__", {})
            texts = (
                f"{name} = {text}"
                for name, text in (_entries(part) if known else ())
                if name in TAGS
                or getattr(part, name) != known[name].get_default(call_default_factory=True)
            )
            rows.append((key, ", ".join(texts)))
    return [(key, text) for key, text in rows if text]


def _fields(part: Any) -> list[Any]:
    """Fields in the order of a file, the tag first."""
    return sorted(dataclasses.fields(part), key=lambda f: f.name not in TAGS)


def _lines(part: Any) -> str:
    return "".join(f"{key} = {text}\n" for key, text in _entries(part))


def _entries(part: Any) -> list[tuple[str, str]]:
    values = [(f.name, getattr(part, f.name)) for f in _fields(part)]
    texts = [(key, _value(value)) for key, value in values if value is not None and value != ()]
    return [(key, text) for key, text in texts if text != "{}"]


def _value(value: Any) -> str:
    if is_component(type(value)):
        inside = ", ".join(f"{key} = {text}" for key, text in _entries(value))
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value)
