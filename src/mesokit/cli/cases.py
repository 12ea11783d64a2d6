"""Commands that look at a case without running it: new, check."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mesokit import method as methods
from mesokit.cli.commands import CASE, JSON, SET, THREADS, axes_of, cli, naming, read
from mesokit.cli.completion import beginning
from mesokit.cli.words import READING, in_json, patience, show_table
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case.case import Case

TEMPLATES = methods.templates()
EXAMPLES = methods.examples()
KNOWN = TEMPLATES | EXAMPLES


def _listed(names: Iterable[str]) -> str:
    """Names in words; of those in a folder, which are many, the first stands for all."""
    folders: dict[str, str] = {}
    for name in names:
        folders.setdefault(name.partition("/")[0], name)
    return ", ".join(f"{name} ..." if "/" in name else name for name in folders.values())


SCHEMA = "case.schema.json"


@cli.command(
    help="Write a commented case NAME.toml: "
    f"{', '.join(TEMPLATES)}, or one of the examples: {_listed(EXAMPLES)}.\n\n"
    "With a FILE, that is what is written (or give another NAME and its --template). Beside it "
    "comes "
    f"{SCHEMA}, by which editors complete and check all cases of the folder."
)
@click.argument("name", shell_complete=lambda context, parameter, text: beginning(text, KNOWN))
@click.argument("path", metavar="[FILE]", required=False)
@click.option(
    "--template", type=click.Choice(list(KNOWN)), metavar="NAME", help="What to start from."
)
def new(name: str, path: str | None, template: str | None) -> None:
    """Write a commented case."""
    from mesokit.case.component import nearest

    if path is not None:
        name, template = path, template or name.removesuffix(".toml")
        if template not in KNOWN:
            raise CaseError(f"{template}: no such template{nearest(template, KNOWN)}")
    file = Path(name if name.endswith(".toml") else f"{name}.toml")
    if template is None and file.stem in KNOWN:
        template = file.stem
    elif template is None and name.removesuffix(".toml") in KNOWN:  # one in a folder of examples
        template, file = name.removesuffix(".toml"), Path(file.name)
    if template is None:
        raise CaseError(
            f"{name}: no such template{nearest(file.stem, KNOWN)} (give one of them, "
            f"or --template: {_listed(KNOWN)})"
        )
    source = KNOWN[template]
    text = source.read_text(encoding="utf-8")
    said = rf"(^# .*?\bmesokit .*?\b){template.rpartition('/')[2]}(?=\.toml|/| |$)"
    text = re.sub(said, rf"\g<1>{file.stem}", text, flags=re.M)
    try:
        with open(file, "x", encoding="utf-8") as written:
            written.write(f"#:schema ./{SCHEMA}\n{text}")
    except FileExistsError:
        raise CaseError(f"{file}: exists already; remove it, or choose another name") from None
    from mesokit.case.describe.schema import schema_text
    from mesokit.io.atomic import write_text

    write_text(file.with_name(SCHEMA), schema_text())  # for the parts that are installed now
    for other in re.findall(
        r'^(?:file|bonds) = "([\w.-]+)"', text, flags=re.M
    ):  # such as a picture of solids
        beside = file.with_name(other)
        if not beside.exists():
            beside.write_bytes((source.parent / other).read_bytes())
    click.echo(
        f"wrote {file} (and {SCHEMA}, for editors); next: mesokit check {file}, mesokit run {file}"
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
    from mesokit.method.protocol import method_of, summary_of

    with patience(READING):
        full = read(case, settings)
        method = method_of(full)
        with naming(case):
            method.first_state(full, {})
        summary = summary_of(full, threads)
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
    from mesokit.method.protocol import method_of
    from mesokit.report import save_figure
    from mesokit.simulation import Simulation

    with naming(case):
        figure = Simulation(full).flow(method_of(full).picture or "particles", axes=axes)
    return save_figure(figure, picture or f"{case.stem}-start.png")
