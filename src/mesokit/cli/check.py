"""The command check: a case and its derived numbers, without a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mesokit.cli.commands import CASE, DEVICE, JSON, SET, THREADS, axes_of, cli, naming, read
from mesokit.cli.words import READING, in_json, patience, show_table
from mesokit.devices.names import CPU
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mesokit.case.case import Case
    from mesokit.seam.method import Row, Summary


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
@DEVICE
@JSON
@click.option(
    "--picture",
    is_flag=False,
    flag_value="",
    metavar="[FILE]",
    help="Draw solids, molecules and particles as they start (CASE-start.png unless said).",
)
@click.option("--axes", callback=axes_of, metavar="A,B", help="Of the picture in 3D.  [x,y]")
def check(
    case: Path,
    settings: dict[str, str],
    threads: int | None,
    device: str,
    as_json: bool,
    picture: str | None,
    axes: tuple[str, ...] | None,
) -> None:
    """Check CASE. Print it with all defaults, its derived numbers and its warnings.

    With --device cuda, also what it takes on common cards; no card is needed for that.
    """
    from mesokit.case.kind import has_run
    from mesokit.case.warnings import has_memory
    from mesokit.devices.named import require_name
    from mesokit.seam.method import method_of, on_devices, summary_of

    with patience(READING):
        full = read(case, settings)
        method = method_of(full)
        summary = summary_of(full, threads)
        if has_memory(summary.memory):  # else it warns of that
            with naming(case):
                full = method.initial.prepared(full, {})
                method.initial.read(full, {})
            summary = summary_of(full, threads)
    if require_name(device) != CPU:
        with naming(case):
            rows = on_devices(full, device, 1).rows(full)
        summary = _beside(summary, rows)
    if axes is not None and picture is None:
        raise CaseError("--axes: only for a picture; add --picture")
    drawn = None if picture is None else _draw(full, case, picture, axes)
    if as_json:
        from mesokit.case import toml

        record = {"case": toml.parse(full.to_toml())} | summary.record()
        click.echo(in_json(record | ({"picture": str(drawn)} if drawn else {})))
        return
    click.echo(full.to_toml())
    once = "compiling, once for each kind of case; up to a minute where nothing is kept yet"
    ahead = [("first start", "some seconds", once)]
    show_table([*summary.rows, *([] if has_run(full) else ahead)])
    if full.units is not None and method.si is not None:
        click.echo(method.si(full))
    for warning in summary.warnings:
        click.echo(f"warning: {warning}")
    if drawn:
        click.echo(f"picture: {drawn}")


def _beside(summary: Summary, rows: Sequence[Row]) -> Summary:
    """A summary with rows of devices; what is of the processor alone says so."""
    from mesokit.case.warnings import memory_warning

    here = [
        (what, value, f"on this processor; {note}" if what in ("run time", "memory") else note)
        for what, value, note in summary.rows
    ]
    of_here = memory_warning(summary.memory)
    warnings = tuple(one for one in summary.warnings if one != of_here)
    return summary._replace(rows=(*here, *rows), warnings=warnings)


def _draw(full: Case, case: Path, picture: str, axes: tuple[str, ...] | None) -> Path:
    """Draw the first state of a case, without a step."""
    from mesokit.report import save_figure
    from mesokit.run.simulation import Simulation

    with naming(case):
        figure = Simulation(full).flow(full.groups[0].picture or "particles", axes=axes)
    return save_figure(figure, picture or f"{case.stem}-start.png")
