"""Runs whose trajectories are exported, and a reader of GSD files."""

from __future__ import annotations

import gsd.hoomd
import numpy as np

from mesokit import Harmonic, MaxwellBoltzmann, every
from mesokit.case.box import Box
from mesokit.case.case import Case
from mesokit.case.run import Run
from mesokit.case.trajectory import Trajectory
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.molecule import Molecule
from mesokit.run.simulation import Simulation

TRIMERS = Molecule(length=3, bond=Harmonic(K=2.0))


ALL = ("position", "velocity", "image")


EVERYONE = np.arange(79)  # in the mixed run


def watched(case, folder):
    """A run that remembers what it was like at each frame."""
    seen = {}

    def look(simulation):
        fluid = simulation.engine
        seen[simulation.step] = (
            fluid.positions(), fluid.velocities(), fluid.images(), fluid.bond_vectors(),
        )  # fmt: skip

    callbacks = [every(case.trajectory.every, look)] if case.trajectory else []
    simulation = Simulation(case, output=folder, threads=1, callbacks=callbacks)
    simulation.seen = seen
    return simulation


def run_of(folder, size=(6, 6, 6), steps=40, walls=(), fields=ALL, subset=None, **parts):
    """A run that has ended, in the folder."""
    box = {key: parts.pop(key) for key in ("shear_rate",) if key in parts}
    parts = {"molecule": TRIMERS, "thermostat": MaxwellBoltzmann()} | parts
    case = Case(
        run=Run(steps=steps, seed=5),
        box=Box(size, **box),
        fluid=Fluid(density=9, **parts),
        walls=walls,
        trajectory=Trajectory(every=10, fields=fields, subset=subset),
    )
    simulation = watched(case, folder)
    simulation.run()
    return simulation


def read(path):
    with gsd.hoomd.open(str(path)) as file:
        return list(file)
