"""The four panels of figure 1 of Vicsek et al. (1995): birds with their ways of the last 20 steps.

python draw_vicsek_1995.py        writes vicsek_1995.png; some seconds
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import Case, Simulation
from mesokit.report.flow.birds import colours
from mesokit.report.style import STYLE

TRAIL = 20  # steps
PANELS = {  # side of the box, noise, steps before it is drawn
    "(a) start": (7, 2.0, 0),
    "(b) few, little noise": (25, 0.1, 600),
    "(c) crowded, much noise": (7, 2.0, 600),
    "(d) crowded, little noise": (5, 0.1, 2000),
}


def draw(ax, side, noise, steps):
    """One panel: run, and note the ways of the last steps."""
    given = {"box.size": [side, side], "flock.noise.strength": noise, "observe": []}
    case = Case.from_toml(Path(__file__).with_name("vicsek_1995.toml"), given)
    engine = Simulation(case).engine
    engine.advance(max(steps - TRAIL, 0))
    ways = [engine.positions(unwrapped=True)]
    while engine.step < steps:
        engine.advance(1)
        ways.append(engine.positions(unwrapped=True))
    last, heading = engine.positions(), engine.headings()
    colour = colours()(0.5 + np.arctan2(heading[:, 1], heading[:, 0]) / (2 * np.pi))
    for way, end, tint in zip(np.moveaxis(ways, 1, 0), last, colour, strict=True):
        ax.plot(*(way - way[-1] + end).T, color=tint, lw=0.7)
    ax.quiver(
        *last.T, *heading.T, color=colour, scale=26 if side < 10 else 40,  # shorter where crowded
        width=0.012 if side < 10 else 0.008, headwidth=5, headlength=6,
        headaxislength=5, pivot="tip" if steps else "mid",
    )  # fmt: skip
    ax.set(xlim=(0, side), ylim=(0, side), aspect="equal")
    ax.set_xticks([0, side])
    ax.set_yticks([0, side])


def key(figure):
    """A wheel: the colour of each heading."""
    figure.get_layout_engine().set(rect=(0, 0, 0.87, 1))
    ax = figure.add_axes((0.892, 0.44, 0.08, 0.1), projection="polar")
    ax.set_in_layout(False)
    edges = np.linspace(-np.pi, np.pi, 257)
    ax.pcolormesh(edges, (0.55, 1), np.arange(256)[None], cmap=colours(), rasterized=True)
    ax.set_title("heading", fontsize=9, pad=16)
    ax.set_xticks(np.arange(4) * np.pi / 2, ["$+x$", "$+y$", "$-x$", "$-y$"], fontsize=7)
    ax.tick_params(pad=-3)
    ax.set_yticks([])
    ax.set_ylim(0, 1)
    ax.spines["polar"].set_visible(False)
    ax.grid(False)


def main():
    """Draw all four."""
    figure, axes = plt.subplots(2, 2, figsize=(8, 7.2), layout="constrained")
    key(figure)
    for ax, (name, panel) in zip(axes.flat, PANELS.items(), strict=True):
        draw(ax, *panel)
        side, noise, steps = panel
        ax.set_title(f"{name}: $L={side}$, $\\eta={noise}$, $t={steps}$", fontsize=9, loc="left")
    figure.supxlabel("$x$, in reaches of sight", fontsize=9)
    figure.supylabel("$y$, in reaches of sight", fontsize=9)
    figure.savefig("vicsek_1995.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
