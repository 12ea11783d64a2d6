"""Escape over a barrier: rates from dynamics, fed into kinetic Monte Carlo (Kramers 1940).

python draw_escape.py      prints rates and times, and writes escape.png; some seconds

Brownian particles in U = E_b (x^2 - 1)^2 sit in one of two wells for ages. How often they go over
the barrier is counted; walkers of the model `wells` then jump at that rate, with nothing between.
"""

import math
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Box, Run, Simulation, theory
from mesokit.method.brownian import Brownian
from mesokit.method.kinetic_monte_carlo.model.wells import Link, Well, Wells
from mesokit.method.kinetic_monte_carlo.section import Lattice
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.report.style import COLOURS, STYLE, lettered

BARRIER, KT, D = 6.0, 1.0, 1.0  # E_b, kT, and the diffusion coefficient kT/zeta
SIDE, NUMBER = 8.0, 3000  # of the box, and particles in it: each axis is a walker of its own
TIMESTEP, SLICE, SLICES = 5e-4, 20, 1200  # of dynamics; steps from look to look; looks
CORE = 0.8  # a walker has arrived in a well at |x| > 0.8


def dynamics():
    """Which well each walker was in last (looks, walkers), the path of one, and seconds."""
    first = np.full((NUMBER, 2), 0.5 * SIDE - 1)
    given = Brownian(density=NUMBER / SIDE**2, diffusion=D, timestep=TIMESTEP)
    run, box = Run(steps=SLICE * SLICES, method="brownian"), Box([SIDE, SIDE])
    engine = Simulation(run=run, box=box, brownian=given, positions=first, threads=1).engine
    well, wells, path = np.zeros(2 * NUMBER, bool), [], []
    engine.advance(1)  # compiles
    begun = time.perf_counter()
    for _ in range(SLICES):
        for _ in range(SLICE):
            x = engine.state()["positions"] - 0.5 * SIDE
            x -= 4 * BARRIER * x * (x * x - 1) * (D / KT * TIMESTEP)  # the force -U'
            engine.restore(engine.state() | {"positions": x + 0.5 * SIDE})
            engine.advance(1)  # the noise
        x = engine.state()["positions"].ravel() - 0.5 * SIDE
        well = np.where(abs(x) > CORE, x > 0, well)
        wells.append(well)
        path.append(x)
    took = time.perf_counter() - begun
    wells = np.array(wells)
    busy = np.argmax((wells[1:] != wells[:-1]).sum(axis=0))
    return wells, np.array(path)[:, busy], took


def jumps(rate):
    """Part of the walkers in the right well at each look, by kinetic Monte Carlo, and seconds."""
    wells = Well(name="left"), Well(name="right")
    model = Wells(well=wells, link=[Link(hop="left <-> right", rate=rate)])
    lattice = Lattice(
        kind="chain", model=model, timestep=SLICE * TIMESTEP, start=UniformStart(state="left")
    )
    run = Run(steps=SLICES, method="kinetic-monte-carlo")
    engine = Simulation(run=run, box=Box([2 * NUMBER]), lattice=lattice, threads=1).engine
    engine.advance(1)  # compiles
    right, begun = [engine.sites().mean()], time.perf_counter()
    for _ in range(SLICES - 1):
        engine.advance(1)
        right.append(engine.sites().mean())
    return np.array(right), time.perf_counter() - begun


def mean_time():
    """Of a walker from the left well to the right one, exactly: (1/D) int exp(U) int exp(-U)."""
    x, dx = np.linspace(-2, 1, 30_001, retstep=True)
    energy = BARRIER / KT * (x * x - 1) ** 2
    inner = np.cumsum(np.exp(-energy)) * dx
    passed = x > -1
    return float((np.exp(energy[passed]) * inner[passed]).sum() * dx / D)


def main():
    """Measure the rate, feed it into jumps, and compare."""
    wells, path, took = dynamics()
    times = TIMESTEP * SLICE * np.arange(1, SLICES + 1)
    hops = int((wells[1:] != wells[:-1]).sum())
    rate = hops / (2 * NUMBER * times[-1])
    kramers = theory.kramers_rate(8 * BARRIER, 4 * BARRIER, KT / D, BARRIER, KT)
    print(f"rate from {hops} escapes: {rate:.5f} +- {rate / math.sqrt(hops):.5f}")
    print(f"one over the mean time: {1 / mean_time():.5f}; Kramers: {kramers:.5f}")
    right, instead = jumps(rate)
    last = wells[-1].mean(), right[-1]
    error = math.sqrt(last[0] * (1 - last[0]) / (2 * NUMBER))
    print(f"in the right well at last: dynamics {last[0]:.4f}, jumps {last[1]:.4f} +- {error:.4f}")
    print(f"dynamics {took:.2f} s, jumps {instead:.3f} s: {took / instead:.0f} times faster")

    figure, (left, middle) = plt.subplots(1, 2, figsize=(7.5, 3.2), layout="constrained")
    left.plot(times, path, lw=0.6, color=COLOURS[0])
    left.axhline(0, color="0.6", lw=0.8, ls=":")
    left.set(xlabel="time $t$", ylabel="place $x$ of a walker", title="one that jumps often")
    left.set_ylim(-1.6, 1.6)
    middle.plot(times, 0.5 - 0.5 * np.exp(-2 * kramers * times), "k--", lw=1, label="Kramers")
    expected = theory.occupation([[0, rate], [rate, 0]], [1, 0], times)[:, 1]
    middle.plot(times, expected, color="0.75", lw=4, label="master equation, measured rate")
    middle.plot(times, wells.mean(axis=1), color=COLOURS[0], lw=1.2, label="dynamics")
    middle.plot(times, right, color=COLOURS[1], lw=1.2, label="jumps at the measured rate")
    middle.set(xlabel="time $t$", ylabel="part in the right well", title="all walkers")
    middle.set_ylim(0)
    middle.legend(fontsize=8)
    lettered([left, middle])
    figure.savefig("escape.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
