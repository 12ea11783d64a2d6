"""The command theory: transport coefficients of an MPCD fluid, without a case."""

from __future__ import annotations

import math
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
@click.option("--length", type=click.IntRange(2), help="Beads of a chain, for a fluid of chains.")
@click.option("--K", "K", type=float, help="Springs between beads: U = K r^2.")
def theory(**given: Any) -> None:
    """Transport coefficients of a fluid, without running it."""
    _show_theory(given)


def _show_theory(given: dict[str, Any]) -> None:
    from mesokit.case.component import build
    from mesokit.method.mpcd.fluid import Fluid
    from mesokit.theory import origins, transport
    from mesokit.theory.transport import takes_angle

    length, stiffness = given.pop("length"), given.pop("K")
    if (length is None) != (stiffness is None):
        alone, missing = ("--length", "--K") if stiffness is None else ("--K", "--length")
        raise CaseError(f"{alone}: only with {missing}; give both for a fluid of chains")
    if stiffness is not None and not 0 < stiffness < math.inf:
        raise CaseError(f"--K = {stiffness:g}: expected a finite number above 0")
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
    if length is not None:
        rows += _chain_rows(found, given, length, stiffness)
    show_table([("thermostat", given["thermostat"], _thermostat_word(given, found)), *rows])


def _thermostat_word(given: dict[str, Any], found: Any) -> str:
    """What the usual thermostat would make of the viscosity, where none was given."""
    from mesokit.theory import transport
    from mesokit.theory.transport import takes_angle

    if given["thermostat"] != "none" or not takes_angle(given["rule"]):
        return ""
    try:
        held = transport(**{**given, "thermostat": "maxwell-boltzmann"})
    except ValueError:
        return ""
    percent = 100 * (held.viscosity / found.viscosity - 1)
    return (
        f"--thermostat maxwell-boltzmann, which most cases have: viscosity {percent:+.2g} %"
        if abs(percent) >= 0.05
        else ""
    )


def _chain_rows(
    found: Any, given: dict[str, Any], length: int, stiffness: float
) -> list[tuple[str, str, str]]:
    """What Rouse makes of the fluid where its particles are beads of chains."""
    from mesokit.theory import linear_modes, mean_square_bond, rouse_times

    kT, density = given["kT"], given["density"]
    times = rouse_times(linear_modes(length), kT / found.diffusion, K=stiffness)
    bonds = density / length * kT * float(times.stress.sum())
    eta = found.dynamic_viscosity + bonds
    mass_density = density * given["mass"]
    square = mean_square_bond(K=stiffness, dimension=given["dimension"], kT=kT)
    note = "Rouse: beads with the friction of free particles; approximate"
    return [
        (f"chains of {length}", "", "the numbers above are those of the same fluid without bonds"),
        ("mean square bond", number(square, "a^2"), "Boltzmann"),
        ("slowest mode time", number(float(times.mode[0]), "time"), note),
        ("slowest stress time", number(float(times.stress[0]), "time"), "half of it"),
        ("viscosity of bonds", number(bonds / mass_density, "a^2/time"), "slow flow"),
        ("kinematic viscosity", number(eta / mass_density, "a^2/time"), "with the bonds"),
    ]
