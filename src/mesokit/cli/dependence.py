"""One number of a study against what it varies: options of `study` and `plot`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from mesokit.errors import CaseError

FITS = click.Choice(["line", "power"])
LOGS = click.Choice(["x", "y", "x,y"])
OPTIONS = (
    click.option("--x", metavar="KEY", help="Draw against this key (the first unless said)."),
    click.option("--y", metavar="NUMBER", help="Draw this number, such as flow-rate.permeability."),
    click.option("--fit", type=FITS, help="Fit a straight line or a power law to it."),
    click.option("--log", type=LOGS, help="Logarithmic axes of it."),
    click.option("--linear", is_flag=True, help="Linear axes of it."),
)


def dependence(command: Any) -> Any:
    """The options that say which number of a study is drawn, and how."""
    for option in reversed(OPTIONS):
        command = option(command)
    return command


def require_number(given: Mapping[str, Any]) -> None:
    """Raise CaseError for options of a number without the number, or that exclude one another."""
    for option in ("x", "fit", "log", "linear"):
        if given[option] and not given["y"]:
            raise CaseError(f"--{option}: of which number? add --y")
    if given["log"] and given["linear"]:
        raise CaseError("--linear: not with --log")


def draw_number(made: Any, given: Mapping[str, Any], **look: Any) -> Path:
    """Draw the number of a study that is given into a file, and print its fit."""
    x, y, fit = given["x"] or first_key(made), given["y"], given["fit"]
    log = False if given["linear"] else given["log"]
    picture: Path = made.save_picture(x, y, fit, log=log, **look)
    for found in made.fit(x, y, fit) if fit else ():
        click.echo(f"fit: {found}")
    return picture


def first_key(made: Any) -> str:
    """What a number is drawn against unless said. Raises CaseError where nothing is varied."""
    if not made.keys:
        raise CaseError("--y: nothing is varied that it could be drawn against")
    return str(made.keys[0])
