"""Soft spheres for the tests of their laws."""

import numpy as np

from mesokit import (
    Box,
    Case,
    LennardJones,
    Plates,
    RandomStart,
    Rectangle,
    Run,
    Simulation,
    SoftSpheres,
    SpringDashpot,
)


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


ROUGH = SpringDashpot(0.4, contact_time=0.02, friction=0.5)


def lennard_jones(timestep=0.004, seed=1, threads=1, skin=None, **given):
    return soft(
        [8.0, 8.0, 8.0], number=400, kT=1.0, pair=LennardJones(), timestep=timestep, seed=seed,
        threads=threads, skin=skin, **given,
    )  # fmt: skip


def pile(threads=1, skin=None, seed=1):
    return soft(
        [16, 14], walls=[Plates("y"), Rectangle(centre=[8, 2], size=[9, 3], angle=20)],
        number=60, kT=0.5, gravity=[0.0, -2.0], start=RandomStart(), pair=ROUGH,
        threads=threads, skin=skin, seed=seed,
    )  # fmt: skip
