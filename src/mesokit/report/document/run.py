"""The report of a run: one file that holds everything, to be read, printed or sent."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from mesokit.case.amounts import duration_text
from mesokit.errors import MesokitError
from mesokit.io.atomic import write_text
from mesokit.io.run_directory import RunDirectory
from mesokit.method.protocol import Row, method_of
from mesokit.observe.shared.result import Result
from mesokit.report.document.comparisons import lines_of
from mesokit.report.document.conservation import changes
from mesokit.report.document.pictures import figures, films_of, pictures_of_flow
from mesokit.report.document.template import render
from mesokit.report.table import SUSPICIOUS

if TYPE_CHECKING:
    from mesokit.case.case import Case

HEADINGS = {  # of the sections that a run may have, in the order of the page
    "warnings": "Warnings", "lines": "Measured and expected", "figures": "Figures",
    "films": "Films", "conservation": "Conservation", "derived": "What follows from the case",
    "si": "In SI units",
}  # fmt: skip
PROGRAMS = ("mesokit", "__main__.py")  # by which the command line is called
ALWAYS = {"case": "Case", "origin": "Where it comes from", "repeat": "To repeat it"}


class Files(Protocol):
    """What a report asks of the files of a run, as `mesokit.open` gives them."""

    path: Path

    @property
    def case(self) -> Case:
        """The resolved case."""

    @property
    def provenance(self) -> dict[str, Any]:
        """Versions, seed, host, times."""

    @property
    def ended(self) -> bool:
        """Whether the run has come to its end."""

    @property
    def state(self) -> str:
        """How far it has come, if it has not ended."""

    def so_far(self) -> Mapping[str, Result]:
        """Results by name, those so far of a run that has not ended."""


def write_report(files: Files, path: str | Path | None = None, films: bool = False) -> Path:
    """Write the report of a run.

    Parameters
    ----------
    files : RunFiles
        Of the run.
    path : path, optional
        The file to write, `report.html` in the folder of the run unless said.
    films : bool, optional
        Put small films of the folder into the page, which is then larger; else they are linked.

    Raises
    ------
    RunError
        If the file cannot be written, or the data of the run are damaged.

    Examples
    --------
    >>> import tempfile, mesokit
    >>> from mesokit import Box, Conservation, Run, Simulation
    >>> folder = Path(tempfile.mkdtemp()) / "run"
    >>> Simulation(run=Run(steps=20), box=Box([8, 8]), observe=[Conservation(every=1)],
    ...            output=folder).run()
    >>> mesokit.open(folder).report().name
    'report.html'
    """
    path = Path(path) if path is not None else RunDirectory(files.path).report_file
    write_text(path, page(files, path, films))
    return path


def page(files: Files, path: Path, films: bool = False) -> str:
    """The report of a run as HTML, for a file `path`."""
    case, record = files.case, files.provenance
    results = list(files.so_far().values())
    names = [result.name for result in results]
    rows, warnings = _derived(case)
    sections: dict[str, Any] = {
        "warnings": warnings,
        "lines": lines_of(results),
        "figures": [*figures(results, case), *pictures_of_flow(files.path, names)],
        "films": films_of(files.path, path, films),
        "conservation": changes(results),
        "derived": rows,
        "si": _si(case),
    }
    ids = {"lines": "comparisons"}
    contents = [(ids.get(k, k), words) for k, words in HEADINGS.items() if sections[k]]
    return render(
        "run.html",
        title=case.title or files.path.resolve().name,
        folder=files.path.resolve().name,
        lead=_lead(case, record),
        state="" if files.ended else files.state,
        contents=[*contents, *ALWAYS.items()],
        far=f"{SUSPICIOUS:g}",
        case=case.to_toml(files.path),
        origin=_origin(record),
        timings=_timings(record.get("timings") or {}),
        repeat=_repeat(record),
        cite=_cite(record),
        version=record.get("versions", {}).get("mesokit", ""),
        **sections,
    )


def _lead(case: Case, record: Mapping[str, Any]) -> str:
    """What was simulated, in a line."""
    size = " x ".join(f"{length:g}" for length in case.box.size)
    particles = sum(group.number for group in case.groups)
    words = [
        f"{case.run.method}, box of {size} cells",
        f"{particles:,} particles".replace(",", " "),
        f"{case.run.steps} steps" + f" after {case.run.warmup} of warm-up" * bool(case.run.warmup),
        f"seed {case.run.seed}",
    ]
    if record.get("ended"):
        words.append(f"ended {_time(record['ended'])}")
    return ", ".join(words)


def _time(text: str) -> str:
    """A time of the record for people, who need no seconds."""
    return text[:16].replace("T", " ") + " UTC" * text.endswith("+00:00")


def _derived(case: Case) -> tuple[list[Row], tuple[str, ...]]:
    """What `mesokit check` says of the case, but for the cost, which is known by now."""
    try:
        summary = method_of(case).summary(case, None)
    except MesokitError:  # a file that the start was made from may be gone
        return [], ()
    return [row for row in summary.rows if not row[2].startswith("estimate")], summary.warnings


def _si(case: Case) -> str:
    convert = method_of(case).si
    return str(convert(case)) if case.units is not None and convert is not None else ""


def _origin(record: Mapping[str, Any]) -> list[Row]:
    """Versions, machine and times, so far as they are on record."""
    versions = ", ".join(f"{name} {v}" for name, v in record.get("versions", {}).items())
    rows = [("versions", versions, "")] if versions else []
    rows += _sources(record.get("sources") or {})
    for key in ("seed", "case_digest", "host", "system", "processor", "cores",
                "threads", "started", "ended", "failed"):  # fmt: skip
        if record.get(key) is not None:
            rows.append((key.replace("_", " "), str(record[key]), ""))
    for key in ("resumed", "parts"):
        if record.get(key):
            rows.append((key, ", ".join(map(str, record[key])), ""))
    for key, parent in (record.get("starts_from") or {}).items():
        rows.append((key, str(parent.get("path", "")), f"sha256 {parent.get('sha256', 'unknown')}"))
    if record.get("command"):
        program, *words = map(str, record["command"])
        name = "mesokit" if Path(program).name in PROGRAMS else Path(program).name
        rows.append(("command", shlex.join([name, *words]), ""))
    return rows


def _sources(record: Mapping[str, Any]) -> list[Row]:
    """Which state of mesokit made the numbers."""
    rows = []
    if record.get("commit"):
        rows.append(("commit", record["commit"], "changed since" * (record["changed"] == "true")))
    if record.get("digest"):
        rows.append(("sources", f"sha256 {record['digest']}", ""))
    return rows


def _timings(seconds: Mapping[str, float]) -> list[tuple[str, str, str]]:
    """Stages of the run, longest first, with their share."""
    total = sum(seconds.values())
    if not total > 0:
        return []
    longest = sorted(seconds.items(), key=lambda item: -item[1])
    rows = [(name, f"{s:.2f}", f"{100 * s / total:.1f} %") for name, s in longest]
    return [*rows, ("together", f"{total:.2f}", duration_text(total))]


def _repeat(record: Mapping[str, Any]) -> str:
    """Commands that run the case again, and write this page of them."""
    version = record.get("versions", {}).get("mesokit", "")
    commands = [
        f"pip install mesokit=={version}" if version[:1].isdigit() else "pip install mesokit",
        "mesokit run case.toml --output again",
        "mesokit report again",
    ]
    return "\n".join(commands)


def _cite(record: Mapping[str, Any]) -> str:
    """The program as a reference, with the version that made the numbers."""
    version = record.get("versions", {}).get("mesokit", "")
    commit = (record.get("sources") or {}).get("commit")
    of_it = f", version {version}" * bool(version) + f", commit {commit}" * bool(commit)
    return f"The mesokit developers, mesokit: mesoscale particle simulation in Python{of_it}."
