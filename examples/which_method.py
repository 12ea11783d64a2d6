"""Which method for grains: what soft spheres, event-driven and contact dynamics cost.

python which_method.py     writes which_method.png and which_method.md; some minutes, one core

The same gas by all, from packing fractions where spheres fly 500 radii to those of a crystal; and
a bed of grains that comes to rest. That the first two give the same physics: dilute_gas.py. From
which stiffness contact dynamics is cheaper than soft spheres: crossing.py.
"""

import math
import sys
import time
from pathlib import Path
from typing import NamedTuple

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
    RigidContact,
    RigidSpheres,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    theory,
)
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.report.style import COLOURS, LINES, MARKERS, STYLE, lettered

SHORT = "--short" in sys.argv  # a quick try
ROUNDS, SECONDS = (2, 0.05) if SHORT else (6, 0.05)  # of each measurement, in turn
GRAINS = 1000
CONTACT_TIMES = (1e-3, 1e-2, 1e-1)  # in units of diameter sqrt(m/kT)
FRACTIONS = {
    2: (1.11e-3, 1e-2, 0.1, 0.3, 0.5, 0.6, 0.75, 0.82, 0.86, 0.88, 0.89, 0.9),
    3: (4.7e-4, 1e-2, 0.1, 0.3, 0.45, 0.6, 0.68, 0.71, 0.725),
}
OPEN = {2: 0.82, 3: 0.68}  # up to where gaps are as wide as steps of contact dynamics are long
LEAST = 200  # steps of soft spheres, or collisions of all, in one measurement
METHODS = {
    HardSpheres: "event-driven",
    RigidSpheres: "contact-dynamics",
    SoftSpheres: "soft-spheres",
}
HUES = {"event-driven": COLOURS[0], "soft": COLOURS[1], "rigid": COLOURS[2]}
FORMS = {"event-driven": MARKERS[0], "soft": MARKERS[1], "rigid": MARKERS[2]}
LOOKS = (LINES[0], LINES[1], LINES[3])  # of contact times


class Cost(NamedTuple):
    """Microseconds of a core per grain and unit of time, its standard error."""

    value: float
    error: float


def engine(spheres, box, walls=(), seed=1):
    """The engine of spheres of any method."""
    run = Run(0, method=METHODS[type(spheres)], seed=seed)
    case = Case(run=run, box=box, walls=walls, spheres=spheres)
    return Simulation(case, threads=1).engine


def box_of(dimension, fraction, grains):
    """A box which so many spheres of diameter 1 fill to that fraction, on a whole lattice in 2D."""
    volume = grains * ball_volume(dimension, 1.0) / fraction
    if dimension == 3:
        return Box([volume ** (1 / 3)] * 3)
    rows = 2 * round(math.sqrt(grains / math.sqrt(3)))  # of a triangular lattice, grains/rows each
    width = math.sqrt(volume * (grains / rows) / (rows * math.sqrt(3) / 2))
    return Box([width, volume / width])


def lattice_number(dimension, about):
    """A number of spheres for which a close-packed lattice has no empty sites."""
    if dimension == 3:
        return 4 * round((about / 4) ** (1 / 3)) ** 3
    rows = 2 * round(math.sqrt(about / math.sqrt(3)))
    return rows * round(about / rows)


def once(engine, least, first):
    """CPU time and time flown of one measurement; rigid grains begin with the first state, since a
    dense elastic gas of them cools."""
    if isinstance(engine.case.spheres, RigidSpheres):
        engine.restore(first)
    begun, at = time.process_time(), engine.time
    while True:
        engine.advance(least)
        took = time.process_time() - begun
        if took > SECONDS:
            return took, engine.time - at


def costs(engines):
    """Of several engines, measured in turn."""
    firsts = [some.state() for some, _ in engines]
    for some, least in engines:
        some.advance(least)
    taken = [
        [once(*pair, first) for pair, first in zip(engines, firsts, strict=True)]
        for _ in range(ROUNDS)
    ]
    found = []
    for (some, _), rows in zip(engines, zip(*taken, strict=True), strict=True):
        each = [1e6 * took / flown / some.n for took, flown in rows]
        found.append(Cost(float(np.mean(each)), float(np.std(each, ddof=1) / math.sqrt(ROUNDS))))
    return found


def rigid_gas(hard, box):
    """The engine of rigid grains with the places and velocities of hard spheres."""
    elastic = RigidContact(friction=0.0, restitution=1.0)
    spheres = RigidSpheres(number=hard.n, kT=1.0, contact=elastic)
    case = Case(run=Run(0, method="contact-dynamics"), box=box, spheres=spheres)
    spins = np.zeros(hard.n if hard.dimension == 2 else (hard.n, 3))
    start = {"positions": hard.positions(), "velocities": hard.velocities(), "spins": spins}
    return Simulation(case, threads=1, **start).engine


def gas(dimension, fraction):
    """Costs of event-driven dynamics, soft spheres and contact dynamics, and collisions per time of
    a sphere."""
    number = lattice_number(dimension, GRAINS)
    box = box_of(dimension, fraction, number)
    rate = 2 * dimension * (pressure(dimension, fraction) - 1) / math.sqrt(math.pi)
    hard = engine(HardSpheres(number=number, timestep=min(0.2 / rate, 50.0)), box)
    soft = [
        engine(SoftSpheres(number=number, pair=SpringDashpot(restitution=1, contact_time=t)), box)
        for t in CONTACT_TIMES
    ]
    hard.advance(100)  # the lattice melts, or begins to shake
    hard.end_warmup()
    begun, engines = hard.time, [(hard, 20), *((some, LEAST) for some in soft)]
    found = costs(engines if fraction > OPEN[dimension] else [*engines, (rigid_gas(hard, box), 20)])
    found += [None] * (2 + len(CONTACT_TIMES) - len(found))
    return found, 2 * hard.collisions[0] / number / (hard.time - begun)


def pressure(dimension, fraction):
    """P/(n kT), roughly: of the fluid, or of a crystal by its free volume."""
    closest = math.pi / math.sqrt(12) if dimension == 2 else math.pi / math.sqrt(18)
    free = dimension / (1 - fraction / closest)
    fluid = fraction < (0.7 if dimension == 2 else 0.5)
    return theory.compressibility(fraction, dimension) if fluid else free


def crossing(fractions, hard, soft):
    """Where the first cost passes the second, on a straight line of logarithms; None if nowhere."""
    apart = np.log([h.value / s.value for h, s in zip(hard, soft, strict=True)])
    for k in range(len(apart) - 1):
        if apart[k] < 0 <= apart[k + 1]:
            part = -apart[k] / (apart[k + 1] - apart[k])
            return float(fractions[k] + part * (fractions[k + 1] - fractions[k]))
    return None


def bed(contact_time, seed, until):
    """Costs in each unit of time of grains that fall and come to rest: (until, 3)."""
    box, walls = Box([20, 40]), [Plates("y")]
    given = {
        "number": 300, "kinds": [SphereKind(spread=0.1)], "kT": 0.1, "gravity": [0, -1],
    }  # fmt: skip
    hard = HardSpheres(**given, collision=HardCollision(restitution=0.6, contact_time=contact_time))
    soft = SoftSpheres(**given, pair=SpringDashpot(restitution=0.6, contact_time=contact_time))
    rigid = RigidSpheres(**given, contact=RigidContact(friction=0.0, restitution=0.6))
    found, engines = [], [engine(spheres, box, walls, seed) for spheres in (hard, soft, rigid)]
    for some in engines:
        some.advance(0)
    for _ in range(until):
        row = []
        for some in engines:
            begun, at = time.process_time(), some.time
            some.advance(round(1 / some.timestep))
            row.append(1e6 * (time.process_time() - begun) / (some.time - at) / some.n)
        found.append(row)
    return np.array(found)


def rounded(cost):
    """A cost with its error in brackets, in units of the last digit."""
    digits = max(0, 1 - math.floor(math.log10(max(cost.error, 1e-12 + cost.value * 1e-3))))
    return f"{cost.value:.{digits}f}({round(cost.error * 10**digits)})"


def gases(figure_axes, lines):
    """Costs against the packing fraction."""
    for dimension, ax in figure_axes.items():
        fractions = FRACTIONS[dimension]
        rows, rates = zip(*(gas(dimension, phi) for phi in fractions), strict=True)
        hard, *soft, rigid = zip(*rows, strict=True)
        rigid = [cost for cost in rigid if cost is not None]
        lines += [
            f"## {dimension}D",
            "",
            "| packing fraction | collisions per time | event-driven | "
            + " | ".join(f"soft, {t:g}" for t in CONTACT_TIMES)
            + " | contact dynamics |",
            "|---" * (4 + len(CONTACT_TIMES)) + "|",
        ]
        for k, phi in enumerate(fractions):
            cells = ["" if cost is None else rounded(cost) for cost in rows[k]]
            lines.append(f"| {phi:g} | {rates[k]:.4g} | " + " | ".join(cells) + " |")
        lines.append("")
        for name, label, those in (
            ("event-driven", "event-driven", hard),
            ("rigid", "contact dynamics", rigid),
        ):
            ax.errorbar(
                fractions[: len(those)], [c.value for c in those], [c.error for c in those],
                fmt=FORMS[name] + "-", ms=4, color=HUES[name], label=label,
            )  # fmt: skip
        for times, look, contact_time in zip(soft, LOOKS, CONTACT_TIMES, strict=True):
            ax.errorbar(
                fractions, [c.value for c in times], [c.error for c in times],
                fmt=FORMS["soft"], mfc="white", ms=3.5, ls=look, color=HUES["soft"],
                label=f"soft, contact time {contact_time:g}",
            )  # fmt: skip
            at = crossing(fractions, hard, times)
            lines.append(
                f"Contact time {contact_time:g}: event-driven dynamics is cheaper "
                + (f"up to {at:.3f}." if at else "at all of these.")
            )
            ratios = [s.value / h.value for h, s in zip(hard, times, strict=True)]
            lines[-1] += f" Ratio of costs from {max(ratios):.0f} to {min(ratios):.2g}."
        lines.append("")
        ax.set(xscale="log", yscale="log", xlabel="packing fraction")
        ax.set_title(f"gas, {dimension}D")
    figure_axes[2].set_ylabel(r"cost  [$\mu$s per grain and $d\,\sqrt{m/kT}$]")
    figure_axes[3].legend()


def beds(ax, lines):
    """Costs against time of grains that come to rest."""
    head = "| contact time | time | event-driven | soft | contact dynamics |"
    lines += ["## Bed", "", head, "|---|---|---|---|---|"]
    for look, contact_time, until in (("-", 2e-3, 36), ("--", 1e-2, 60)):
        seeds = range(1, 3)
        all_of = np.array([bed(contact_time, seed, 5 if SHORT else until) for seed in seeds])
        mean, error = all_of.mean(axis=0), all_of.std(axis=0, ddof=1) / math.sqrt(len(seeds))
        times = np.arange(len(mean)) + 0.5
        for column, (name, label) in enumerate(
            (("event-driven", "event-driven"), ("soft", "soft"), ("rigid", "contact dynamics"))
        ):
            if name == "rigid" and look != "-":
                continue  # it has no contact time
            with_time = f", contact time {contact_time:g}" if name != "rigid" else ""
            ax.plot(
                times, mean[:, column], ls=look, color=HUES[name], label=label + with_time,
                marker=FORMS[name], markevery=5, ms=4, mfc="white" if name == "soft" else None,
            )  # fmt: skip
            low, high = (mean + sign * error for sign in (-1, 1))
            ax.fill_between(times, low[:, column], high[:, column], color=HUES[name], alpha=0.2)
        for k in range(4, len(mean), 5):
            cells = [rounded(Cost(*pair)) for pair in zip(mean[k], error[k], strict=True)]
            lines.append(f"| {contact_time:g} | {times[k]:g} | " + " | ".join(cells) + " |")
        above = np.flatnonzero(mean[:, 0] > mean[:, 1])
        if len(above):
            lines.append(f"| {contact_time:g} | {times[above[0]]:g} | dearer than soft | | |")
    lines.append("")
    ax.set(yscale="log", xlabel=r"time  [$\sqrt{d/g}$]")
    ax.set_ylabel(r"cost  [$\mu$s per grain and $\sqrt{d/g}$]")
    ax.set_title("grains that fall and come to rest, 2D")
    ax.legend()


def main():
    """Measure, write the table, draw."""
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.6), layout="constrained")
    lines = ["# Which method", "", "Microseconds of a core per grain and unit of time.", ""]
    gases({2: axes[0], 3: axes[1]}, lines)
    beds(axes[2], lines)
    axes[1].sharey(axes[0])
    axes[0].set_ylim(bottom=3e-3)  # room for legends
    axes[2].set_ylim(bottom=0.02)
    for ax in axes:
        ax.grid(alpha=0.3, lw=0.5)
    Path("which_method.md").write_text("\n".join(lines))
    print("\n".join(lines))
    lettered(axes)
    figure.savefig("which_method.png", dpi=150)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
