"""A ball that bounces on a floor: with and without a contact time, beside theory.

python draw_ping_pong.py        writes ping_pong.png; some seconds
"""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mesokit import (
    Box,
    Case,
    HardCollision,
    HardSpheres,
    Plates,
    Run,
    RunError,
    Simulation,
    Surface,
    SurfaceContact,
    theory,
)
from mesokit.report.style import STYLE, lettered

E, G, HEIGHT, STEP = 0.8, 1.0, 1.0, 0.01
CONTACT_TIME = 0.3  # long, so that one sees what it does


def bounces(contact_time):
    """Times, heights, bounces so far and energies of the ball; and why it ended before time."""
    floor = Surface(contact=SurfaceContact(restitution=E))
    case = Case(
        run=Run(0, method="event-driven"),
        box=Box([4, 4]),
        walls=[Plates("y", lower=floor)],
        spheres=HardSpheres(
            number=1,
            gravity=[0, -G],
            timestep=STEP,
            collision=HardCollision(contact_time=contact_time),
        ),
    )
    engine = Simulation(case, positions=[[1, 0.5 + HEIGHT]], velocities=[[0, 0]]).engine
    rows, why = [], ""
    while engine.time < 15:
        height = engine.positions()[0, 1] - 0.5
        energy = 0.5 * engine.velocities()[0, 1] ** 2 + G * height
        rows.append((engine.time, height, engine.collisions[1], energy))
        try:
            engine.advance(1)
        except RunError as error:
            why = str(error).partition(":")[0]
            break
    return np.array(rows).T, why


def flights():
    """Heights by theory, flight by flight."""
    times = [0.0, *(theory.bounce_time(HEIGHT, G, E, n) for n in range(1, 60))]
    tops = [theory.bounce_height(HEIGHT, E, n) for n in range(60)]
    at, height = (
        [np.linspace(0, times[1], 60)],
        [HEIGHT - 0.5 * G * np.linspace(0, times[1], 60) ** 2],
    )
    for n in range(1, 59):
        since = np.linspace(0, times[n + 1] - times[n], 60)
        at.append(times[n] + since)
        height.append(math.sqrt(2 * G * tops[n]) * since - 0.5 * G * since**2)
    return np.concatenate(at), np.concatenate(height)


def main():
    """Draw heights in time, and energies from bounce to bounce."""
    figure, axes = plt.subplots(
        1, 3, figsize=(11, 3.6), layout="constrained", width_ratios=(2, 2, 1.6)
    )
    end = theory.bounce_time(HEIGHT, G, E, 10_000)
    lossy = theory.dissipative_bounces(HEIGHT, G, E, CONTACT_TIME)
    names = ("no contact time", f"contact time {CONTACT_TIME:g}")
    for ax, name, contact_time in zip(axes, names, (0.0, CONTACT_TIME), strict=False):
        (time, height, count, energy), why = bounces(contact_time)
        ax.plot(*flights(), color="0.65", lw=2.5, label="theory, no contact time")
        ax.plot(time, height, color="black", lw=0.9, label="measured")
        ax.axvline(end, color="black", ls=":", lw=1)
        ax.set(xlabel=r"time  [$\sqrt{h/g}$]", ylabel="height  [$h$]", ylim=(0, 1.05), xlim=(0, 15))
        ax.set_title(name, fontsize=10)
        inset = ax.inset_axes((0.52, 0.45, 0.45, 0.3))
        inset.plot(*flights(), color="0.65", lw=2.5)
        inset.plot(time, height, color="black", lw=0.9)
        inset.set(xlim=(11, 15), ylim=(0, 0.02))
        inset.tick_params(labelsize=7)
        if why:
            ax.text(14.8, 0.3, why.replace(" at", "\nat"), ha="right", va="center", fontsize=8)
        mark = "o" if contact_time == 0 else "s"
        new = np.flatnonzero(np.diff(count, prepend=-1))
        axes[2].semilogy(
            count[new], energy[new], mark, ms=4, mfc="white", color="black", label=name
        )
    axes[0].legend(loc="upper right")
    n = np.arange(0, 46)
    axes[2].semilogy(n, E ** (2.0 * n), color="0.65", lw=2.5, zorder=0, label="theory: $e^{2n}$")
    axes[2].axhline(
        E ** (2.0 * lossy), color="black", ls="--", lw=1, label=f"theory: {lossy} lose energy"
    )
    axes[2].set(
        xlabel="bounces $n$", ylabel="energy over that of the start", xlim=(0, 46), ylim=(1e-9, 2)
    )
    axes[2].legend()
    lettered(axes)
    figure.savefig("ping_pong.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
