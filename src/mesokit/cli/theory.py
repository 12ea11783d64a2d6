"""The command theory: transport coefficients of an MPCD fluid, without a case."""

from __future__ import annotations

from typing import Any

import click

from mesokit.case.amounts import number
from mesokit.cli.commands import cli
from mesokit.cli.words import show_table
from mesokit.errors import CaseError


@cli.command()
@click.option("--rule", default="srd", type=click.Choice(["srd", "at", "srd+a", "at+a"]))
@click.option("--dimension", default="3", type=click.Choice(["2", "3"]))
@click.option("--density", default=10.0, help="Particles per cell.  [10]")
@click.option("--timestep", default=0.1, help="Time between two collisions.  [0.1]")
@click.option("--angle", type=float, help="Rotation angle in degrees, SRD only.  [130]")
@click.option("--angle-distribution", default="fixed", type=click.Choice(["fixed", "uniform"]))
@click.option(
    "--thermostat",
    default="none",
    help="none, maxwell-boltzmann or rescale.",
    type=click.Choice(["none", "maxwell-boltzmann", "rescale"]),
)
@click.option("--kT", "kT", default=1.0, help="Thermal energy.  [1]")
@click.option("--mass", default=1.0, help="Mass of a particle.  [1]")
def theory(**given: Any) -> None:
    """Transport coefficients of a fluid, without running it."""
    _show_theory(given)


def _show_theory(given: dict[str, Any]) -> None:
    from mesokit.case.component import build
    from mesokit.method.mpcd.fluid import Fluid
    from mesokit.theory import origins, transport
    from mesokit.theory.transport import takes_angle

    try:
        build(Fluid, {key: given[key] for key in ("density", "timestep", "kT", "mass")})
    except CaseError as error:
        raise CaseError(f"--{error}") from None
    given["dimension"] = int(given["dimension"])
    uniform = given.pop("angle_distribution") == "uniform"
    if uniform and given["angle"] is not None:
        raise CaseError(f"--angle = {given['angle']:g}: no effect on angles that are uniform")
    if given["angle"] is None and takes_angle(given["rule"]):
        given["angle"] = "uniform" if uniform else 130.0
    try:
        found = transport(**given)
    except ValueError as error:
        text = str(error).replace("angle = 'uniform'", "angle_distribution = 'uniform'")
        raise CaseError(f"--{text}".replace("_", "-")) from None
    rows: list[tuple[str, str, str]] = []
    distribution = "uniform" if uniform else "fixed"
    known = origins(given["rule"], given["dimension"], distribution, given["thermostat"])
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
