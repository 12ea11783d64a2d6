"""Two grains that touch grow together: their neck in time.

python draw_sintering.py      prints the neck and writes sintering.png; some seconds

Atoms of a triangular lattice hop along the surface of the grains, over a barrier for each bond.
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Box, Run, Simulation
from mesokit.method.kinetic_monte_carlo.model.sintering import Sintering
from mesokit.method.kinetic_monte_carlo.section import Lattice
from mesokit.method.kinetic_monte_carlo.start import GrainsStart
from mesokit.report.style import COLOURS, STYLE, lettered

SIZE, RADIUS, SEEDS = (96, 60), 18, 8
TIMES = np.geomspace(10, 3e5, 46)
SHOWN = (0, 24, 45)  # of these times


def main():
    """Sinter, measure, and draw."""
    lattice = Lattice(
        kind="triangular", timestep=TIMES[0], start=GrainsStart(radius=RADIUS),
        model=Sintering(bond_energy=1.0, kT=0.4),
    )  # fmt: skip
    places = lattice.lattice.places(SIZE)
    middle = abs(places[:, 0] - places[:, 0].mean()) < 1
    height = math.sqrt(3) / 2  # of a row
    steps = np.diff(np.round(TIMES / TIMES[0]).astype(int), prepend=0)
    necks, shapes, atoms = [], [], set()
    for seed in range(SEEDS):
        run = Run(steps=0, seed=seed, method="kinetic-monte-carlo")
        engine = Simulation(run=run, box=Box(SIZE), lattice=lattice).engine
        row = []
        for k, some in enumerate(steps.tolist()):
            engine.advance(some)
            sites = engine.sites()
            atoms.add(int(sites.sum()))
            row.append(sites[middle].sum() / 2 * height)  # two columns
            if seed == 0 and k in SHOWN:
                shapes.append((engine.time, places[sites == 1]))
        necks.append(row)
    mean, error = np.mean(necks, axis=0), np.std(necks, axis=0, ddof=1) / math.sqrt(SEEDS)
    times = np.cumsum(steps) * TIMES[0]
    use = (times > 1e3) & (times < 1e5)
    slope = np.polyfit(np.log(times[use]), np.log(mean[use]), 1)[0]
    print(f"atoms {atoms}; neck {mean[0]:.1f} to {mean[-1]:.1f} a")
    print(f"exponent of the neck {slope:.3f}; of surface diffusion 1/7 to 1/6 expected")

    figure = plt.figure(figsize=(8, 4), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1, 2))
    panels = [*(figure.add_subplot(grid[k, 0]) for k in range(3)), figure.add_subplot(grid[:, 1])]
    for ax, (time, atoms_at) in zip(panels, shapes, strict=False):
        ax.plot(*atoms_at.T, "o", ms=1.6, color=COLOURS[0])
        ax.set(aspect="equal", title=f"$t = {time:.0f}$", xlim=(4, 92), ylim=(4, 48))
        ax.set(xticks=[], yticks=[])
    ax = panels[3]
    ax.errorbar(times, mean, error, fmt="o", ms=4, mfc="white", color=COLOURS[0], lw=0.8,
                label=f"mean of {SEEDS}")  # fmt: skip
    guide = mean[use].mean() * (times[use] / np.exp(np.log(times[use]).mean())) ** (1 / 6)
    ax.plot(times[use], 0.8 * guide, "k--", lw=1, label="$t^{1/6}$")
    ax.set(xscale="log", yscale="log", xlabel="time $t$", ylabel="neck  [$a$]", title="neck")
    ax.set_yticks([5, 10, 20, 40], ["5", "10", "20", "40"])
    ax.minorticks_off()
    ax.legend()
    lettered(panels)
    figure.savefig("sintering.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
