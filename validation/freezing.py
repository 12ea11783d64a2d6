"""Disks about freezing: pressure and hexatic order of many. Half an hour, so not in `all.py`."""

from __future__ import annotations

import math

import numpy as np
from common import BLUE, RED, Page, long, main, mean_and_error, plt

from mesokit import Box, Comparison, HardSpheres, Run, Simulation
from mesokit.observe.hexatic_order import psi_6

SIDE = 128  # disks along one
TIMES = 1200.0  # measured for so long, after half of it
BLOCKS = 20
# beta P d^2 of 1024^2 disks (Bernard and Krauth 2011); it is flat where fluid and hexatic are both
KNOWN = {0.69: math.nan, 0.70: 9.185, 0.714: 9.182, 0.72: 9.228}


def disks(phi: float) -> tuple[float, float, float, float]:
    """beta P d^2 and the size of the mean psi_6, each with its error."""
    number = SIDE * SIDE
    side = math.sqrt(number * math.pi / 4 / phi)
    engine = Simulation(
        run=Run(steps=0, seed=1, method="event-driven"),
        box=Box([side, side]),
        spheres=HardSpheres(number=number, timestep=1.0),
    ).engine
    steps = max(BLOCKS, long(TIMES))
    engine.advance(steps // 2)
    kT = 2 * engine.totals()[2] / (2 * (number - 1))
    zs, orders = [], []
    for _ in range(BLOCKS):
        virial, began = engine.virial, engine.time
        engine.advance(steps // BLOCKS)
        zs.append(1 + (engine.virial - virial) / (2 * number * kT * (engine.time - began)))
        orders.append(abs(psi_6(engine.positions(), np.array([side, side])).mean()))
    (z, dz), (order, spread) = mean_and_error(zs), mean_and_error(orders)
    return z * phi * 4 / math.pi, dz * phi * 4 / math.pi, order, spread


def make() -> int:
    """Write the page."""
    page = Page("freezing", "Disks about freezing", "diameter, kT and mass of a disk are 1")
    page.text(
        f"{SIDE}^2 disks from a triangular lattice, over {1.5 * TIMES:g} units of time, of which "
        f"the first third is left out. beta P d^2 beside 1024^2 disks of Bernard and Krauth, Phys. "
        "Rev. Lett. 107, 155704 (2011). Order changes slowly between 0.70 and 0.716, where fluid "
        "and hexatic are both there: error bars, of blocks of a twentieth, are lower bounds. "
        "Beyond, boxes of this size still have part of the loop that goes with their number (870 "
        "disks: 9.065 at 0.71), and less pressure than large ones."
    )
    rows, worst, order = [], 0.0, {}
    for phi, known in KNOWN.items():
        p, dp, psi, dpsi = disks(phi)
        order[phi] = (psi, dpsi)
        rows.append(Comparison(f"beta P d^2 at {phi}", p, dp, known))
        rows.append(Comparison(f"psi_6 of all at {phi}", psi, dpsi))
        print(rows[-2], rows[-1], flush=True)
        if math.isfinite(known):
            worst = max(worst, abs(p / known - 1))
    page.table(rows)
    page.check(f"pressure within {100 * worst:.2f} % (0.5 %)", worst < 0.005)
    low, high = order[0.69][0], order[0.72][0]
    page.check(f"psi_6 is {low:.2f} at 0.69 and {high:.2f} at 0.72 (twice)", high > 2 * low)
    fig, ax = plt.subplots(figsize=(5, 3.6))
    values, errors = np.array(list(order.values())).T
    ax.errorbar(list(order), values, errors, fmt="o", color=BLUE, mfc="white")
    ax.axvspan(0.70, 0.716, color=RED, alpha=0.15, label="fluid and hexatic")
    ax.set_xlabel("packing fraction")
    ax.set_ylabel(r"$|\langle\psi_6\rangle|$")
    ax.set_ylim(bottom=0)
    ax.legend()
    page.figure(fig, f"Hexatic order of {SIDE}^2 disks.")
    return page.write()


if __name__ == "__main__":
    main(make)
