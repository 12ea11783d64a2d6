"""Commands that say what a case file may say: new, schema, explain."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import click

from mesokit import method as methods
from mesokit.cli.commands import cli
from mesokit.cli.completion import beginning
from mesokit.errors import CaseError

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
@click.option(
    "--output", type=click.Path(dir_okay=False, path_type=Path), help="File (the screen if none)."
)
def schema(output: Path | None) -> None:
    """Write the JSON schema of case files, by which editors complete and check them.

    `mesokit new` writes it beside a case, with the line that names it. In a case of your own, put

    #:schema ./case.schema.json

    as the first line, and say: mesokit schema --output case.schema.json
    """
    from mesokit.case.describe.schema import schema_text

    if output is None:
        click.echo(schema_text(), nl=False)
        return
    from mesokit.io.atomic import write_text

    write_text(output, schema_text())
    click.echo(f"wrote {output}")


@cli.command()
@click.argument("key", default="")
def explain(key: str) -> None:
    """Say what KEY of a case file means, such as wall.disk, observe.wake or fluid.collision.

    With its unit, default and limits, and the keys inside. Without KEY: the sections of a case.
    """
    from rich.console import Console
    from rich.table import Table

    from mesokit.case.describe.explain import explain as explained

    console = Console(highlight=False, markup=False, emoji=False)
    for i, found in enumerate(explained(key)):
        click.echo(
            "\n" * (i > 0) + (f"{found.path}: " if found.path else "") + found.meaning + "\n"
        )
        table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
        for row in found.keys:
            table.add_row(f"  {row.name}", "\n".join(filter(None, [row.meaning, row.values])))
        console.print(table)
