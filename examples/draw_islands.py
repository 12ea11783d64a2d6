"""Islands of atoms that come down, diffuse and stick: how many, by how fast they diffuse.

python draw_islands.py      prints densities of islands and writes islands.png; some seconds

The first tenth of a layer (Amar, Family and Lam 1994).
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy import ndimage

from mesokit import Box, Run, Simulation
from mesokit.method.kinetic_monte_carlo.model.islands import Islands
from mesokit.method.kinetic_monte_carlo.section import Lattice
from mesokit.method.kinetic_monte_carlo.start import UniformStart
from mesokit.report.style import COLOURS, STYLE, lettered

SIDE, PART, SEEDS = 256, 128, 2  # sites of the lattice, of what is drawn of it, and runs
HOPS = (1e3, 1e4, 1e5, 1e6)  # of an atom to each of four sites while one comes down on a site
DOSE = 0.1


def grown(hops, seed):
    """The lattice after a tenth of a layer has come down."""
    lattice = Lattice(
        timestep=DOSE, model=Islands(flux=1.0, hop_rate=hops / 4), start=UniformStart()
    )
    run = Run(steps=1, seed=seed, method="kinetic-monte-carlo")
    engine = Simulation(run=run, box=Box([SIDE, SIDE]), lattice=lattice).engine
    engine.advance(1)
    return engine.sites().reshape(SIDE, SIDE)


def islands(sites):
    """Islands of two atoms or more, per site; the edges of the lattice meet."""
    label, number = ndimage.label(sites)
    parts = np.arange(number + 1)

    def root(k):
        while parts[k] != k:
            k = parts[k]
        return k

    for one, other in ((label[0], label[-1]), (label[:, 0], label[:, -1])):
        for a, b in zip(one[(one > 0) & (other > 0)], other[(one > 0) & (other > 0)], strict=True):
            parts[root(a)] = root(b)
    sizes = np.bincount([root(k) for k in label[label > 0]])
    return (sizes > 1).sum() / sites.size


def main():
    """Grow, count, and draw."""
    figure, panels = plt.subplots(1, 3, figsize=(9, 3.2), layout="constrained")
    found = []
    for hops in HOPS:
        layers = [grown(hops, seed) for seed in range(SEEDS)]
        found.append([islands(sites) for sites in layers])
        print(f"K/F = {hops:.0e}: {np.mean(found[-1]):.5f} islands per site")
        if hops in (1e4, 1e6):
            ax = panels[0 if hops == 1e4 else 1]
            ax.imshow(layers[0][:PART, :PART].T, cmap="cividis_r", origin="lower")
            ax.set(title=f"$K/F = 10^{{{math.log10(hops):.0f}}}$", xlabel="$x$  [$a$]")
    panels[0].set_ylabel("$y$  [$a$]")
    mean = np.mean(found, axis=1)
    slope = -math.log(mean[-1] / mean[-2]) / math.log(HOPS[-1] / HOPS[-2])
    print(f"exponent of the last two {slope:.2f}, rate equations 1/3")
    ax = panels[2]
    ax.loglog(HOPS, mean[-1] * (np.array(HOPS) / HOPS[-1]) ** (-1 / 3), color="0.7", lw=3,
              label="$(K/F)^{-1/3}$")  # fmt: skip
    ax.loglog(HOPS, mean, "o", color=COLOURS[0], mfc="white", label="measured")
    ax.set(title="density", xlabel="hops over flux $K/F$", ylabel="islands per site")
    ax.set_yticks([4e-3, 1e-2, 2e-2, 4e-2], ["0.004", "0.01", "0.02", "0.04"])
    ax.minorticks_off()
    ax.legend()
    lettered(panels)
    figure.savefig("islands.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
