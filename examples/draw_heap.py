"""Columns of grains that fall down: the heaps that friction leaves, and how steep they are.

python draw_heap.py        writes heap.png; some minutes
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

from mesokit import Box, Case, Plates, Run, Simulation, SoftSpheres, SphereKind, SpringDashpot
from mesokit.report.style import STYLE, lettered

WIDE, HIGH, LENGTH = 40, 16, 110
FRICTIONS = (0.05, 0.2, 0.4, 0.8)  # between grains, and with the floor
SEEDS = (1, 2, 3)
REST = 1e-4  # kinetic energy of a grain over its weight times a diameter
CALL = 20_000  # steps between two looks


def heap(friction, seed):
    """Places and diameters of the grains of a column that has come to rest."""
    law = SpringDashpot(restitution=0.4, contact_time=0.02, friction=friction, rolling=0.05)
    case = Case(
        run=Run(0, method="soft-spheres", seed=seed),
        box=Box([LENGTH, HIGH + 4]),
        walls=[Plates("y")],
        spheres=SoftSpheres(
            number=WIDE * HIGH,
            kinds=[SphereKind(0.9, spread=0.1)],
            kT=0.01,
            gravity=[0, -1],
            pair=law,
        ),
    )
    x, y = np.meshgrid(np.arange(WIDE) - (WIDE - 1) / 2, np.arange(HIGH))
    x = x + 0.25 * (-1.0) ** y
    places = np.column_stack([LENGTH / 2 + x.ravel(), 0.5 + y.ravel()])
    engine = Simulation(case, positions=places).engine
    while True:
        engine.advance(CALL)
        fastest = 0.5 * (engine.velocities() ** 2).sum(axis=1).max()
        if engine.time > 30 and fastest < REST:
            return engine.positions(), engine.diameters()


def slope(places, diameters):
    """The angle of the flanks, in degrees: lines through the highest grains, from 15 to 85 % of
    the height."""
    x, top = places[:, 0], places[:, 1] + diameters / 2
    edges = np.arange(0, LENGTH + 1.5, 1.5)
    which = np.digitize(x, edges) - 1
    middles = 0.5 * (edges[1:] + edges[:-1])
    high = np.array([top[which == k].max(initial=0.0) for k in range(len(middles))])
    angles = []
    for side in (middles < LENGTH / 2, middles >= LENGTH / 2):
        flank = side & (high > 0.15 * high.max()) & (high < 0.85 * high.max())
        angles.append(np.degrees(np.arctan(abs(np.polyfit(middles[flank], high[flank], 1)[0]))))
    return float(np.mean(angles))


def main():
    """Draw four heaps, and the angle of repose against friction."""
    rows = [[f"heap {k}", "angles"] for k in range(len(FRICTIONS))]
    figure, axes = plt.subplot_mosaic(
        rows, figsize=(10, 5), width_ratios=(1.8, 1), layout="constrained"
    )
    measured = []
    for k, friction in enumerate(FRICTIONS):
        angles = []
        for seed in SEEDS:
            places, diameters = heap(friction, seed)
            angles.append(slope(places, diameters))
            if seed == SEEDS[0]:
                panel(axes[f"heap {k}"], places, diameters, friction)
        measured.append((np.mean(angles), np.std(angles, ddof=1) / np.sqrt(len(angles))))
        print(f"friction {friction}: {measured[-1][0]:.1f} +- {measured[-1][1]:.1f} degrees")
    for k in range(len(FRICTIONS) - 1):
        axes[f"heap {k}"].tick_params(labelbottom=False)
    axes[f"heap {len(FRICTIONS) - 1}"].set_xlabel("$x$  [$d$]")
    ax = axes["angles"]
    ax.errorbar(
        FRICTIONS, *np.transpose(measured), fmt="o", color="black", mfc="white",
        capsize=3, label=f"heaps, mean of {len(SEEDS)} $\\pm$ s.e.",
    )  # fmt: skip
    line = np.linspace(0, 0.9, 100)
    ax.plot(
        line, np.degrees(np.arctan(line)), color="0.5", label=r"block on a slope: $\arctan\,\mu$"
    )
    ax.set(
        xlabel=r"friction $\mu$",
        ylabel="angle of the flanks  [degrees]",
        xlim=(0, 0.9),
        ylim=(0, 45),
    )
    ax.legend()
    lettered([*(axes[f"heap {k}"] for k in range(len(FRICTIONS))), ax])
    figure.savefig("heap.png", dpi=150)


def panel(ax, places, diameters, friction):
    """One heap, to scale; layers of the column that it was in grey."""
    layer = np.arange(len(places)) // (4 * WIDE) % 2
    circles = [Circle(r, d / 2) for r, d in zip(places, diameters, strict=True)]
    shades = np.where(layer == 0, 0.35, 0.75)
    ax.add_collection(
        PatchCollection(circles, facecolors=[str(s) for s in shades], edgecolors="none")
    )
    ax.set(xlim=(0, LENGTH), ylim=(0, 18), aspect="equal", ylabel="$y$  [$d$]")
    ax.set_title(rf"$\mu = {friction:g}$, {len(places)} disks", fontsize=10, loc="left")


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
