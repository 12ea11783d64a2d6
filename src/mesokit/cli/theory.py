"""The command theory: transport coefficients of an MPCD fluid, and the numbers of chains in it."""

from __future__ import annotations

import contextlib
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mesokit.case.amounts import number
from mesokit.cli.commands import CASE, SET, Finite, cli, naming, options, read
from mesokit.cli.words import show_table
from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.mpcd.collision import Gas
    from mesokit.theory import Transport

Row = tuple[str, str, str]
KEYS = {  # options, and the keys of a case that they give
    "rule": "fluid.collision.rule", "density": "fluid.density", "timestep": "fluid.timestep",
    "angle": "fluid.collision.angle", "angle_distribution": "fluid.collision.angle_distribution",
    "thermostat": "fluid.thermostat.rule", "kT": "fluid.kT", "mass": "fluid.mass",
}  # fmt: skip
OPTIONS = {key: f"--{name.replace('_', '-')}" for name, key in KEYS.items()}
FIGURES = ("plot", "draw", "wave-length", "until", "bond-length", "radius")  # earlier options
SCRIPT = "examples/draw_chains.py"
LENGTH = click.IntRange(2, 1000)
COEFFICIENTS = (
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
)


def _moved(context: click.Context, option: click.Parameter, given: str | None) -> None:
    if given is not None:
        raise CaseError(f"{option.opts[0]}: unknown option; {SCRIPT} draws the figures of chains")


_options = options(
    *(
        click.option(OPTIONS[key], name, metavar="VALUE", help=f"Value of {key}.")
        for name, key in KEYS.items()
    ),
    *(
        click.option(f"--{name}", hidden=True, expose_value=False, callback=_moved)
        for name in reversed(FIGURES)
    ),
)


def _numbers(name: str, parameter: str, text: str) -> Any:
    """An option with a positive number, which may be repeated."""
    return click.option(
        name, parameter, type=Finite(1e-9, 1e9), metavar="NUMBER", multiple=True, help=text
    )


@cli.command()
@click.argument("path", metavar="[CASE]", type=CASE, required=False)
@click.option("--dimension", type=click.Choice(["2", "3"]), help="Without CASE.  [3]")
@_options
@SET
@click.option("--length", "lengths", type=LENGTH, multiple=True, help="Beads of a chain.")
@_numbers("--K", "springs", "Springs between beads: U = K r^2.")
@_numbers("--stress-time", "times", "Instead of K: the slowest stress time, by Rouse.")
@_numbers("--frequency", "frequencies", "Storage and loss modulus of chains at it.")
def theory(
    path: Path | None,
    dimension: str | None,
    settings: dict[str, str],
    lengths: Sequence[int],
    springs: Sequence[float],
    times: Sequence[float],
    frequencies: Sequence[float],
    **given: str | None,
) -> None:
    """Transport coefficients of the fluid of CASE, or of the one that options describe.

    Options have the meanings and defaults of a case: mesokit explain fluid. A fluid of chains, in
    CASE or by --length, also has relaxation times, moduli and a viscosity of bonds. Options of
    chains may be repeated.
    """
    from mesokit.theory import self_diffusion

    values = {KEYS[name]: value for name, value in given.items() if value is not None}
    case = _case(path, dimension, values | settings)
    with naming(path) if path else contextlib.nullcontext():
        found, gas, rows = _fluid(case)
    stirring = found.diffusion
    if gas.dimension == 3 and found.mean_free_path < 1:
        known = found.diffusion, found.viscosity, gas.density, None, gas.kT, gas.mass
        stirring = self_diffusion(3, *known)
        after = next(i for i, row in enumerate(rows) if row[0] == "Schmidt number")
        word = "with hydrodynamic backflow, in a large box"
        rows.insert(after, ("  in a fluid", number(stirring, "a^2/tau"), word))
    friction = gas.kT / stirring
    chains = _chains(case, friction, lengths, springs, times)
    if frequencies and not chains:
        raise CaseError("--frequency: only with --length, or a CASE with chains")
    for length, K in chains:
        rows += _chain_rows(length, K, found, gas, friction, frequencies)
    show_table(rows)


def _case(path: Path | None, dimension: str | None, settings: dict[str, str]) -> Case:
    """The case in a file, or one of the fluid that the options describe."""
    from mesokit.case import toml
    from mesokit.case.case import Case
    from mesokit.case.component import name_of
    from mesokit.method.mpcd.fluid import Fluid

    if path is not None:
        if dimension is not None:
            raise CaseError("--dimension: only without CASE, whose box has a dimension")
        case = read(path, settings)
        if not isinstance(getattr(case, "fluid", None), Fluid):
            raise CaseError(f"{path}: run.method = {case.run.method!r}: expected a fluid of MPCD")
        return case
    size = [10] * int(dimension or 3)  # on which no coefficient depends
    rule = {"rule": name_of(Fluid().collision)}
    data = {"run": {"steps": 0}, "box": {"size": size}, "fluid": {"collision": rule}}
    try:
        for key, value in settings.items():
            toml.override(data, key, value)
        return Case.from_data(data, Path())
    except CaseError as error:  # which begins with the key
        text = re.sub(r"^[\w.]+", lambda key: OPTIONS.get(key[0], key[0]), str(error))
        raise CaseError(text) from None


def _fluid(case: Case) -> tuple[Transport, Gas, list[Row]]:
    """Coefficients of a fluid by its own collision rule, and rows of them with their sources."""
    from mesokit.case.component import name_of
    from mesokit.method.mpcd.expected import setting
    from mesokit.method.mpcd.thermostat import RULES
    from mesokit.theory import origins

    rule, gas, caveat = case.fluid.collision, setting.gas(case), setting.caveat(case)
    name, thermostat = name_of(rule), name_of(case.fluid.thermostat)
    try:
        found = None if case.fluid.mixed else rule.transport(gas)
    except ValueError as error:
        raise CaseError(f"fluid.collision.rule = {name!r}: {error}") from None
    if found is None:
        why = caveat or f"no theory of this rule with fluid.thermostat.rule = {thermostat!r}"
        raise CaseError(f"fluid.collision.rule = {name!r}: no coefficients: {why}")
    known, sources, others = rule.in_theory(), {}, []
    if known is not None:
        angles = "uniform" if known.get("angle") == "uniform" else "fixed"
        sources = origins(known["rule"], gas.dimension, angles, str(gas.thermostat))
        same = {None, gas.thermostat}
        others = [] if rule.isothermal else [one for one in RULES if one.in_theory not in same]
    held = [(one, rule.transport(gas._replace(thermostat=one.in_theory))) for one in others]
    rises = [f"{one.rule} {100 * (c.viscosity / found.viscosity - 1):+.2g} %" for one, c in held]
    word = "viscosity with others: " + ", ".join(rises) if rises else ""
    values = f"density {gas.density:g}, timestep {gas.timestep:g}, kT {gas.kT:g}, mass {gas.mass:g}"
    rows = [
        ("collision rule", name, f"{gas.dimension}D, {values}"),
        ("thermostat", thermostat, word),
    ]
    if caveat:
        rows.append(("", "", f"{caveat}; numbers of single particles, at full grid shift"))
    for title, field, unit in COEFFICIENTS:
        source, holds = sources.get(field, ("of this collision rule", ""))
        rows.append((title, number(getattr(found, field), unit), source))
        rows += [("", "", f"holds: {holds}")] if holds else []
    return found, gas, rows


def _chains(
    case: Case,
    friction: float,
    lengths: Sequence[int],
    springs: Sequence[float],
    times: Sequence[float],
) -> list[tuple[int, float]]:
    """Length and K of the chains that the options describe, or else of those of the case."""
    from mesokit.method.mpcd.expected.molecules import spring_of
    from mesokit.theory import linear_modes, rouse_times

    if bool(springs) + bool(times) != bool(lengths):
        raise CaseError(
            "--length, --K, --stress-time: expected a length, and with it one of the others"
        )
    if lengths:
        slowest = [float(rouse_times(linear_modes(n), friction, K=1.0).stress[0]) for n in lengths]
        pairs = zip(lengths, slowest, strict=True)
        return [(n, K) for n, own in pairs for K in springs or [own / time for time in times]]
    molecule = case.fluid.molecule
    spring = spring_of(molecule) if molecule and molecule.topology == "chain" else None
    return [(molecule.length, spring.K)] if spring else []


def _chain_rows(
    length: int, K: float, found: Transport, gas: Gas, friction: float, frequencies: Sequence[float]
) -> list[Row]:
    """Times, moduli and viscosity of a fluid that is all chains of a kind."""
    from mesokit import theory

    eta, force = found.dynamic_viscosity, "m/tau^2" if gas.dimension == 2 else "m/(a tau^2)"
    times = theory.rouse_times(theory.linear_modes(length), friction, K=K)
    square = theory.mean_square_bond(K=K, dimension=gas.dimension, kT=gas.kT)
    modulus = gas.density / length * gas.kT
    bonds = modulus * float(times.stress.sum()) / (gas.density * gas.mass)
    above = "the numbers above are those of the same fluid without bonds"
    rouse = "approximate: Rouse, beads with the friction of single particles"
    rows = [
        (f"chains of {length}", f"K = {K:.4g} kT/a^2", above),
        ("mean square bond", number(square, "a^2"), "Boltzmann"),
        ("end to end, squared", number((length - 1) * square, "a^2"), "ideal chain"),
        ("slowest mode time", number(float(times.mode[0]), "tau"), rouse),
        ("slowest stress time", number(float(times.stress[0]), "tau"), "half of Rouse's"),
        ("modulus", number(modulus, force), "kT for each molecule in a volume"),
        ("viscosity of bonds", number(bonds, "a^2/tau"), "slow flow"),
        ("kinematic viscosity", number(found.viscosity + bonds, "a^2/tau"), "with the bonds"),
    ]
    with contextlib.suppress(ValueError):  # bonds shorter than beads are large
        if gas.dimension == 3:
            zimm = theory.zimm_times(length, friction, eta, math.sqrt(square), gas.kT)
            note = "approximate: Zimm, one chain in a simple fluid"
            rows.insert(4, ("with hydrodynamics", number(float(zimm.mode[0]), "tau"), note))
    for w in frequencies:
        at = f"at the frequency {w:g}/tau"
        stored = theory.storage_modulus(w, modulus, times.stress)
        lost = theory.loss_modulus(w, modulus, times.stress, eta)
        rows.append(("storage modulus", number(float(stored), force), at))
        rows.append(("loss modulus", number(float(lost), force), at))
    return rows
