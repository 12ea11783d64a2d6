"""Soft spheres for the tests of their laws."""

import numpy as np

from mesokit import Box, Case, Run, Simulation, SoftSpheres


def soft(size, walls=(), given=None, threads=1, seed=1, observe=(), **spheres):
    """A simulation of soft spheres, not run; `given` are arrays to start from."""
    case = Case(
        run=Run(0, method="soft-spheres", seed=seed),
        box=Box(size),
        walls=list(walls),
        observe=list(observe),
        spheres=SoftSpheres(**spheres),
    )
    return Simulation(case, threads=threads, **(given or {})).engine


def at_rest(positions, **arrays):
    """Arrays of a start: without velocities and spins unless said."""
    positions = np.array(positions, float)
    n, d = positions.shape
    still = {"velocities": np.zeros((n, d)), "spins": np.zeros(n if d == 2 else (n, 3))}
    return {"positions": positions, **still, **arrays}


def total(engine):
    """Kinetic energy of both sorts and potential energy."""
    energies = engine.energies()
    return energies["translation"] + energies["rotation"] + energies["potential"]


def same(one, other):
    """Whether two engines hold the same bits."""
    first, second = one.state(), other.state()
    return all(np.array_equal(first[name], second[name]) for name in first)


def collision(law, speed, steps_per_contact, start=0.0, timestep=None):
    """Two disks of diameter and mass 1 that meet head on: the engine, and restitution, duration and
    largest overlap as simulated; `start`: part of a step by which they are apart at first."""
    time = law.contact_time_of(0.5, speed)
    dt = time / steps_per_contact if timestep is None else timestep
    away = 0.5 + 0.5 * speed * dt * (1 + start)
    places = [[5 - away, 5.0], [5 + away, 5.0]]
    velocities = np.array([[speed / 2, 0.0], [-speed / 2, 0.0]])
    engine = soft(
        [10, 10], given=at_rest(places, velocities=velocities), number=2, pair=law, timestep=dt
    )
    deepest, touching = 0.0, 0
    for _ in range(int(3 * steps_per_contact) + 10):
        engine.advance(1)
        x = engine.positions(unwrapped=True)[:, 0]
        deepest = max(deepest, 1 - (x[1] - x[0]))
        touching += int(x[1] - x[0] < 1)
    v = engine.velocities()[:, 0]
    return engine, (v[1] - v[0]) / speed, touching * dt, deepest
