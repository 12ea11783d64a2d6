"""Commands that write what people read: report."""

from __future__ import annotations

from pathlib import Path

import click

from mesokit.cli.commands import RUN, cli, require_run

FILE = click.Path(dir_okay=False, path_type=Path)


@cli.command()
@click.argument("run", type=RUN)
@click.option("--output", type=FILE, help="The file (RUN/report.html unless said).")
@click.option("--films", is_flag=True, help="Put small films into the file; else they are linked.")
def report(run: Path, output: Path | None, films: bool) -> None:
    """Write one HTML file with the case, all numbers and all figures of RUN."""
    import mesokit

    require_run(run)
    click.echo(mesokit.open(run).report(output, films))
