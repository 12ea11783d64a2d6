"""What follows from a case before it runs: numbers, cost, and warnings."""

from __future__ import annotations

import dataclasses
import math
import os
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mesokit import theory
from mesokit.box import AXES
from mesokit.geometry import Plates
from mesokit.geometry.from_file import FromFile
from mesokit.mpcd.molecule import COARSE
from mesokit.observe import setting
from mesokit.solids import solids_of

if TYPE_CHECKING:
    from mesokit.case import Case

# What one thread does on the machine that the project measures on (docs/benchmark.md): million
# particle-steps per second, by dimension and collision rule.
RATES = {
    (2, "srd"): 210.0, (2, "at"): 80.0, (2, "srd+a"): 120.0, (2, "at+a"): 60.0,
    (3, "srd"): 130.0, (3, "at"): 58.0, (3, "srd+a"): 40.0, (3, "at+a"): 33.0,
}  # fmt: skip
# factors of time, rate
COSTS = {"thermostat": 1.15, "walls": 1.25, "solids": 1.7, "shear": 1.2, "thread": 0.85}
# seconds more for each particle-step of a molecule, and for each of its sub-steps
FLOCK, SUBSTEP = 5e-9, 1e-9
SAMPLE = 12e-9  # seconds for each particle in each sample of an observable
BYTES = {"particle 2D": 68, "particle 3D": 88, "cell 2D": 60, "cell 3D": 110, "program": 250e6}
WIDTHS = {"image": 4, "id": 8}  # bytes of a trajectory field; the others follow the precision
COMPRESSED = 0.9  # thermal noise hardly compresses


@dataclass(frozen=True)
class Derived:
    """What follows from a case. Lengths in cells; None where there is no formula.

    `flow_speed` is the largest velocity that theory expects of the steady flow, `flow_size` the
    size across it, `reynolds` both over the viscosity, `mach` the speed over that of sound;
    `steady_time` is the time in which the flow comes within 1/e of its steady state. `substeps` are
    those of molecules. `seconds` and `memory` (bytes) of the run are estimates, `assumed` says of
    what.
    """

    particles: int
    particle_steps: int
    transport: theory.Transport | None
    flow: str
    flow_speed: float | None
    flow_size: float
    reynolds: float | None
    mach: float | None
    steady_time: float | None
    heating: float | None
    seconds: float
    memory: int
    trajectory: int
    substeps: int | None
    assumed: str
    warnings: tuple[str, ...]


def derive(case: Case, threads: int | None = None) -> Derived:
    """Derived numbers of a case, run on so many threads (all cores unless said).

    >>> from mesokit import Box, Case, Run
    >>> numbers = derive(Case(run=Run(steps=1000), box=Box([30, 30, 30])), threads=1)
    >>> numbers.particles, round(numbers.transport.viscosity, 2)
    (270000, 0.87)
    """
    threads = threads or os.cpu_count() or 1
    fluid, dimension = case.fluid, case.box.dimension
    steps = case.run.warmup + case.run.steps
    transport = setting.transport(case)
    flow, across, speed = _flow(case)
    nu = transport.viscosity if transport else None
    length = _length(case, across)
    builds_up = flow != "lees-edwards"  # that one starts with its linear profile
    rate = RATES[dimension, fluid.collision.rule] * 1e6 * (1 + (threads - 1) * COSTS["thread"])
    for cost, applies in (
        ("thermostat", fluid.thermostat.rule != "none"),
        ("walls", bool(case.walls)),
        ("solids", setting.obstructed(case)),
        ("shear", case.box.shear_rate != 0),
    ):
        rate /= COSTS[cost] if applies else 1
    substeps = None
    if fluid.molecule is not None:
        substeps = fluid.molecule.number_of_substeps(
            dimension, fluid.timestep, fluid.kT, fluid.mass
        )
        rate = 1 / (1 / rate + (FLOCK + SUBSTEP * substeps) / threads)
    memory = case.particles * BYTES[f"particle {dimension}D"]
    memory += case.box.volume * BYTES[f"cell {dimension}D"] * threads
    numbers = Derived(
        particles=case.particles,
        particle_steps=case.particles * steps,
        transport=transport,
        flow=flow,
        flow_speed=speed,
        flow_size=length,
        reynolds=speed * length / nu if speed is not None and nu else None,
        mach=speed / transport.sound_speed if speed is not None and transport else None,
        steady_time=_steady_time(case, across, nu) if nu and speed and builds_up else None,
        heating=_heating(case, across, nu) if nu else None,
        seconds=case.particles * steps / rate + _observe_seconds(case),
        memory=round(memory + BYTES["program"]),
        trajectory=_trajectory_bytes(case),
        substeps=substeps,
        assumed=f"{threads} thread{'s' * (threads > 1)}, {rate / 1e6:.0f} million "
        "particle-steps/s between samples",
        warnings=(),
    )
    return Derived(**{**vars(numbers), "warnings": tuple(_warnings(case, numbers, across))})


def _flow(case: Case) -> tuple[str, int, float | None]:
    """Kind of the steady flow, axis number across it, and its largest speed.

    For a channel with obstacles these are what they would be without: an upper bound.
    """
    if setting.obstructed(case):
        plates = tuple(wall for wall in case.walls if isinstance(wall, Plates))
        if len(plates) == 1 and not plates[0].diffuse:
            bare = dataclasses.replace(case, walls=plates, observe=(), trajectory=None)
            kind, across, speed = _flow(bare)
            if speed is not None and _surface_speed(case) > speed:
                return "of moving surfaces", across, _surface_speed(case)
            return kind if kind == "rest" else f"{kind}, as without obstacles", across, speed
        if _surface_speed(case) and case.fluid.force.rule == "none":
            return "of moving surfaces", 1, _surface_speed(case)
    kinds, across, squares = [], 1, np.zeros(201)
    for i in range(case.box.dimension):
        flow = setting.flow(case, i)
        if flow.profile is None:
            return flow.kind, flow.across, None
        speeds = flow.profile(np.linspace(0, case.box.size[flow.across], len(squares)))
        if np.any(speeds):
            kinds.append(flow.kind)
            across = flow.across
        squares = squares + speeds**2
    return (kinds or ["rest"])[0], across, float(np.sqrt(squares.max()))


def _surface_speed(case: Case) -> float:
    """Of the fastest place on a solid's surface: no place in the fluid that it drags is faster."""
    motion = solids_of(case).motion.values() if setting.obstructed(case) else ()
    return max((speed for speed, _ in motion), default=0.0)


def _length(case: Case, across: int) -> float:
    """Size across the flow: of the box, or 1/k of a Kolmogorov flow."""
    force, size = case.fluid.force, float(case.box.size[across])
    return size / (2 * math.pi * force.waves) if force.rule == "sinusoidal" else size


def _wavenumber(case: Case, across: int) -> float:
    """Of the slowest shear mode."""
    if case.walls:
        return math.pi / case.box.size[across]
    return 1 / _length(case, across) if case.fluid.force.rule == "sinusoidal" else (
        2 * math.pi / case.box.size[across]
    )  # fmt: skip


def _steady_time(case: Case, across: int, viscosity: float) -> float:
    return 1 / (viscosity * _wavenumber(case, across) ** 2)


def _heating(case: Case, across: int, viscosity: float) -> float | None:
    """Relative rise of the temperature by viscous heating over the run; None if held.

    About solids that move, of a flow that falls to zero over the whole box: they heat it no less.
    """
    if setting.isothermal(case):
        return None
    length = float(case.box.size[across])
    y = np.linspace(0, length, 401)
    profiles = [setting.flow(case, i).profile for i in range(case.box.dimension)]
    dissipation = sum(
        viscosity * float(np.mean(np.gradient(u(y), y) ** 2)) for u in profiles if u is not None
    )
    dissipation = max(dissipation, viscosity * (_surface_speed(case) / length) ** 2)
    time = (case.run.warmup + case.run.steps) * case.fluid.timestep
    return 2 / case.box.dimension * case.fluid.mass * dissipation * time / case.fluid.kT


def _observe_seconds(case: Case) -> float:
    seconds = 0.0
    for observable in case.observe:
        seen = min(case.particles, getattr(observable, "particles", case.particles))
        seconds += case.run.steps // observable.every * seen * SAMPLE
    return seconds


def _trajectory_bytes(case: Case) -> int:
    given = case.trajectory
    if given is None:
        return 0
    number = 4 if given.precision == "float32" else 8
    per_particle = sum(
        WIDTHS.get(name, number) * (1 if name == "id" else case.box.dimension)
        for name in given.fields
    )
    frames = case.run.steps // given.every + 1
    shrink = COMPRESSED if given.compression else 1.0
    return round(frames * (given.subset or case.particles) * per_particle * shrink)


# --- warnings -----------------------------------------------------------------------------------


def _warnings(case: Case, numbers: Derived, across: int) -> Iterator[str]:
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
        mach = _surface_speed(case) / numbers.transport.sound_speed
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
    if force.rule == "uniform":
        for axis, push in zip(AXES, force.acceleration, strict=False):
            if push and not case.walls:
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


# --- words --------------------------------------------------------------------------------------


def size_text(count: float) -> str:
    """Bytes for people.

    >>> size_text(270_000_000)
    '270 MB'
    """
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} TB"


def duration_text(seconds: float) -> str:
    """Time for people, to two units.

    >>> duration_text(0.2), duration_text(61), duration_text(7300)
    ('0.2 s', '1 min 1 s', '2 h 1 min')
    """
    if seconds < 10:
        return f"{seconds:.1f} s"
    seconds = round(seconds)
    for big, first, small, second in ((86400, "d", 3600, "h"), (3600, "h", 60, "min")):
        if seconds >= big:
            return f"{seconds // big} {first} {seconds % big // small} {second}"
    return f"{seconds // 60} min {seconds % 60} s" if seconds >= 60 else f"{seconds} s"
