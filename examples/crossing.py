"""Soft spheres or contact dynamics: from which stiffness rigid grains are cheaper, by their number.

python crossing.py                writes crossing.png and crossing.md; an hour, one core
python crossing.py 2 400          measures 400 disks only; `crossing.jsonl` keeps what is measured

The same grains fall from the same places and come to rest by both methods; and the forces of grains
at rest are found anew in one step of contact dynamics. Costs are CPU times, and counts that nothing
else on the machine changes: contacts times steps, or times sweeps. Stiffness is K r^2/(m v^2), with
the speed v of a fall by a radius r.
"""

import contextlib
import itertools
import json
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
    GaussSeidel,
    Plates,
    RandomStart,
    RigidContact,
    RigidSpheres,
    Run,
    Simulation,
    SoftSpheres,
    SphereKind,
    SpringDashpot,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.report.style import COLOURS, LINES, STYLE, lettered, points

KEPT, WHATS = Path("crossing.jsonl"), ("cold", "rigid", "soft")
ACCURACY = 1e-2  # net force on a grain at rest over its weight, root mean square
ANEW = 1e-1  # the same of forces that are found anew, some percent of the force of a contact
SLOW = 1e-2  # speed at rest, root mean square, in sqrt(g d)
LONGEST = 60.0  # sqrt(d/g), of a settling
LOOK = 0.1  # sqrt(d/g) between two looks at whether grains rest
MOST = 40  # N^(2/d) sweeps in a step at most
GRAIN = SphereKind(diameter=1.0, spread=0.2)
FRICTION, RESTITUTION = 0.5, 0.3  # restitution of soft spheres; rigid ones have none
LOOSE, BED = {2: 0.6, 3: 0.4}, {2: 0.82, 3: 0.6}  # packing fractions of the start and the bed
SEEDS = {
    2: {100: 4, 200: 3, 400: 3, 800: 2, 1600: 2, 3200: 2, 10_000: 1},
    3: {100: 4, 250: 3, 600: 3, 1500: 2, 4000: 2},
}
SETTLED = {2: 800, 3: 600}  # largest number of rigid grains that are watched until they rest
STEPS_OF_SOFT = 2e8, 2e7  # grains times steps of soft spheres, at most; of more seeds
ALL_OF = 2, 100  # dimension and number of grains that have all stiffnesses, whatever they take
STIFFNESS = [10.0**k for k in range(2, 9)]  # K r^2/(m v^2), v^2 = g d: after a fall by a radius
STIFF = 0.05  # of N^(4/d): stiffness from which waves die out in soft spheres while they fall
EXACT = 1e-12  # tolerance with which a step has all its sweeps
CHEAP = 100  # sweeps in a step of grains that only come to rest to be looked at
COLD = [round(2 ** (k / 2)) for k in range(6, 40)]  # sweeps after which errors are looked at


def case_of(dimension, number, seed, spheres, method):
    """Grains between a floor and a lid; periodic along the other axes, and as wide as the bed is
    high."""
    volume = number * GRAIN.mean_power(dimension) * ball_volume(dimension, 1.0)
    width = (volume / BED[dimension]) ** (1 / dimension)
    height = volume / LOOSE[dimension] / width ** (dimension - 1)
    box, floor = Box([width] * (dimension - 1) + [height]), Plates("xyz"[dimension - 1])
    return Case(run=Run(0, method=method, seed=seed), box=box, walls=[floor], spheres=spheres)


def grains(dimension, number):
    """Keys of both methods."""
    down = [0] * (dimension - 1) + [-1]
    return {"number": number, "kinds": [GRAIN], "gravity": down, "start": RandomStart()}


def engine_of(case, places=None):
    """An engine whose loops are compiled, with grains at rest at some places or those of the
    case."""
    given = {}
    if places is not None:
        n, d = places.shape
        spins = np.zeros(n if d == 2 else (n, 3))
        given = {"positions": places, "velocities": np.zeros((n, d)), "spins": spins}
    engine = Simulation(case, threads=1, **given).engine
    engine.advance(0)
    return engine


def relaxed_by(dimension, number):
    """Sweeps in which the slowest error of a bed decays by e, about."""
    return theory.packing_sweeps(number, dimension, math.exp(-1), "coloured")


def rigid(dimension, number, seed, sweeps=None):
    """The engine of rigid grains; errors of forces are some ACCURACY after the last sweep, which
    changes them less by as many times as the slowest one takes sweeps to decay."""
    most = sweeps or round(MOST * number ** (2 / dimension))
    tolerance = ACCURACY / relaxed_by(dimension, number) if sweeps is None else EXACT
    solver = GaussSeidel(sweeps=most, tolerance=tolerance)
    contact = RigidContact(friction=FRICTION)
    spheres = RigidSpheres(**grains(dimension, number), contact=contact, solver=solver)
    return case_of(dimension, number, seed, spheres, "contact-dynamics")


def soft(dimension, number, seed, stiffness):
    """The case of soft spheres; stiffness: K r^2/(m v^2)."""
    pair = SpringDashpot(restitution=RESTITUTION, stiffness=4 * stiffness, friction=FRICTION)
    spheres = SoftSpheres(**grains(dimension, number), pair=pair)
    return case_of(dimension, number, seed, spheres, "soft-spheres")


def size(vectors):
    """Root mean square of vectors."""
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))


def net_force(engine):
    """Net force on a grain over its weight, root mean square, from a step; and speed."""
    before = engine.velocities()
    engine.advance(1)
    after = engine.velocities()
    return size(after - before) / engine.timestep, size(after)


def settle(case):
    """Steps, sweeps, contacts times these, and CPU time until all grains rest, and the last look.

    Contacts times sweeps: of each interval between two looks, with the mean of its ends.
    """
    engine = engine_of(case)
    engine.advance(1)
    rigid_ones = case.run.method == "contact-dynamics"
    engine.end_warmup()
    every = max(round(LOOK / engine.timestep), 2)
    touching, swept, work, took, at_most = 0, 0, 0.0, 0.0, 0
    while engine.time < LONGEST:
        began = time.process_time()
        engine.advance(every - 1)
        force, speed = net_force(engine)
        took += time.process_time() - began
        now, done = len(engine.contacts().pairs), every
        if rigid_ones:
            so_far = engine.solved.so_far
            swept, done = so_far, so_far - swept
            at_most += engine.solved.sweeps >= case.spheres.solver.sweeps
        work += done * (touching + now) / 2
        touching = now
        if force < ACCURACY and speed < SLOW:
            break
    return {
        "steps": engine.step, "sweeps": swept, "work": work, "seconds": took, "time": engine.time,
        "contacts": touching, "force": force, "speed": speed,
        "at_most": at_most / (engine.step / every), "places": engine.positions(),
    }  # fmt: skip


def cold(dimension, number, seed):
    """How the forces of grains at rest are found within one step, without earlier impulses: sweeps,
    and error of the net force over the weight, beside that after the last of these numbers."""
    falls = engine_of(rigid(dimension, number, seed, sweeps=CHEAP))
    while falls.time < 3 * number ** (0.5 / dimension) + 3:
        falls.advance(50)
    places, tried, found = falls.positions(), [], []
    for sweeps in COLD:
        if sweeps < number ** (2 / dimension) / 8:
            continue
        still = engine_of(rigid(dimension, number, seed, sweeps), places)
        still.advance(1)
        tried.append(sweeps)
        found.append(still.velocities() / still.timestep)
        if len(found) > 2 and size(found[-1] - found[-3]) < ANEW / 5:
            break
    errors = [size(forces - found[-1]) for forces in found[:-1]]
    pairs = zip(tried[:-1], errors, strict=True)
    return {"found": list(pairs), "contacts": len(still.contacts().pairs)}


def keep(what, dimension, number, seed, **more):
    """Write a line of what is measured."""
    line = {"what": what, "dimension": dimension, "number": number, "seed": seed, **more}
    line.pop("places", None)
    with KEPT.open("a") as file:
        file.write(json.dumps(line) + "\n")
    print(line, flush=True)


def kept():
    """All lines."""
    return [json.loads(line) for line in KEPT.read_text().splitlines()] if KEPT.exists() else []


def seeds_of(dimension, number):
    """The first seeds whose random starts do not jam, as many as are measured."""
    seeds = itertools.count(1)
    found = []
    while len(found) < SEEDS[dimension][number]:
        seed = next(seeds)
        with contextlib.suppress(CaseError):
            engine_of(rigid(dimension, number, seed))
            found.append(seed)
    return found


def measure(dimension, number, whats=WHATS):
    """Measure what is not yet measured of so many grains."""
    done = {(k["what"], k["dimension"], k["number"], k["seed"], k.get("stiffness")) for k in kept()}
    for rank, seed in enumerate(seeds_of(dimension, number)):
        this = dimension, number, seed
        if "cold" in whats and ("cold", *this, None) not in done:
            keep("cold", *this, **cold(*this))
        watched = "rigid" in whats and number <= SETTLED[dimension]
        if watched and ("rigid", *this, None) not in done:
            keep("rigid", *this, **settle(rigid(*this)))
        for stiffness in STIFFNESS if "soft" in whats else ():
            done_before = ("soft", *this, stiffness) in done
            steps = 50 * LONGEST / 4 / (math.pi * math.sqrt(0.5 / (4 * stiffness)))
            few = steps * number < STEPS_OF_SOFT[rank > 0]
            if not done_before and (few or (rank == 0 and (dimension, number) == ALL_OF)):
                found = settle(soft(*this, stiffness))
                keep("soft", *this, stiffness=stiffness, **found)


class Fit(NamedTuple):
    """A power law: logarithm of its factor, exponent, and its standard error."""

    factor: float
    power: float
    error: float


def power_law(numbers, values, errors):
    """Least squares of logarithms, weighted by their standard errors; the error of the exponent is
    larger where points scatter more than these say."""
    x, y, weight = np.log(numbers), np.log(values), 1 / np.square(errors)
    middle = (weight * x).sum() / weight.sum()
    spread = (weight * (x - middle) ** 2).sum()
    power = float((weight * (x - middle) * y).sum() / spread)
    factor = float((weight * y).sum() / weight.sum() - power * middle)
    off = weight * (y - factor - power * x) ** 2
    wide = max(float(off.sum()) / max(len(x) - 2, 1), 1.0)
    return Fit(factor, power, math.sqrt(wide / spread))


def means(rows, value):
    """Numbers of grains, geometric means over seeds, and standard errors of their logarithms, from
    the scatter of seeds at all numbers."""
    logs = {}
    for row in rows:
        logs.setdefault(row["number"], []).append(math.log(value(row)))
    numbers = sorted(logs)
    several = [np.var(logs[n], ddof=1) for n in numbers if len(logs[n]) > 1]
    scatter = math.sqrt(np.mean(several)) if several else 0.1
    counts = np.array([len(logs[n]) for n in numbers])
    return (
        np.array(numbers, float),
        np.exp([np.mean(logs[n]) for n in numbers]),
        scatter / np.sqrt(counts),
    )


def sweeps_to(found, accuracy=ANEW):
    """Sweeps after which an error is below an accuracy for good."""
    sweeps, errors = np.array(found).T
    after = np.flatnonzero(errors > accuracy)[-1]
    part = math.log(errors[after] / accuracy) / math.log(errors[after] / errors[after + 1])
    return float(sweeps[after] * (sweeps[after + 1] / sweeps[after]) ** part)


def of(rows, what, dimension):
    """The lines of one kind, first of each."""
    found = {}
    for row in rows:
        if row["what"] == what and row["dimension"] == dimension:
            found.setdefault((row["number"], row["seed"], row.get("stiffness")), row)
    return list(found.values())


def stiff(rows, dimension):
    """Lines of soft spheres so stiff that waves die out while they fall."""
    return [
        row
        for row in of(rows, "soft", dimension)
        if row["stiffness"] >= STIFF * row["number"] ** (4 / dimension) and row["time"] < LONGEST
    ]


def crossings(rows, dimension):
    """Power laws by name: numbers of grains, values, standard errors of their logarithms, and the
    exponent expected; and what a contact costs in a sweep over that in a step of soft spheres."""
    soft_ones, rigid_ones = stiff(rows, dimension), of(rows, "rigid", dimension)
    cold_ones, half, whole = of(rows, "cold", dimension), 2 / dimension, 4 / dimension
    found = {
        "sweeps for forces anew": (*means(cold_ones, lambda r: sweeps_to(r["found"])), half),
        "sweeps in a step": (*means(rigid_ones, lambda r: r["sweeps"] / r["steps"]), half),
        "time until rest, rigid": (*means(rigid_ones, lambda r: r["time"]), None),
        "time until rest, soft": (*means(soft_ones, lambda r: r["time"]), None),
    }
    # Whole settlings: costs of soft spheres go as the root of the stiffness.
    for name, key in (("work", "counts"), ("seconds", "CPU time")):
        numbers, costs, errors = means(rigid_ones, lambda r, n=name: r[n])
        others, roots, wrong = means(soft_ones, lambda r, n=name: r[n] / math.sqrt(r["stiffness"]))
        both = np.intersect1d(numbers, others)
        here, there = np.isin(numbers, both), np.isin(others, both)
        error = 2 * np.hypot(errors[here], wrong[there])
        found[f"whole settling, {key}"] = both, (costs[here] / roots[there]) ** 2, error, whole
    # Forces anew: a step of contact dynamics has so many sweeps from no impulses; soft spheres have
    # so many steps in its time, and as many contacts.
    step = np.mean([row["time"] / row["steps"] for row in rigid_ones])
    root = np.mean([row["time"] / row["steps"] * math.sqrt(row["stiffness"]) for row in soft_ones])
    price = math.exp(
        np.mean(np.log([row["seconds"] / row["work"] for row in rigid_ones]))
        - np.mean(np.log([row["seconds"] / row["work"] for row in soft_ones]))
    )
    for name, sweeps in (("forces anew", "sweeps for forces anew"), ("moving", "sweeps in a step")):
        numbers, values, errors, _ = found[sweeps]
        for key, factor in (("counts", 1.0), ("CPU time", price)):
            equal = (factor * values * root / step) ** 2
            found[f"{name}, {key}"] = numbers, equal, 2 * errors, whole
    return found, price


def table(rows):
    """What is measured, and exponents, as lines."""
    lines = ["# Where the costs of soft spheres and contact dynamics cross", ""]
    for dimension in (2, 3):
        found, price = crossings(rows, dimension)
        lines += [f"## {dimension}D", "", "A contact in a sweep takes"]
        lines[-1] += f" {price:.3f} of the time of one in a step of soft spheres."
        lines += ["", "| quantity | grains | value | exponent | expected |", "|---" * 5 + "|"]
        for name, (numbers, values, errors, expected) in found.items():
            fit = power_law(numbers, values, errors)
            last = f"{fit.power:.2f} +- {fit.error:.2f} | "
            last += f"{expected:.2f}" if expected else ""
            for number, value, error in zip(numbers, values, errors, strict=True):
                lines.append(
                    f"| {name} | {number:g} | {value:.3g} +- {100 * error:.0f} % | {last} |"
                )
                last = " | "
        lines += [
            "",
            "| rigid grains | seed | steps | sweeps in a step | until rest | steps with most ",
        ]
        lines[-1] += "sweeps | net force |"
        lines.append("|---" * 7 + "|")
        for row in sorted(of(rows, "rigid", dimension), key=lambda r: (r["number"], r["seed"])):
            mean, share = row["sweeps"] / row["steps"], 100 * row["at_most"]
            start = f"| {row['number']} | {row['seed']} | {row['steps']} | {mean:.0f} "
            lines.append(start + f"| {row['time']:.1f} | {share:.1f} % | {row['force']:.1e} |")
        lines += [
            "",
            "| soft spheres | seed | stiffness | steps | until rest | contacts times steps ",
        ]
        lines[-1] += "over its root |"
        lines.append("|---" * 6 + "|")
        for row in sorted(of(rows, "soft", dimension), key=lambda r: (r["number"], r["stiffness"])):
            work = row["work"] / math.sqrt(row["stiffness"])
            start = f"| {row['number']} | {row['seed']} | {row['stiffness']:.0e} | {row['steps']} "
            lines.append(start + f"| {row['time']:.1f} | {work:.3g} |")
        lines.append("")
    return lines


def draw(rows):
    """The plane of stiffness and number."""
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 4.6), layout="constrained", sharey=True)
    for ax, dimension in zip(axes, (2, 3), strict=True):
        found, _ = crossings(rows, dimension)
        reach = np.array([70.0, 16_000.0])
        law = f"$N^{{4/{dimension}}}$"
        ax.plot(reach, reach ** (4 / dimension), "-", color=COLOURS[5], lw=1.5, label=law)
        for k, name in enumerate(("whole settling", "forces anew")):
            for key, fill in (("CPU time", COLOURS[k]), ("counts", "white")):
                numbers, values, errors, _ = found[f"{name}, {key}"]
                fit = power_law(numbers, values, errors)
                bars = values * (1 - np.exp(-errors)), values * (np.exp(errors) - 1)
                said = f"{name}, {key}: {fit.power:.2f}({100 * fit.error:.0f})"
                points(ax, numbers, values, bars, k, mfc=fill, ms=5, label=said)
                at = np.array([0.8 * numbers[0], 1.25 * numbers[-1]])
                line = np.exp(fit.factor) * at**fit.power
                ax.plot(at, line, ls=LINES[1 + k], color=COLOURS[k], lw=1)
        ax.set(xscale="log", yscale="log", xlabel="number of grains $N$", xlim=reach)
        ax.set_title(f"{dimension}D; exponents, {4 / dimension:.2f} expected")
        ax.grid(alpha=0.3, lw=0.5)
        ax.legend(loc="lower right", fontsize=8)
        ax.text(0.03, 0.95, "contact dynamics cheaper", transform=ax.transAxes, va="top")
    axes[0].set_ylim(bottom=10)
    axes[0].set_ylabel(r"stiffness of equal cost  $K r^2/(m v^2)$")
    lettered(axes)
    figure.savefig("crossing.png", dpi=150)


def main():
    """Measure, write the table, draw."""
    if sys.argv[1:]:
        dimension, number, *whats = sys.argv[1:]
        measure(int(dimension), int(number), whats or WHATS)
        return
    for dimension, seeds in SEEDS.items():
        for number in seeds:
            measure(dimension, number)
    rows = kept()
    lines = table(rows)
    Path("crossing.md").write_text("\n".join(lines))
    print("\n".join(lines))
    draw(rows)


if __name__ == "__main__":
    plt.rcParams.update(STYLE)
    main()
