"""Commands on compiled code: warm, cache."""

import re
from collections.abc import Sequence
from pathlib import Path

import click

from mesokit.cli.commands import CASE, FILE, SET, cli
from mesokit.cli.together import on_ranks
from mesokit.cli.words import say, show_table
from mesokit.devices.names import CPU
from mesokit.errors import CaseError, MesokitError, RunError


def chip_of(context: click.Context, option: click.Parameter, text: str | None) -> str | None:
    """A compute capability, such as "9.0"."""
    if text is not None and not re.fullmatch(r"\d{1,2}\.\d", text):
        raise CaseError(f"--chip {text}: expected a compute capability, such as 9.0")
    return text


@cli.command()
@click.argument("cases", type=CASE, nargs=-1, metavar="[CASE]...")
@SET
@click.option("--all", "every", is_flag=True, help="All templates and examples of all methods.")
@click.option("--why", is_flag=True, help="Say why each kernel was compiled.")
@click.option(
    "--chip",
    metavar="N.N",
    callback=chip_of,
    help="Kernels of a card of this compute capability, such as 9.0; none is needed.",
)
@click.option("--quiet", is_flag=True, help="Errors only.")
@on_ranks(lambda given: Path("warm"))
def warm(
    cases: Sequence[Path],
    settings: dict[str, str],
    every: bool,
    why: bool,
    chip: str | None,
    quiet: bool,
) -> None:
    """Compile what each CASE runs and keep it, so that the first run starts at once.

    A few steps of each case are run, and nothing is written but compiled code. Use it once in a
    container, or before many jobs of a cluster start; with --ranks for runs on several ranks. With
    --chip, kernels of cards are compiled too, on a machine without one.
    """
    if bool(cases) == every:
        raise CaseError("warm: expected cases, or --all")
    from mesokit.case.methods import examples, templates
    from mesokit.processes.world import world
    from mesokit.run.warm import warm as compile_all

    device = CPU if chip is None else f"emulated:{chip}"
    known = {**templates(), **examples()} if every else {str(case): case for case in cases}
    for name, case in known.items():
        try:
            made = compile_all(Path(str(case)), settings, why, device)
        except MesokitError as error:
            if not every:
                raise
            say(f"{name}: left out: {error}")
            continue
        if quiet or world().rank != 0:
            continue
        click.echo(f"{name}: {made.kernels} kernels, {made.parts} parts, {made.seconds:.1f} s")
        for what, because in made.reasons.items() if why else ():
            if what.startswith("kernel"):
                click.echo(f"  {what}: {because}")


@cli.command()
@click.option("--clear", is_flag=True, help="Delete all compiled code of this user.")
@click.option(
    "--export",
    "file",
    type=FILE,
    help="Write all parts to a file, for a package (see docs: releasing).",
)
def cache(clear: bool, file: Path | None) -> None:
    """Show where compiled code is kept and how much there is, clear or export it.

    It lies in the user's cache, or in NUMBA_CACHE_DIR where that is set.
    """
    import sqlite3

    from mesokit.case.amounts import size_text
    from mesokit.kernels import store
    from mesokit.kernels.kept import forget, kept, shipped_file
    from mesokit.kernels.ship import export

    if clear and file is not None:
        raise CaseError("cache: --clear and --export: expected one of them")
    if clear:
        place = store.store_file()
        before = sum(one.stat().st_size for one in place.parent.glob(f"{place.name}*"))
        store.clear()
        forget()
        click.echo(f"cleared {size_text(before)} in {place.parent}")
        return
    if file is not None:
        try:
            number = export(file)
        except (OSError, sqlite3.Error) as error:
            raise RunError(f"--export {file}: {error}") from None
        click.echo(f"{number} parts, {size_text(file.stat().st_size)}: {file}")
        return
    own, shipped = kept().own, kept().shipped
    if own is None:
        click.echo(f"store: none: {kept().trouble}")
    else:
        click.echo(f"store: {own.file}{'' if own.writes else ' (can only be read)'}")
        counted = own.counts()
        show_table(
            [
                ("size", size_text(own.size), f"at most {size_text(store.BOUND)}"),
                ("kernels", str(counted["kernels"]), "machine code for this processor"),
                ("stages", str(counted["stages"]), "machine code that kernels share"),
                ("parts", str(counted["parts"]), "for all kernels to be made of"),
                ("kinds of case", str(counted["kinds"]), "that have run here"),
            ]
        )
    holds = f"{shipped.counts()['parts']} parts in" if shipped else "none; they would be in"
    click.echo(f"with the package: {holds} {shipped_file()}")
