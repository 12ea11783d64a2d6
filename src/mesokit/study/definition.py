"""The definition of a study: the case that all runs share, what varies, and the seeds.

It is read from a study file that users write, or from the one in the folder of a study.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from mesokit.case import toml
from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.io.atomic import write_text
from mesokit.study.axes import MOST, Axis
from mesokit.study.plan import Base

FILE, CASE = "study.toml", "case.toml"
HEAD = "# A study of mesokit: what it varies; its case lies in this folder, its runs in runs/.\n"
KEYS = ["case", "seeds", "vary", "set"]  # of a file that users write


class Definition(NamedTuple):
    """Case of all runs, what varies, and the seeds."""

    base: Base
    axes: list[Axis]
    seeds: list[int]


def read(file: Path) -> Definition:
    """The definition in a study file. Raises CaseError."""
    data = toml.parse(toml.read(file))
    for key in data:
        if key not in (*KEYS, "folder"):
            raise CaseError(f"{key}: unknown key{nearest(key, KEYS)} (expected {one_of(KEYS)})")
    given = data.get("case")
    if not isinstance(given, str):
        raise CaseError(f"case = {show(given)}: expected the name of a case file")
    vary = data.get("vary", [])
    if not isinstance(vary, list):
        raise CaseError("vary: expected [[vary]], in double brackets")
    axes = [Axis.from_table(each) for each in vary]
    settings = data.get("set", {})
    if not isinstance(settings, Mapping):
        raise CaseError(f"set = {show(settings)}: expected a table [set]")
    base = Base.of(file.parent / given, dict(_settings(settings)))
    folder = data.get("folder", str(base.folder))
    if not isinstance(folder, str):
        raise CaseError(f"folder = {show(folder)}: expected the name of a folder")
    base.folder = Path(folder)
    return Definition(base, axes, seeds_of(data.get("seeds", 1), base))


def write(folder: Path, base: Base, axes: Sequence[Axis], seeds: Sequence[int]) -> None:
    """Write the study file and the case into the folder of a study. Raises RunError."""
    lines = [
        f"{HEAD}case = {json.dumps(CASE)}\n",
        f"folder = {json.dumps(str(base.folder))}  # of files that the case names\n",
        f"seeds = {json.dumps(seeds)}\n",
    ]
    tables = [("[set]", base.settings)] if base.settings else []
    for head, rows in [*tables, *(("[[vary]]", axis.table()) for axis in axes)]:
        lines.append(f"\n{head}\n")
        lines += [f"{json.dumps(k)} = {json.dumps(v)}\n" for k, v in rows.items()]
    write_text(folder / CASE, base.text)
    write_text(folder / FILE, "".join(lines))


def _settings(table: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Values of [set] by their key paths; `run.steps = 9` without quotes is a table in a table."""
    for key, value in table.items():
        if isinstance(value, Mapping) and "." not in key:
            yield from ((f"{key}.{inner}", each) for inner, each in value.items())
        else:
            yield key, value


def seeds_of(given: Any, base: Base) -> list[int]:
    """Seeds from a number of them, counted from the seed of the case, or from a list.

    Raises CaseError.
    """
    if isinstance(given, int) and not isinstance(given, bool) and given >= 1:
        if given > MOST:
            raise CaseError(f"seeds = {given}: expected at most {MOST}")
        run = base.data.get("run")
        first = run.get("seed", 1) if isinstance(run, Mapping) else 1
        return [first + i for i in range(given)] if isinstance(first, int) else [1]
    whole = isinstance(given, Sequence) and all(type(seed) is int for seed in given)
    if not whole or not given or len(set(given)) < len(given):
        raise CaseError(f"seeds = {show(given)}: expected how many, or a list of different ones")
    return list(given)
