"""Disks under isotropic pressure, with and without friction: force chains, P(f), and contacts.

python draw_compress.py        runs compress.toml twice and writes compress.png; two minutes
"""

from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from force_chains import draw_disks, draw_forces

from mesokit import Case, Simulation, every
from mesokit.report.style import STYLE, lettered
from mesokit.theory import isostatic_coordination

CASE = Path(__file__).with_name("compress.toml")
FRICTIONS = (0.0, 0.5)
LOOK = 100  # steps
DECAY = 1.4  # of P(f) above the mean, Radjai, Jean, Moreau and Roux 1996
LEAST = 1e-3  # of the mean force: less is taken for none


def coordination(engine):
    """Contacts of a grain that bears a load, twice those of all over the number of these grains."""
    found = engine.contacts()
    pushing = found.normal_forces > LEAST * found.normal_forces.mean()
    pairs = found.pairs[pushing]
    bearing = np.ones(engine.n, bool)
    fewest = 3 if engine.case.spheres.contact.friction == 0 else 2
    for _ in range(50):  # rattlers are left out, and those that leaned on them
        held = bearing[pairs[:, 0]] & ((pairs[:, 1] < 0) | bearing[pairs[:, 1]])
        pairs = pairs[held]
        number = np.bincount(pairs[pairs >= 0], minlength=engine.n)
        if (number[bearing] >= fewest).all():
            break
        bearing &= number >= fewest
    return 2 * len(pairs) / max(bearing.sum(), 1)


def compressed(friction):
    """A run with this friction; times, and contacts of a grain then."""
    case, seen = Case.from_toml(CASE), []
    contact = replace(case.spheres.contact, friction=friction)
    case = replace(case, spheres=replace(case.spheres, contact=contact))

    def look(running):
        if running.step:
            seen.append((running.engine.time, coordination(running.engine)))

    simulation = Simulation(case, threads=1, callbacks=[every(LOOK, look)])
    simulation.run()
    return simulation, np.array(seen)


def main():
    """Draw both packings, and what their forces are like."""
    figure, axes = plt.subplot_mosaic(
        [["chains 0.0", "forces"], ["chains 0.5", "contacts"]],
        figsize=(9, 8), width_ratios=(1, 1.1), layout="constrained",
    )  # fmt: skip
    for friction, marker, shade in zip(FRICTIONS, "os", ("black", "0.5"), strict=True):
        simulation, seen = compressed(friction)
        engine, forces = simulation.engine, simulation["contact-forces"]
        for name in ("contact-network", "contact-forces"):
            for found in simulation[name].comparisons:
                print(f"friction {friction}: {found.what} {float(found.measured):.3f} +- "
                      f"{float(found.error):.3f} ({float(found.expected):.3f})")  # fmt: skip
        ax = axes[f"chains {friction}"]
        draw_disks(ax, engine)
        draw_forces(ax, engine, 4)
        wide = engine.box - engine.system.plates[:, 0].reshape(2, 2).sum(axis=1)
        filled = np.pi / 4 * (engine.diameters() ** 2).sum() / wide.prod()
        print(f"friction {friction}: packing fraction {filled:.4f}, with that at the plates")
        ax.set(xlim=(-0.2, wide[0] + 0.2), ylim=(-0.2, wide[1] + 0.2), aspect="equal")
        ax.set(xlabel="$x$  [$d$]", ylabel="$y$  [$d$]", title=rf"$\mu = {friction:g}$")
        middle = 0.5 * (forces.extra["edges"][1:] + forces.extra["edges"][:-1])
        shown = forces.value > 0
        look = {"color": shade, "mfc": "white", "label": rf"$\mu = {friction:g}$"}
        axes["forces"].errorbar(middle[shown], forces.value[shown], forces.error[shown],
                                fmt=marker, **look)  # fmt: skip
        axes["contacts"].plot(*seen.T, marker + "-", lw=0.8, ms=3, **look)
        least = isostatic_coordination(2, friction > 0)
        axes["contacts"].axhline(least, color=shade, ls="--", lw=1)
        axes["contacts"].annotate(f"isostatic: {least:.0f}", (135, least - 0.12), color=shade)
    line = np.linspace(1, 6, 50)
    axes["forces"].plot(line, np.exp(-DECAY * (line - 1)) * 0.45, "k--", lw=1,
                        label=rf"slope of $e^{{-{DECAY} f}}$")  # fmt: skip
    axes["forces"].set(yscale="log", xlim=(0, 6), ylim=(1e-3, 2), ylabel="probability density",
                       xlabel=r"normal force over its mean, $f/\langle f\rangle$")  # fmt: skip
    axes["contacts"].set(xlabel=r"time  [$\sqrt{m/P}$]", xlim=(40, 163), ylim=(2, 4.4),
                         ylabel="contacts of a grain, rattlers left out")  # fmt: skip
    for name in ("forces", "contacts"):
        axes[name].legend()
    lettered(list(axes.values()))
    figure.savefig("compress.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
