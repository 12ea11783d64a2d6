"""Commands that write what people read and other programs take: report, table."""

from pathlib import Path

import click

from mesokit.cli.commands import RUN, cli, is_study, require_run, result_named
from mesokit.errors import CaseError

FILE = click.Path(dir_okay=False, path_type=Path)


@cli.command()
@click.argument("what", type=RUN, metavar="RUN|STUDY")
@click.option("--output", type=FILE, help="The file (report.html in the folder unless said).")
@click.option("--films", is_flag=True, help="Put small films into the file; else they are linked.")
def report(what: Path, output: Path | None, films: bool) -> None:
    """Write one HTML file with the case, all numbers and all figures of RUN or STUDY."""
    import mesokit

    if is_study(what):
        if films:
            raise CaseError(f"--films: only of a run; {what} holds a study")
        click.echo(mesokit.Study.open(what).report(output))
        return
    require_run(what)
    click.echo(mesokit.open(what).report(output, films))


@cli.command()
@click.argument("run", type=RUN)
@click.option("--result", metavar="NAME", help="All values of this result; else all comparisons.")
@click.option("--output", type=FILE, help="The file (on the screen unless said).")
def table(run: Path, result: str | None, output: Path | None) -> None:
    """Write the comparisons of RUN, or the values of one result, as CSV."""
    import mesokit
    from mesokit.io.atomic import write_text
    from mesokit.io.tables import result_text, rows_text

    require_run(run)
    files = mesokit.open(run)
    one = None if result is None else result_named(files, result)
    text = rows_text(files.results) if one is None else result_text(one)
    if output is None:
        return click.echo(text, nl=False)
    click.echo(write_text(output, text))
