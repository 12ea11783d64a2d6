"""What each collision rule conserves: in the whole fluid for 100,000 steps, and in each cell."""

from __future__ import annotations

from typing import Any

import numpy as np
from common import BLUE, GREEN, PURPLE, RED, Page, main, plt

import mesokit
from mesokit import AT, SRD, ATPlusA, Box, Fluid, Run, SRDPlusA

NAMES = {"srd": "SRD", "at": "AT-a", "srd+a": "SRD+a", "at+a": "AT+a"}
LIMIT = 1e-10


def drift(rule: Any, d: int, size: int, steps: int, samples: int = 50) -> tuple:
    """Relative drift of energy and momentum over time.

    Energy relative to the energy, momentum relative to sum m |v| at the start.
    """
    simulation = mesokit.Simulation(
        threads=1, run=Run(steps=0, seed=4), box=Box([size] * d),
        fluid=Fluid(density=5, timestep=0.1, collision=rule),
    )  # fmt: skip
    fluid = simulation.engine
    _, momentum, energy = fluid.totals()
    scale = np.linalg.norm(fluid.velocities(), axis=1).sum()
    drifts = []
    for _ in range(samples):
        fluid.advance(steps // samples)
        _, p, e = fluid.totals()
        drifts.append([abs(e / energy - 1), np.linalg.norm(p - momentum) / scale])
    return fluid.n, np.array(drifts)


def within_cells(rule: Any, d: int, size: int = 12) -> np.ndarray:
    """Largest change of energy, momentum and angular momentum in any cell by one collision.

    Without a grid shift the cells are those of the whole numbers; velocities before the collision
    are those of the step before. Relative to the sums of the absolute values in the cell.
    """
    simulation = mesokit.Simulation(
        threads=1, run=Run(steps=0, seed=4), box=Box([size] * d),
        fluid=Fluid(density=5, timestep=0.1, collision=rule, grid_shift=0),
    )  # fmt: skip
    fluid = simulation.engine
    fluid.advance(10)
    before = fluid.velocities()
    fluid.advance(1)
    after, r = fluid.velocities(), fluid.positions()
    cell = np.ravel_multi_index(tuple(np.floor(r).astype(int).T), (size,) * d, mode="wrap")

    def sums(values: np.ndarray) -> np.ndarray:
        columns = values.reshape(len(values), -1).T
        return np.array([np.bincount(cell, c, minlength=size**d) for c in columns])

    def cross(v: np.ndarray) -> np.ndarray:
        arm = r - np.floor(r) - 0.5
        return arm[:, 0] * v[:, 1] - arm[:, 1] * v[:, 0] if d == 2 else np.cross(arm, v)

    worst = []
    for quantity in (lambda v: (v**2).sum(axis=1), lambda v: v, cross):
        change = abs(sums(quantity(after)) - sums(quantity(before)))
        scale = sums(abs(quantity(before))).sum(axis=0)
        worst.append((change / np.maximum(scale, 0.1)).max())
    return np.array(worst)


def make() -> int:
    """Write the page."""
    page = Page("conservation", "Conservation")
    page.text(
        "Bulk, density 5, timestep 0.1, no thermostat. Energy relative to itself; momentum "
        "relative to sum m |v|. SRD and SRD+a run for 100,000 steps, AT for 5,000. AT draws "
        "velocities anew, so that only its momentum is conserved."
    )
    cases = [
        (SRD(angle=130), 2, 32, 100_000), (SRD(angle=130), 3, 12, 100_000),
        (SRDPlusA(angle=130), 2, 32, 100_000), (SRDPlusA(angle=130), 3, 12, 100_000),
        (AT(), 2, 32, 5_000), (AT(), 3, 12, 5_000),
        (ATPlusA(), 2, 32, 5_000), (ATPlusA(), 3, 12, 5_000),
    ]  # fmt: skip
    fig, ax = plt.subplots(figsize=(7, 4))
    looks = iter(zip((BLUE, RED, GREEN, PURPLE), "os^D", ("-", "--", "-.", ":"), strict=True))
    rows = []
    for rule, d, size, steps in cases:
        n, drifts = drift(rule, d, size, steps)
        name = f"{NAMES[rule.rule]} {d}D"
        energy, momentum = drifts.max(axis=0)
        kept = "energy" in rule.conserves
        rows.append([name, n, steps, f"{energy:.1e}" if kept else f"({energy:.1e})",
                     f"{momentum:.1e}"])  # fmt: skip
        if kept:
            page.check(f"{name}, {steps} steps: energy {energy:.1e} (below 1e-10)", energy < LIMIT)
        page.check(
            f"{name}, {steps} steps: momentum {momentum:.1e} (below 1e-10)", momentum < LIMIT
        )
        if rule.rule == "srd":
            time = np.arange(1, len(drifts) + 1) * steps / len(drifts)
            for k, what in enumerate(("energy", "momentum")):
                colour, mark, dash = next(looks)
                ax.plot(time, np.maximum(drifts[:, k], 1e-17), mark, ls=dash, ms=3, color=colour,
                        mfc="white", lw=1, label=f"{what}, {d}D")  # fmt: skip
    page.grid(["rule", "particles", "steps", "energy drift", "momentum drift"], rows)
    page.heading("Within a cell")
    page.text(
        "Largest change that one collision makes to any cell, relative to the sum of absolute "
        "values in the cell. Rules +a conserve angular momentum too. Numbers in brackets are not "
        "meant to be conserved."
    )
    inner = []
    for rule in (SRD(angle=130), SRDPlusA(angle=130), AT(), ATPlusA()):
        for d in (2, 3):
            changes = within_cells(rule, d)
            name = f"{NAMES[rule.rule]} {d}D"
            meant = ["energy" in rule.conserves, True, rule.rule.endswith("+a")]
            cells = [f"{c:.0e}" if m else f"({c:.0e})"
                     for c, m in zip(changes, meant, strict=True)]  # fmt: skip
            inner.append([name, *cells])
            worst = max(c for c, m in zip(changes, meant, strict=True) if m)
            page.check(f"{name}, in each cell: {worst:.0e} (below 1e-9)", worst < 1e-9)
    page.grid(["rule", "energy", "momentum", "angular momentum"], inner)
    ax.axhline(LIMIT, color="k", lw=1, label="limit")
    ax.set(xlabel="steps", ylabel="relative drift", yscale="log")
    ax.legend(loc="upper left", bbox_to_anchor=(0.0, 0.93), ncols=2)
    page.figure(
        fig,
        "Drift of SRD fluids over time: of the energy over itself, of the momentum over sum m |v|.",
    )
    return page.write()


if __name__ == "__main__":
    main(make)
