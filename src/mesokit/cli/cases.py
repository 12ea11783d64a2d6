"""Commands that look at a case without running it: new, check."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mesokit import method as methods
from mesokit.cli.commands import CASE, JSON, SET, THREADS, axes_of, cli, naming, read
from mesokit.cli.words import in_json, patience, show_table
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case.case import Case

TEMPLATES = methods.templates()
SCHEMA = "case.schema.json"


@cli.command(
    help="Write a commented case NAME.toml: "
    f"{', '.join(TEMPLATES)}.\n\nWith another NAME, say which --template. Beside it comes "
    f"{SCHEMA}, by which editors complete and check all cases of the folder."
)
@click.argument("name")
@click.option("--template", type=click.Choice(list(TEMPLATES)), help="What to start from.")
def new(name: str, template: str | None) -> None:
    """Write a commented case."""
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    template = template or (path.stem if path.stem in TEMPLATES else None)
    if template is None:
        from mesokit.case.component import nearest, one_of

        raise CaseError(
            f"{name}: no such template{nearest(path.stem, TEMPLATES)} (give one of them, "
            f"or --template: {one_of(list(TEMPLATES))})"
        )
    text = TEMPLATES[template].read_text(encoding="utf-8")
    text = text.replace(f"{template}.toml", path.name).replace(f"{template}/", f"{path.stem}/")
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(f"#:schema ./{SCHEMA}\n{text}")
    except FileExistsError:
        raise CaseError(f"{path}: exists already; remove it, or choose another name") from None
    from mesokit.case.describe.schema import schema_text
    from mesokit.io.atomic import write_text

    write_text(path.with_name(SCHEMA), schema_text())  # for the parts that are installed now
    click.echo(
        f"wrote {path} (and {SCHEMA}, for editors); next: mesokit check {path}, mesokit run {path}"
    )


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
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
    as_json: bool,
    picture: str | None,
    axes: tuple[str, ...] | None,
) -> None:
    """Check CASE, show it with all defaults, what follows from it, and what to mind."""
    from mesokit.case.kind import has_run
    from mesokit.method.protocol import method_of

    with patience("looking at the solids (the first time, what looks at them is compiled)"):
        full = read(case, settings)
        method = method_of(full)
        with naming(case):
            method.first_state(full, {})
        summary = method.summary(full, threads)
    if axes is not None and picture is None:
        raise CaseError("--axes: only for a picture; add --picture")
    drawn = None if picture is None else _draw(full, case, picture, axes)
    if as_json:
        from mesokit.case import toml

        record = {"case": toml.parse(full.to_toml())} | summary.record()
        click.echo(in_json(record | ({"picture": str(drawn)} if drawn else {})))
        return
    click.echo(full.to_toml())
    ahead = [("first start", "up to a minute", "compiling, once for each kind of case")]
    show_table([*summary.rows, *([] if has_run(full) else ahead)])
    if full.units is not None and method.si is not None:
        click.echo(method.si(full))
    for warning in summary.warnings:
        click.echo(f"warning: {warning}")
    if drawn:
        click.echo(f"picture: {drawn}")


def _draw(full: Case, case: Path, picture: str, axes: tuple[str, ...] | None) -> Path:
    """Draw what a case starts from, without a step."""
    from mesokit.report import save_figure
    from mesokit.simulation import Simulation

    with naming(case):
        figure = Simulation(full).flow("particles", axes=axes)
    return save_figure(figure, picture or f"{case.stem}-start.png")
