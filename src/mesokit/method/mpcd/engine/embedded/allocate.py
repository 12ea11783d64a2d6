"""Arrays for beads that interact with fluid particles by a pair potential (shapes: `state.py`)."""

import math

import numpy as np

from mesokit.loops.layout import LANES, zeros
from mesokit.loops.neighbours import GAP
from mesokit.method.mpcd.engine.beads.neighbours import lists_of
from mesokit.method.mpcd.engine.cpu.grid import Grid
from mesokit.method.mpcd.engine.cpu.numbers import Numbers, fastest_surface
from mesokit.method.mpcd.engine.embedded.state import PARTNERS, Embedded
from mesokit.method.mpcd.solutes import Solutes
from mesokit.potential import Pair
from mesokit.potential.thermal import boltzmann_volume

FAST = 5.0  # thermal velocities: few particles are faster, and those are tested one by one
NEVER = 8.0  # thermal velocities, which no diffuse wall gives in the life of a run (chance 1e-14)
ROOM = 3.0  # times as many particles near beads as there are in equilibrium


def reach_of(pair: Pair, skin: float, numbers: Numbers) -> tuple[float, float, float]:
    """How far beads reach in a step, a particle goes in it, and surfaces make it go further."""
    fluid, solids = numbers.case.fluid, numbers.solids
    thermal = fluid.timestep * math.sqrt(fluid.kT / min(numbers.masses_of_kinds))
    diffuse = any(body.surface.rule == "diffuse" for body in (solids.bodies if solids else []))
    # A particle gains at most twice the speed of a surface that reflects it.
    further = 2.0 * fluid.timestep * fastest_surface(numbers.case) + NEVER * thermal * diffuse
    travel = FAST * thermal + further
    reach = (pair.reach + skin + travel) * (1.0 + 1e-9)  # rounded up
    return reach, travel, further


def most_near_beads(given: Solutes, pair: Pair, numbers: Numbers) -> int:
    """Room for the particles that beads may reach in a step."""
    reach, fluid = reach_of(pair, given.skin, numbers)[0], numbers.case.fluid
    near = boltzmann_volume(pair.kernel(), numbers.dimension, fluid.kT, reach)
    return int(min(numbers.n, ROOM * given.beads * numbers.density * near + 1000))


def embedded_of(given: Solutes, numbers: Numbers, threads: int) -> tuple:
    """One `Embedded` for solutes with a solvent pair; () for those that collide with the fluid."""
    if given.solvent_pair is None:
        return ()
    d, pair = numbers.dimension, given.solvent_pair
    reach, travel, further = reach_of(pair, given.skin, numbers)
    most = most_near_beads(given, pair, numbers)
    cells = tuple(float(n) for n in numbers.cells)
    zero = (0.0,) * d
    return (
        Embedded(
            potential=pair.kernel(),
            reach=pair.reach,
            skin=given.skin,
            travel=travel,
            further=further,
            grid=Grid(zero, zero, cells, tuple(1.0 / n for n in cells)),
            marked=np.zeros(numbers.number_of_cells + 1, np.int64),
            lists=lists_of(reach, 0.0, given.beads, 0, numbers.box, numbers.closed, threads),
            lane=zeros((threads, most), np.int64),
            partners=zeros((threads, most), np.int32),
            beads=zeros((threads, most * PARTNERS), np.int32),
            r=zeros((threads, most * d)),
            v=zeros((threads, most * d)),
            start=zeros((threads, most * d)),
            bound=zeros((threads, most)),
            number=zeros((threads, GAP), np.int64),
            chosen=zeros((threads, LANES), np.int64),
            taken=zeros((threads, given.beads * d), np.int64),
            faults=zeros((threads, GAP), np.int64),
        ),
    )
