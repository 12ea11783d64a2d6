"""Commands on several runs of a case: study, merge."""

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from mesokit.cli.commands import DEVICE, RUN, SET, cli, dependence, pairs, require_run
from mesokit.cli.end import show_results, stopping
from mesokit.cli.words import patience, say, show_table
from mesokit.errors import CaseError, RunError


def _axes(context: click.Context, option: click.Parameter, values: Sequence[str]) -> Any:
    from mesokit.study.axes import Axis

    return [Axis.parse(text) for text in values]


@cli.command()
@click.argument("what", type=click.Path(path_type=Path), metavar="CASE|STUDY")
@click.option(
    "--vary",
    "axes",
    multiple=True,
    callback=_axes,
    metavar="KEY=VALUES",
    help="A list (fluid.density=5,10), a range (fluid.timestep=0.05:0.2:4, or 0.001:1:4:log), or "
    "keys that change together (fluid.timestep=0.1,0.05; run.steps=1000,2000). May be repeated: "
    "every combination is run.",
)
@click.option("--seeds", type=click.IntRange(1), help="So many seeds of each.  [1]")
@SET
@click.option(
    "--output", type=RUN, help="Folder of the study (CASE-study, or the name of the study file)."
)
@click.option("--jobs", type=click.IntRange(1), help="Runs at once (one a core unless said).")
@click.option("--threads", type=click.IntRange(1), default=1, help="Threads of each run.  [1]")
@DEVICE
@click.option(
    "--cluster",
    metavar="KIND",
    help="Carry the runs by Dask: slurm, pbs, sge, lsf, htcondor, local, or tcp://SCHEDULER.",
)
@click.option(
    "--cluster-option",
    "options",
    multiple=True,
    callback=pairs("name=value, such as queue=long"),
    metavar="NAME=VALUE",
    help="Of the jobs of a cluster, such as walltime=10:00:00. May be repeated.",
)
@click.option("--list", "listing", is_flag=True, help="Show the runs; nothing is run or written.")
@click.option("--job-array", is_flag=True, help="Write a Slurm script with a job for each run.")
@click.option("--only", type=click.IntRange(1), help="Carry the run of this number alone.")
@dependence
@click.option("--quiet", is_flag=True, help="No progress, no table; errors only.")
def study(what: Path, **given: Any) -> None:
    """Run CASE for several values and seeds, or go on with a STUDY (its folder, or a study file).

    Runs that have ended are not repeated. At the end there are a table (table.csv) and a picture of
    every number against the first key that is varied.
    """
    require_number(given)
    from mesokit.study.cluster import write_job_array
    from mesokit.study.drive import StudyReporter
    from mesokit.study.study import Study

    with patience("checking the cases of all runs", given["quiet"]):
        made = _made(Study, what, given)
    if given["listing"]:
        rows = enumerate(made.runs, start=1)
        return show_table([(str(number), run.state, str(run.path)) for number, run in rows])
    if given["job_array"]:
        script = write_job_array(made.path, len(made.runs), given["threads"], given["device"])
        return click.echo(f"wrote {script}; next: sbatch {shlex.quote(str(script))}")
    if given["only"] is not None:
        return _only(made, given["only"], given["threads"], given["device"])
    if not given["quiet"] and not made.ended:
        for warning in made.warnings():
            say(f"warning: {warning}")
    if given["y"]:
        made.require(given["x"] or first_key(made), given["y"])
    failed = None
    with stopping(f"mesokit study {shlex.quote(str(made.path))}"):
        try:
            if given["options"] and not given["cluster"]:
                raise CaseError("--cluster-option: only with --cluster")
            own = {name: given[name] for name in ("threads", "device", "cluster", "options")}
            made.run(given["jobs"], progress=StudyReporter(given["quiet"]), **own)
        except RunError as error:
            if not any(run.ended for run in made.runs):
                raise
            failed = error
    _show(made, given)
    if failed is not None:  # what has ended is shown all the same
        raise failed


def _made(Study: Any, what: Path, given: dict[str, Any]) -> Any:
    """The study of a case file, of a study file or in a folder."""
    from mesokit.case import toml

    data = toml.parse(toml.read(what)) if what.is_file() else {}
    if what.is_dir() or isinstance(data.get("case"), str):  # a study, or its file
        options = {"axes": "vary", "seeds": "seeds", "settings": "set"}
        if what.is_dir():
            options["output"] = "output"
        for name, option in options.items():
            if given[name]:
                raise CaseError(f"--{option}: only with a case file; {what} says it already")
        return Study.open(what, given["output"], write=not given["listing"])
    output = given["output"] or Path(f"{what.stem}-study")
    return Study(
        what,
        given["axes"],
        given["seeds"] or 1,
        output=output,
        settings=given["settings"],
        write=not given["listing"],
    )


def _only(made: Any, number: int, threads: int, device: str) -> None:
    """Carry one run, as a job of an array does."""
    from mesokit.study.work import carry

    if number > len(made.runs):
        raise CaseError(f"--only {number}: the study has {len(made.runs)} runs")
    run = made.runs[number - 1]
    if not run.ended and (why := carry(str(run.path), threads, device=device)):
        raise RunError(f"{run.path}: {why}")


def _show(made: Any, given: dict[str, Any]) -> None:
    """The table, and the pictures."""
    table = made.to_csv()
    if not given["quiet"]:
        for line in made.lines():
            click.echo(line)
    click.echo(f"table: {table}")
    for path in [draw_number(made, given)] if given["y"] else made.save_pictures():
        click.echo(f"picture: {path}")


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
    """Key against which a number is drawn unless said. Raises CaseError where nothing is varied."""
    if not made.keys:
        raise CaseError("--y: nothing is varied that it could be drawn against")
    return str(made.keys[0])


@cli.command()
@click.argument("runs", type=RUN, nargs=-1, required=True, metavar="RUN...")
@click.option("--output", type=RUN, required=True, help="Folder of the pooled results.")
@click.option("--quiet", is_flag=True, help="No summary; errors only.")
def merge(runs: tuple[Path, ...], output: Path, quiet: bool) -> None:
    """Pool the observables of RUNs of one case with different seeds, as if they were one run."""
    from mesokit.study.merge import merge as merged

    for run in runs:
        require_run(run)
    merged(runs, output)
    if not quiet:
        show_results(output)


def run_seeds(case: Path, seeds: int, output: Path, given: dict[str, Any]) -> None:
    """The command `run --seeds N`: a study of nothing but seeds, and what its runs say as one."""
    from mesokit.study.drive import StudyReporter
    from mesokit.study.study import Study

    made = Study(case, None, seeds, output=output, settings=given["settings"])
    if not given["quiet"] and not made.ended:
        for warning in made.warnings():
            say(f"warning: {warning}")
    with stopping(f"mesokit study {output}"):
        made.run(
            threads=given["threads"] or 1,
            device=given["device"],
            progress=StudyReporter(given["quiet"]),
        )
    if len(made.runs) > 1:
        files = made.merged()
        if not given["quiet"]:
            say(f"{len(made.runs)} runs are in {made.runs[0].path.parent}; pooled:")
            show_results(files.path)
