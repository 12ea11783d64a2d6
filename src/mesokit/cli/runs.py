"""Commands on runs: run, resume, info, export, report, table."""

import contextlib
import shutil
from pathlib import Path
from typing import Any

import click

from mesokit.cli.commands import (
    CASE,
    DEVICE,
    FILE,
    FORMATS,
    JSON,
    RUN,
    SET,
    THREADS,
    cli,
    is_study,
    naming,
    read,
    require_run,
    result_named,
)
from mesokit.cli.end import show_results, stopping
from mesokit.cli.together import on_ranks
from mesokit.cli.words import READING, in_json, patience, say
from mesokit.errors import CaseError
from mesokit.processes.world import world

NOT_REACHED = 3  # exit status of a run that ended before an error was small enough


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
@DEVICE
@click.option("--seed", type=click.IntRange(0), help="Replace run.seed.")
@click.option("--seeds", type=click.IntRange(1), help="So many runs, and their pooled results.")
@click.option("--output", type=RUN, help="Folder of the run (the name of CASE unless said).")
@click.option("--overwrite", is_flag=True, help="Replace an earlier run in that folder.")
@click.option("--quiet", is_flag=True, help="No progress, no summary; errors only.")
@on_ranks(lambda given: given["output"] or Path(given["case"].stem))
def run(
    case: Path,
    settings: dict[str, str],
    seed: int | None,
    seeds: int | None,
    output: Path | None,
    overwrite: bool,
    quiet: bool,
    **by: Any,
) -> None:
    """Run CASE. Ctrl-C (or SIGTERM, SIGHUP, SIGUSR1) stops it at a checkpoint; mesokit resume goes
    on.

    With --seeds, runs with so many seeds lie in OUTPUT/runs, and their pooled results in
    OUTPUT/runs/merged; the same command goes on with what was stopped.
    """
    from mesokit.report.progress import Reporter
    from mesokit.seam.method import summary_of

    here = world()
    if seed is not None:
        settings = {**settings, "run.seed": str(seed)}
    output = output or Path(case.stem)
    if seeds is not None:
        from mesokit.cli.studies import run_seeds

        if overwrite:
            raise CaseError(
                "--overwrite: not with --seeds, whose runs go on where they are; to begin anew, "
                f"remove the folder {output}, or choose another --output"
            )
        if here.size > 1:
            raise CaseError(f"--seeds: not on {here.size} ranks; expected one process")
        given = {"settings": settings, "quiet": quiet, **by}
        return run_seeds(case, seeds, output, given)
    with patience(READING, quiet):
        full = read(case, settings)
    here.on_root(lambda: _claim(output, overwrite))
    if not quiet:
        for warning in summary_of(full, by["threads"]).warnings:
            say(f"warning: {warning}")
    from mesokit.run.simulation import Simulation

    with naming(case):
        simulation = Simulation(full, **by)
    here.on_root(lambda: _clear(output))  # only now: what cannot start costs no earlier run
    simulation.write_to(output)
    with stopping(f"mesokit resume {output}"):
        simulation.run(progress=Reporter(quiet))
    if not quiet:
        here.on_root(lambda: show_results(output))


@cli.command()
@click.argument("run", type=RUN)
@click.option("--steps", type=click.IntRange(0), help="Let it last so many after its warm-up.")
@click.option(
    "--until-error",
    metavar="NUMBER=ERROR",
    help="Let it last until a compared number is known so well, such as "
    "velocity-profile.viscosity=1%; then --steps is the limit.",
)
@THREADS
@DEVICE
@click.option("--quiet", is_flag=True, help="No progress, no summary; errors only.")
@on_ranks(lambda given: given["run"])
def resume(
    run: Path,
    steps: int | None,
    until_error: str | None,
    threads: int | None,
    device: str,
    quiet: bool,
) -> None:
    """Go on with RUN from its last checkpoint, to the same bits as if it had never stopped.

    A RUN that has ended goes on if it is to be longer, to the bits of a run that was as long from
    the start; else its results and figures are written again.
    """
    from mesokit.report.progress import Reporter

    here = world()
    here.on_root(lambda: require_run(run))
    from mesokit.io.run_directory import RunDirectory
    from mesokit.run.simulation import Simulation

    longer = None if until_error else steps
    with stopping(f"mesokit resume {run}"):
        simulation = Simulation.resume(run, threads=threads, steps=longer, device=device)
        if not (quiet or RunDirectory(run).checkpoint_file.exists()):
            say(f"{run}: no checkpoint yet; starting from step 0")
        limit = None
        if until_error and steps is not None:
            limit = max(simulation.case.run.warmup + steps - simulation.step, 0)
        ended = simulation.step == simulation.last_step and not until_error
        if ended and not quiet:
            say(f"{run}: had ended at step {simulation.step}; drawing its figures again")
        simulation.run(limit, until=until_error, progress=Reporter(quiet or ended))
    if not quiet:
        here.on_root(lambda: show_results(run))
    if until_error and not simulation.reached(until_error):
        raise SystemExit(NOT_REACHED)


@cli.command()
@click.argument("run", type=RUN, metavar="RUN|STUDY")
@JSON
def info(run: Path, as_json: bool) -> None:
    """Show what is in the files of RUN, or the pooled numbers of STUDY."""
    import mesokit

    if is_study(run):
        study = mesokit.Study.open(run)
        click.echo(in_json(study.record()) if as_json else "\n".join([repr(study), *study.lines()]))
        return
    require_run(run)
    files = mesokit.open(run)
    click.echo(in_json(files.record()) if as_json else files)


@cli.command()
@click.argument("run", type=RUN)
@click.option(
    "--to",
    "path",
    type=FILE,
    required=True,
    help="The file: .gsd, .lammpstrj, .xyz, .h5md, .dcd, .xtc, .trr or .data; contacts of "
    "grains: .csv or .local; of a lattice .xyz, .vti or .png.",
)
@click.option(
    "--states", metavar="A,B", help="Only sites in these states, such as all but empty ones (.xyz)."
)
@click.option("--pixels", type=click.IntRange(1), help="Pixels along a side of a site (.png).  [1]")
def export(run: Path, path: Path, states: str | None, pixels: int | None) -> None:
    """Write the trajectory of RUN as a file for OVITO, HOOMD-blue, VMD, LAMMPS or ParaView."""
    import mesokit

    require_run(run)
    names = None if states is None else [name.strip() for name in states.split(",")]
    click.echo(mesokit.open(run).export(path, names, pixels))


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
    own = None if result is None else result_named(files, result)
    text = rows_text(files.results) if own is None else result_text(own)
    if output is None:
        return click.echo(text, nl=False)
    click.echo(write_text(output, text))


def _claim(output: Path, overwrite: bool) -> None:
    """Refuse a folder that holds something, unless it is an earlier run to be replaced."""
    if output.exists() and not output.is_dir():
        raise CaseError(f"--output {output}: is a file; choose another folder")
    there = sorted(output.iterdir()) if output.is_dir() else []
    own = _files_of_run(output)
    if not there or (overwrite and set(there) <= set(own)):
        return
    others = [path.name for path in there if path not in own]
    hint = "an earlier run; mesokit resume goes on with it, --overwrite replaces it"
    if others:
        hint = f"other files ({others[0]}); choose another folder"
    raise CaseError(f"--output {output}: holds {hint}")


def _files_of_run(output: Path) -> list[Path]:
    """Files of an earlier run in a folder; the case, which makes the folder a run, is last."""
    from mesokit.case.case import Case
    from mesokit.io.log_file import ASIDE
    from mesokit.io.run_directory import RunDirectory
    from mesokit.report.flow import NAMES

    run = RunDirectory(output)
    if not run.case_file.is_file():
        return []
    figures = [run.flow_file(kind, ".png") for kind in NAMES]
    with contextlib.suppress(CaseError):
        figures += [run.figure_file(o.label) for o in Case.from_toml(run.case_file).observe]
    return [
        *(figure.with_suffix(f".{end}") for figure in figures for end in FORMATS),
        *(run.flow_file(kind, end) for kind in NAMES for end in (".mp4", ".gif")),
        *output.glob(f"{ASIDE}*.csv"), *output.glob(".*.tmp"), *run.files_of_parts(),
        run.data_file, run.checkpoint_file, run.log_file, run.report_file, run.provenance_file,
        run.trajectory_folder, run.trajectory_remains, run.trajectory_coming,
        run.progress_file, run.lock_file, run.case_file,
    ]  # fmt: skip


def _clear(output: Path) -> None:
    """Remove the files of an earlier run, unless another process writes them."""
    from mesokit.io.one_writer import alone
    from mesokit.io.run_directory import RunDirectory

    run = RunDirectory(output)
    with alone(run if output.is_dir() else None):
        for path in _files_of_run(output):  # in this order: what is left makes a run until the end
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path)
            elif path != run.lock_file:
                path.unlink(missing_ok=True)
    run.lock_file.unlink(missing_ok=True)
