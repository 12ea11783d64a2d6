"""The report of a run: one file that holds everything, to be read, printed or sent."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from mesokit.case.case import Case
from mesokit.errors import MesokitError
from mesokit.io.atomic import write_text
from mesokit.io.record_words import pooled_words
from mesokit.io.run_directory import RunDirectory
from mesokit.report.document.pictures import figures, films_of, pictures_of_flow
from mesokit.report.document.record import citation, install, origin_rows, timing_rows, when
from mesokit.report.document.tables import changes, lines_of
from mesokit.report.document.template import render
from mesokit.report.finish.origin import as_text
from mesokit.seam.method import Row, absorbed_words, method_of, summary_of
from mesokit.seam.result import SUSPICIOUS, Result

HEADINGS = {  # of the sections that a run may have, in the order of the page
    "warnings": "Warnings", "lines": "Measured and expected", "figures": "Figures",
    "films": "Films", "conservation": "Conservation", "derived": "What follows from the case",
    "si": "In SI units",
}  # fmt: skip
ALWAYS = {"case": "Case", "origin": "Where it comes from", "repeat": "To repeat it"}


class Files(Protocol):
    """The files of a run, as `mesokit.open` returns them."""

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
    files: of the run.
    path: the file to write, `report.html` in the folder of the run unless said.
    films: put small films of the folder into the page, which is then larger; else they are linked.

    Raises RunError if the file cannot be written, or the data of the run are damaged.

    >>> import tempfile, mesokit
    >>> from mesokit import Box, Conservation, Run, Simulation
    >>> folder = Path(tempfile.mkdtemp()) / "run"
    >>> Simulation(run=Run(steps=20), box=Box([8, 8]), observe=[Conservation(every=1)],
    ...            output=folder).run()
    >>> mesokit.open(folder).report().name
    'report.html'
    """
    path = Path(path) if path is not None else RunDirectory(files.path).report_file
    write_text(path, as_text(page(files, path, films)))
    return path


def page(files: Files, path: Path, films: bool = False) -> str:
    """The report of a run as HTML, for a file `path`."""
    case, record = files.case, files.provenance
    name, results = files.path.resolve().name, list(files.so_far().values())
    drawn = [*figures(results, case), *pictures_of_flow(files.path, [r.name for r in results])]
    rows, warnings = _derived(case)
    convert = method_of(case).si if case.units is not None else None
    sections: dict[str, Any] = {
        "warnings": warnings,
        "lines": lines_of(results),
        "figures": drawn,
        "films": films_of(files.path, path, films),
        "conservation": changes(results),
        "derived": rows,
        "si": "" if convert is None else str(convert(case)),
    }
    ids = {"lines": "comparisons"}
    contents = [(ids.get(k, k), words) for k, words in HEADINGS.items() if sections[k]]
    return render(
        "run.html",
        title=case.title or name,
        folder=name,
        lead=_lead(case, record),
        state="" if files.ended else files.state,
        contents=[*contents, *ALWAYS.items()],
        far=f"{SUSPICIOUS:g}",
        case=case.to_toml(files.path),
        origin=origin_rows(record),
        timings=timing_rows(record.get("timings") or {}),
        repeat=_repeat(case, record),
        cite=citation(record),
        version=record.get("versions", {}).get("mesokit", ""),
        **sections,
    )


def _lead(case: Case, record: Mapping[str, Any]) -> str:
    """The case in a line: method, size, particles, steps and seed."""
    size = " x ".join(f"{length:g}" for length in case.box.size)
    number, noun = sum(group.number for group in case.groups), case.noun
    of = f"lattice of {size} sites" if noun == "site" else f"box of {size} cells"
    merged, warmup = record.get("merged") or (), case.run.warmup
    steps = sum(run["step"] - warmup for run in merged) or case.run.steps
    words = [
        f"{case.run.method}, {of}",
        f"{number:,} {noun}s".replace(",", " ") * (noun != "site"),
        f"{steps} steps" + " in all" * bool(merged) + f" after {warmup} of warm-up" * bool(warmup),
        pooled_words(record) or f"seed {case.run.seed}",
    ]
    if record.get("ended"):
        words.append(f"ended {when(record['ended'])}")
    if still := absorbed_words(record.get("absorbed")):
        words.append(still)
    return ", ".join(filter(None, words))


def _derived(case: Case) -> tuple[list[Row], tuple[str, ...]]:
    """Derived numbers and warnings of a case, as in `mesokit check`, without estimated costs."""
    try:
        summary = summary_of(case, None)
    except MesokitError:  # a file that the start was made from may be gone
        return [], ()
    return [row for row in summary.rows if not row[2].startswith("estimate")], summary.warnings


def _repeat(case: Case, record: Mapping[str, Any]) -> str:
    """Commands that run the case again, and write this page of them."""
    commands = [install(record)]
    merged = record.get("merged") or ()
    for run in merged:
        longer = run["step"] - case.run.warmup
        steps = f" --set run.steps={longer}" * (longer != case.run.steps)
        seed = f"--set run.seed={run['seed']}{steps}"
        commands.append(f"mesokit run case.toml {seed} --output again-{run['seed']}")
    folders = " ".join(f"again-{run['seed']}" for run in merged)
    how = f"merge {folders}" if merged else "run case.toml"
    commands.append(f"mesokit {how} --output again")
    return "\n".join([*commands, "mesokit report again"])
