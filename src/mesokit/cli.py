"""The command line: every command is a few lines over the Python API."""

from __future__ import annotations

import contextlib
import errno
import importlib.resources
import os
import shutil
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mesokit import __version__
from mesokit.errors import CaseError, MesokitError, RunError

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.derived import Derived

TEMPLATES = ("poiseuille", "couette", "shear", "kolmogorov", "bulk")
CASE = click.Path(dir_okay=False, path_type=Path)
RUN = click.Path(file_okay=False, path_type=Path)


@click.group(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Completion of commands and options: put "
    'eval "$(_MESOKIT_COMPLETE=bash_source mesokit)" into ~/.bashrc (or zsh_source, fish_source).',
)
@click.version_option(__version__, message="mesokit %(version)s")
def cli() -> None:
    """Mesoscale fluid simulation, from a case file to a figure with the theory on it.

    Start with: mesokit new poiseuille, then mesokit run poiseuille.toml
    """


@cli.command()
@click.argument("name")
@click.option("--template", type=click.Choice(TEMPLATES), help="What to start from.")
def new(name: str, template: str | None) -> None:
    """Write a commented case NAME.toml: poiseuille, couette, shear, kolmogorov or bulk.

    With another NAME, say which --template.
    """
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    template = template or (path.stem if path.stem in TEMPLATES else None)
    if template is None:
        from mesokit.component import nearest, one_of

        raise CaseError(
            f"{name}: no such template{nearest(path.stem, TEMPLATES)} (give one of them, "
            f"or --template: {one_of(TEMPLATES)})"
        )
    text = importlib.resources.files("mesokit.templates").joinpath(f"{template}.toml").read_text()
    text = text.replace(f"{template}.toml", path.name).replace(f"{template}/", f"{path.stem}/")
    try:
        with open(path, "x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise CaseError(f"{path}: exists already; remove it, or choose another name") from None
    click.echo(f"wrote {path}; next: mesokit check {path}, mesokit run {path}")


def _settings(context: click.Context, option: click.Parameter, values: Sequence[str]) -> Any:
    for text in values:
        if "=" not in text:
            raise CaseError(f"--set {text}: expected key=value, such as fluid.density=5")
    return {key.strip(): value.strip() for key, _, value in (t.partition("=") for t in values)}


SET = click.option(
    "--set", "settings", multiple=True, callback=_settings, metavar="KEY=VALUE",
    help="Replace a value of the case, such as fluid.density=5. May be repeated.",
)  # fmt: skip
THREADS = click.option("--threads", type=click.IntRange(1), help="Threads (all cores unless said).")


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
def check(case: Path, settings: dict[str, str], threads: int | None) -> None:
    """Check CASE, show it with all defaults, what follows from it, and what to mind."""
    from mesokit.derived import derive

    full = _read(case, settings)
    _show_check(full, derive(full, threads))


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
@click.option("--seed", type=click.IntRange(0), help="Replace run.seed.")
@click.option("--output", type=RUN, help="Folder of the run (the name of CASE unless said).")
@click.option("--overwrite", is_flag=True, help="Replace an earlier run in that folder.")
@click.option("--quiet", is_flag=True, help="No progress, no summary; errors only.")
def run(
    case: Path, settings: dict[str, str], threads: int | None, seed: int | None,
    output: Path | None, overwrite: bool, quiet: bool,
) -> None:  # fmt: skip
    """Run CASE. Ctrl-C stops it at a checkpoint; mesokit resume goes on."""
    from mesokit.derived import derive
    from mesokit.progress import Reporter

    if seed is not None:
        settings = {**settings, "run.seed": str(seed)}
    full = _read(case, settings)
    output = output or Path(case.stem)
    _claim(output, overwrite)
    if not quiet:
        for warning in derive(full, threads).warnings:
            click.echo(f"warning: {warning}", err=True)
    from mesokit.simulation import Simulation

    simulation = Simulation(full, threads=threads)
    _clear(output)  # only now: a case that cannot start must not cost an earlier run
    simulation.write_to(output)
    with _run_errors(output):
        simulation.run(progress=Reporter(quiet))
    if not quiet:
        _show_results(output)


@cli.command()
@click.argument("run", type=RUN)
@THREADS
@click.option("--quiet", is_flag=True, help="No progress, no summary; errors only.")
def resume(run: Path, threads: int | None, quiet: bool) -> None:
    """Go on with RUN from its last checkpoint, to the same bits as if it had never stopped."""
    from mesokit.progress import Reporter

    _require_run(run)
    from mesokit.simulation import Simulation

    with _run_errors(run):
        Simulation.resume(run, threads=threads).run(progress=Reporter(quiet))
    if not quiet:
        _show_results(run)


@cli.command()
@click.argument("run", type=RUN)
def plot(run: Path) -> None:
    """Draw the pictures of RUN again."""
    import mesokit

    _require_run(run)
    for picture in mesokit.open(run).plot():
        click.echo(picture)


@cli.command()
@click.argument("run", type=RUN)
def info(run: Path) -> None:
    """Show what is in the files of RUN."""
    import mesokit

    _require_run(run)
    click.echo(mesokit.open(run))


@cli.command()
@click.option("--rule", default="srd", type=click.Choice(["srd", "at", "srd+a", "at+a"]))
@click.option("--dimension", default="3", type=click.Choice(["2", "3"]))
@click.option("--density", default=10.0, help="Particles per cell.  [10]")
@click.option("--timestep", default=0.1, help="Time between two collisions.  [0.1]")
@click.option("--angle", type=float, help="Rotation angle in degrees, SRD only.  [130]")
@click.option("--angle-distribution", default="fixed", type=click.Choice(["fixed", "uniform"]))
@click.option("--thermostat", default="none", help="none, maxwell-boltzmann or rescale.",
              type=click.Choice(["none", "maxwell-boltzmann", "rescale"]))  # fmt: skip
@click.option("--kT", "kT", default=1.0, help="Thermal energy.  [1]")
@click.option("--mass", default=1.0, help="Mass of a particle.  [1]")
def theory(**given: Any) -> None:
    """Transport coefficients of a fluid, without running it."""
    _show_theory(given)


# --- helpers ------------------------------------------------------------------------------------


def _read(path: Path, settings: dict[str, str]) -> Case:
    from mesokit.case import Case

    case = Case.from_toml(path, settings)
    for problem in case.missing_files():
        raise CaseError(f"{path}: {problem}")
    return case


def _claim(output: Path, overwrite: bool) -> None:
    """Refuse a folder that holds something, unless it is an earlier run to be replaced."""
    if output.exists() and not output.is_dir():
        raise CaseError(f"--output {output}: is a file; choose another folder")
    there = sorted(output.iterdir()) if output.is_dir() else []
    own = _files_of_run(output)
    if not there or (overwrite and set(there) <= set(own)):
        return
    others = [path.name for path in there if path not in own]
    if others:
        raise CaseError(
            f"--output {output}: holds other files ({others[0]}); choose another folder"
        )
    raise CaseError(
        f"--output {output}: holds an earlier run; mesokit resume goes on with it, "
        "--overwrite replaces it"
    )


def _files_of_run(output: Path) -> list[Path]:
    """What an earlier run has written into a folder; the case, which makes it a run, is last."""
    from mesokit.case import Case
    from mesokit.io.run_directory import RunDirectory

    run = RunDirectory(output)
    if not run.case_file.is_file():
        return []
    figures: list[Path] = []
    with contextlib.suppress(CaseError):
        figures = [run.figure_file(o.label) for o in Case.from_toml(run.case_file).observe]
    files = [run.data_file, run.checkpoint_file, run.log_file, run.provenance_file]
    return [*figures, *output.glob(".*.tmp"), run.trajectory_folder, *files, run.case_file]


def _clear(output: Path) -> None:
    """Remove the files of an earlier run."""
    for path in _files_of_run(output):
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)


@contextlib.contextmanager
def _run_errors(output: Path) -> Iterator[None]:
    """A full disk while running is a failure of the run, not of the command."""
    try:
        yield
    except KeyboardInterrupt as stop:
        if not str(stop):  # stopped so hard that nothing is known
            raise
        click.echo(f"mesokit: {stop}; go on with: mesokit resume {output}", err=True)
        _leave(130)
    except OSError as error:
        raise RunError(_reason(error)) from None


def _require_run(run: Path) -> None:
    from mesokit.io.run_directory import RunDirectory

    try:
        RunDirectory.existing(run)
    except RunError as error:  # the command is wrong, not the run
        raise CaseError(str(error)) from None


def _console() -> Any:
    from rich.console import Console

    return Console(highlight=False, soft_wrap=True)


def _rows(rows: Sequence[tuple[str, str, str]]) -> None:
    from rich.table import Table

    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    for row in rows:
        table.add_row(*row)
    _console().print(table)


def _number(value: float | None, unit: str = "") -> str:
    return "no formula" if value is None else f"{value:.4g} {unit}".rstrip()


def _show_check(case: Case, numbers: Derived) -> None:
    from mesokit.derived import duration_text, size_text

    click.echo(case.to_toml())
    transport = numbers.transport
    rows = [("particles", f"{numbers.particles:,}".replace(",", " "), "")]
    if transport is not None:
        rows += [
            ("mean free path", _number(transport.mean_free_path, "a"), ""),
            ("kinematic viscosity", _number(transport.viscosity, "a^2/time"),
             f"kinetic {transport.viscosity_kinetic:.4g}, "
             f"collisional {transport.viscosity_collisional:.4g}"),
            ("self-diffusion", _number(transport.diffusion, "a^2/time"), ""),
            ("Schmidt number", _number(transport.schmidt), ""),
            ("speed of sound", _number(transport.sound_speed, "a/time"), ""),
        ]  # fmt: skip
    if numbers.flow_speed:
        rows += [
            ("flow speed", _number(numbers.flow_speed, "a/time"), numbers.flow),
            ("Reynolds number", _number(numbers.reynolds), ""),
            ("Mach number", _number(numbers.mach), ""),
        ]
        if numbers.steady_time is not None:
            steps = round(numbers.steady_time / case.fluid.timestep)
            rows.append(("time to build up", _number(numbers.steady_time), f"{steps} steps to 1/e"))
    rows.append(("run time", duration_text(numbers.seconds), f"estimate: {numbers.assumed}"))
    rows.append(("memory", size_text(numbers.memory), "estimate"))
    if numbers.trajectory:
        rows.append(("trajectory", size_text(numbers.trajectory), "estimate"))
    _rows(rows)
    for warning in numbers.warnings:
        click.echo(f"warning: {warning}")


def _show_results(output: Path) -> None:
    import mesokit

    done = mesokit.open(output)
    for result in done.results.values():
        for comparison in result.comparisons:
            click.echo(f"{result.name}: {comparison}")
    for picture in sorted(output.glob("*.png")):
        click.echo(f"picture: {picture}")


def _show_theory(given: dict[str, Any]) -> None:
    from mesokit.theory import origins, transport

    given["dimension"] = int(given["dimension"])
    needs_angle = given["rule"].startswith("srd") and given["angle_distribution"] == "fixed"
    if given["angle"] is None and needs_angle:
        given["angle"] = 130.0
    try:
        found = transport(**given)
    except ValueError as error:
        raise CaseError(f"--{error}") from None
    rows: list[tuple[str, str, str]] = []
    known = origins(*(given[k] for k in ("rule", "dimension", "angle_distribution", "thermostat")))
    for name, field, unit in (
        ("mean free path", "mean_free_path", "a"),
        ("kinematic viscosity", "viscosity", "a^2/time"),
        ("  kinetic", "viscosity_kinetic", "a^2/time"),
        ("  collisional", "viscosity_collisional", "a^2/time"),
        ("dynamic viscosity", "dynamic_viscosity", "m/(a^(d-2) time)"),
        ("self-diffusion", "diffusion", "a^2/time"),
        ("Schmidt number", "schmidt", ""),
        ("thermal diffusivity", "thermal_diffusivity", "a^2/time"),
        ("speed of sound", "sound_speed", "a/time"),
        ("sound attenuation", "sound_attenuation", "a^2/time"),
    ):
        rows.append((name, _number(getattr(found, field), unit), known[field].source))
        rows.append(("", "", f"holds: {known[field].holds}"))
    _rows(rows)


# --- the end of every command -------------------------------------------------------------------


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line: one line on standard error and a status for whatever goes wrong.

    Exit status: 0 done, 1 the run failed, 2 the case or the command is wrong, 130 interrupted.
    """
    try:
        status = cli.main(arguments, prog_name="mesokit", standalone_mode=False)
        _leave(status if isinstance(status, int) else 0)
    except (click.exceptions.Abort, KeyboardInterrupt):
        click.echo("mesokit: interrupted", err=True)
        _leave(130)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message())
        _leave(2)
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "mesokit"
        _fail(f"{error.format_message()} (try {command} --help)", 2)
    except click.ClickException as error:
        _fail(error.format_message(), 2)
    except RunError as error:
        _fail(str(error), 1)
    except MesokitError as error:
        _fail(str(error), 2)
    except BrokenPipeError:  # the reader of our output has left, such as `| head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        _leave(0)
    except OSError as error:
        _fail(_reason(error), 2)
    except MemoryError:
        _fail("not enough memory for this case (mesokit check tells what it needs)", 1)


def _reason(error: OSError) -> str:
    words = {errno.ENOSPC: "no space left on the disk", errno.EDQUOT: "disk quota exceeded"}
    reason = words.get(error.errno or 0) or error.strerror or str(error)
    name = f"{error.filename}: " if error.filename else ""
    return f"{name}{reason[0].lower()}{reason[1:]}" if reason else repr(error)


def _fail(message: str, status: int) -> None:
    click.echo(f"mesokit: error: {' '.join(message.split())}", err=True)
    _leave(status)


def _leave(status: int) -> None:
    raise SystemExit(status)
