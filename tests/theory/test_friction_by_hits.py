"""Friction by hits, from the published rule of reflection and random velocities; by cells, too."""

import math

import numpy as np
import pytest

from mesokit.theory import (
    enskog_friction,
    enskog_rotational_friction,
    friction_by_virtual_particles,
    velocity_variance,
)

KT, SOLVENT, RADIUS, DENSITY = 1.3, 0.8, 1.7, 5.0
HITS = 400_000


def sampled(d, mass, inertia, smooth):
    """Friction from dV and dOmega of hits, weighted by how often they happen: a body loses
    <V.dV> of <V^2> = d kT/M in a time.

    The place of a hit is along z, of which in 2D there are y and z; axes turn with it.
    """
    rng = np.random.default_rng(11)
    fluid = rng.normal(0, math.sqrt(KT / SOLVENT), (HITS, 3))
    body = rng.normal(0, math.sqrt(KT / mass), (HITS, 3))
    spin = rng.normal(0, math.sqrt(KT / inertia), (HITS, 3))
    if d == 2:
        fluid[:, 0] = body[:, 0] = 0
        spin[:, 1:] = 0
    at = np.array([0, 0, RADIUS])
    relative = fluid - body - np.cross(spin, at)
    reduced = mass * SOLVENT / (mass + SOLVENT)
    along = 0 if smooth else 1 / (1 / reduced + RADIUS**2 / inertia)
    impulse = 2 * relative * [along, along, reduced]
    area = 2 * np.pi * RADIUS if d == 2 else 4 * np.pi * RADIUS**2
    often = DENSITY * area * np.maximum(-relative[:, 2], 0)
    lost = -(often * (body * impulse).sum(1)).mean() / (d * KT / mass)
    torque = np.cross(at, impulse)
    spins = 1 if d == 2 else 3
    return lost, -(often * (spin * torque).sum(1)).mean() / (spins * KT / inertia)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("mass", [1.5, 40.0])
def test_enskog_friction_is_that_of_sampled_hits(d, mass):
    inertia = mass * RADIUS**2 / 2.3
    given = RADIUS, DENSITY, mass
    smooth, _ = sampled(d, mass, inertia, True)
    assert enskog_friction(*given, d, KT, SOLVENT) == pytest.approx(smooth, rel=0.02)
    rough, turning = sampled(d, mass, inertia, False)
    assert enskog_friction(*given, d, KT, SOLVENT, inertia) == pytest.approx(rough, rel=0.02)
    found = enskog_rotational_friction(*given, inertia, d, KT, SOLVENT)
    assert found == pytest.approx(turning, rel=0.02)


def test_heavy_bodies():
    given = 2.0, 10, 1e9
    for d, factor in ((2, 1.5), (3, 2.0)):
        smooth = enskog_friction(*given, d)
        assert enskog_friction(*given, d, inertia=math.inf) == pytest.approx(factor * smooth)
        turning = enskog_rotational_friction(*given, math.inf, d)
        assert turning == pytest.approx(smooth * 4)


@pytest.mark.parametrize(("d", "radius", "fine"), [(2, 20.0, 30), (3, 6.0, 12)])
def test_cut_cells(d, radius, fine):
    """f(1 - f) summed over all cells that a sphere or disk cuts."""
    centre = np.array([0.31, 0.17, 0.43])[:d]
    n = int(radius) + 2
    one = (np.arange(-n * fine, n * fine) + 0.5) / fine
    square = 0.0
    for axis in range(d):
        square = square + ((one - centre[axis]) ** 2).reshape(
            [-1 if i == axis else 1 for i in range(d)]
        )
    inside = (square > radius**2).reshape([2 * n, fine] * d)
    part = inside.mean(axis=tuple(range(1, 2 * d, 2)))
    surface = 2 * np.pi * radius if d == 2 else 4 * np.pi * radius**2
    expected = (part * (1 - part)).sum() * 2.5 * 7.0
    found = friction_by_virtual_particles(surface, 8.0, 0.4, d, None, 1.0)
    assert found == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("d", [2, 3])
def test_collision_of_a_cut_cell(d):
    """Rotation about the mean velocity, for random numbers of particles on both sides."""
    rng = np.random.default_rng(5)
    density, f, angle = 3.0, 0.4, 70.0
    outside, within = rng.poisson([density * f, density * (1 - f)], (200_000, 2)).T
    both = outside + within
    mean = within / np.maximum(both, 1)  # of a body of velocity 1
    kept = math.cos(math.radians(angle))
    kept = kept if d == 2 else (1 + 2 * kept) / 3
    lost = (within * (1 - (mean + kept * (1 - mean)))).mean()
    rule = friction_by_virtual_particles(1.0, density, 1.0, d, angle)
    straight = friction_by_virtual_particles(1.0, density, 1.0, d)
    assert rule / straight == pytest.approx(1 - kept)
    assert rule * f * (1 - f) / lost == pytest.approx(0.1654 if d == 3 else 0.166, rel=0.01)


def test_equipartition_without_total_momentum():
    masses, rng = np.array([20.0, 1, 1, 2, 5]), np.random.default_rng(3)
    v = rng.normal(0, np.sqrt(KT / masses), (200_000, 5))
    v -= (v @ masses / masses.sum())[:, None]
    assert velocity_variance(20.0, 29.0, KT) == pytest.approx(v[:, 0].var(), rel=0.02)


def test_hits_refuse():
    with pytest.raises(ValueError, match="inertia = 0"):
        enskog_friction(1, 1, 1, inertia=0)
    with pytest.raises(ValueError, match="total_mass = 1"):
        velocity_variance(2, 1)
    with pytest.raises(ValueError, match="surface = 0"):
        friction_by_virtual_particles(0, 1, 1)
