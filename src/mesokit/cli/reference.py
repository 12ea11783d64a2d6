"""Commands about the contents of case files: new, schema, explain."""

import re
from collections.abc import Iterable
from pathlib import Path

import click

from mesokit.case import methods
from mesokit.cli.commands import FILE, cli
from mesokit.cli.completion import beginning
from mesokit.errors import CaseError

TEMPLATES, EXAMPLES, STUDIES = methods.templates(), methods.examples(), methods.studies()
KNOWN = TEMPLATES | EXAMPLES | STUDIES


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
    f"Or the file of a study, and its case beside it: {', '.join(STUDIES)}.\n\n"
    "With a FILE it is written there; or give another NAME and its --template. Beside it "
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
    if template is None and name.removesuffix(".toml") in KNOWN:  # also one in a folder of examples
        template, file = name.removesuffix(".toml"), Path(file.name)
        if template in STUDIES:  # some have the name of their case, which lies beside them
            file = Path(f"{file.stem}_study.toml")
    elif template is None and file.stem in KNOWN:
        template = file.stem
    if template is None:
        listed = f" (give one of them, or --template: {_listed(KNOWN)})"
        raise CaseError(f"{name}: no such template{nearest(file.stem, KNOWN) or listed}")
    is_study = template in STUDIES
    written = _write_study(template, file) if is_study else _write_case(template, file)
    from mesokit.case.describe.kept import schema_text
    from mesokit.io.atomic import write_text

    write_text(file.with_name(SCHEMA), schema_text())  # for the parts that are installed now
    command = "study" if is_study else "run"
    click.echo(
        f"wrote {' and '.join(map(str, written))} (and {SCHEMA}, for editors); "
        f"next: mesokit check {written[-1]}, mesokit {command} {file}"
    )


def _write_study(template: str, file: Path) -> list[Path]:
    """The study file and its case beside it; both, in this order."""
    text = _named(template, file)
    of = re.search(r'^case = "\.\./([^"]+)\.toml"', text, flags=re.M)
    assert of is not None  # studies of examples name one of them
    case = file.with_name(f"{of[1].rpartition('/')[2]}.toml")
    _create(file, text.replace(of[0], f'case = "{case.name}"'))
    try:
        _write_case(of[1], case)
    except CaseError:
        file.unlink()
        raise
    return [file, case]


def _write_case(template: str, file: Path) -> list[Path]:
    """Write a case, and the files that it names, such as a picture of solids; the case."""
    text, source = _named(template, file), KNOWN[template]
    _create(file, f"#:schema ./{SCHEMA}\n{text}")
    for other in re.findall(r'^(?:file|bonds) = "([\w.-]+)"', text, flags=re.M):
        beside = file.with_name(other)
        if not beside.exists():
            beside.write_bytes((source.parent / other).read_bytes())
    return [file]


def _named(template: str, file: Path) -> str:
    """The text of a template, whose commands name the file."""
    text = KNOWN[template].read_text(encoding="utf-8")
    said = rf"(^# .*?\bmesokit .*?\b){template.rpartition('/')[2]}(?=\.toml|/| |$)"
    return str(re.sub(said, rf"\g<1>{file.stem}", text, flags=re.M))


def _create(file: Path, text: str) -> None:
    """Write a new file. Raises CaseError if one is there."""
    try:
        with open(file, "x", encoding="utf-8") as written:
            written.write(text)
    except FileExistsError:
        raise CaseError(f"{file}: exists already; remove it, or choose another name") from None


@cli.command()
@click.option("--output", type=FILE, help="File (the screen if none).")
def schema(output: Path | None) -> None:
    """Write the JSON schema of case files, by which editors complete and check them.

    `mesokit new` writes it beside a case, with the line that names it. In a case of your own, put

    #:schema ./case.schema.json

    as the first line, and say: mesokit schema --output case.schema.json
    """
    from mesokit.case.describe.kept import schema_text

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
