"""The same steps on one process and on some ranks of mpiexec; says which arrays differ.

mpiexec -n 4 python -m mpi4py same_bits.py '{"channel": [3, 1]}'
"""

import json
import sys

import numpy as np
from mpi4py import MPI

from mesokit import (
    FENE,
    WCA,
    Box,
    Case,
    CounterForce,
    Disk,
    DiskBody,
    Fluid,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    Plates,
    Polymer,
    RectangleBody,
    Run,
    Solutes,
    SphereBody,
    SpheroidBody,
    Squirming,
    SRDPlusA,
    Uniform,
)
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.domains.blocks.tree import divided
from mesokit.method.mpcd.engine.domains.engine import Ranks
from mesokit.method.mpcd.start.fluid import start
from mesokit.processes.several import wait

COMM = MPI.COMM_WORLD
RUN, HELD = Run(steps=100), MaxwellBoltzmann()
POLYMERS = (Polymer(number=6, length=6), Polymer(number=4, length=1))
CASES = {
    "channel": Case(
        run=RUN,
        box=Box([40, 20]),
        fluid=Fluid(density=5, force=Uniform([0.01, 0]), thermostat=HELD),
        walls=[
            Plates("y"),
            Disk(centre=[10.3, 9.7], radius=4),
            Disk(centre=[30, 4], radius=3),
        ],
        solutes=Solutes(polymers=POLYMERS, bond=FENE(), pair=WCA(), mass=5.0),
    ),
    "sheared dimers": Case(
        run=RUN,
        box=Box([24, 20], shear_rate=0.05),
        fluid=Fluid(density=5, thermostat=HELD, molecule=Molecule(length=2, bond=Harmonic(K=1.0))),
    ),
    "long flights": Case(
        run=RUN,
        box=Box([12, 10, 14]),
        fluid=Fluid(density=5, timestep=1.0, thermostat=HELD),
    ),
}
CASES |= {
    "bodies in a channel": Case(
        run=RUN,
        box=Box([40, 20]),
        fluid=Fluid(density=5, force=Uniform([0.01, 0]), thermostat=HELD),
        walls=[Plates("y"), Disk(centre=[10.3, 9.7], radius=3)],
        bodies=[
            DiskBody(
                radius=2,
                number=3,
                swim=Squirming(B1=0.1),
                force=[20, 0],
                frame="body",
                counter=CounterForce(at=[-4, 0]),
            ),
            RectangleBody(size=[5, 3], density=10, torque=50, counter=CounterForce(shell=1.5)),
        ],
    ),
    "bodies in shear": Case(
        run=RUN,
        box=Box([16, 14, 15], shear_rate=0.05),
        fluid=Fluid(density=5, timestep=0.3, collision=SRDPlusA(), thermostat=HELD),
        bodies=[
            SphereBody(radius=2, number=4),
            SpheroidBody(half_length=3, radius=1.5, density=10, virtual="none"),
        ],
    ),
    "beads beside bodies": Case(
        run=RUN,
        box=Box([24, 20], shear_rate=0.05),
        fluid=Fluid(density=5, thermostat=HELD),
        bodies=[DiskBody(radius=2, number=3), RectangleBody(size=[5, 3], density=10)],
        solutes=Solutes(polymers=POLYMERS, bond=FENE(), pair=WCA(), mass=5.0),
    ),
}
MEASURES = ("stress", "walls")


def course(engine, case, moves):
    """What is read on the way, borders moving every tenth step."""
    found = {}
    for k in range(3):
        engine.advance(10)
        if moves:
            engine.move_borders(anywhere(engine, k))
    engine.advance(2, ["stress"])
    found |= {f"stress {name}": part for name, part in engine.stress.items()}
    found["totals"] = np.concatenate([np.atleast_1d(part) for part in engine.totals()])
    for name, part in zip(
        ("number", "mass", "momentum", "energy"), engine.moments((0,), (6,)), strict=True
    ):
        found[name] = part
    found["modes"] = np.concatenate(
        [part.ravel() for part in engine.modes(np.eye(2, engine.dimension))]
    )
    some = np.array([5, 3, engine.n - 1])
    found["velocities"], found["places"] = engine.velocities(some), engine.positions(some, True)
    if case.walls:
        found["taken"] = engine.wall_impulse
    if case.solutes or case.fluid.molecule:
        found["potential energy"] = np.array(engine.potential_energy())
    engine.advance(15)
    return found | {f"state {name}": np.asarray(array) for name, array in engine.state().items()}


def anywhere(engine, k):
    """A tree whose planes lie anywhere."""
    random = np.random.default_rng(k)
    weights = tuple(random.random(engine.dimension))

    def work(asked):
        return [random.random(block.lengths[axis]) ** 3 for block, axis in asked]

    return divided(engine.numbers.cells, engine.comm.size, weights, work)


def first_ranks(n):
    """A communicator of the first ranks, None on the others."""
    comm = COMM.Split(0 if COMM.rank < n else MPI.UNDEFINED)
    return None if comm == MPI.COMM_NULL else comm


def compared(here, there):
    """The names of arrays that differ, and how many there are."""
    assert here.keys() == there.keys()
    return [key for key in here if here[key].tobytes() != there[key].tobytes()], len(here)


def compare(name, ranks, threads):
    """Rank 0 says what differs."""
    case, comm = CASES[name], first_ranks(ranks)
    if comm is not None:
        some = Ranks(case, threads, MEASURES, comm)
        start(some)
        there = course(some, case, moves=True)
    if COMM.rank == 0:
        one = CPU(case, 1, MEASURES)
        start(one)
        return compared(course(one, case, moves=False), there)


def main(runs):
    """What differs in each of these runs, by the name of the case; the ranks and threads of each
    are given."""
    found = {}
    for name, (ranks, threads) in runs.items():
        found[name] = compare(name, ranks, threads)
        wait(COMM.Ibarrier())
    if COMM.rank == 0:
        print(json.dumps(found))


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
