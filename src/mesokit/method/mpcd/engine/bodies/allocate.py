"""The memory of bodies, made when a case is built (shapes: `state.py`)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry.solids.solids import Solids
from mesokit.loops.layout import LANES, SCRATCH_ROW, zeros
from mesokit.method.mpcd.body.protocol import Body, Squirming
from mesokit.method.mpcd.body.substeps import needed_substeps
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.near import LISTS_HOLD, LONGEST_REACH, PARTNERS_HOLD
from mesokit.method.mpcd.engine.bodies.state import MovingBodies
from mesokit.method.mpcd.engine.cpu.grid import Grid
from mesokit.method.mpcd.engine.cpu.numbers import Numbers, fastest_surface
from mesokit.method.mpcd.groups import fluid_mass_density
from mesokit.scalar.pointer import address

LISTED = 6.0  # thermal velocities: lists hold so fast flights; of faster ones all bodies are tried
STRIDES = 0.05  # cells: surfaces rarely go farther in a timestep
FAST = 5.0  # thermal velocities: few particles are faster, and those are tested one by one
NEVER = 8.0  # thermal velocities, which no diffuse wall gives in the life of a run
BENT = 1e-6  # cells: a flight among walls may be bent, so its path is longer than if straight
ROOM = 2.0  # times as many particles near bodies as there are on average
MASS_BITS = 40
Floats = NDArray[np.float64]


def masses_of(case: Case) -> Floats:
    """Mass of a body of each kind."""
    d, density = case.box.dimension, fluid_mass_density(case)
    return np.array([kind.mass_in(d, density) for kind in case.bodies])


def balancing_pull(case: Case) -> tuple[float, ...]:
    """The uniform acceleration of everything that balances forces on bodies; () for none."""
    if not any(kind.counter_force for kind in case.bodies):
        return ()
    fluid = sum(kind.mass * kind.number for kind in case.groups[0].kinds)
    beads = 0.0 if case.solutes is None else case.solutes.total_mass
    masses = masses_of(case)
    numbers = np.array([kind.number for kind in case.bodies])
    total = np.zeros(case.box.dimension)
    for kind in case.bodies:
        if kind.counter_force and kind.force is not None:
            total += kind.number * np.array(kind.force)
    return tuple((-total / (fluid + beads + float(masses @ numbers))).tolist())


def row_of(kind: Body, mass: float, case: Case, first_part: int) -> Floats:
    """The numbers of a kind of bodies, for compiled code."""
    d, row = case.box.dimension, np.zeros(state.KIND_COLUMNS)
    solid = kind.solid(d)
    row[state.MASS] = mass
    for k in range(d):
        free = "xyz"[k] not in kind.fixed
        row[state.INVERSE + k] = free / mass
        row[state.ROOT + k] = free / math.sqrt(mass)
    inertia = mass / solid.volume * solid.moments
    turns = "orientation" not in kind.fixed
    inverse, root = np.zeros((3, 3)), np.zeros((3, 3))
    if d == 2:
        inertia = np.diag([0.0, 0.0, inertia[2, 2]])
        inverse[2, 2], root[2, 2] = turns / inertia[2, 2], turns / math.sqrt(inertia[2, 2])
    elif turns:
        values, axes = np.linalg.eigh(inertia)
        inverse = axes @ np.diag(1.0 / values) @ axes.T
        root = axes @ np.diag(values**-0.5) @ axes.T
    row[state.INERTIA : state.INERTIA + 6] = six(inertia)
    row[state.INVERSE_INERTIA : state.INVERSE_INERTIA + 6] = six(inverse)
    row[state.ROOT_INERTIA : state.ROOT_INERTIA + 6] = six(root)
    row[state.RADIUS] = solid.radius
    row[state.IS_BALL] = solid.ball
    row[state.IS_SLIP] = kind.surface == "slip"
    fluid = fluid_mass_density(case) * solid.volume
    if kind.virtual == "fill" and kind.surface != "slip":
        row[state.FILLED] = min(1.0, mass / fluid)
    if kind.hinge is not None and d == 3:
        row[state.HINGED] = 1.0
        row[state.HINGE : state.HINGE + 3] = np.array(kind.hinge) / math.hypot(*kind.hinge)
    nearby = kind.counter
    by_ball = nearby is not None and nearby.at is not None
    by_shell = nearby is not None and nearby.shell > 0
    force_given = state.BALL_FORCE if by_ball else state.FORCE_GIVEN
    torque_given = state.SHELL_TORQUE if by_shell else state.TORQUE_GIVEN
    row[force_given : force_given + d] = kind.force or (0.0,) * d
    twist = kind.torque if isinstance(kind.torque, tuple) else (0.0, 0.0, kind.torque or 0.0)
    row[torque_given : torque_given + 3] = twist
    row[state.REACH] = solid.radius
    row[state.SWEPT] = 0.0 if solid.ball else solid.radius
    if nearby is not None and by_shell:
        row[state.SHELL] = nearby.shell
        row[state.REACH] += nearby.shell
        row[state.SWEPT] += 0.0 if solid.ball else nearby.shell
    if nearby is not None and nearby.at is not None:
        row[state.BALL_AT : state.BALL_AT + d] = nearby.at
        row[state.BALL_RADIUS] = nearby.radius
        far = math.hypot(*nearby.at) + nearby.radius
        row[state.REACH], row[state.SWEPT] = max(row[state.REACH], far), max(row[state.SWEPT], far)
    row[state.IN_BODY_FRAME] = kind.frame == "body"
    kT = case.fluid.kT
    if kind.trap is not None:
        row[state.SPRING] = kind.trap.k * kT
        row[state.ANGULAR_SPRING] = kind.trap.angular * kT
        towards = kind.trap.direction or (1.0, 0.0, 0.0)[:d]
        row[state.TOWARDS : state.TOWARDS + d] = np.array(towards) / math.hypot(*towards)
    if kind.interaction.depth:
        row[state.DEPTH], row[state.RANGE] = kind.interaction.depth * kT, kind.interaction.range
    if isinstance(kind.swim, Squirming):
        row[state.B1], row[state.B2] = kind.swim.B1, kind.swim.B2
        row[state.TUMBLES] = kind.swim.tumble_rate
    row[state.FIRST_PART], row[state.PARTS_END] = first_part, first_part + len(solid.parts)
    row[state.DISPLACED] = fluid
    row[state.HALF_LENGTH] = kind.half_axis
    return row


def six(matrix: Floats) -> Floats:
    """A symmetric matrix as xx, yy, zz, xy, xz, yz."""
    return matrix[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def allocate_bodies(numbers: Numbers, threads: int, waste: int, domain: Any = None) -> MovingBodies:
    """Bodies at rest at 0, and room for all that their steps need."""
    case, d = numbers.case, numbers.dimension
    fluid, box = case.fluid, case.box
    masses, kinds = masses_of(case), []
    parts: list[Any] = []
    for kind, mass in zip(case.bodies, masses.tolist(), strict=True):
        kinds.append(row_of(kind, mass, case, len(parts)))
        parts += kind.solid(d).parts
    kind_of = np.repeat(np.arange(len(kinds)), [kind.number for kind in case.bodies])
    table = np.array([part.numbers for part in parts])
    n, number = len(kind_of), np.array([kind.number for kind in case.bodies])
    thermal = fluid.timestep * math.sqrt(fluid.kT / min(numbers.masses_of_kinds))
    solids: Solids | None = numbers.solids
    diffuse = any(body.surface.rule == "diffuse" for body in (solids.bodies if solids else []))
    further = 2.0 * fluid.timestep * fastest_surface(case) + NEVER * thermal * diffuse
    further += BENT * (solids is not None)
    shear = box.largest_rate * float(box.size[1]) * fluid.timestep
    travel = FAST * thermal + further + 0.5 * shear
    radii = np.array([kind.solid(d).radius for kind in case.bodies])
    shell = surface_bound(radii, d) * (2.0 * travel + 2.0)
    own = [(kind.counter, kind.solid(d)) for kind in case.bodies]
    reached = np.array([0.0 if one is None else one.volume(solid, d) for one, solid in own])
    near_them = float(number @ (shell + reached))
    most = int(min(numbers.n, ROOM * numbers.density * near_them + 1000))
    filled = float(number @ surface_bound(radii + 1.0, d)) * 2.0 * numbers.density
    most_gas = int(ROOM * filled / threads + 0.2 * filled + 2000)
    cells = tuple(float(c) for c in numbers.cells)
    zero = (0.0,) * d
    near = numbers.number_of_cells + 1
    walls = () if solids is None else (wall_of_gaps(numbers, case),)
    heaviest = max(numbers.masses_of_kinds)
    return MovingBodies(
        rows=np.zeros((n, state.COLUMNS)),
        kinds=np.array(kinds),
        kind=kind_of.astype(np.int64),
        part_code=np.array([part.code for part in parts], np.int64),
        table=table,
        parts=address(table),
        mass_scale=2.0 ** (MASS_BITS - math.ceil(math.log2(heaviest))),
        cells=numbers.number_of_cells,
        density=numbers.density,
        substeps=needed_substeps(case),
        lever=2.0 ** math.ceil(math.log2(max(radii.max(), 1.0))),
        further=further,
        twice=1,
        grid=Grid(zero, zero, cells, tuple(1.0 / c for c in cells)),
        halves=Grid(zero, zero, tuple(2.0 * c for c in cells), tuple(0.5 / c for c in cells)),
        cubes=zeros((threads, LANES), np.int32),
        list_reach=reach_of_lists(case, LISTED * thermal + further + shear),
        near_count=np.zeros(near, np.int32),
        near=np.zeros((near, state.MOST_NEAR_CELL), np.int32),
        alone=np.full(near, state.NO_BODY, np.int32),
        clear=np.zeros((numbers.number_of_cells << d) + 1, np.uint8),
        partner_count=np.zeros(n, np.int32),
        partners=np.zeros((n, state.MOST_PARTNERS), np.int32),
        values=zeros((threads, most, state.NEAR_COLUMNS)),
        numbers=zeros((threads, most, state.NEAR_NUMBERS), np.int64),
        sums=zeros((threads, n, state.SUMS), np.int64),
        taken=zeros((threads, n, 6), np.int64),
        gas=zeros((threads, most_gas, state.GAS_COLUMNS)),
        gas_mass=fluid.mass,
        together=int("angular momentum" not in fluid.collision.conserves),
        gas_number=zeros((threads, most_gas), np.int64),
        gas_cell=zeros((threads, most_gas), np.int64),
        gas_body=zeros((threads, most_gas), np.int64),
        tensor=zeros((threads, 2, 2 * d * d), np.int64),
        counters=zeros((threads, state.COUNTERS), np.int64),
        faults=zeros((threads, 8), np.int64),
        work=zeros((threads, state.WORK)),
        chosen=zeros((threads, LANES), np.int64),
        columns=zeros((threads, state.ROWS * SCRATCH_ROW)),
        keys=zeros((threads, 4, LANES), np.int64),
        waste=zeros((threads, waste), np.int64),
        counters_near=(1,) if any(kind.counter for kind in case.bodies) else (),
        solid=walls,
        pull=balancing_pull(case),
        messages=() if domain is None else domain.body_messages(n, state.SUMS),
    )


def reach_of_lists(case: Case, flight: float) -> float:
    """How near a surface is to a cell that has its body on the list, in cells.

    It is as far as a flight goes in a timestep, and with solutes as far as the potential of gaps.
    """
    far = flight
    if case.solutes is not None:
        gaps = (kind.interaction.range for kind in case.bodies if kind.interaction.depth)
        far = max(flight, PARTNERS_HOLD + max(gaps, default=0.0))
    return min(LISTS_HOLD + STRIDES + far, LONGEST_REACH)


def surface_bound(radius: Floats, d: int) -> Floats:
    """Surface of balls of these radii."""
    return 2.0 * math.pi * radius if d == 2 else 4.0 * math.pi * radius**2


def wall_of_gaps(numbers: Numbers, case: Case) -> Any:
    """The solids as the potential of gaps sees them: found as far as that reaches."""
    if numbers.slit is not None:
        return numbers.slit.kernel(case.box.size)
    d = numbers.dimension
    reach = max(kind.solid(d).radius + kind.interaction.range for kind in case.bodies)
    assert numbers.solids is not None
    return numbers.solids.reaching(reach)
