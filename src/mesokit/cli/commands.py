"""The group of commands, and the options that several of them take."""

from __future__ import annotations

import contextlib
import functools
import importlib
import math
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mesokit import __version__
from mesokit.cli.completion import keys
from mesokit.cli.together import take_part
from mesokit.cli.words import frames_of_parts
from mesokit.devices.names import CPU
from mesokit.errors import CaseError, RunError

if TYPE_CHECKING:
    from mesokit.case.case import Case


MODULES = {  # files of this folder, and the commands in each
    "check": ("check",),
    "runs": ("run", "resume", "info", "export", "report", "table"),
    "studies": ("study", "merge"),
    "pictures": ("plot", "animate"),
    "reference": ("new", "schema", "explain"),
    "theory": ("theory",),
    "compiled": ("warm", "cache"),
}
COMMANDS = {command: module for module, commands in MODULES.items() for command in commands}


class Finite(click.FloatRange):
    """A number within bounds, if there are any; nan lies within none."""

    def __init__(self, least: float | None = None, most: float | None = None) -> None:
        super().__init__(least, most)
        self.name = "float range" if least is not None else "float"  # in the help

    def _describe_range(self) -> str:
        return super()._describe_range() if self.min is not None else ""

    def convert(self, value: Any, option: click.Parameter | None, context: Any) -> Any:
        number = super().convert(value, option, context)
        return number if math.isfinite(number) else self.fail(f"{value} is no number", option)


class Commands(click.Group):
    """The commands of COMMANDS, in alphabetical order. The module of a command is imported on its
    first use, or for a list of all."""

    def list_commands(self, context: click.Context) -> list[str]:
        return sorted(COMMANDS)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        if name in COMMANDS:
            importlib.import_module(f"{__package__}.{COMMANDS[name]}")
        return super().get_command(context, name)


@click.group(
    cls=Commands,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Completion of commands and options: put "
    'eval "$(_MESOKIT_COMPLETE=bash_source mesokit)" into ~/.bashrc (or zsh_source, fish_source).',
)
@click.version_option(__version__, message="mesokit %(version)s")
@click.option(
    "--import",
    "modules",
    multiple=True,
    metavar="MODULE",
    help="A Python module, of this folder or installed, with parts of one's own. May be repeated.",
)
@click.pass_context
def cli(context: click.Context, modules: Sequence[str]) -> None:
    """Mesoscale particle simulation, from a case file to a figure with the theory on it.

    Start with: mesokit new poiseuille, then mesokit run poiseuille.toml
    """
    take_part(context.invoked_subcommand)
    for module in modules:
        sys.path[:0] = [os.getcwd()] if os.getcwd() not in sys.path else []
        module = module.removesuffix(".py")  # the name of a file works as well
        if not all(part.isidentifier() for part in module.split(".")):
            raise CaseError(f"--import {module!r}: expected the name of a module, such as mine")
        try:
            importlib.import_module(module)
        except ImportError as error:
            raise CaseError(f"--import {module}: {error}") from None
        except (Exception, SystemExit) as error:  # code of users may raise anything
            last = frames_of_parts(error)[-1:]
            where = "".join(f" (line {frame.lineno} of {frame.filename})" for frame in last)
            why = f"{type(error).__name__}: {error}{where}"
            raise CaseError(f"--import {module}: {why}") from None


CASE = FILE = click.Path(dir_okay=False, path_type=Path)
FORMATS = ("png", "pdf", "svg")  # of figures
RUN = click.Path(file_okay=False, path_type=Path)


def pairs(form: str) -> Any:
    """The callback of an option that may be repeated: a dictionary of its texts KEY=VALUE."""

    def split(context: click.Context, option: click.Parameter, values: Sequence[str]) -> Any:
        for text in values:
            if "=" not in text:
                raise CaseError(f"{option.opts[0]} {text}: expected {form}")
        return {key.strip(): value.strip() for key, _, value in (t.partition("=") for t in values)}

    return split


def options(*given: Any) -> Any:
    """A decorator of commands for several options, in this order."""
    return lambda command: functools.reduce(lambda made, one: one(made), reversed(given), command)


SET = click.option(
    "--set",
    "settings",
    multiple=True,
    callback=pairs("key=value, such as fluid.density=5"),
    shell_complete=keys,
    metavar="KEY=VALUE",
    help="Replace a value of the case, such as fluid.density=5. May be repeated.",
)
JSON = click.option("--json", "as_json", is_flag=True, help="All of it as JSON, for scripts.")
DEVICE = click.option(
    "--device",
    default=CPU,
    metavar="NAME",
    help="cpu, or cuda for a card of NVIDIA (cuda:1: the second); emulated and host run its "
    "kernels on the processor, slowly. The same bits on all.  [cpu]",
)
THREADS = click.option("--threads", type=click.IntRange(1), help="Threads (all cores unless said).")


def axes_of(context: click.Context, option: click.Parameter, text: str | None) -> Any:
    """'x,z' as two names."""
    return None if text is None else tuple(text.split(","))


def read(path: Path, settings: dict[str, str]) -> Case:
    """The case in a file, with values replaced."""
    from mesokit.case.case import Case

    case = Case.from_toml(path, settings)
    for problem in case.missing_files():
        raise CaseError(f"{path}: {problem}")
    return case


@contextlib.contextmanager
def naming(path: Path) -> Iterator[None]:
    """Put the name of the case file before what is wrong in it."""
    try:
        yield
    except CaseError as error:
        raise CaseError(f"{path}: {error}") from None


def is_study(folder: Path) -> bool:
    """True if a study is in the folder."""
    from mesokit.io.run_directory import RunDirectory

    return RunDirectory(folder).study_file.exists()


def require_run(run: Path) -> None:
    """Raise CaseError, because the command is wrong, if there is no run in the folder."""
    from mesokit.io.run_directory import RunDirectory

    try:
        RunDirectory.existing(run)
    except RunError as error:
        raise CaseError(str(error)) from None


def result_named(files: Any, name: str) -> Any:
    """The result of a run that --result names; CaseError lists the results."""
    if name in files:
        return files[name]
    from mesokit.case.component import nearest

    known = f"{', '.join(files) or 'none'}{nearest(name, files)}"
    raise CaseError(f"--result {name}: no such result; there are {known}")


FITS = click.Choice(["line", "power"])
LOGS = click.Choice(["x", "y", "x,y"])
dependence = options(  # of a study: the number that is drawn, and how
    click.option("--x", metavar="KEY", help="Draw against this key (the first unless said)."),
    click.option(
        "--y",
        metavar="NUMBER[,NUMBER]",
        help="Draw this number, such as flow-rate.permeability, or several of one unit.",
    ),
    click.option("--fit", type=FITS, help="Fit a straight line or a power law to it."),
    click.option("--log", type=LOGS, help="Logarithmic axes of it."),
    click.option("--linear", is_flag=True, help="Linear axes of it."),
)
