"""Commands that draw what a run has kept: plot, animate."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mesokit.cli.commands import (
    FILE,
    FORMATS,
    RUN,
    Finite,
    axes_of,
    cli,
    dependence,
    is_study,
    options,
    require_run,
    result_named,
)
from mesokit.cli.completion import colours, kinds
from mesokit.cli.words import say
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.run.opened import RunFiles

KIND = (
    "quiver, streamlines, particles, density, speed, vorticity, four, disks, force-chains, flock, "
    "bodies; of a lattice sites, space-time, profiles, heights or occupied"
)
SHORT, LONG = 2.0, 5  # seconds: of a film too short to be seen, and slowed down


def _ranges(context: click.Context, option: click.Parameter, text: str | None) -> Any:
    """'0:20,5:10' as pairs of numbers."""
    if text is None:
        return None
    try:
        ranges = tuple(
            (float(low), float(high))
            for low, _, high in (part.partition(":") for part in text.split(","))
        )
        if any(math.isnan(end) for ends in ranges for end in ends):
            raise ValueError
        return ranges
    except ValueError:
        form = {"region": "x0:x1,y0:y1, in cells", "window": "t0:t1, two times"}[str(option.name)]
        raise CaseError(f"--{option.name} {text}: expected {form}") from None


def _window(context: click.Context, option: click.Parameter, text: str | None) -> Any:
    ranges = _ranges(context, option, text)
    if ranges is not None and len(ranges) != 1:
        raise CaseError(f"--window {text}: expected t0:t1, two times")
    return ranges and ranges[0]


def _names(context: click.Context, option: click.Parameter, text: str | None) -> Any:
    """'A,B' as names."""
    return text if text is None else tuple(name.strip() for name in text.split(","))


_choices = options(  # the part of the flow that is drawn
    click.option(
        "--region",
        callback=_ranges,
        metavar="X0:X1,Y0:Y1",
        help="Part of the box, in cells (all of it unless said).",
    ),
    click.option(
        "--window",
        callback=_window,
        metavar="T0:T1",
        help="Part of the time since the start (all of it unless said).",
    ),
    click.option(
        "--axes",
        callback=axes_of,
        metavar="A,B",
        help="The two axes of the picture in 3D, such as x,z.",
    ),
    click.option(
        "--at",
        type=Finite(),
        help="Place along the third axis where solids are shown; of spheres those behind it, of "
        "sites the layer there.",
    ),
    click.option(
        "--colour",
        shell_complete=colours,
        metavar="NAME",
        help="Of spheres: speed, log-speed, relative-speed, spin, neighbours, psi6, kind.  [speed]",
    ),
    click.option(
        "--traces",
        type=Finite(),
        metavar="T",
        help="Time over which the paths of bodies are shown.",
    ),
    click.option(
        "--states",
        callback=_names,
        metavar="A,B",
        help="States of sites that kind occupied shows.  [all but the first]",
    ),
    click.option(
        "--time",
        type=click.Choice(["linear", "log"]),
        help="Spacing of the times of a film, or of profiles.  [linear]",
    ),
)


@cli.command()
@click.argument("run", type=RUN, metavar="RUN|STUDY")
@click.option("--kind", shell_complete=kinds, help=f"Draw the flow: {KIND}.")
@_choices
@click.option("--result", metavar="NAME", help="Draw this result alone.")
@dependence
@click.option("--format", "kind_of_file", type=click.Choice(FORMATS), help="[png]")
@click.option("--width", type=Finite(2, 20), help="Inches; a column has 3.4.  [6.4]")
@click.option("--output", type=FILE, help="The file of one picture: PNG, PDF or SVG.")
def plot(run: Path, output: Path | None, width: float | None, **given: Any) -> None:
    """Draw the results of RUN again, one of them, or with --kind a picture of the flow.

    Options of a picture without --kind draw the usual kind for which the run has kept all. Of STUDY
    every number is drawn against the first varied key, or that of --y against --x.
    """
    import mesokit

    ending = f".{given.pop('kind_of_file') or 'png'}"
    of_study = {option: given.pop(option) for option in ("x", "y", "fit", "log", "linear")}
    if is_study(run):
        return _plot_study(run, output, width, ending, of_study, given)
    kind, name = given.pop("kind"), given.pop("result")
    require_run(run)
    for option, value in of_study.items():
        if value:
            raise CaseError(f"--{option}: only of a study; {run} holds a run")
    files = mesokit.open(run)
    if kind is None and name is None and any(value is not None for value in given.values()):
        kind = _usual(files, "four", given, given["window"] is not None)
    _require_one(kind, name, output, given)
    if not files.ended and files.results:
        say(f"{run}: the run {files.state}; what is drawn is so far")
    if kind is not None:
        from mesokit.report import save_figure

        figure = files.flow(kind, width=width, **given)
        click.echo(save_figure(figure, output or files.directory.flow_file(kind, ending)))
    elif name is not None:
        from mesokit.report import save

        path = output or files.path / f"{name}{ending}"
        run_name = files.path.resolve().name
        click.echo(save(result_named(files, name), path, files.case, width=width, run=run_name))
    else:
        for picture in files.plot(ending=ending, width=width):
            click.echo(picture)


def _plot_study(
    path: Path, output: Path | None, width: float | None, ending: str, chosen: Any, others: Any
) -> None:
    """Draw every number of a study, or the chosen one."""
    from mesokit.cli.studies import draw_number, require_number
    from mesokit.study.study import Study

    for option, value in others.items():
        if value is not None:
            raise CaseError(f"--{option}: only of a run; {path} holds a study")
    require_number(chosen)
    study = Study.open(path)
    if not study.ended:
        say(f"{path}: {sum(run.ended for run in study.runs)} of {len(study)} runs have ended")
    if chosen["y"]:
        return click.echo(draw_number(study, chosen, ending=ending, path=output, width=width))
    if output is not None:
        raise CaseError(f"--output {output}: there are many pictures; add --y NUMBER")
    pictures = study.save_pictures(ending, width=width)
    if not pictures:
        raise CaseError(f"{path}: no number has error bars at two values of a varied key")
    for picture in pictures:
        click.echo(picture)


def _require_one(kind: str | None, name: str | None, output: Path | None, given: Any) -> None:
    """Raise CaseError for options that have no meaning together."""
    if kind and name:
        raise CaseError(f"--result {name}: not with --kind; draw one of them")
    for option, value in given.items():
        if value is not None and not kind:
            raise CaseError(f"--{option}: only for a picture of the flow; add --kind ({KIND})")
    if output is not None and not (kind or name):
        raise CaseError(
            f"--output {output}: there are many pictures; add --result NAME or --kind ({KIND}), "
            "or draw all in another --format"
        )


def _usual(files: RunFiles, first: str, choices: Any, in_time: bool) -> str:
    """The kind of picture for which the files of a run have enough."""
    from mesokit.report.flow import usual
    from mesokit.report.flow.region import View
    from mesokit.report.flow.site_kinds import own_kind
    from mesokit.report.flow.source import sources

    if own := own_kind(files.case):
        return own
    found = sources(files.case, files.results, files.trajectory, View(**choices))
    return usual(files.case, found, first, in_time)


@cli.command()
@click.argument("run", type=RUN)
@click.option(
    "--kind", shell_complete=kinds, help=f"What is drawn: {KIND}.  [what the run has kept]"
)
@_choices
@click.option("--fps", type=Finite(), default=15.0, help="Frames shown per second.  [15]")
@click.option(
    "--average",
    type=click.IntRange(1),
    metavar="N",
    help="Frames that each picture is the mean of.  [as few as lift the flow above its noise]",
)
@click.option("--output", type=FILE, help="MP4 or GIF (RUN/flow-KIND.mp4 unless said).")
@click.option("--quiet", is_flag=True, help="No progress; errors only.")
def animate(
    run: Path, kind: str | None, fps: float, output: Path | None, quiet: bool, **choices: Any
) -> None:
    """Make a film of the flow in RUN, from its flow-frames or its trajectory."""
    import mesokit
    from mesokit.report.progress import FilmReporter

    require_run(run)
    files = mesokit.open(run)
    kind = kind or _usual(files, "speed", choices, in_time=True)
    output = output or files.directory.flow_file(kind, ".mp4")
    film = files.animate(output, kind, fps=fps, progress=FilmReporter(quiet), **choices)
    if not quiet:
        if film.frames == 1:
            say("the film has one frame, so nothing moves in it; the case may keep more")
        elif (lasts := film.frames / fps) < SHORT:
            slower = max(1, film.frames // LONG)
            say(f"{film.frames} frames last {lasts:.2g} s; --fps {slower} slows the film down")
        click.echo(film.path)
