"""Plane shear of rigid disks: friction and packing fraction by the inertial number, and the fabric.

python draw_shear_cell.py        runs shear_cell.toml five times, writes shear_cell.png; two minutes
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
from mesokit.theory import fraction_of_disks, friction_of_disks

CASE = Path(__file__).with_name("shear_cell.toml")
FRACTIONS = (0.74, 0.76, 0.78, 0.79, 0.8)
SHOWN = 0.78  # of which more is drawn
BINS = 18  # of directions, from 0 to 180 degrees


def sheared(fraction):
    """A run at a packing fraction, and the directions of contacts on its way."""
    case, angles = Case.from_toml(CASE), []
    case = replace(case, spheres=replace(case.spheres, packing_fraction=fraction))

    def look(running):
        found = running.engine.contacts()
        if running.step <= case.run.warmup:
            return
        angles.append(np.arctan2(*found.normals[~found.at_walls].T[::-1]) % np.pi)

    simulation = Simulation(case, threads=1, callbacks=[every(40, look)])
    simulation.run()
    return simulation, np.concatenate(angles)


def measured(simulation, what):
    """Value and standard error of a number of the rheology."""
    found = next(c for c in simulation["shear-rheology"].comparisons if c.what == what)
    return float(found.measured), float(found.error)


def main():
    """Run the densities, and draw what they measured."""
    runs = {fraction: sheared(fraction) for fraction in FRACTIONS}
    names = ("inertial number", "shear stress over pressure")
    found = np.array([[measured(runs[f][0], name) for name in names] for f in FRACTIONS])
    (inertial, frictions), fractions = found.transpose(1, 2, 0), np.array(FRACTIONS)
    for f, i, mu in zip(FRACTIONS, inertial.T, frictions.T, strict=True):
        print(f"phi = {f}: I = {i[0]:.4f} +- {i[1]:.4f}, mu = {mu[0]:.3f} +- {mu[1]:.3f}")
        print(f"  laws: mu {friction_of_disks(i[0]):.3f}, phi {fraction_of_disks(i[0]):.3f}")

    figure, axes = plt.subplot_mosaic(
        [["chains", "friction", "profile"], ["chains", "fraction", "fabric"]],
        figsize=(11, 6), width_ratios=(1.5, 1, 1), layout="constrained",
        per_subplot_kw={"fabric": {"projection": "polar"}},
    )  # fmt: skip
    line = np.linspace(0, 1.1 * inertial[0].max(), 100)
    errors = {"fmt": "ko", "mfc": "white", "label": "measured, $\\pm$ s.e."}
    law = {"color": "0.5", "label": "da Cruz et al. 2005"}
    axes["friction"].errorbar(inertial[0], frictions[0], frictions[1], inertial[1], **errors)
    axes["friction"].plot(line, friction_of_disks(line), **law)
    axes["friction"].set(ylabel=r"$\mu = \tau/P$", ylim=(0, None))
    axes["fraction"].errorbar(inertial[0], fractions, None, inertial[1], **errors)
    axes["fraction"].plot(line, fraction_of_disks(line), **law)
    axes["fraction"].set(ylabel=r"packing fraction $\varphi$")
    for name in ("friction", "fraction"):
        axes[name].set(xlabel=r"$I = \dot\gamma\sqrt{m/P}$", xlim=(0, None))
        axes[name].legend(loc="lower right" if name == "friction" else "upper right")

    simulation, angles = runs[SHOWN]
    engine, profile = simulation.engine, simulation["shear-rheology"]
    ax, size = axes["chains"], simulation.case.box.size
    draw_disks(ax, engine)
    draw_forces(ax, engine, 5)
    ax.set(xlim=(0, size[0]), ylim=(0, size[1]), aspect="equal", xlabel="$x$  [$d$]",
           ylabel="$y$  [$d$]", title=rf"$\varphi = {SHOWN}$: forces of contacts")  # fmt: skip
    rate, y = simulation.case.box.shear_rate, profile.x["y"]
    ax, mean = axes["profile"], np.mean(profile.value)
    ax.errorbar((profile.value - mean) / rate, y, xerr=profile.error / rate, **errors)
    ax.plot(y - np.mean(y), y, color="0.5", label="imposed")
    ax.set(xlabel=r"$v_x/\dot\gamma$  [$d$]", ylabel="$y$  [$d$]")
    ax.legend(loc="upper left")
    ax = axes["fabric"]
    share, edges = np.histogram(angles, BINS, (0, np.pi), density=True)
    middles = 0.5 * (edges[1:] + edges[:-1])
    both = np.concatenate([middles, middles + np.pi])
    ax.bar(both, np.tile(share * np.pi, 2), width=np.pi / BINS, color="0.75", edgecolor="black",
           lw=0.6)  # fmt: skip
    round_about = np.linspace(0, 2 * np.pi, 200)
    cosine, sine = 2 * np.cos(2 * angles).mean(), 2 * np.sin(2 * angles).mean()
    strength, direction = np.hypot(cosine, sine), 0.5 * np.arctan2(sine, cosine)
    ax.plot(round_about, 1 + strength * np.cos(2 * (round_about - direction)), "k-", lw=1)
    ax.set(title="contacts by direction",
           rticks=[1], rlim=(0, 1.6))  # fmt: skip
    ax.set_rlabel_position(60)
    ax.set_xticks(np.radians([0, 45, 90, 135]), ["0", "45", "90", "135"])
    print(f"phi = {SHOWN}: fabric 1 + {strength:.2f} cos 2(theta - "
          f"{np.degrees(direction) % 180:.0f} degrees)")  # fmt: skip
    lettered(list(axes.values()))
    figure.savefig("shear_cell.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
