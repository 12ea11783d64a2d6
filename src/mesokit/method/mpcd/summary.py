"""What `mesokit check` says of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.amounts import duration_text, number, size_text
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.numbers import Derived
from mesokit.method.protocol import Row, Summary

if TYPE_CHECKING:
    from mesokit.case.case import Case


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers of a case as a table, and what to mind."""
    numbers = derive(case, threads)
    rows = [
        *_particle_rows(case, numbers),
        *_fluid_rows(numbers),
        *_flow_rows(case, numbers),
        ("run time", duration_text(numbers.seconds), f"estimate: {numbers.assumed}"),
        ("memory", size_text(numbers.memory), "estimate"),
    ]
    if numbers.trajectory:
        rows.append(("trajectory", size_text(numbers.trajectory), "estimate"))
    return Summary(tuple(rows), numbers.warnings, numbers.seconds)


def _particle_rows(case: Case, numbers: Derived) -> list[Row]:
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
    return rows


def _fluid_rows(numbers: Derived) -> list[Row]:
    transport = numbers.transport
    if transport is None:
        return []
    parts = (
        f"kinetic {transport.viscosity_kinetic:.4g}, "
        f"collisional {transport.viscosity_collisional:.4g}"
    )
    return [
        ("mean free path", number(transport.mean_free_path, "a"), ""),
        ("kinematic viscosity", number(transport.viscosity, "a^2/time"), parts),
        ("self-diffusion", number(transport.diffusion, "a^2/time"), ""),
        ("Schmidt number", number(transport.schmidt), ""),
        ("speed of sound", number(transport.sound_speed, "a/time"), ""),
    ]


def _flow_rows(case: Case, numbers: Derived) -> list[Row]:
    if not numbers.flow_speed:
        return []
    rows = [
        ("flow speed", number(numbers.flow_speed, "a/time"), numbers.flow),
        ("Reynolds number", number(numbers.reynolds), ""),
        ("Mach number", number(numbers.mach), ""),
    ]
    if numbers.steady_time is not None:
        steps = round(numbers.steady_time / case.fluid.timestep)
        rows.append(("time to build up", number(numbers.steady_time), f"{steps} steps to 1/e"))
    return rows
