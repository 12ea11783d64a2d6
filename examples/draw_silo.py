"""A silo: how fast grains flow out, and how much of their weight the side walls bear.

python draw_silo.py        runs silo.toml with four holes and writes silo.png; two minutes
"""

from dataclasses import replace
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from force_chains import draw_disks, draw_forces

from mesokit import Case, Rectangle, Simulation
from mesokit.report.style import STYLE, lettered
from mesokit.theory import (
    beverloo_fit,
    beverloo_line,
    beverloo_rate,
    janssen_length,
    janssen_stress,
)

CASE = Path(__file__).with_name("silo.toml")
OPENINGS = (6, 7, 8, 10)
SHUT = 1.0  # time for which the hole stays shut once more
WIDTH, FLOOR, LEVEL = 20.0, 35.0, 34.0  # of the bin; top of the floor; plane of the outflow
EVERY = 25  # steps
FRICTION = 0.5


def with_hole(case, opening):
    """The case with another hole, which opens soon."""
    side = WIDTH / 2 - opening / 2 + 2  # of a slab, 2 of it within the side wall
    left, right = (
        Rectangle([x, LEVEL], [side, 2], name=name)
        for x, name in ((side / 2 - 2, "left slab"), (WIDTH + 2 - side / 2, "right slab"))
    )
    return replace(case, walls=[*case.walls[:2], left, right, replace(case.walls[-1], opens=SHUT)])


class Stress:
    """Vertical stress by depth, and forces on the side walls, at several times."""

    def __init__(self, top):
        self.depths = np.arange(0.0, top - FLOOR, 1.0)
        self.down, self.sides = [], []

    def sample(self, engine, top):
        """Add the contacts of now, where the surface is at `top`."""
        found, y = engine.contacts(), engine.positions()[:, 1]
        between = ~found.at_walls
        one, other = found.pairs[between].T
        up = np.where(y[one] > y[other], 1, -1) * found.forces[between, 1]
        low, high = np.minimum(y[one], y[other]), np.maximum(y[one], y[other])
        planes = (top - self.depths)[:, None]
        down = ((low < planes) & (planes < high)) @ up / WIDTH
        self.down.append(np.where(planes[:, 0] > FLOOR + 1, down, np.nan))
        inside = (found.places[:, 1] > FLOOR + 4) & (found.places[:, 1] < top - 4)
        sides = found.at_walls & (abs(found.normals[:, 0]) > 0.99) & inside
        middle = (planes[:, 0] > FLOOR + 4) & (planes[:, 0] < top - 4)
        self.sides.append([abs(found.forces[sides, 0]).sum(), found.forces[sides, 1].sum(),
                           2 * down[middle].mean() * (top - FLOOR - 8)])  # fmt: skip

    def vertical(self):
        """Mean vertical stress by depth, and its standard error, of five parts of the time."""
        parts = np.array([np.mean(part, axis=0) for part in np.array_split(self.down, 5)])
        return parts.mean(axis=0), parts.std(axis=0, ddof=1) / np.sqrt(5)

    def ratios(self):
        """Horizontal over vertical stress, and vertical over horizontal force on the sides."""
        aside, borne, down = np.mean(self.sides, axis=0)
        return aside / down, borne / aside


def surface(engine):
    """Height of the filling above the floor, if it were level."""
    y = engine.positions()[:, 1]
    return FLOOR + 2 * (y[y > FLOOR].mean() - FLOOR)


def flow(case, filled, opening):
    """Times and numbers of grains that have left, stress in the flow, the engine on its way."""
    engine = Simulation(with_hole(case, opening), threads=1, **filled).engine
    first = int((engine.positions()[:, 1] > LEVEL).sum())
    stress, times, left = Stress(surface(engine)), [0.0], [0]
    while left[-1] < 0.4 * first and engine.time < 100:
        engine.advance(EVERY)
        times.append(max(engine.time - SHUT, 0.0))
        left.append(first - int((engine.positions()[:, 1] > LEVEL).sum()))
        if 0.04 * first < left[-1] < 0.25 * first:
            stress.sample(engine, surface(engine))
    return np.array(times), np.array(left), stress, engine


def rate(times, left):
    """Grains per time from 5 to 40 % of the filling, and its standard error."""
    flows = left > 0.12 * left.max()
    parts = np.array_split(np.column_stack([times, left])[flows], 6)
    slopes = np.array([np.polyfit(*part.T, 1)[0] for part in parts])
    return slopes.mean(), slopes.std(ddof=1) / np.sqrt(len(slopes))


def main():
    """Fill the bin, open four holes, and draw flow and stress."""
    case = Case.from_toml(CASE)
    engine = Simulation(case, threads=1).engine
    engine.advance(round(case.walls[-1].opens / engine.timestep) - 1)
    filled = {"positions": engine.positions(), "velocities": engine.velocities(),
              "spins": engine.spins()}  # fmt: skip
    top, y, sizes = surface(engine), engine.positions()[:, 1], engine.diameters()
    inside = (y > FLOOR + 3) & (y < top - 3)
    fraction = np.pi / 4 * (sizes[inside] ** 2).sum() / (WIDTH * np.ptp(y[inside]))
    dense = fraction * engine.masses().sum() / (np.pi / 4 * (sizes**2).sum())
    print(f"{(y > FLOOR).sum()} grains, packing fraction {fraction:.3f}")
    rest = Stress(top)
    rest.sample(engine, top)

    runs = {opening: flow(case, filled, opening) for opening in OPENINGS}
    rates = np.array([rate(*runs[opening][:2]) for opening in OPENINGS])
    found = beverloo_fit(OPENINGS, *rates.T, sizes.mean(), dense, 1.0, 2)
    print(f"Beverloo: C = {found.prefactor:.2f} +- {found.prefactor_error:.2f}, "
          f"k = {found.blocked:.2f} +- {found.blocked_error:.2f}")  # fmt: skip
    for opening, (value, error) in zip(OPENINGS, rates, strict=True):
        law = beverloo_rate(opening, sizes.mean(), dense, 1.0, 2, found.prefactor, found.blocked)
        print(f"opening {opening}: {value:.2f} +- {error:.2f} grains per time (law {law:.2f})")

    slow = runs[OPENINGS[0]][2]
    down, error = slow.vertical()
    ratio, borne = slow.ratios()
    laws = [
        janssen_stress(slow.depths, janssen_length(WIDTH, friction, ratio, 2), dense, 1.0)
        for friction in (borne, FRICTION)
    ]
    print(f"in flow, stress ratio {ratio:.2f}, side walls bear {borne:.2f} of their normal force")
    print(f"at rest, {rest.ratios()[0]:.2f} and {rest.ratios()[1]:.2f}")
    for depth in (10, 20, 28):
        known = dense * depth, laws[0][depth], laws[1][depth]
        print(f"depth {depth}: {down[depth]:.1f} +- {error[depth]:.1f} in the flow; all the weight "
              "{:.1f}, Janssen {:.1f}, with mu {:.1f}".format(*known))  # fmt: skip

    figure, axes = plt.subplot_mosaic(
        [["rest", "flow", "left"], ["rest", "flow", "rates"], ["rest", "flow", "stress"]],
        figsize=(10, 8), width_ratios=(1, 1, 1.35), layout="constrained",
    )  # fmt: skip
    wide = runs[8][3]
    scale = 5 * engine.contacts().normal_forces.mean()
    for name, shown, words in (("rest", engine, "filled"), ("flow", wide, "in flow")):
        ax, opening = axes[name], 8 if name == "flow" else 0
        draw_disks(ax, shown)
        draw_forces(ax, shown, 2.5, scale)
        for x in (0, (WIDTH + opening) / 2):
            ax.add_patch(plt.Rectangle((x, FLOOR - 2), (WIDTH - opening) / 2, 2, color="0.3"))
        ax.set(
            xlim=(0, WIDTH),
            ylim=(FLOOR - 20, top + 3),
            aspect="equal",
            title=words,
            xlabel="$x$  [$d$]",
        )
    axes["rest"].set_ylabel("$y$  [$d$]")
    for opening, style in zip(OPENINGS, (":", "-.", "--", "-"), strict=True):
        axes["left"].plot(*runs[opening][:2], "k" + style, lw=1.2, label=f"$D = {opening}\\,d$")
    axes["left"].set(xlabel="time since the hole opens  [$\\sqrt{d/g}$]", ylabel="grains that left")
    axes["left"].legend(ncols=2)
    powers = beverloo_line(rates[:, 0], 2)
    axes["rates"].errorbar(
        OPENINGS, powers, 2 / 3 * powers * rates[:, 1] / rates[:, 0], fmt="ko", mfc="white",
        label="measured, $\\pm$ s.e.",
    )  # fmt: skip
    line = np.linspace(0, 11, 200)
    fitted = beverloo_rate(line, sizes.mean(), dense, 1.0, 2, found.prefactor, found.blocked)
    words = f"Beverloo: $C = {found.prefactor:.2f}$, $k = {found.blocked:.1f}$"
    axes["rates"].plot(line, beverloo_line(fitted, 2), color="0.5", label=words)
    axes["rates"].set(xlim=(0, 11), ylim=(0, None), xlabel="opening $D$  [$d$]",
                      ylabel="rate$^{2/3}$  [$(g/d)^{1/3}$]")  # fmt: skip
    axes["rates"].legend()
    ax = axes["stress"]
    ax.plot(rest.down[0], rest.depths, "s", ms=3, color="0.6", label="filled, at rest")
    ax.errorbar(down, slow.depths, xerr=error, fmt="ko", ms=3, mfc="white",
                label=f"in flow, $D = {OPENINGS[0]}\\,d$")  # fmt: skip
    ax.plot(laws[0], slow.depths, "k-", lw=1, label=f"Janssen, walls bear {borne:.2f}")
    ax.plot(laws[1], slow.depths, "k--", lw=1, label=rf"Janssen, $\mu = {FRICTION}$")
    ax.plot(dense * slow.depths, slow.depths, "k:", lw=1, label="all the weight")
    ax.set(xlabel="vertical stress  [$m g/d$]", ylabel="depth  [$d$]", xlim=(0, 72),
           ylim=(slow.depths[-1] + 1, 0))  # fmt: skip
    ax.legend(loc="upper right")
    lettered(list(axes.values()))
    figure.savefig("silo.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
