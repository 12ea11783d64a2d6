"""Flow in a channel towards a body: the fluid, how it starts, and what the body sees of it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mesokit import SRD, Case, Fluid, MaxwellBoltzmann, Solids, Uniform, theory

PLACE = 0.25  # of the body, over the length


class Flow(NamedTuple):
    """A wake: its aim, and the fluid."""

    reynolds: int
    diameter: int
    timestep: float
    steps: float
    density: int = 16


def fluid(density: int, timestep: float, push: float) -> Fluid:
    """SRD at 90 degrees: the lowest viscosity there is."""
    return Fluid(
        density=density, timestep=timestep, collision=SRD(angle=90),
        thermostat=MaxwellBoltzmann(), force=Uniform(acceleration=(push, 0)),
    )  # fmt: skip


def viscosity_of_theory(density: int, timestep: float) -> float:
    """Kinematic."""
    return theory.transport(
        "srd", 2, density, timestep, angle=90, thermostat="maxwell-boltzmann"
    ).viscosity


def begun(case: Case, speed: float) -> tuple[Any, Any]:
    """Positions and velocities of a parabola in the fluid: near the steady state."""
    random = np.random.default_rng(case.run.seed)
    size, solids = np.array(case.box.size, float), Solids(case.walls, case.box)
    r = random.random((case.particles, 2)) * size
    bad = np.arange(len(r))
    while len(bad):
        bad = bad[solids.distance(r[bad]) < 1e-6]
        r[bad] = random.random((len(bad), 2)) * size
    v = random.standard_normal(r.shape)
    v -= v.mean(axis=0)
    v[:, 0] += 4 * speed * r[:, 1] * (size[1] - r[:, 1]) / size[1] ** 2
    return r, v


def inflow(field: Any, d: int, where: tuple[float, float] = (4, 6)) -> tuple[float, float, float]:
    """Highest velocity of the parabola before the body, its error, and in per cent by how much the
    velocity in the middle differs from it."""
    x, y = field.x["x"], field.x["y"]
    place = PLACE * (x[-1] + x[0])
    before = (x > place - where[1] * d) & (x < place - where[0] * d)
    u = field.value[before, :, 0].mean(axis=0)
    # neighbouring bins are correlated: the error of the mean of these is that of one in four
    error = np.sqrt((field.error[before, :, 0] ** 2).mean(axis=0) / (before.sum() / 4))
    shape = 4 * (y / (y[-1] + y[0])) * (1 - y / (y[-1] + y[0]))
    top = float((shape @ u) / (shape @ shape))
    spread = float(np.sqrt((shape**2 * error**2).sum() * 4) / (shape @ shape))
    middle = abs(y - (y[-1] + y[0]) / 2) < d / 4
    return top, spread, 100 * float((u[middle] / (top * shape[middle])).mean() - 1)
