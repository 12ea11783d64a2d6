"""The report of a study: one file that holds everything, to be read, printed or sent."""

import shlex
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from mesokit.case.case import Case
from mesokit.errors import CaseError, MesokitError, RunError
from mesokit.io.atomic import write_text
from mesokit.io.run_directory import RunDirectory
from mesokit.report.document.pictures import Picture, drawn, link_to
from mesokit.report.document.record import citation, install, origin_rows, timing_rows, when
from mesokit.report.document.template import render
from mesokit.report.finish.origin import as_text
from mesokit.seam.method import Row, summary_of
from mesokit.seam.result import SUSPICIOUS
from mesokit.study.axes import Axis
from mesokit.study.dependence import Theory
from mesokit.study.names import called
from mesokit.study.numbers import numbers, point_words, words_of
from mesokit.study.plan import Base, Planned, by_point, short_names
from mesokit.study.plot import drawable, find_rows, plot
from mesokit.study.table import Pooled

HEADINGS = {  # of the sections that a study may have, in the order of the page
    "warnings": "Warnings", "numbers": "Measured and expected", "figures": "Figures",
}  # fmt: skip
ALWAYS = {
    "varied": "What is varied", "runs": "Runs", "case": "Case", "origin": "Where it comes from",
    "repeat": "To repeat it",
}  # fmt: skip
OF_A_RUN = ("seed", "case digest", "started", "ended", "failed", "resumed", "command")
MOST = 4  # different values, such as machines, that are named


class Studied(Protocol):
    """The part of a study that a report needs."""

    path: Path
    base: Base
    axes: list[Axis]
    seeds: list[int]
    runs: list[Planned]

    @property
    def keys(self) -> list[str]: ...
    def table(self) -> list[Pooled]: ...
    def theory_between(
        self, rows: Sequence[Pooled], keys: Sequence[str], log: bool
    ) -> Theory | None: ...


class RunRow(NamedTuple):
    """A run in the list of runs: `report` is a link, nothing if there is no file."""

    point: list[str]
    seed: int
    state: str
    ended: str
    seconds: str
    folder: str
    report: str


def write_report(study: Studied, path: str | Path | None = None) -> Path:
    """Write the report of a study, `report.html` in its folder unless said. Raises RunError."""
    path = Path(path) if path is not None else RunDirectory(study.path).report_file
    write_text(path, as_text(page(study, path)))
    return path


def page(study: Studied, path: Path) -> str:
    """The report of a study as HTML, for a file `path`."""
    rows = study.table()
    records = [RunDirectory(run.path).read_provenance() for run in study.runs]
    done = [record for run, record in zip(study.runs, records, strict=True) if run.ended]
    command, file = _again(study)
    sections: dict[str, Any] = {
        "warnings": _warnings(study),
        "numbers": numbers(rows, study.keys) if rows else None,
        "figures": _figures(study, rows),
    }
    contents = [(key, words) for key, words in HEADINGS.items() if sections[key]]
    name = study.path.resolve().name
    ended = sum(run.ended for run in study.runs)
    return render(
        "study.html",
        title=study.base.data.get("title") or name,
        folder=name,
        lead=_lead(study, done),
        ended=ended,
        number=len(study.runs),
        again=shlex.join(["mesokit", "study", str(study.path)]),
        failed=[(run.path, run.failed) for run in study.runs if run.failed],
        contents=[*contents, *ALWAYS.items()],
        far=f"{SUSPICIOUS:g}",
        varied=_varied(study),
        keys=short_names(study.keys),
        runs=[_run(*each, path) for each in zip(study.runs, records, strict=True)],
        case=study.base.text,
        origin=_origin(done),
        timings=timing_rows(_together(done)),
        repeat="\n".join([install(done[0] if done else {}), command, "mesokit report again"]),
        file=file,
        cite=list(dict.fromkeys(map(citation, done or [{}]))),
        version=done[0].get("versions", {}).get("mesokit", "") if done else "",
        **sections,
    )


def _lead(study: Studied, done: Sequence[Mapping[str, Any]]) -> str:
    """The numbers of points, seeds and runs, in a line."""
    points, ended = len(list(by_point(study.runs))), filter(None, (r.get("ended") for r in done))
    words = [
        f"{points} points" if points > 1 else "1 point",
        f"{len(study.seeds)} seeds each" if len(study.seeds) > 1 else "1 seed",
        f"{len(study.runs)} runs",
    ]
    words += [f"last ended {when(last)}" for last in sorted(ended)[-1:]]
    return ", ".join(words)


def _varied(study: Studied) -> list[Row]:
    """Keys and their values; keys of one axis change together."""
    rows = []
    for axis in study.axes:
        for number, (key, values) in enumerate(axis.table().items()):
            together = f"together with {axis.keys[0]}" * bool(number)
            rows.append((key, ", ".join(words_of(values)), together))
    rows.append(("run.seed", ", ".join(map(str, study.seeds)), ""))
    rows += [(key, str(value), "in all runs") for key, value in study.base.settings.items()]
    return rows


def _figures(study: Studied, rows: Sequence[Pooled]) -> list[Picture]:
    """Every number that has an error bar against the first key."""
    found: list[Picture] = []
    for name in drawable(rows, study.axes):
        some = next(run for run in study.runs if run.ended)
        each = find_rows(rows, name)
        runs = f"{each[0].runs} runs pooled" if each[0].runs > 1 else "one run"
        notes = dict.fromkeys(row.number.note for row in each if row.number.note)
        words = f"{each[0].number.what} against {study.keys[0]}, {runs} at each point"
        key = study.keys[0], name, called(some.files.case, study.keys[0])
        figure = plot(rows, study.axes, *key, between=study.theory_between)
        found.append(Picture(name, drawn(figure), "; ".join([words, *list(notes)[:2]]) + "."))
    return found


def _run(run: Planned, record: Mapping[str, Any], page: Path) -> RunRow:
    seconds = sum((record.get("timings") or {}).values())
    report = RunDirectory(run.path).report_file
    return RunRow(
        point_words(run.point),
        run.seed,
        run.state,
        when(record["ended"]) if record.get("ended") else "",
        f"{seconds:.2f}" if run.ended and seconds else "",
        f"{link_to(run.path, page)}/",
        link_to(report, page) if report.exists() else "",
    )


def _warnings(study: Studied) -> list[str]:
    """Warnings of `mesokit check`, with their points unless these are all."""
    points = list(by_point(study.runs))
    found: dict[str, list[str]] = {}
    for runs in points:
        try:
            case = Case.from_toml(RunDirectory(runs[0].path).case_file)
            warnings = summary_of(case, None).warnings
        except (MesokitError, OSError):  # a file that the start was made from may be gone
            continue
        names = zip(short_names(study.keys), point_words(runs[0].point), strict=True)
        where = ", ".join(f"{key} = {value}" for key, value in names)
        for text in warnings:
            found.setdefault(text, []).append(where)
    return [
        text if len(there) == len(points) else f"{text} (at {'; '.join(there)})"
        for text, there in found.items()
    ]


def _origin(records: Iterable[Mapping[str, Any]]) -> list[Row]:
    """Origin of all runs; if they differ, up to MOST values."""
    found: dict[str, dict[tuple[str, str], None]] = {}
    for record in records:
        for name, value, note in origin_rows(record):
            if name not in OF_A_RUN:
                found.setdefault(name, {})[value, note] = None
    rows = []
    for name, values in found.items():
        some = list(values)[:MOST]
        more = f"; and {len(values) - MOST} more" * (len(values) > MOST)
        rows.append((name, "; ".join(v for v, _ in some) + more, some[0][1]))
    return rows


def _together(records: Iterable[Mapping[str, Any]]) -> dict[str, float]:
    """Seconds of each stage, of all runs."""
    total: Counter[str] = Counter()
    for record in records:
        total.update(record.get("timings") or {})
    return dict(total)


def _again(study: Studied) -> tuple[str, str]:
    """The command that makes the study anew, and the text of its study file, "" without one."""
    with_options = _command(study)
    if with_options:
        return with_options, ""
    try:
        lines = RunDirectory(study.path).study_file.read_text(encoding="utf-8").splitlines(True)
    except OSError as error:
        raise RunError(f"{study.path}: cannot be read: {error}") from None
    kept = (line for line in lines if not line.startswith(("folder =", "#")))
    return "mesokit study again.toml", "".join(kept)


def _command(study: Studied) -> str:
    """The command with options, "" if they cannot express all seeds and values."""
    first = study.base.data.get("run", {}).get("seed", 1)
    if study.seeds != [first + i for i in range(len(study.seeds))]:
        return ""
    words = ["mesokit", "study", "case.toml"]
    for axis in study.axes:
        try:
            if Axis.parse(axis.text()) != axis:
                return ""
        except CaseError:
            return ""
        words += ["--vary", axis.text()]
    for key, value in study.base.settings.items():
        if not isinstance(value, str):
            return ""
        words += ["--set", f"{key}={value}"]
    words += ["--seeds", str(len(study.seeds))] if len(study.seeds) > 1 else []
    return shlex.join([*words, "--output", "again"])
