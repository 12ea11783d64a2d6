"""Observables of a fluid on one process and on 1, 2, ... ranks; says which numbers differ.

mpiexec -n 3 python -m mpi4py same_sums.py
"""

import json
import math

import numpy as np
from same_bits import COMM, HELD, POLYMERS, RUN, anywhere, compared, first_ranks

from mesokit import (
    FENE,
    WCA,
    Bending,
    BondLength,
    Box,
    Case,
    CellOccupancy,
    Conservation,
    DensityProfile,
    Disk,
    DomainSize,
    Fluid,
    Molecule,
    Plates,
    Probe,
    RadialProfile,
    Solutes,
    Species,
    Sphere,
    StructureFactor,
    SurfaceProfile,
    Uniform,
    Wake,
)
from mesokit.method.mpcd.engine import pieces
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.domains.engine import Ranks
from mesokit.method.mpcd.observe import domain_size
from mesokit.method.mpcd.start.fluid import start
from mesokit.processes.several import wait

domain_size.CLEAR = -math.inf  # noise is to have a size as well
FEW, ALL = 37, 2**18  # particles of a piece
CASES = {
    "past a post": Case(
        run=RUN,
        box=Box([40, 20]),
        fluid=Fluid(density=5, force=Uniform([0.01, 0]), thermostat=HELD),
        walls=[Plates("y"), Disk(centre=[10.3, 9.7], radius=4)],
        observe=[
            SurfaceProfile(of="temperature"),
            SurfaceProfile(of="speed", name="speed"),
            RadialProfile(centre=(20, 10), radii=(0, 8)),
            Wake(),
            Probe(),
            CellOccupancy(),
        ],
    ),
    "past a sphere": Case(
        run=RUN,
        box=Box([12, 10, 14]),
        fluid=Fluid(density=5, force=Uniform([0.01, 0, 0]), thermostat=HELD),
        walls=[Sphere(centre=[5.3, 5.1, 6.2], radius=2)],
        observe=[
            SurfaceProfile(of="speed"),
            RadialProfile(of="axial"),
            Wake(),
            Probe(centre=(2, 2, 2)),
        ],
    ),
    "two species": Case(
        run=RUN,
        box=Box([24, 20]),
        fluid=Fluid(thermostat=HELD, species=(Species(1.0, 3.0), Species(1.7, 2.0))),
        observe=[
            DomainSize(),
            StructureFactor(of="particles"),
            StructureFactor(of="particles", kind=2, name="second"),
            DensityProfile(kind=2),
            RadialProfile(of="temperature"),
            Probe(),
        ],
    ),
    "molecules": Case(
        run=RUN,
        box=Box([24, 20]),
        fluid=Fluid(
            density=6,
            thermostat=HELD,
            molecule=Molecule(length=3, bond=FENE(), pair=WCA(), bending=Bending(kappa=2.0)),
        ),
        solutes=Solutes(polymers=POLYMERS, bond=FENE(), pair=WCA(), mass=5.0),
        observe=[
            BondLength(kind="fluid"),
            BondLength(name="solute-bonds"),
            Conservation(),
            DensityProfile(of="centres", kind="fluid"),
            DensityProfile(of="ends", kind="fluid", name="ends"),
            DensityProfile(of="beads", name="solute-beads"),
            StructureFactor(of="beads", kind="fluid"),
            StructureFactor(of="beads", name="solute-waves"),
        ],
    ),
}


def course(engine, case, piece, moves):
    """All that the observables remember, borders moving between samples."""
    pieces.PIECE = piece
    accumulators = [observable.accumulator(case) for observable in case.observe]
    for k in range(3):
        engine.advance(7)
        if moves:
            engine.move_borders(anywhere(engine, k))
        for accumulator in accumulators:
            accumulator.observe(engine)
    return {
        f"{accumulator.name}: {name}": np.asarray(array)
        for accumulator in accumulators
        for name, array in accumulator.state().items()
    }


def compare(case):
    """What differs on so many ranks from one process, on rank 0."""
    found = {}
    if COMM.rank == 0:
        one = CPU(case, 2)
        start(one)
        here = course(one, case, ALL, moves=False)
    for ranks in range(1, COMM.size + 1):
        wait(COMM.Ibarrier())
        comm = first_ranks(ranks)
        if comm is not None:
            some = Ranks(case, 1, (), comm)
            start(some)
            there = course(some, case, FEW, moves=True)
        if COMM.rank == 0:
            found[ranks] = compared(here, there)
    return found


if __name__ == "__main__":
    every = {name: compare(case) for name, case in CASES.items()}
    wait(COMM.Ibarrier())
    if COMM.rank == 0:
        print(json.dumps(every))
