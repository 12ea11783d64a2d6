"""Grains in a line that fly against a wall: the restitution below which they collapse.

python draw_collapse.py        writes collapse_1d.png; some seconds
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Box, Case, HardCollision, HardSpheres, Plates, Run, RunError, Simulation, theory
from mesokit.report.style import STYLE, lettered

LENGTH = 1000.0  # of the box: those that part fly on until the end
GAP = 1.0  # between grains, and to the wall, at the start
NUMBERS, SHOWN = (2, 3, 4, 8), 3
OFF = (-0.3, -0.2, -0.1, -0.05, -0.02, 0.02, 0.05, 0.1, 0.2, 0.3)  # relative, from the law


def line(number, restitution, timestep):
    """Disks of diameter 1 at even distances, all of which fly toward the wall at speed 1."""
    case = Case(
        run=Run(0, method="event-driven"),
        box=Box([LENGTH, 3]),
        walls=[Plates("x")],
        spheres=HardSpheres(number=number, timestep=timestep, collision=HardCollision(restitution)),
    )
    x = 0.5 + GAP + (1 + GAP) * np.arange(number)
    positions = np.column_stack([x, np.full(number, 1.5)])
    velocities = np.column_stack([np.full(number, -1.0), np.zeros(number)])
    return Simulation(case, positions=positions, velocities=velocities).engine


def outcome(number, restitution):
    """How many collisions there are, and whether they never end."""
    engine = line(number, restitution, 0.5 * LENGTH)
    collapsed = False
    try:
        engine.advance(1)
    except RunError:
        collapsed = True
    pairs, walls, _ = engine.collisions
    return pairs + walls, collapsed


def paths(number, restitution, until):
    """Times, and how far each disk is from where it would lie in a pile; and when it ended."""
    engine, rows = line(number, restitution, 0.02), []
    pile = 0.5 + np.arange(number)
    while engine.time < until:
        rows.append((engine.time, *(engine.positions()[:, 0] - pile)))
        try:
            engine.advance(1)
        except RunError as error:
            return np.array(rows).T, float(str(error).split("t = ")[1].split(":")[0])
    return np.array(rows).T, None


def main():
    """Draw paths of three disks just below and above the law, and numbers of collisions."""
    figure, axes = plt.subplots(
        1, 3, figsize=(11, 3.8), layout="constrained", width_ratios=(2, 2, 3)
    )
    law = theory.collapse_restitution(SHOWN)
    for ax, off in zip(axes, (-0.1, 0.1), strict=False):
        (time, *gone), ended = paths(SHOWN, law * (1 + off), 8.0)
        for k, (way, style) in enumerate(zip(gone, ("-", "--", ":"), strict=True)):
            ax.semilogy(time, way, style, color="black", label=f"disk {k + 1}")
        if ended is not None:
            ax.axvline(ended, color="0.6", lw=3, zorder=0)
            ax.text(ended + 0.2, 0.3, "collapse", fontsize=9)
        what = "below" if off < 0 else "above"
        ax.set_title(f"$e = {law * (1 + off):.3f}$, {what} {law:.4f}", fontsize=10)
        ax.set(xlabel=r"time  [$\tau$]", xlim=(0, 8), ylim=(1e-5, 5))
        ax.set_ylabel("way to its place in a pile  [$d$]")
    axes[1].legend()
    for number, mark in zip(NUMBERS, "osD^", strict=True):
        law = theory.collapse_restitution(number)
        found = [outcome(number, law * (1 + off)) for off in OFF]
        parted = [off for off, (_, collapsed) in zip(OFF, found, strict=True) if not collapsed]
        collapsed = sorted(set(OFF) - set(parted))
        print(
            f"{number} on a wall: collapse up to e = {law * (1 + collapsed[-1]):.4f}, "
            f"none from {law * (1 + parted[0]):.4f} on (law {law:.4f})"
        )
        counts = [count for count, _ in found]
        for shown, look in ((collapsed, "black"), (parted, "white")):
            at = [OFF.index(off) for off in shown]
            axes[2].semilogy(
                [1 + off for off in shown], [counts[i] for i in at], mark, mfc=look, color="black"
            )
        axes[2].plot([], [], mark, mfc="white", color="black", label=f"{number} disks: {law:.4f}")
    axes[2].axvline(1, color="0.6", lw=3, zorder=0)
    axes[2].text(0.99, 6, "collapse\n(filled)", ha="right", fontsize=9)
    axes[2].text(1.01, 6, "they part\n(open)", fontsize=9)
    axes[2].set(
        xlabel=r"restitution over $\tan^2[(\pi/4)(1 - 1/N)]$",
        ylabel="collisions until they part, or the run ends",
        xlim=(0.67, 1.33),
        ylim=(5, 5000),
    )
    axes[2].legend(loc="upper right", title="on a wall: law", title_fontsize=8)
    lettered(axes)
    figure.savefig("collapse_1d.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
