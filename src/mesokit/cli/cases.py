"""Commands that look at a case without running it: new, check, theory."""

from __future__ import annotations

import importlib.resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mesokit.cli import TEMPLATES
from mesokit.cli.commands import CASE, SET, THREADS, cli, naming, read
from mesokit.cli.words import number, show_table
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.derived import Derived


@cli.command()
@click.argument("name")
@click.option("--template", type=click.Choice(TEMPLATES), help="What to start from.")
def new(name: str, template: str | None) -> None:
    """Write a commented case NAME.toml: poiseuille, obstacle, couette, shear, kolmogorov or bulk.

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


@cli.command()
@click.argument("case", type=CASE)
@SET
@THREADS
def check(case: Path, settings: dict[str, str], threads: int | None) -> None:
    """Check CASE, show it with all defaults, what follows from it, and what to mind."""
    from mesokit.derived import derive
    from mesokit.first_state import first_state

    full = read(case, settings)
    with naming(case):
        first_state(full)
    _show_check(full, derive(full, threads))


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


def _show_check(case: Case, numbers: Derived) -> None:
    from mesokit.amounts import duration_text, size_text

    click.echo(case.to_toml())
    transport = numbers.transport
    rows = [("particles", f"{numbers.particles:,}".replace(",", " "), "")]
    if case.solutes is not None:
        rows.append(("beads of solutes", f"{case.solutes.beads:,}".replace(",", " "), ""))
    molecule = case.fluid.molecule
    if molecule is not None:
        number_of = f"{numbers.particles // molecule.length:,}".replace(",", " ")
        rows.append(("molecules", number_of, f"{molecule.topology}s of {molecule.length}"))
    if numbers.substeps is not None:
        how = molecule.propagation if molecule is not None else "verlet"
        rows.append(("sub-steps", str(numbers.substeps), how))
    if transport is not None:
        rows += [
            ("mean free path", number(transport.mean_free_path, "a"), ""),
            ("kinematic viscosity", number(transport.viscosity, "a^2/time"),
             f"kinetic {transport.viscosity_kinetic:.4g}, "
             f"collisional {transport.viscosity_collisional:.4g}"),
            ("self-diffusion", number(transport.diffusion, "a^2/time"), ""),
            ("Schmidt number", number(transport.schmidt), ""),
            ("speed of sound", number(transport.sound_speed, "a/time"), ""),
        ]  # fmt: skip
    if numbers.flow_speed:
        rows += [
            ("flow speed", number(numbers.flow_speed, "a/time"), numbers.flow),
            ("Reynolds number", number(numbers.reynolds), ""),
            ("Mach number", number(numbers.mach), ""),
        ]
        if numbers.steady_time is not None:
            steps = round(numbers.steady_time / case.fluid.timestep)
            rows.append(("time to build up", number(numbers.steady_time), f"{steps} steps to 1/e"))
    rows.append(("run time", duration_text(numbers.seconds), f"estimate: {numbers.assumed}"))
    rows.append(("memory", size_text(numbers.memory), "estimate"))
    if numbers.trajectory:
        rows.append(("trajectory", size_text(numbers.trajectory), "estimate"))
    show_table(rows)
    if case.units is not None:
        from mesokit.si import convert

        click.echo(convert(case))
    for warning in numbers.warnings:
        click.echo(f"warning: {warning}")


def _show_theory(given: dict[str, Any]) -> None:
    from mesokit.component import build
    from mesokit.mpcd.fluid import Fluid
    from mesokit.theory import origins, transport

    try:
        build(Fluid, {key: given[key] for key in ("density", "timestep", "kT", "mass")})
    except CaseError as error:
        raise CaseError(f"--{error}") from None
    given["dimension"] = int(given["dimension"])
    needs_angle = given["rule"].startswith("srd") and given["angle_distribution"] == "fixed"
    if given["angle"] is None and needs_angle:
        given["angle"] = 130.0
    try:
        found = transport(**given)
    except ValueError as error:
        raise CaseError(f"--{error}".replace("_", "-")) from None
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
        rows.append((name, number(getattr(found, field), unit), known[field].source))
        rows.append(("", "", f"holds: {known[field].holds}"))
    show_table(rows)
