"""A case: everything that defines a run, as a Python object and as a TOML file."""

from __future__ import annotations

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

from mesokit import combinations
from mesokit.box import Box
from mesokit.component import TAGS, build, component, is_component, param, show
from mesokit.errors import CaseError
from mesokit.geometry import Wall
from mesokit.io.trajectory import Trajectory
from mesokit.mpcd.fluid import Fluid
from mesokit.mpcd.solutes import Solutes
from mesokit.observe import AnyObservable
from mesokit.run import Run
from mesokit.solids import free_volume
from mesokit.units import Units

KEYS = {"walls": "wall"}  # field -> key in the file, where they differ: one [[wall]] each


@component
class Case:
    """Everything that defines a run.

    Raises CaseError for values out of range and for combinations without a physics.

    Examples:
        >>> case = Case(run=Run(steps=100), box=Box([30, 30]), fluid=Fluid(density=5))
        >>> print(case.to_toml()[:37])
        [run]
        steps = 100
        warmup = 0
        seed = 1
    """

    run: Run = param(doc="how long, and how safe")
    box: Box = param(doc="the box")
    fluid: Fluid = param(Fluid(), doc="the fluid")
    solutes: Solutes | None = param(None, doc="monomers and polymers in the fluid (none)")
    walls: tuple[Wall, ...] = param((), doc="walls; key `[[wall]]` in a file")
    observe: tuple[AnyObservable, ...] = param((), doc="what is measured; key `[[observe]]`")
    trajectory: Trajectory | None = param(None, doc="particles to write (none unless said)")
    units: Units | None = param(None, doc="what the units are in SI (reduced units unless said)")
    title: str = param("", doc="for the figures")

    def __post_init__(self) -> None:
        combinations.check(self)

    @property
    def particles(self) -> int:
        """Number of the fluid's particles: density times the volume that walls leave, species by
        species.

        Of molecules there is a whole number, and of a random solvent none.
        """
        if self.solutes is not None and self.solutes.solvent == "random":
            return 0
        kinds = [kind.density for kind in self.fluid.species] or [self.fluid.density]
        volume = free_volume(self)
        if self.fluid.molecule is not None:
            length = self.fluid.molecule.length
            return length * round(self.fluid.density * volume / length)
        return sum(round(density * volume) for density in kinds)

    @classmethod
    def from_toml(cls, path: str | Path, overrides: Mapping[str, Any] | None = None) -> Case:
        """Read a case file.

        Parameters:
            path: the file. File names in it are relative to its folder.
            overrides: values that replace those of the file, by key path, such as
                {"fluid.density": "5"}; a text is read as a TOML value, else taken as it is. One
                of several [[wall]] or [[observe]] is named by its number from 1, and an
                observable by its name: "observe.velocity-profile.every".

        Raises CaseError: one line with file, key, value and what was expected.
        """
        path = Path(path)
        try:
            data = parse(_read(path))
            for key, value in (overrides or {}).items():
                _override(data, key, value)
            return build(cls, _fields_of(data), KEYS, path.parent)
        except CaseError as error:
            raise CaseError(f"{path}: {error}") from None

    def to_toml(self, folder: Path | None = None) -> str:
        """The case as a file, with every default written out; `from_toml` gives an equal case.

        Files in the folder that the file is for are named without it: they may be moved together.
        """
        plain = {"title": f"title = {_value(self.title)}\n"} if self.title else {}
        tables = [_table(KEYS.get(f.name, f.name), getattr(self, f.name)) for f in _fields(self)]
        text = "\n".join([*plain.values(), *filter(None, tables)])
        if folder is None:
            return text
        return text.replace(f"file = {_value(f'{folder.resolve()}{os.sep}')[:-1]}", 'file = "')

    def missing_files(self) -> list[str]:
        """'key = file' for each file or folder that the start needs and that is not there."""
        starts = {"fluid.start": self.fluid.start}
        if self.solutes is not None:
            starts["solutes.start"] = self.solutes.start
        return [
            f"{where}.{key} = {show(name, 500)}: no such {'folder' if key == 'run' else 'file'}"
            for where, start in starts.items()
            for key, name in dataclasses.asdict(start).items()
            if name is not None and not Path(name).exists()
        ]


# --- reading ------------------------------------------------------------------------------------


def parse(text: str) -> dict[str, Any]:
    """TOML as dictionaries. Raises CaseError with line and column."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)", str(error))
        reason = str(error)[: place.start()] if place else str(error)
        where = "at the end" if place is None or place[1] is None else (
            f"line {place[1]}, column {place[2]}"
        )  # fmt: skip
        raise CaseError(f"{where}: not valid TOML: {reason}") from None
    except RecursionError:
        raise CaseError("not valid TOML: nested too deeply") from None


def _read(path: Path) -> str:
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


def _fields_of(data: dict[str, Any]) -> dict[str, Any]:
    """Keys of the file to names of the fields."""
    for field, key in KEYS.items():
        if field in data:
            raise CaseError(f"{field}: unknown key; did you mean [[{key}]]?")
    for key in ("wall", "observe"):
        if isinstance(data.get(key), dict):
            raise CaseError(f"{key}: expected [[{key}]], in double brackets")
    fields = {key: field for field, key in KEYS.items()}
    return {fields.get(key, key): value for key, value in data.items()}


def _override(data: dict[str, Any], key: str, value: Any) -> None:
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
    if not isinstance(here, dict) or not last:
        raise CaseError(f"{key} = {show(value)}: expected a key path such as fluid.density")
    here[last] = value


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
    """The last part of the path should have said which item of a list is meant."""
    start, _, last = path.rpartition(".")
    example = f"{start}.1" if last.isdecimal() else f"{start}.1.{last}"
    known = f"a number from 1 to {len(items)}" if len(items) != 1 else "the number 1"
    return CaseError(f"{path}: expected {known} or a unique name after {start}, as in {example}")


# --- writing ------------------------------------------------------------------------------------


def _fields(part: Any) -> list[Any]:
    """Fields in the order of a file, the tag (rule, shape, quantity) first."""
    return sorted(dataclasses.fields(part), key=lambda f: f.name not in TAGS)


def _table(key: str, value: Any) -> str:
    if isinstance(value, tuple):
        return "\n".join(f"[[{key}]]\n{_lines(item)}" for item in value)
    return f"[{key}]\n{_lines(value)}" if is_component(type(value)) else ""


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
