"""Grains poured from a funnel: the force chains of a pile, and its angle by friction.

python draw_pile.py        runs pile.toml with four frictions and writes pile.png; two minutes
"""

from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from force_chains import draw_disks, draw_forces

from mesokit import Case, Simulation
from mesokit.report.style import STYLE, lettered

CASE = Path(__file__).with_name("pile.toml")
FRICTIONS = (0.2, 0.35, 0.5, 0.8)
SHOWN = (0.2, 0.8)  # of which the force chains are drawn
BUSY = 30.0  # time at which the funnel is drawn


def pile(friction, ax=None):
    """A simulation at its end; on its way the funnel is drawn in `ax`."""
    case = Case.from_toml(CASE)
    contact = replace(case.spheres.contact, friction=friction)
    case = replace(case, spheres=replace(case.spheres, contact=contact))
    simulation = Simulation(case, threads=1)
    if ax is not None:
        simulation.run(round(BUSY / simulation.engine.timestep))
        draw_disks(ax, simulation.engine)
        for solid in case.walls[1:5]:
            low = np.array(solid.centre) - np.array(solid.size) / 2
            turn = {"angle": solid.angle, "rotation_point": "center", "color": "0.6", "lw": 0}
            ax.add_patch(plt.Rectangle(low, *solid.size, **turn))
    simulation.run()
    return simulation


def main():
    """Draw piles, and their angles against friction."""
    figure, axes = plt.subplot_mosaic(
        [["pour", "angles"], ["smooth", "smooth"], ["rough", "rough"]],
        figsize=(9, 8), height_ratios=(1.9, 1, 1), layout="constrained",
    )  # fmt: skip
    panels = dict(zip(SHOWN, ("smooth", "rough"), strict=True))
    found = []
    for friction in FRICTIONS:
        simulation = pile(friction, axes["pour"] if friction == SHOWN[-1] else None)
        engine = simulation.engine
        angle = next(c for c in simulation["repose-angle"].comparisons if "end" in c.what)
        found.append((float(angle.measured), float(angle.error)))
        print(f"friction {friction}: {found[-1][0]:.1f} +- {found[-1][1]:.1f} degrees; fastest "
              f"grain {abs(engine.velocities()).max():.1e}")  # fmt: skip
        if friction in panels:
            ax, wide = axes[panels[friction]], engine.box[0]
            draw_disks(ax, engine)
            draw_forces(ax, engine, 3)
            ax.set(xlim=(0, wide), ylim=(0, 22), aspect="equal", xlabel="$x$  [$d$]",
                   ylabel="$y$  [$d$]", title=rf"$\mu = {friction}$")  # fmt: skip
    axes["pour"].set(xlim=(40, 110), ylim=(0, 60), aspect="equal", xlabel="$x$  [$d$]",
                     ylabel="$y$  [$d$]", title=rf"$\mu = {SHOWN[-1]}$, on its way")  # fmt: skip
    ax, line = axes["angles"], np.linspace(0, 0.9, 50)
    ax.errorbar(
        FRICTIONS,
        *np.transpose(found),
        fmt="ko",
        mfc="white",
        label="piles, both flanks $\\pm$ s.e.",
    )
    ax.plot(
        line, np.degrees(np.arctan(line)), color="0.5", label=r"block on a slope: $\arctan\,\mu$"
    )
    ax.set(
        xlabel=r"friction $\mu$", ylabel="angle of repose  [degrees]", xlim=(0, 0.9), ylim=(0, 45)
    )
    ax.legend(loc="upper left")
    lettered(list(axes.values()))
    figure.savefig("pile.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
