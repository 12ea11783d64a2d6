"""The command theory: transport coefficients of an MPCD fluid, without a case."""

from __future__ import annotations

from typing import Any

import click

from mesokit.case.amounts import number
from mesokit.cli.commands import cli
from mesokit.cli.words import show_table
from mesokit.errors import CaseError

KINDS = ("velocity-modes", "bonds", "springs")
SHEARED = KINDS[1:]
FIGURE = {  # options of figures, and of which
    "plot": KINDS, "draw": KINDS, "wave_length": KINDS[:1], "until": KINDS[:1],
    "bond_length": KINDS[2:], "radii": SHEARED,
}  # fmt: skip
MOST_BEADS = 1000
FILE = click.Path(dir_okay=False)


@cli.command()
@click.option("--rule", default="srd", type=click.Choice(["srd", "at", "srd+a", "at+a", "none"]))
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
@click.option(
    "--length",
    "lengths",
    type=click.IntRange(2, MOST_BEADS),
    multiple=True,
    help="Beads of a chain, for a fluid of chains; again and again for several.",
)
@click.option("--K", "K", type=float, multiple=True, help="Springs between beads: U = K r^2.")
@click.option(
    "--stress-time",
    "stress_times",
    type=float,
    multiple=True,
    help="Instead of K: the slowest stress time that it shall make, by Rouse.",
)
@click.option(
    "--frequency",
    "frequencies",
    type=click.FloatRange(min=0, min_open=True),
    multiple=True,
    help="Storage and loss modulus of chains at it.",
)
@click.option("--plot", type=FILE, help="Draw a figure of chains into this file: PNG, PDF or SVG.")
@click.option("--draw", type=click.Choice(KINDS), help=f"What is drawn.  [{KINDS[0]}]")
@click.option(
    "--wave-length",
    type=click.FloatRange(2),
    help="Of velocity modes, in cells.  [30]",
)
@click.option(
    "--until",
    type=click.FloatRange(min=0, min_open=True),
    help="Latest time of velocity modes.  [100]",
)
@click.option(
    "--bond-length", type=click.FloatRange(min=0, min_open=True), help="That springs shall hold."
)
@click.option(
    "--radius",
    "radii",
    type=click.FloatRange(min=0, min_open=True),
    multiple=True,
    help="Hydrodynamic radius of a bead in figures.  [that of a particle]",
)
def theory(**given: Any) -> None:
    """Transport coefficients of a fluid, without running it; relaxation times, moduli and
    viscosity of one of chains, and figures of these."""
    figure = {key: given.pop(key) for key in FIGURE}
    _show_theory(given, figure)


def _show_theory(given: dict[str, Any], figure: dict[str, Any]) -> None:
    from mesokit.case.component import build
    from mesokit.cli.chains import beads_of, chains_of, rows_of
    from mesokit.method.mpcd.fluid import Fluid
    from mesokit.theory import origins, transport
    from mesokit.theory.transport import takes_angle

    lengths, springs = given.pop("lengths"), (given.pop("K"), given.pop("stress_times"))
    frequencies = given.pop("frequencies")
    if frequencies and not lengths:
        raise CaseError("--frequency: only with --length; give both for a fluid of chains")
    _require_plot(figure)
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
        ("kinematic viscosity", "viscosity", "a^2/tau"),
        ("  kinetic", "viscosity_kinetic", "a^2/tau"),
        ("  collisional", "viscosity_collisional", "a^2/tau"),
        ("dynamic viscosity", "dynamic_viscosity", "m/(a^(d-2) time)"),
        ("self-diffusion", "diffusion", "a^2/tau"),
        ("Schmidt number", "schmidt", ""),
        ("thermal diffusivity", "thermal_diffusivity", "a^2/tau"),
        ("speed of sound", "sound_speed", "a/tau"),
        ("sound attenuation", "sound_attenuation", "a^2/tau"),
    ):
        rows.append((name, number(getattr(found, field), unit), known[field].source))
        rows.append(("", "", f"holds: {known[field].holds}"))
    beads, chains = beads_of(found, given), []
    if any(springs) or (lengths and figure["draw"] != "springs"):
        chains = chains_of(beads, lengths, *springs)
    if given["dimension"] == 3 and found.mean_free_path < 1:
        stirred = number(beads.stirring, "a^2/tau")
        after = next(i for i, row in enumerate(rows) if row[0] == "Schmidt number")
        word = "with hydrodynamic backflow, in a large box"
        rows.insert(after, ("  in a fluid", stirred, word))
    for chain in chains:
        rows += rows_of(chain, beads, frequencies)
    if figure["plot"] is not None:
        click.echo(_draw(figure, lengths, chains, beads))
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


def _require_plot(figure: dict[str, Any]) -> None:
    """Raise CaseError for options of figures that are not drawn."""
    drawn = None if figure["plot"] is None else figure["draw"] or KINDS[0]
    for key, kinds in FIGURE.items():
        if key != "plot" and figure[key] and drawn not in kinds:
            name = key.replace("_", "-").replace("radii", "radius")
            where = "with --plot" if drawn is None else f"with --draw {' or '.join(kinds)}"
            raise CaseError(f"--{name}: only {where}")


def _draw(figure: dict[str, Any], lengths: tuple[int, ...], chains: Any, beads: Any) -> Any:
    """Draw it, and say into which file."""
    import matplotlib as mpl

    from mesokit.cli import chain_figures
    from mesokit.report import save_figure
    from mesokit.report.finish.origin import Origin
    from mesokit.report.notebook import ShownFigure
    from mesokit.report.style import HEIGHT, STYLE, WIDTH

    radii = figure["radii"] or (beads.radius,)
    kind = figure["draw"] or KINDS[0]
    if kind != "velocity-modes" and beads.dimension == 2:
        raise CaseError(f"--draw {kind}: expected --dimension 3, as hydrodynamics are those of 3D")
    with mpl.rc_context(STYLE):
        drawn = ShownFigure(figsize=(WIDTH, HEIGHT), layout="constrained")
        ax = drawn.subplots()
        if kind == "velocity-modes":
            wave, end = figure["wave_length"] or 30.0, figure["until"] or 100.0
            chain_figures.velocity_modes(ax, chains, beads, wave, end)
        elif kind == "bonds":
            chain_figures.bond_lengths(ax, chains, beads, radii)
        else:
            chain_figures.spring_constants(ax, lengths, figure["bond_length"], beads, radii)
    fluid = f"density {beads.density:g}, kinematic viscosity {beads.viscosity:.4g} a^2/tau"
    drawn.origin = Origin(f"theory, {fluid}")
    return save_figure(drawn, figure["plot"])
