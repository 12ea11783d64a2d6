"""The runs of a study, their folders and their state."""

from __future__ import annotations

import contextlib
import copy
import functools
import itertools
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from mesokit.case import toml
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError, CheckpointError, RunError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.run.opened import RunFiles
from mesokit.run.until import longer
from mesokit.seam.method import method_of
from mesokit.seam.named import keyed
from mesokit.seam.result import Comparison, Result
from mesokit.study.axes import MOST, Axis, grid
from mesokit.study.merge import different_key, flat, pooled


@dataclass(frozen=True)
class Planned:
    """One run of a study: the values that it varies, its seed and its folder."""

    point: Mapping[str, Any]
    seed: int
    path: Path

    @property
    def files(self) -> RunFiles:
        """Its files. Raises RunError if it has not been made."""
        return RunFiles(self.path)

    @property
    def ended(self) -> bool:
        """True if it has its results."""
        run = RunDirectory(self.path)
        return run.data_file.exists() and _ended(self.path, *_stamps(run))

    @property
    def numbers(self) -> Numbers:
        """Numbers of a run that has ended. Raises RunError if they cannot be read."""
        return _numbers(self.path, *_stamps(RunDirectory(self.path)))

    @property
    def failed(self) -> str:
        """The reason why it cannot go on, "" if it can."""
        with contextlib.suppress(RunError):
            return str(RunDirectory(self.path).read_provenance().get("failed") or "")
        return ""

    @property
    def state(self) -> str:
        """Its state in words."""
        if self.ended:
            return "ended"
        if why := self.failed:
            return f"failed: {why}"
        return f"at step {step}" if (step := self.step) else "not begun"

    @property
    def step(self) -> int:
        """Steps done, from its progress file while it runs, or its last checkpoint."""
        run, steps = RunDirectory(self.path), [0]
        with contextlib.suppress(OSError, ValueError):
            steps.append(int(run.progress_file.read_text(encoding="utf-8")))
        with contextlib.suppress(RunError):
            steps.append(int(checkpoint.read_meta(run.checkpoint_file)["step"]))
        return max(steps)


Compared = tuple[tuple[str, str, Comparison], ...]  # each with its result, and its key there


class Numbers(NamedTuple):
    """Compared numbers, and steps after the warm-up."""

    steps: int
    compared: Compared


def pooled_numbers(runs: Sequence[Planned]) -> Compared:
    """The compared numbers of runs with several seeds, from the samples of all.

    Those that cannot be pooled have no value, and a note that says why.
    """
    if len(runs) == 1:
        return runs[0].numbers.compared
    stamps = (_stamps(RunDirectory(run.path)) for run in runs)
    return _pooled_numbers(tuple(run.path for run in runs), *stamps)


# A study needs these often; files that have not changed are not read again.
@functools.lru_cache(maxsize=10_000)
def _ended(path: Path, *stamps: Any) -> bool:
    return RunFiles(path).ended


@functools.lru_cache(maxsize=10_000)
def _numbers(path: Path, *stamps: Any) -> Numbers:
    files = RunFiles(path)
    results = files.results
    in_order = (results[o.label] for o in files.case.observe if o.label in results)
    return Numbers(files.case.run.steps, _compared(in_order))


@functools.lru_cache(maxsize=10_000)
def _pooled_numbers(paths: tuple[Path, ...], *stamps: Any) -> Compared:
    files = [RunFiles(path) for path in paths]
    try:
        together = pooled(files)
    except CheckpointError as error:
        return _unknown(files[0].results.values(), str(error))
    found = _compared(together.results)
    for name, why in together.refused.items():
        found += _unknown([files[0][name]], str(why))
    return found


def _compared(results: Iterable[Result]) -> Compared:
    return tuple(
        (result.name, key, comparison)
        for result in results
        for key, comparison in keyed(result.comparisons).items()
    )


def _unknown(results: Iterable[Result], why: str) -> Compared:
    """Numbers that are not known, and why."""
    return tuple(
        (name, key, Comparison(c.what, math.nan, math.nan, c.expected, c.unit, why))
        for name, key, c in _compared(results)
    )


def _stamps(run: RunDirectory) -> tuple[Any, ...]:
    """Time, size and number of the files of a run, which change when they are written anew."""
    stamps: list[Any] = []
    for file in (run.case_file, run.checkpoint_file, run.data_file):
        try:
            now = file.stat()
            stamps.append((now.st_mtime_ns, now.st_size, now.st_ino))
        except OSError:
            stamps.append(None)
    return tuple(stamps)


def planned(axes: Sequence[Axis], seeds: Sequence[int], folder: Path) -> list[Planned]:
    """Every point with every seed, in folders that say which.

    >>> runs = planned([Axis.parse("fluid.kT=1,2")], [1, 2], Path("study"))
    >>> [run.path.as_posix() for run in runs][:2]
    ['study/runs/kT=1/seed=1', 'study/runs/kT=1/seed=2']
    """
    number = math.prod(len(axis.values) for axis in axes) * len(seeds)
    if number > MOST:
        raise CaseError(f"{number} runs: expected at most {MOST} in a study")
    keys = [key for axis in axes for key in axis.keys]
    names = dict(zip(keys, short_names(keys), strict=True))
    runs = []
    for point in grid(axes):
        words = [f"{names[key]}={_safe(value)}" for key, value in point.items()]
        place = folder / "runs" / ",".join(words) if words else folder / "runs"
        runs += [Planned(point, seed, place / f"seed={seed}") for seed in seeds]
    for path, times in Counter(run.path for run in runs).items():
        if times > 1:
            raise CaseError(f"{path}: two runs would have this name; a value is there twice")
    return runs


def short_names(keys: Sequence[str]) -> list[str]:
    """The last parts of key paths, whole paths where these are not enough.

    >>> short_names(["fluid.kT", "run.steps", "wall.1.radius", "wall.2.radius"])
    ['kT', 'steps', 'wall.1.radius', 'wall.2.radius']
    """
    last = [key.rpartition(".")[2] for key in keys]
    return [
        key if last.count(end) > 1 or end.isdecimal() else end
        for key, end in zip(keys, last, strict=True)
    ]


def _safe(value: Any) -> str:
    """A value in the name of a folder, on any system."""
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return re.sub(r"[^\w.+-]+", "_", text).strip("_")[:60] or "none"


class Base:
    """The case that all runs share, as data of its file, so that whole parts can be replaced.

    Raises CaseError for a file that is not there or not TOML.
    """

    def __init__(self, text: str, folder: Path, settings: Mapping[str, Any] | None = None) -> None:
        self.text, self.folder, self.settings = text, folder, dict(settings or {})
        self.data = toml.parse(text)
        for key, value in self.settings.items():
            toml.override(self.data, key, value)

    @classmethod
    def of(cls, given: Case | str | Path, settings: Mapping[str, Any] | None = None) -> Base:
        """From a case or its file, with values that are replaced in it."""
        if isinstance(given, Case):
            return cls(given.to_toml(), Path.cwd(), settings)
        try:
            return cls(toml.read(Path(given)), Path(given).resolve().parent, settings)
        except CaseError as error:
            raise CaseError(f"{given}: {error}") from None

    def case(self, point: Mapping[str, Any], seed: int) -> Case:
        """The case of one run. Raises CaseError, which names the values that were set."""
        data = copy.deepcopy(self.data)
        try:
            for key, value in point.items():
                toml.override(data, key, value)
            toml.override(data, "run.seed", seed)
            return Case.from_data(data, self.folder)
        except CaseError as error:
            words = ", ".join(f"{key} = {value}" for key, value in point.items())
            raise CaseError(f"with {words}: {error}" if words else str(error)) from None


def checked(runs: Sequence[Planned], base: Base) -> list[tuple[Planned, Case]]:
    """The runs with their cases, completed by keys that follow from their first states.

    Nothing is written. Raises CaseError for a wrong case, and RunError if the folder of a run has
    another case.
    """
    cases = [(run, base.case(run.point, run.seed)) for run in runs]
    cases = [(run, method_of(case).initial.prepared(case, {})) for run, case in cases]
    for run, case in cases:
        if RunDirectory(run.path).case_file.exists():
            _require_same(run, case)
    return cases


def make(cases: Iterable[tuple[Planned, Case]]) -> None:
    """Make missing folders of runs that are `checked`, and lengthen other runs. Raises RunError."""
    for run, case in cases:
        there = RunDirectory(run.path)
        if not there.case_file.exists():
            RunDirectory.create(run.path, case)
        elif case.run.steps > run.files.case.run.steps:
            there.write_case(longer(run.files.case, case.run.steps, 0))


def _require_same(run: Planned, case: Case) -> None:
    """Raise RunError if the folder has another case. A shorter run can be made longer.

    Keys that name files are not compared, because runs keep copies of files.
    """
    there = flat(RunDirectory(run.path).case_file.read_text(encoding="utf-8"))
    wanted = flat(case.to_toml())
    names = tuple(key for key in wanted if key.rpartition(".")[2] in ("file", "run"))
    key = different_key(wanted, there, ("run.steps", *names))
    if key is not None:
        raise RunError(
            f"{run.path}: holds a run with {key} = {show(there.get(key))}, not "
            f"{show(wanted.get(key))}; choose another output"
        )
    steps, done = wanted["run.steps"], there["run.steps"]
    if steps < done:
        raise RunError(f"{run.path}: holds a run with run.steps = {done}, which cannot be {steps}")


def by_point(runs: Sequence[Planned]) -> Iterator[list[Planned]]:
    """The runs of each point: all seeds, one after another."""
    for _, group in itertools.groupby(runs, key=lambda run: run.point):
        yield list(group)
