"""Warnings of `check` and `run`: cases that can run, and may not give what was meant."""

import contextlib
import math
from collections.abc import Iterator, Sequence

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import name_of
from mesokit.case.describe.digits import above, two_digits
from mesokit.case.warnings import run_warnings
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.solids.solids import slit_of, solids_of
from mesokit.method.mpcd.body_warnings import body_warnings
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.compression import compression, unit_cell
from mesokit.method.mpcd.expected.molecules import (
    FAST,
    spring_of,
    swing_of_flight,
    without_bonds,
    without_solutes,
)
from mesokit.method.mpcd.molecule import COARSE
from mesokit.method.mpcd.numbers import PIPE, TIMES, Derived

COMPRESSED = 0.2  # acceleration x length/(kT/m) of a fluid driven against solids
SLIPPERY = 0.03  # slip length in cells
RADIANS = 0.01  # an angle of no less may have been meant in radians
TURBULENT = 2000  # Reynolds number of a pipe, of the mean velocity and the diameter
SHOCK = 2.0  # speeds of sound at which images may move; those of 8 do not follow theory
STRONG = 0.3  # thermal velocities that a force may add in a timestep


def cautions(case: Case, numbers: Derived, across: int) -> Iterator[str]:
    """Warnings before a run; `across` is the number of the axis across the flow."""
    yield from _method_warnings(case, numbers)
    yield from _solid_warnings(case)
    yield from body_warnings(case, numbers)
    yield from _flow_warnings(case, numbers, across)
    yield from run_warnings(case, numbers.memory, numbers.trajectory)


def _method_warnings(case: Case, numbers: Derived) -> Iterator[str]:
    fluid, transport = case.fluid, numbers.transport
    path = fluid.timestep * math.sqrt(fluid.kT / fluid.mass)
    angle = (fluid.collision.in_theory() or {}).get("angle")  # of rules that turn velocities
    if angle is not None and angle < 7:
        yield (
            f"fluid.collision.angle = {angle:g}: the angle is in degrees"
            + (f"; {angle:g} rad is {math.degrees(angle):.2f}" if angle > RADIANS else "")
        )
    if fluid.grid_shift < 1 and path < 0.5:
        yield (
            f"fluid.grid_shift = {fluid.grid_shift:g}: with a mean free path of {path:.3g} cells "
            "(below 0.5) only the full shift makes the fluid Galilean invariant"
        )
    if above(path, 1, 3) and fluid.collision.acts:
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
    if fluid.molecule is not None and spring_of(fluid.molecule) is not None:
        turns = swing_of_flight(case)
        if turns > FAST:
            yield (
                f"fluid.timestep = {fluid.timestep:g}: the fastest bond turns by {turns:.2g} rad "
                f"in one flight (above {FAST:g}); theory of slow bonds, Rouse's viscosity "
                "and times, is approximate"
            )
    if case.solutes is not None and case.solutes.substeps is not None:
        given = case.solutes
        lightest = min(kind.mass for kind in fluid.kinds)
        frequency = given.frequency(case.box.dimension, fluid.kT, lightest)
        phase = frequency * fluid.timestep / case.solutes.substeps
        if phase > COARSE:
            yield (
                f"solutes.substeps = {given.substeps}: the stiffest potential or the magnetic "
                f"field turns by {phase:.2g} rad in each (above {COARSE:g}): swings read up to "
                f"{25 * phase**2:.2g} % too large"
            )
    if fluid.density < 3 and fluid.collision.acts:
        yield (
            f"fluid.density = {fluid.density:g}: below 3 many cells hold no pair that could "
            "collide, and the formulas for the viscosity fail"
        )
    note = setting.temperature_note(case)
    if note:
        yield (
            f"fluid.thermostat.rule = {name_of(fluid.thermostat)!r}, fluid.collision.rule = "
            f"{name_of(fluid.collision)!r}: {note.removeprefix('approximate: ')} at this density"
        )
    transport = transport or (numbers.solvent if case.bodies else None)
    if transport is None:
        reason = setting.caveat(case) or "no formula for this fluid"
        if lacking := _without_theory(case):
            yield f"transport coefficients: {reason}; {lacking}"
    elif case.box.dimension == 2 and above(7, transport.dynamic_viscosity, 3):
        yield (
            f"in 2D fluctuations raise a dynamic viscosity of {transport.dynamic_viscosity:.3g} "
            "(below 7) by several percent over theory, more in a larger box"
        )


def _without_theory(case: Case) -> str:
    """Which plots lack theory where transport coefficients do; "" if those of a case have it.

    Solutes and molecules of springs have theories of their own, of all but flows between walls and
    of waves and velocities of single beads.
    """
    molecule, sheared = case.fluid.molecule, bool(case.box.sheared)
    springs = molecule is not None and spring_of(molecule) is not None
    known = without_solutes(case) if molecule is None else springs and without_bonds(case)
    if not known or (molecule is None and case.solutes is None):
        return "plots of what needs them lack theory"
    names = [one.label for one in case.observe if one.asks_transport and not sheared]
    if not names:
        return ""
    return f"{' and '.join(names)} {'lack' if len(names) > 1 else 'lacks'} theory"


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
    sheared = case.box.sheared
    if numbers.mach is not None and above(numbers.mach, 0.2) and not sheared:
        yield (
            f"Mach number {numbers.mach:.2g}: above 0.2 the fluid is compressible; "
            "lower the force or the velocity of the surfaces"
        )
    elif numbers.mach is None and numbers.transport:
        mach = setting.surface_speed(case) / numbers.transport.sound_speed
        if above(mach, 0.2):
            yield (
                f"wall: surfaces move at Mach number {mach:.2g}: above 0.2 the fluid is "
                "compressible; lower their velocity or rotation"
            )
    history, known = case.box.history, numbers.transport
    in_time = history is not None and not history.steady
    if sheared and (known or not in_time):
        sound = known.sound_speed if known else setting.sound_speed(case)
        cell = case.box.largest_rate / sound
        if above(cell, 0.2):
            yield (
                f"{case.box.shear_key}: velocities differ by {cell:.2g} of the "
                "speed of sound across a cell; keep it below 0.2"
            )
    if history is not None and in_time:
        faster = history.largest * case.box.size[1] / setting.sound_speed(case)
        if above(faster, SHOCK):
            yield (
                f"{case.box.shear_key}: the images move at up to {faster:.2g} times the speed of "
                f"sound (rate x height, {history.largest:.3g} x {case.box.size[1]}): above "
                f"{SHOCK:g} they drive shocks into the fluid, which no theory of shear has; "
                "shear more slowly"
            )
    pressed = compression(case)
    if pressed is not None and above(pressed[1], COMPRESSED):
        yield (
            f"fluid.force.acceleration: over {unit_cell(case, pressed[0]):g} cells, until the "
            f"solids repeat, it may change the density by a factor of up to {1 + pressed[1]:.2g}: "
            f"acceleration x length/(kT/m) = {pressed[1]:.2g} (above {COMPRESSED:g}); measure it "
            "with density-gradient, lower the force"
        )
    plates, rule, slip = slit_of(case), fluid.collision.in_theory(), 0.0
    beside = plates is not None and not plates.slips and plates.virtual == "extrapolate"
    if beside and rule is not None and not setting.caveat(case) and fluid.thermostat.in_theory:
        with contextlib.suppress(ValueError):  # of rules that conserve angular momentum
            slip = theory.virtual_gas_slip(**rule, **setting.gas(case)._asdict())
    if slip > SLIPPERY and (numbers.flow_speed or sheared):
        yield (
            f"wall: in so thin a fluid plates slip, by a length of some {slip:.2g} cells: virtual "
            "particles know nothing of its stress; more particles or a shorter timestep help"
        )
    for note in force.notes(case.box.size):
        yield f"fluid.force.{note}"
    kick = force.largest_in(case.box.size) * fluid.timestep / math.sqrt(fluid.kT / fluid.mass)
    if above(kick, STRONG):
        yield (
            f"fluid.force: in a timestep it changes velocities by up to {kick:.2g} thermal "
            f"velocities; above {STRONG:g} its steps are coarse: a shorter timestep, or less force"
        )
    random = case.solutes is not None and case.solutes.solvent == "random"
    for axis, acceleration in zip(AXES, setting.uniform_acceleration(case).tolist(), strict=False):
        if acceleration and not case.walls and not random:
            heats = "" if setting.isothermal(case) else " (without a thermostat it also heats)"
            yield (
                f"fluid.force.acceleration: nothing holds the fluid along {axis}: without walls it "
                f"speeds up for ever{heats}"
            )
        elif acceleration and AXES.index(axis) in setting.closed_axes(case):
            drop = fluid.mass * abs(acceleration) * case.box.size[across] / fluid.kT
            if drop > 0.1:
                yield (
                    f"fluid.force.acceleration along {axis} presses the fluid on a plate: its "
                    f"density falls by a factor {math.exp(min(drop, 99)):.3g} across the slit"
                )
    yield from _net_pull(case)
    if numbers.flow == "plug" and numbers.flow_speed is None:
        yield "fluid.force.acceleration: slip plates hold nothing: the fluid speeds up for ever"
    if numbers.heating is not None and numbers.heating > 0.01:
        most = numbers.heating_bound
        yield (
            f"no thermostat: friction raises the temperature by {'at most ' * most}"
            f"{two_digits(100 * numbers.heating)} % over the run"
            + "; walls at kT cool the fluid"
            * most
        )
    if numbers.reynolds is not None:
        shown = float(f"{numbers.reynolds:.2g}")  # 1.4 is not above 1.4
        if numbers.flow == PIPE and shown > TURBULENT:
            yield (
                f"Reynolds number {shown:g}: above some {TURBULENT:g} the flow along a pipe is "
                "turbulent; the law of Hagen and Poiseuille ends there"
            )
        if unstable := force.instability(shown, case.box.size, across):
            yield unstable
    if numbers.steady_time is not None and (numbers.flow_speed or numbers.flow_bound):
        # obstacles make it shorter by an unknown amount
        times, need = (1, "up to") if numbers.flow_bound else (TIMES, "about")
        wait = math.ceil(times * numbers.steady_time / fluid.timestep)
        if case.run.warmup < wait and case.run.steps and fluid.start.run is None:
            yield (
                f"run.warmup = {case.run.warmup}: the flow needs {need} "
                f"{math.ceil(TIMES * numbers.steady_time / fluid.timestep)} steps from rest to its "
                "steady state; observables will average over the start"
            )
    wait = 0
    if numbers.relaxation is not None and (case.box.steady_rate or case.box.oscillation):
        wait = math.ceil(3 * numbers.relaxation[0] / fluid.timestep)
    # molecules start at rest, and take a few relaxation times to follow the shear
    if case.run.warmup < wait and case.run.steps and case.observe and fluid.start.run is None:
        yield (
            f"run.warmup = {case.run.warmup}: molecules need about {wait} steps (3 relaxation "
            "times) until shear has turned and stretched them; observables will average over the "
            "start"
        )


def _net_pull(case: Case) -> Iterator[str]:
    solutes = case.solutes
    if solutes is None or case.walls or solutes.traps or solutes.solvent == "random":
        return
    forces = [len(pull.beads(solutes)) * np.array(pull.force) for pull in solutes.pulls]
    total = np.sum(forces, axis=0) if forces else np.zeros(case.box.dimension)
    size = max((float(np.abs(force).max()) for force in forces), default=0.0)
    along = [axis for axis, f in zip(case.box.axes, total, strict=True) if abs(f) > 1e-9 * size]
    if along:
        yield (
            f"solutes.pulls: together they pull along {' and '.join(along)}, and nothing holds the "
            "fluid: without walls or a second force the whole box speeds up for ever"
        )
