"""Numbers that follow from a case before it runs: cost, warnings and the table of a check."""

import dataclasses
import math

import numpy as np

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.describe.digits import two_digits
from mesokit.case.trajectory import stored_bytes
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.body.protocol import named
from mesokit.method.mpcd.body.substeps import needed_substeps
from mesokit.method.mpcd.expected import recognise, setting
from mesokit.method.mpcd.expected.bodies import followed
from mesokit.method.mpcd.expected.heating import heating
from mesokit.method.mpcd.expected.molecules import longest_relaxation
from mesokit.method.mpcd.numbers import PIPE, TIMES, Derived
from mesokit.method.mpcd.warnings import cautions
from mesokit.processes.cores import usable_cores
from mesokit.seam.method import BuildUp, Row, Summary
from mesokit.seam.result import NOT_STEADY

HOTTER = 0.05  # relative rise of kT from which on theory at kT is of another fluid
WITHOUT = ", as without obstacles"  # said of a flow
FIRST_ZERO = 2.404825557695773  # of the Bessel function J_0: the slowest mode of a pipe
# factors of time, rate
COSTS = {"thermostat": 1.15, "walls": 1.25, "solids": 1.3, "shear": 1.2, "thread": 0.85}
# seconds more for each particle-step of a molecule, and for each of its sub-steps
MOLECULE, SUBSTEP = 5e-9, 1e-9
BEAD, BEAD_SUBSTEP = 100e-9, 45e-9  # and for each step and sub-step of a bead of a solute
# and for each particle that the fluid has in a unit of a body's surface, in steps of particles
NEAR_BALL, NEAR_SHAPE = 25.0, 100.0
SAMPLE = 12e-9  # seconds for each particle in each sample of an observable
BYTES = {
    "particle 2D": 68,
    "particle 3D": 88,
    "checkpoint 2D": 108,  # of a particle, while one is written
    "checkpoint 3D": 156,
    "cell 2D": 64,
    "cell 3D": 114,
    "empty cell": 17,  # of a random solvent, far from beads: of all threads together
    "end of a cell": 4,  # of each thread, in an empty cell as well
    "program": 215e6,
    "figures": 115e6,  # to draw them, at the end
    "bead": 500,
}

CELLS_OF_BEAD = 40  # in the page of memory where its cell lies
COMPILING = {"fluid": 290e6, "walls": 40e6, "solids": 20e6, "beads": 50e6}


def derive(case: Case, threads: int | None = None) -> Derived:
    """Derived numbers of a case, run on so many threads (all cores unless said).

    >>> from mesokit import Box, Case, Run
    >>> numbers = derive(Case(run=Run(steps=1000), box=Box([30, 30, 30])), threads=1)
    >>> numbers.particles, round(numbers.transport.viscosity, 2)
    (270000, 0.87)
    """
    threads = threads or usable_cores()
    fluid, dimension = case.fluid, case.box.dimension
    steps = case.run.warmup + case.run.steps
    transport = setting.transport(case)
    flow, across, speed = _flow(case)
    bound = None  # on a speed that is not known
    if setting.obstructed(case) and flow.endswith(WITHOUT):
        bound, speed = speed, None
    round_pipe = recognise.pipe(case)
    nu = transport.viscosity if transport else None
    typical = speed / 2 if speed is not None and flow == PIPE else speed  # the mean of a pipe
    length = 2 * round_pipe.radius if round_pipe else _length(case, across)
    builds_up = flow != "lees-edwards"  # that one starts with its linear profile
    rate = fluid.collision.rates[dimension] * 1e6 * (1 + (threads - 1) * COSTS["thread"])
    for cost, applies in (
        ("thermostat", fluid.thermostat.acts),
        ("walls", bool(case.walls)),
        ("solids", setting.obstructed(case)),
        ("shear", case.box.sheared),
    ):
        rate /= COSTS[cost] if applies else 1
    substeps = None
    if fluid.molecule is not None:
        substeps = fluid.molecule.number_of_substeps(
            dimension, fluid.timestep, fluid.kT, fluid.mass
        )
        rate = 1 / (1 / rate + (MOLECULE + SUBSTEP * substeps) / threads)
    beads, bead_seconds = 0, 0.0
    if case.solutes is not None:
        beads = case.solutes.beads
        flights = case.solutes.number_of_substeps(dimension, fluid)
        flights = needed_substeps(case) if case.bodies else flights
        substeps = flights if fluid.molecule is None else substeps
        bead_seconds = beads * (BEAD + BEAD_SUBSTEP * flights) * steps
    rate /= 1 + _near_bodies(case) / max(case.particles, 1)
    memory = beads * BYTES["bead"] + case.particles * BYTES[f"particle {dimension}D"]
    cells, cell_bytes = case.box.volume, BYTES[f"cell {dimension}D"]
    if case.solutes is None or case.solutes.solvent != "random":
        memory += cells * cell_bytes * threads
    else:  # few cells of a random solvent are ever touched
        empty = BYTES["empty cell"] + BYTES["end of a cell"] * threads
        memory += min(cells, beads * CELLS_OF_BEAD) * cell_bytes * threads + cells * empty
    checkpoint = case.particles * BYTES[f"checkpoint {dimension}D"]
    memory += max(checkpoint, bool(case.observe) * BYTES["figures"])
    heated = _heating(case, across, steps)
    observing = 0.0
    for observable in case.observe:
        seen = min(case.particles, getattr(observable, "particles", case.particles))
        observing += case.run.steps // observable.every * seen * SAMPLE
    numbers = Derived(
        particles=case.particles,
        particle_steps=case.particles * steps,
        mean_free_path=setting.mean_free_path(case),
        transport=transport,
        solvent=setting.solvent(case),
        suspended=suspended_in(case),
        flow=flow,
        flow_speed=speed,
        flow_bound=bound,
        flow_size=length,
        reynolds=typical * length / nu if typical is not None and nu else None,
        mach=speed / transport.sound_speed if speed is not None and transport else None,
        steady_time=_steady_time(case, across, nu)
        if nu and (speed or bound) and builds_up
        else None,
        relaxation=longest_relaxation(case),
        heating=heated[0] if heated else None,
        heating_bound=heated is not None and heated[1],
        seconds=case.particles * steps / rate + bead_seconds + observing,
        memory=round(memory + BYTES["program"]),
        trajectory=stored_bytes(case.trajectory, case.groups, dimension, case.run.steps),
        substeps=substeps,
        assumed=f"{threads} thread{'s' * (threads > 1)}, {rate / 1e6:.0f} million "
        "particle-steps/s between samples",
        warnings=(),
    )
    return Derived(**{**vars(numbers), "warnings": tuple(cautions(case, numbers, across))})


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers of a case as a table, and warnings."""
    from mesokit.case.kind import has_run  # which loads compiled code

    numbers, compiling, memory = derive(case, threads), compiling_memory(case), "estimate"
    if compiling > numbers.memory and not has_run(case):
        memory += f"; {size_text(compiling)} while it compiles, the first time"
    rows: list[Row] = [("particles", f"{numbers.particles:,}".replace(",", " "), "")]
    if case.solutes is not None:
        rows.append(("beads of solutes", f"{case.solutes.beads:,}".replace(",", " "), ""))
    rows += body_rows(case)
    molecule = case.fluid.molecule
    if molecule is not None:
        number_of = f"{numbers.particles // molecule.length:,}".replace(",", " ")
        rows.append(("molecules", number_of, f"{molecule.topology}s of {molecule.length}"))
    if numbers.relaxation is not None:
        time, name = numbers.relaxation
        steps = f"slowest mode, {name}; {round(time / case.fluid.timestep)} steps"
        rows.append(("relaxation time", number(time, "tau"), steps))
        if rate := abs(case.box.steady_rate):
            rows.append(("Weissenberg number", number(rate * time), "shear rate x relaxation time"))
    if numbers.substeps is not None:
        how = molecule.propagation if molecule is not None else "verlet"
        rows.append(("sub-steps", str(numbers.substeps), how))
    if molecule is not None and case.solutes is not None:
        beads = case.solutes.number_of_substeps(case.box.dimension, case.fluid)
        rows.append(("sub-steps of solutes", str(beads), "verlet"))
    rows += [
        *numbers.fluid_rows(),
        *numbers.flow_rows(case.fluid.timestep),
        ("run time", duration_text(numbers.seconds), f"estimate: {numbers.assumed}"),
        ("memory", size_text(numbers.memory), memory),
    ]
    if numbers.trajectory:
        rows.append(("trajectory", size_text(numbers.trajectory), "estimate"))
    return Summary(tuple(rows), numbers.warnings, numbers.seconds, numbers.record(), numbers.memory)


def suspended_in(case: Case) -> str:
    """What is in the fluid, in words."""
    found = {"solutes": case.solutes is not None, "bodies": bool(case.bodies)}
    return " and ".join(name for name, there in found.items() if there)


def body_rows(case: Case) -> list[Row]:
    """A row for each kind of bodies: how many, how large, how heavy, and how much they fill."""
    d, fluid, rows = case.box.dimension, case.fluid, []
    for name, kind in named(case.bodies):
        solid, mass = kind.solid(d), kind.mass_in(d, fluid.density * fluid.mass)
        share = kind.number * solid.volume / free_volume(case)
        far = f"{'radius' if solid.ball else 'reach'} {solid.radius:.4g} a"
        said = f"{far}, mass {mass:.4g}, volume fraction {share:.3g}"
        rows.append((f"bodies {name}", f"{kind.number:,}".replace(",", " "), said))
        rows += _rough_rows(case, name)
    return rows


def _rough_rows(case: Case, name: str) -> list[Row]:
    """What theory expects of one body of a kind alone, or of disks as in a lattice."""
    body, rows = followed(case, "check", name), []
    found = body.roughly()
    of = "one in a wide fluid"
    if case.box.dimension == 2:
        of = "a lattice" if body.number > 1 else "one in this box"
        of += " without walls" if case.walls else ""
    if found.speed > 0:
        said = f"estimate, of {of}; Reynolds number {found.reynolds:.3g}"
        rows.append((f"speed of {name}", number(found.speed, "a/tau"), said))
    if math.isfinite(found.diffusion) and body.moving and not body.trapped:
        said = f"estimate, of {of}; R^2/D = {found.time:.3g} tau"
        rows.append((f"diffusion of {name}", number(found.diffusion, "a^2/tau"), said))
    return rows


def _near_bodies(case: Case) -> float:
    """Particles that would take as long, in each step, as all bodies.

    A shape has the surface that it would have if it were round as at its least width.
    """
    found, d = 0.0, case.box.dimension
    for kind in case.bodies:
        solid = kind.solid(d)
        surface = d * solid.volume / (0.5 * solid.thinnest)
        found += kind.number * surface * (NEAR_BALL if solid.ball else NEAR_SHAPE)
    return found * case.fluid.density


def compiling_memory(case: Case) -> int:
    """Bytes that a process takes while it compiles the kernels of such a case, measured.

    >>> from mesokit import Box, Case, Fluid, Plates, Run
    >>> slit = Case(run=Run(steps=1), box=Box([9, 9]), fluid=Fluid(), walls=[Plates("y")])
    >>> compiling_memory(slit)
    330000000
    """
    more = {
        "walls": bool(case.walls),
        "solids": setting.obstructed(case),
        "beads": case.solutes is not None or case.fluid.molecule is not None,
    }
    return round(COMPILING["fluid"] + sum(COMPILING[name] * there for name, there in more.items()))


def _flow(case: Case) -> tuple[str, int, float | None]:
    """Kind of the steady flow, axis number across it, and its largest speed.

    For a channel with obstacles these are what they would be without: an upper bound.
    """
    pipe, known = recognise.pipe(case), setting.transport(case)
    if pipe is not None and known is not None and setting.driven_axis(case) == pipe.axis:
        acceleration = float(abs(setting.uniform_acceleration(case)[pipe.axis]))
        middle = theory.hagen_poiseuille_velocity(0.0, pipe.radius, acceleration, known.viscosity)
        return PIPE, 1, float(middle)
    if setting.obstructed(case):
        plates = tuple(wall for wall in case.walls if isinstance(wall, Plates))
        if len(plates) == 1 and not plates[0].diffuse:
            bare = dataclasses.replace(case, walls=plates, observe=(), trajectory=None, log=None)
            kind, across, speed = _flow(bare)
            if speed is not None and setting.surface_speed(case) > speed:
                return "of moving surfaces", across, setting.surface_speed(case)
            return kind if kind == "rest" else kind + WITHOUT, across, speed
        if setting.surface_speed(case) and not case.fluid.force.acts:
            return "of moving surfaces", 1, setting.surface_speed(case)
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


def _length(case: Case, across: int) -> float:
    """Size across the flow: of the box, or 1/k of a Kolmogorov flow."""
    waves, size = case.fluid.force.waves_across(), float(case.box.size[across])
    return size if waves is None else size / (2 * math.pi * waves)


def build_up(case: Case) -> BuildUp | None:
    """How a driven flow comes from rest to its steady state; None where there is none, or where
    obstacles make it shorter than is known."""
    numbers, dt = derive(case), float(case.fluid.timestep)
    known = numbers.steady_time is not None and numbers.flow_speed and not numbers.flow_bound
    if not known or not case.fluid.force.steady or case.fluid.start.run is not None:
        return None
    steps = float(numbers.steady_time or 0.0) / dt
    return BuildUp(steps, math.ceil(TIMES * steps), case.run.warmup)


def _steady_time(case: Case, across: int, viscosity: float) -> float:
    pipe = recognise.pipe(case)
    if pipe is not None:
        return (pipe.radius / FIRST_ZERO) ** 2 / viscosity
    if case.walls:
        wavenumber = math.pi / case.box.size[across]  # of the slowest shear mode
    elif case.fluid.force.waves_across():
        wavenumber = 1 / _length(case, across)
    else:
        wavenumber = 2 * math.pi / case.box.size[across]
    return 1 / (viscosity * wavenumber**2)


def heat_caveat(case: Case, steps: int) -> str:
    """Where friction makes the fluid much hotter than the kT of the case in so many steps, warm-up
    included: a caveat of numbers that depend on kT; "" elsewhere."""
    across = _flow(case)[1]
    found = _heating(case, across, steps)
    if found is None or found[0] <= HOTTER:
        return ""
    (rise, most), kT = found, float(case.fluid.kT)
    hot = f"{kT + float(two_digits(kT * rise)):.4g}"
    if most:
        return f"approximate: viscous heating raises kT from {kT:.4g} to {hot} at most"
    law = heating(case, across)
    before = law.after(case.run.warmup * case.fluid.timestep) if law else 0.0
    if law and law.steady is not None and rise - before < HOTTER:
        return f"approximate: viscous heating holds kT at about {hot}"
    return f"{NOT_STEADY}: viscous heating raises kT from {kT:.4g} to {hot} or more in the run"


def _heating(case: Case, across: int, steps: int) -> tuple[float, bool] | None:
    """Relative rise of the temperature by friction in so many steps, and True if that is a bound,
    as walls cool the fluid by an unknown amount; None with a thermostat."""
    found = heating(case, across)
    if found is None:
        return None
    time = steps * case.fluid.timestep
    cooled = any(
        surface.rule == "diffuse" or (surface.rule == "no-slip" and wall.virtual != "none")
        for wall in case.walls
        for surface in wall.surfaces().values()
    )
    return found.after(time), found.steady is None and cooled
