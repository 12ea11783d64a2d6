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
from mesokit.potential.thermal import boltzmann_volume

FAST = 5.0  # thermal velocities: few particles are faster, and those are tested one by one
NEVER = 8.0  # thermal velocities, which no diffuse wall gives in the life of a run (chance 1e-14)
ROOM = 3.0  # times as many particles near beads as there are in equilibrium


def embedded_of(given: Solutes, numbers: Numbers, threads: int) -> tuple:
    """One `Embedded` for solutes with a solvent pair; () for those that collide with the fluid."""
    if given.solvent_pair is None:
        return ()
    case, d = numbers.case, numbers.dimension
    fluid, pair = case.fluid, given.solvent_pair
    thermal = fluid.timestep * math.sqrt(fluid.kT / min(numbers.masses_of_kinds))
    diffuse = any(
        body.surface.rule == "diffuse" for body in (numbers.solids.bodies if numbers.solids else [])
    )
    # A particle gains at most twice the speed of a surface that reflects it.
    further = 2.0 * fluid.timestep * fastest_surface(case) + NEVER * thermal * diffuse
    travel = FAST * thermal + further
    reach = (pair.reach + given.skin + travel) * (1.0 + 1e-9)  # rounded up
    expected = given.beads * numbers.density * boltzmann_volume(pair.kernel(), d, fluid.kT, reach)
    most = int(min(numbers.n, ROOM * expected + 1000))
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
