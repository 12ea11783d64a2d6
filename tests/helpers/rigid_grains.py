"""Rigid grains for the tests of their laws."""

import numpy as np

from mesokit import Box, Case, RandomStart, Run, Simulation, SphereKind
from mesokit.method.spheres.rigid.law.contact import RigidContact
from mesokit.method.spheres.rigid.section import RigidSpheres
from mesokit.method.spheres.rigid.solver.gauss_seidel import GaussSeidel

UNIT = SphereKind(1.0, mass=1.0)


def rigid(size, walls=(), given=None, threads=1, seed=1, box=None, contact=None, **spheres):
    """An engine of rigid grains of diameter and mass 1 that has made no step.

    given: arrays to start from, whose number is that of the grains; contact: its coefficients.
    """
    spheres.setdefault("kinds", [UNIT])
    if given is not None:
        spheres.setdefault("number", len(given["positions"]))
        spheres.setdefault("start", RandomStart())
    case = Case(
        run=Run(0, method="contact-dynamics", seed=seed),
        box=Box(size, **(box or {})),
        walls=list(walls),
        spheres=RigidSpheres(contact=RigidContact(**(contact or {})), **spheres),
    )
    return Simulation(case, threads=threads, **(given or {})).engine


def exact(order="coloured", tolerance=1e-12, sweeps=10_000):
    """A solver that goes on until impulses hardly change."""
    return GaussSeidel(order, sweeps=sweeps, tolerance=tolerance)


def at_rest(positions, **arrays):
    """Arrays of a start: without velocities and spins unless said."""
    positions = np.array(positions, float)
    n, d = positions.shape
    still = {"velocities": np.zeros((n, d)), "spins": np.zeros(n if d == 2 else (n, 3))}
    return {"positions": positions, **still, **{k: np.array(v, float) for k, v in arrays.items()}}


def impulses(engine):
    """Pairs (m, 2), the smaller number first, and the impulse on that one in the last step."""
    state = engine.state()
    return state["pairs"], state["springs"][:, : engine.dimension]


def pushes(engine):
    """Forces (m,) of pairs in the last step, along the line of centres where friction is 0."""
    return np.linalg.norm(impulses(engine)[1], axis=1) / engine.timestep


def from_walls(engine):
    """Impulse (n, walls, d) of each plane or round wall on each grain in the last step."""
    found = engine.state()["wall_springs"]
    return found.reshape(engine.n, -1, found.shape[-1])[..., : engine.dimension]


def net_impulse(engine):
    """Impulse (n, d) of all contacts on each grain in the last step."""
    pairs, found = impulses(engine)
    total = from_walls(engine).sum(axis=1)
    np.add.at(total, pairs[:, 0], found)
    np.add.at(total, pairs[:, 1], -found)
    return total


def same(one, other):
    """Whether two engines hold the same bits."""
    first, second = one.state(), other.state()
    return all(np.array_equal(first[name], second[name]) for name in first)


def energy(engine):
    """Kinetic and potential energy, and what contacts have taken."""
    found = engine.energies()
    kinetic = found["translation"] + found["rotation"]
    return kinetic + found["potential"] + sum(engine.lost.values())
