"""What `check` and `run` warn of: cases that can run, and may not give what was meant."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mesokit.amounts import size_text
from mesokit.box import AXES
from mesokit.geometry.from_file import FromFile
from mesokit.mpcd.molecule import COARSE
from mesokit.observe import setting
from mesokit.solids import solids_of

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.derived import Derived


def cautions(case: Case, numbers: Derived, across: int) -> Iterator[str]:
    """What one should know before a run; `across` is the number of the axis across the flow."""
    yield from _method_warnings(case, numbers)
    yield from _solid_warnings(case)
    yield from _flow_warnings(case, numbers, across)
    yield from _run_warnings(case, numbers)


def _method_warnings(case: Case, numbers: Derived) -> Iterator[str]:
    fluid, transport = case.fluid, numbers.transport
    path = fluid.timestep * math.sqrt(fluid.kT / fluid.mass)
    angle = getattr(fluid.collision, "angle", 90.0)
    if angle < 7:
        yield (
            f"fluid.collision.angle = {angle:g}: the angle is in degrees; "
            f"{angle:g} rad is {math.degrees(angle):.2f}"
        )
    if fluid.grid_shift < 1 and path < 0.5:
        yield (
            f"fluid.grid_shift = {fluid.grid_shift:g}: with a mean free path of {path:.3g} cells "
            "(below 0.5) only the full shift makes the fluid Galilean invariant"
        )
    if _above(path, 1, 3):
        yield (
            f"fluid.timestep = {fluid.timestep:g}: the mean free path is {path:.3g} cells; above 1 "
            "the fluid is a dilute gas, with slip at walls"
        )
    if fluid.molecule is not None and fluid.molecule.propagation == "verlet":
        phase = fluid.molecule.phase(case.box.dimension, fluid.timestep, fluid.kT, fluid.mass)
        if fluid.molecule.substeps is not None and phase > COARSE:
            yield (
                f"fluid.molecule.substeps = {fluid.molecule.substeps}: the stiffest spring turns "
                f"by {phase:.2g} rad in each (above {COARSE:g}): its swings read up to "
                f"{25 * phase**2:.2g} % too large"
            )
    if case.solutes is not None and case.solutes.substeps is not None:
        given = case.solutes
        frequency = given.frequency(case.box.dimension, fluid.kT)
        phase = frequency * fluid.timestep / case.solutes.substeps
        if phase > COARSE:
            yield (
                f"solutes.substeps = {given.substeps}: the stiffest potential turns by {phase:.2g} "
                f"rad in each (above {COARSE:g}): its swings read up to {25 * phase**2:.2g} % too "
                "large"
            )
    if fluid.density < 3:
        yield (
            f"fluid.density = {fluid.density:g}: below 3 many cells hold no pair that could "
            "collide, and the formulas for the viscosity fail"
        )
    note = setting.temperature_note(case)
    if note:
        yield (
            f"fluid.thermostat.rule = {fluid.thermostat.rule!r}, fluid.collision.rule = "
            f"{fluid.collision.rule!r}: {note.removeprefix('approximate: ')} at this density"
        )
    if transport is None:
        reason = setting.caveat(case) or "no formula for this fluid"
        yield f"transport coefficients: {reason}; plots will lack theory"
    elif case.box.dimension == 2 and _above(7, transport.dynamic_viscosity, 3):
        yield (
            f"in 2D fluctuations raise a dynamic viscosity of {transport.dynamic_viscosity:.3g} "
            "(below 7) by several percent over theory, more in a larger box"
        )


def _solid_warnings(case: Case) -> Iterator[str]:
    if not setting.obstructed(case):
        return
    solids = solids_of(case)
    for i, wall in enumerate(case.walls):
        if isinstance(wall, FromFile):
            for note in wall.notes(solids.room, solids.samples(i)):
                yield f"wall[#{i + 1}].{note}"
    thin, narrow = solids.tight_places()
    if thin is not None:
        place, size = thin
        yield (
            f"wall: the solid at {_place(place)} is about {size:.2g} cells thick; below 1.5 fluid "
            "on its two sides collides"
        )
    if narrow is not None:
        place, size = narrow
        yield (
            f"wall: the gap at {_place(place)} is about {size:.2g} cells wide; below 3 the flow in "
            "it is not resolved"
        )


def _place(coordinates: Sequence[float]) -> str:
    return "(" + ", ".join(f"{x:.1f}" for x in coordinates) + ")"


def _flow_warnings(case: Case, numbers: Derived, across: int) -> Iterator[str]:
    fluid, force = case.fluid, case.fluid.force
    sheared = case.box.shear_rate != 0
    if numbers.mach is not None and _above(numbers.mach, 0.2) and not sheared:
        yield (
            f"Mach number {numbers.mach:.2g}: above 0.2 the fluid is compressible; "
            "lower the force or the velocity of the surfaces"
        )
    elif numbers.mach is None and numbers.transport:
        mach = setting.surface_speed(case) / numbers.transport.sound_speed
        if _above(mach, 0.2):
            yield (
                f"wall: surfaces move at Mach number {mach:.2g}: above 0.2 the fluid is "
                "compressible; lower their velocity or rotation"
            )
    if sheared and numbers.transport:
        cell = abs(case.box.shear_rate) / numbers.transport.sound_speed
        if _above(cell, 0.2):
            yield (
                f"box.shear_rate = {case.box.shear_rate:g}: velocities differ by {cell:.2g} of the "
                "speed of sound across a cell; keep it below 0.2"
            )
    random = case.solutes is not None and case.solutes.solvent == "random"
    if force.rule == "uniform":
        for axis, push in zip(AXES, force.acceleration, strict=False):
            if push and not case.walls and not random:
                yield (
                    f"fluid.force.acceleration: nothing holds the fluid along {axis}: without "
                    "walls it speeds up for ever (without a thermostat it also heats)"
                    if not setting.isothermal(case)
                    else f"fluid.force.acceleration: nothing holds the fluid along {axis}: without "
                    "walls it speeds up for ever"
                )
            elif push and AXES.index(axis) in setting.closed_axes(case):
                drop = fluid.mass * abs(push) * case.box.size[across] / fluid.kT
                if drop > 0.1:
                    yield (
                        f"fluid.force.acceleration along {axis} presses the fluid on a plate: its "
                        f"density falls by a factor {math.exp(min(drop, 99)):.3g} across the slit"
                    )
    if numbers.flow == "plug" and numbers.flow_speed is None:
        yield "fluid.force.acceleration: slip plates hold nothing: the fluid speeds up for ever"
    if numbers.heating is not None and numbers.heating > 0.01:
        yield (
            f"no thermostat: friction raises the temperature by {100 * numbers.heating:.2g} % "
            "over the run"
        )
    if force.rule == "sinusoidal" and numbers.reynolds is not None:
        flow_size = case.box.size[AXES.index(force.flow)]
        if _above(numbers.reynolds, 1.4) and flow_size > case.box.size[across] / force.waves:
            yield (
                f"Kolmogorov flow at Reynolds number {numbers.reynolds:.2g} (above 1.4) breaks up "
                "in a box that is longer along the flow than one wave; make it square"
            )
    if numbers.steady_time is not None and numbers.flow_speed:
        wait = math.ceil(3 * numbers.steady_time / fluid.timestep)
        if case.run.warmup < wait and case.run.steps and fluid.start.run is None:
            yield (
                f"run.warmup = {case.run.warmup}: the flow needs about {wait} steps from rest to "
                "its steady state; observables will average over the start"
            )


def _run_warnings(case: Case, numbers: Derived) -> Iterator[str]:
    run = case.run
    flowing = setting.flowing_axes(case)
    if not case.observe and case.trajectory is None:
        yield "no [[observe]] and no [trajectory]: the run will leave nothing but its last state"
    for i, observable in enumerate(case.observe):
        if observable.every > run.steps:
            yield (
                f"observe[#{i + 1}].every = {observable.every}: more than run.steps = {run.steps}; "
                f"{observable.label} takes no sample"
            )
        elif observable.quantity == "flow-frames" and observable.window > run.steps:
            yield (
                f"observe[#{i + 1}].window = {observable.window}: more than run.steps = "
                f"{run.steps}; there will be one frame, of a window cut short"
            )
        seen = getattr(observable, "component", None)
        if seen is not None and flowing and seen not in flowing:
            yield (
                f"observe[#{i + 1}].component = {seen!r}: nothing flows along {seen}; "
                f"the flow is along {' and '.join(flowing)}"
            )
    if case.trajectory is not None:
        if case.trajectory.every > run.steps:
            yield f"trajectory.every = {case.trajectory.every}: more than run.steps = {run.steps}"
        free = shutil.disk_usage(Path.cwd()).free
        if numbers.trajectory > min(20e9, 0.8 * free):
            yield (
                f"the trajectory takes about {size_text(numbers.trajectory)} "
                f"({size_text(free)} are free here); raise trajectory.every or set "
                "trajectory.subset"
            )
    memory = _machine_memory()
    if memory and numbers.memory > 0.9 * memory:
        yield (
            f"the run needs {size_text(numbers.memory)} of memory, "
            f"this machine has {size_text(memory)}"
        )


def _above(value: float, limit: float, digits: int = 2) -> bool:
    """Whether a value is above a limit even as it is shown, to so many digits."""
    return float(f"{value:.{digits}g}") > float(f"{limit:.{digits}g}")


def _machine_memory() -> int | None:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None
