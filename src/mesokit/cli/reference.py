"""Commands that say what a case file may say: schema, explain."""

from __future__ import annotations

from pathlib import Path

import click

from mesokit.cli.commands import cli


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
