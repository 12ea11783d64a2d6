"""Bodies that move in a fluid at rest: how warm they are, how they diffuse, where they are.

Usage: python validation/bodies.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from common import BLUE, GREEN, GREY, RED, RUNS, SHORT, Page, found, main, plt, renamed
from moving_bodies import (
    DENSITY,
    L_SHAPE,
    PREFACE,
    RULES,
    SLIP,
    STEP,
    at_rest,
    case_of,
    gap_energy,
    kept,
    mean_of_parts,
    met,
    ran,
    recorded,
    share_of,
    steps,
    viscosity,
)
from published_rules import SHARE, with_published

from mesokit import (
    BodyCorrelation,
    BodyDisplacement,
    Box,
    Case,
    Comparison,
    DiskBody,
    Fluid,
    Plates,
    Run,
    Simulation,
    SphereBody,
    SRDPlusA,
    UnionBody,
    theory,
)

DISKS, DISK, SQUARE = 29, 1.5, 32  # of the structure at rest: number, radius, side of the box
CHAINS, SWEEPS = 200, 2000  # of its Monte Carlo
LEFT_OUT = (
    ("published virtual particles alone", "both rules and the hits alone are shown"),
    ("pressure of bodies at rest", "the g(r) stands for it"),
)


# ---------------------------------------------------------------- conservation


def conservation(page: Page) -> None:
    """Momentum, and the energy without virtual particles, over many steps."""
    page.heading("Conservation")
    page.text(
        "Momentum of fluid and bodies relative to sum m |v| of the start, and energy relative to "
        "itself: SRD+a without thermostat and without virtual particles, which would bring heat. "
        "The rows with virtual particles and a thermostat are of AT+a, where momentum alone is "
        "kept."
    )
    rows = []
    for name, kind, more, size in (
        ("disk, R = 2", DiskBody, {"radius": 2}, [12, 12]),
        ("union, an L", UnionBody, {"parts": L_SHAPE}, [16, 16]),
        ("sphere, R = 2", SphereBody, {"radius": 2}, [8, 8, 8]),
    ):
        for virtual, rule in (("none", "srd+a"), ("fill", "at+a")):
            number = steps(1e5)
            case = Case(
                run=Run(steps=number, seed=4), box=Box(size),
                bodies=(kind(virtual=virtual, **more),),
                fluid=Fluid(
                    density=DENSITY, timestep=STEP,
                    collision=SRDPlusA(angle=90) if virtual == "none" else RULES[rule][0],
                ),
            )  # fmt: skip
            key = f"conservation-{name}-{virtual}".replace(" ", "").replace(",", "")
            drifts = kept(page, key, case.to_toml(), lambda case=case: drifts_of(case)).tolist()
            shown = [f"{drifts[0]:.1e}", f"{drifts[1]:.1e}" if virtual == "none" else "not kept"]
            rows.append([name, f"{rule}, virtual {virtual}", number, *shown])
            worst = max(drifts) if virtual == "none" else drifts[0]
            what = "momentum and energy" if virtual == "none" else "momentum"
            page.check(
                f"{name}, {rule}, virtual {virtual}, {number} steps: {what} drift by at most "
                f"{worst:.1e} (below 1e-10)",
                worst < 1e-10,
            )
    page.grid(["body", "rule", "steps", "momentum drift", "energy drift"], rows)


def drifts_of(case: Case) -> np.ndarray:
    """By how much momentum and energy of all change in a run."""
    simulation = Simulation(case, threads=1)
    engine = simulation.engine
    _, start, energy = engine.totals()
    scale = np.linalg.norm(engine.velocities(), axis=1).sum()
    engine.advance(case.run.steps)
    _, momentum, now = engine.totals()
    return np.array([np.linalg.norm(momentum - start) / scale, abs(now / energy - 1)])


# ---------------------------------------------------------------- temperature


def equipartition(page: Page) -> None:
    """Mean squares over those of equipartition, for shapes and timesteps."""
    page.heading("Equipartition")
    page.text(
        "<V^2> M/(d kT) and the mean of <Omega_i^2> I_i/kT over axes of the body; AT+a, except "
        "where another rule is named. The velocity has the share 1 - M/M_all, as all momentum is "
        "zero."
    )
    rows, marks = [], []
    for one in at_rest():
        files, note = ran(page, f"warm-{one.key}", one.case())
        motion = files["body-motion"]
        label = f"{one.name}, {one.rule}, dt {one.timestep:g}"
        v, turning = over_theory(motion)
        counts = [found(motion, what).measured for what in ("second hits", "put back")]
        seen = f"{counts[0]:.2g} second hits, {counts[1]:.2g} put back in a step"
        rows.append(Comparison(f"{label}: <V^2> M/kT", *v, 1.0, "", note))
        rows.append(Comparison(f"{label}: <Omega^2> I/kT", *turning, 1.0, "", seen))
        marks.append((label, v, turning))
        for c in rows[-2:]:
            met(page, c.what, c, 1)
    for k in (1, 2):
        rows.append(weighted(marks, k, ""))
        met(page, rows[-1].what, rows[-1], 1)
    page.table(rows)
    fig, axis = plt.subplots(figsize=(6.5, 4.6))
    pair_of_marks(axis, marks)
    page.figure(
        fig, "Mean squares over equipartition. Error bars: one standard error.", "_equipartition"
    )


Pair = tuple[float, float]


def weighted(marks: list[tuple[str, Pair, Pair]], k: int, of: str) -> Comparison:
    """The weighted mean over runs of a mean square over theory, of V (k = 1) or Omega (2)."""
    value, error = np.array([m[k] for m in marks]).T
    mean = float((value / error**2).sum() / (1 / error**2).sum())
    square = float((((value - 1) / error) ** 2).mean())
    return Comparison(
        f"all runs{of}, weighted: {('<V^2> M/kT', '<Omega^2> I/kT')[k - 1]}", mean,
        float((1 / error**2).sum() ** -0.5), 1.0, "",
        f"mean square deviation {square:.2f} s.e.^2 of {len(value)} runs",
    )  # fmt: skip


def over_theory(motion: Any) -> tuple[Pair, Pair]:
    """Mean squares of V and Omega over theory, and their standard errors."""
    v = found(motion, "mean square velocity")
    spins = [c for c in motion.comparisons if c.what.startswith("mean square angular")]
    error = math.hypot(*(c.error for c in spins)) / len(spins)
    return (
        (v.measured / v.expected, v.error / v.expected),
        (float(np.mean([c.measured for c in spins])), error),
    )


def pair_of_marks(axis: Any, marks: list[tuple[str, Pair, Pair]]) -> None:
    """Draw both mean squares of each run."""
    places = np.arange(len(marks))[::-1]
    for shift, k, colour, shape, label in (
        (0.12, 1, BLUE, "o", "velocity"), (-0.12, 2, RED, "s", "angular velocity"),
    ):  # fmt: skip
        value, error = zip(*(m[k] for m in marks), strict=True)
        axis.errorbar(value, places + shift, xerr=error, fmt=shape, color=colour, mfc="white",
                      ms=4, label=label)  # fmt: skip
    axis.axvline(1, color=GREY, lw=1)
    axis.set(yticks=places, yticklabels=[m[0] for m in marks], xlabel="mean square over theory")
    axis.tick_params(axis="y", labelsize=7)
    axis.legend(fontsize=7)


def diffusion(page: Page) -> None:
    """Diffusion of places and angles beside the mobilities of theory."""
    page.heading("Diffusion, kT times mobility")
    page.text(
        "From the mean square displacement of places and of angles, and from the orientation. "
        "Theory is kT times the mobility of the drag laws in the same box, with the viscosities "
        "and slip lengths of [bodies in flow](bodies_in_flow.md). SRD does not conserve angular "
        "momentum: its rotation has the factor 1/(1 - c/3), with c the collisional share. The flow "
        "of the longest wave of the box lives L^2/(4 pi^2 nu), and brings more than half of D of "
        "places: 23 time units for the disk, 9 and 4 for the spheres. Lags go far beyond it."
    )
    rows = []
    for name, body, side, rule, length in (
        ("disk R = 2", DiskBody(radius=2), 20, "at+a", 6e5),
        ("sphere R = 2", SphereBody(radius=2), 12, "at+a", 1e5),
        ("sphere R = 2", SphereBody(radius=2), 12, "srd", 1e5),
    ):
        d = body.dimensions[0]
        lag = min(2000 if d == 2 else 800, steps(length) // 8)
        case = case_of(
            body, side, rule, length, BodyDisplacement(of="places", max_lag=lag, every=10),
            BodyDisplacement(name="angles", of="angles", max_lag=lag, every=10),
            BodyCorrelation(of="orientation", max_lag=lag * 2, every=10),
        )  # fmt: skip
        files, note = ran(page, f"diffusion-{d}-{rule}", case)
        friction = theory.disk_friction_in_square if d == 2 else theory.sphere_friction_in_cube
        eta, slip = viscosity(rule, d), SLIP[rule, d]
        places = 1 / friction(2.0, side, eta, slip)
        turning = 1 / theory.rotational_friction(2.0, eta, d, side, slip, share_of(rule, d))
        for of, way, known in (
            ("body-displacement", "displacement", places), ("angles", "angles", turning),
            ("body-correlation", "orientation", turning),
        ):  # fmt: skip
            for c in files[of].comparisons:
                what = f"{name}, {rule}: {'D' if known == places else 'D_r'} by {way}"
                rows.append(renamed(c, what, note, known))
                met(page, what, rows[-1], 5)
    page.table(rows)


def memory(page: Page) -> None:
    """What one timestep takes of the velocity, and how the rest decays."""
    page.heading("Velocity autocorrelation: its start and its first step")
    page.text(
        "V and Omega of one body, read after every step. C(0) is kT/M (1 - M/M_all) and kT/I. "
        "One timestep takes zeta dt/M of the velocity, where zeta is the friction by hits "
        "(`enskog_friction`) plus that by virtual particles, and zeta_r dt/I of the angular "
        "velocity; of the latter theory has the hits alone. The first order in dt is an upper "
        "bound where dt is not small: beside it stands 1 - exp(-zeta dt/M) as a note. With "
        "virtual particles a step takes less than the sum of both. Hits take h first, and what "
        "they give is in the fluid of the cells that the surface cuts, half of whose particles are "
        "virtual. Their collision gives back (1 - r1)/2 (1 - (1 - exp(-n))/n) of h, with n "
        "particles in a cell and the mean cosine r1, and takes its own part of the rest, 1 - h. "
        "The sum of both stands as a note."
    )
    rows = []
    fig, axis = plt.subplots(figsize=(5.5, 3.8))
    for name, body, side, rule, virtual, length in (
        ("sphere R = 3", SphereBody, 16, "srd", "fill", 4e3),
        ("sphere R = 3", SphereBody, 16, "srd", "none", 4e3),
        ("disk R = 3", DiskBody, 24, "at+a", "none", 3e4),
    ):
        d = body.dimensions[0]
        one = body(radius=3, virtual=virtual)
        case = case_of(one, side, rule, length)
        series = recorded(page, f"memory-{d}-{rule}-{virtual}", case, 1, motion_of_first)
        mass = one.mass_in(d, DENSITY)
        inertia = (0.5 if d == 2 else 0.4) * mass * 9
        whole = mass + DENSITY * (side**d - one.solid(d).volume)
        hits = theory.enskog_friction(3, DENSITY, mass, d, inertia=inertia)
        surface = 2 * math.pi * 3 if d == 2 else 4 * math.pi * 9
        drawn = theory.friction_by_virtual_particles(
            surface, DENSITY, STEP, d, angle=130 if rule == "srd" else None
        )
        both = hits + (drawn if virtual == "fill" else 0.0)
        turned = theory.enskog_rotational_friction(3, DENSITY, mass, inertia, d)
        label = f"{name}, {rule}, virtual {virtual}"
        first = kept_by(series[:, :d], (0, 1))
        lost, by_hits = STEP * both / mass, STEP * hits / mass
        note = f"1 - exp: {1 - math.exp(-lost):.3f}"
        if virtual == "fill":
            note = f"sum {lost:.3f}; {note}"
            turn = 1 - (1 + 2 * math.cos(math.radians(130))) / 3
            back = 0.5 * turn * (1 - (1 - math.exp(-DENSITY)) / DENSITY)
            lost = by_hits + (lost - by_hits) * (1 - by_hits) - back * by_hits
        rows.append(Comparison(f"{label}: <V^2>", *mean_of_parts(first[0], 20),
                               theory.velocity_variance(mass, whole), "a^2/tau^2",
                               f"{case.run.steps} steps"))  # fmt: skip
        rows.append(Comparison(f"{label}: part of V that a step takes", *one_less(first), lost, "",
                               note))  # fmt: skip
        spin = kept_by(series[:, d:], (0, 1))
        rows.append(
            Comparison(f"{label}: <Omega^2>", *mean_of_parts(spin[0], 20), 1 / inertia, "1/tau^2")
        )
        if virtual == "none":
            lost = STEP * turned / inertia
            rows.append(Comparison(f"{label}: part of Omega that a step takes", *one_less(spin),
                                   lost, "", f"1 - exp: {1 - math.exp(-lost):.3f}"))  # fmt: skip
        lags = range(0, 40)
        curve = np.array([x.mean() for x in kept_by(series[:, :d], lags)])
        mark, colour = (("o-", BLUE), ("s-", RED), ("^-", GREEN))[len(axis.lines) % 3]
        axis.plot(np.array(lags) * STEP, curve / curve[0], mark, ms=3, lw=1, mfc="white",
                  label=label, color=colour)  # fmt: skip
    page.table(rows)
    for c in rows:
        met(page, c.what, c, 5)
    axis.axhline(0, color=GREY, lw=1)
    axis.set(xlabel="time", ylabel="$C(t)/C(0)$")
    axis.legend(fontsize=7)
    page.figure(fig, "Correlation of the velocity at two times.", "_memory")


def motion_of_first(engine: Any) -> list[float]:
    """Velocity and angular velocity of the first body."""
    bodies = engine.bodies
    spin = np.atleast_2d(bodies.spins)[0]
    return [*bodies.velocities[0], *(spin[2:] if bodies.dimension == 2 else spin)]


def kept_by(series: np.ndarray, lags: Any) -> list[np.ndarray]:
    """Products at two times, the mean over components, for each lag."""
    n = len(series) - max(lags)
    return [(series[:n] * series[k : k + n]).mean(axis=1) for k in lags]


def one_less(pair: list[np.ndarray]) -> tuple[float, float]:
    """1 - C(1)/C(0), and its standard error from 20 blocks."""
    whole = pair[1].mean() / pair[0].mean()
    scatter = mean_of_parts(pair[1] - whole * pair[0], 20)[1] / pair[0].mean()
    return float(1 - whole), float(scatter)


def barometric(page: Page) -> None:
    """Heights of a heavy disk above a plate."""
    page.heading("Barometric heights")
    scale, wide, radius = 2.0, 16, 2.0
    page.text(
        "A disk of R = 2 between two plates, drawn down by kT/2 a cell, 2D AT+a. Theory is "
        "Boltzmann's factor of this force and of the gap potential. It diffuses over the scale of "
        "2 cells in about 400 time units, so that short runs have few independent heights."
    )
    body = DiskBody(radius=radius, force=(0.0, -1.0 / scale))
    case = case_of(body, 12, "at+a", 2e5, size=[12, wide], walls=[Plates(axis="y")])
    heights = recorded(
        page, "barometric", case, 20, lambda engine: engine.bodies.places(unwrapped=False)[0, 1]
    )
    y = np.linspace(radius + 1e-3, wide - radius - 1e-3, 4801)
    both = gap_energy(y - radius) + gap_energy(wide - radius - y)
    weight = np.exp(-y / scale - np.minimum(both, 99))
    weight /= weight.sum()
    note = f"{case.run.steps} steps"
    rows = [
        Comparison("mean height", *mean_of_parts(heights), float((y * weight).sum()), "a", note),
        Comparison(
            "mean square of the height about that mean",
            *mean_of_parts((heights - (y * weight).sum()) ** 2),
            float(((y - (y * weight).sum()) ** 2 * weight).sum()), "a^2", note,
        ),
    ]  # fmt: skip
    page.table(rows)
    for c in rows:
        met(page, f"barometric, {c.what}", c, 5)
    edges = np.arange(radius, wide - radius + 0.5, 1.0)
    shares = [np.histogram(part, edges)[0] / len(part) for part in np.array_split(heights, 10)]
    expected = np.histogram(y, edges, weights=weight)[0]
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    middle = 0.5 * (edges[1:] + edges[:-1])
    axis.errorbar(middle, np.mean(shares, axis=0), np.std(shares, axis=0, ddof=1) / math.sqrt(10),
                  fmt="o", color=BLUE, mfc="white", ms=4, label="measured")  # fmt: skip
    axis.stairs(expected, edges, color=GREY, label="Boltzmann's factor")
    axis.set(xlabel="height of the centre  [$a$]", ylabel="share of the time", yscale="log")
    axis.legend()
    page.figure(fig, "Heights of a heavy disk in bins of one cell. Error bars: one standard error, "
                "of ten parts of the run.", "_heights")  # fmt: skip


# ---------------------------------------------------------------- structure


def structure(page: Page) -> None:
    """Pair distribution of disks in the fluid beside that of the same disks without it."""
    page.heading("Structure at rest")
    fraction = DISKS * math.pi * DISK**2 / SQUARE**2
    page.text(
        f"{DISKS} disks of R = {DISK} that repel each other by the gap potential, in a square of "
        f"side {SQUARE}, {100 * fraction:.0f} % of the area, AT+a. The fluid is an ideal gas of "
        "points and must not make a force between them. So g(r) is that of the same disks without "
        f"a fluid, here by Monte Carlo: {CHAINS} chains of {SWEEPS} sweeps. A disk diffuses over "
        "its radius in about 100 time units."
    )
    body = DiskBody(radius=DISK, number=DISKS)
    case = case_of(body, SQUARE, "at+a", 5e4)
    places = recorded(page, "structure", case, 50, lambda engine: engine.bodies.places())
    edges = np.array([3.35, 3.5, 3.75, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 15.0])
    blocks_of = np.array([pair_distribution(b, edges) for b in np.array_split(places, 20)])
    value, error = blocks_of.mean(axis=0), blocks_of.std(axis=0, ddof=1) / math.sqrt(20)
    asked = f"{edges[0]} {DISKS} {DISK} {SQUARE} {CHAINS} {SWEEPS // (20 if SHORT else 1)}"
    chains = kept(page, "monte-carlo", asked, lambda: np.array(
        [pair_distribution(chain, edges) for chain in monte_carlo(SWEEPS // (20 if SHORT else 1))]
    ))  # fmt: skip
    known, unsure = chains.mean(axis=0), chains.std(axis=0, ddof=1) / math.sqrt(len(chains))
    rows = [
        Comparison(f"g(r), {a:g} < r < {b:g}", v, math.hypot(e, u), k, "",
                   f"error of the Monte Carlo {u:.1g}")
        for a, b, v, e, k, u in zip(edges[:-1], edges[1:], value, error, known, unsure, strict=True)
    ]  # fmt: skip
    page.table(rows)
    sure = [c for c in rows if c.error > 0]
    square = float(np.mean([c.deviation**2 for c in sure]))
    page.check(
        f"g(r) at rest, {case.run.steps} steps: mean square deviation of {len(sure)} bins "
        f"{square:.2f} standard errors^2 (below 2.5)",
        square < 2.5,
    )
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    middle = 0.5 * (edges[1:] + edges[:-1])
    axis.stairs(known, edges, color=GREY, label="Monte Carlo without a fluid")
    axis.errorbar(middle, value, error, fmt="o", color=BLUE, mfc="white", ms=4,
                  label="bodies in the fluid")  # fmt: skip
    axis.set(xlabel="$r$  [$a$]", ylabel="$g(r)$")
    axis.legend()
    page.figure(fig, "Pair distribution of disks at rest, in bins. Error bars: one standard error.",
                "_structure")  # fmt: skip


def pair_distribution(places: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """g(r) of places (times, number, 2) in the square, in bins of r."""
    first, second = np.triu_indices(places.shape[1], 1)
    counts = np.zeros(len(edges) - 1)
    for part in np.array_split(places, max(len(places) // 500, 1)):
        away = part[:, first] - part[:, second]
        away -= SQUARE * np.rint(away / SQUARE)
        counts += np.histogram(np.hypot(away[..., 0], away[..., 1]), edges)[0]
    rings = math.pi * np.diff(edges**2) / SQUARE**2
    return counts / (len(places) * len(first) * rings)


def monte_carlo(sweeps: int) -> np.ndarray:
    """Places of the same disks without a fluid (chains, times, number, 2), by Metropolis."""
    random = np.random.default_rng(3)
    lattice = np.stack(np.meshgrid(*[np.arange(6) + 0.5] * 2), -1).reshape(-1, 2)[:DISKS]
    x = np.repeat(lattice[None] * SQUARE / 6, CHAINS, axis=0)
    seen, every_chain = [], np.arange(CHAINS)

    def energy(places: np.ndarray, i: int) -> np.ndarray:
        away = np.delete(x, i, axis=1) - places[:, None]
        away -= SQUARE * np.rint(away / SQUARE)
        gap = np.hypot(away[..., 0], away[..., 1]) - 2 * DISK
        return np.where(gap > 0, gap_energy(gap), 1e9).sum(axis=1)

    for sweep in range(sweeps):
        for i in range(DISKS):
            new = x[:, i] + random.uniform(-1.5, 1.5, (CHAINS, 2))
            rise = energy(new, i) - energy(x[:, i], i)
            taken = every_chain[random.random(CHAINS) < np.exp(-np.clip(rise, 0, 700))]
            x[taken, i] = new[taken]
        if sweep >= sweeps // 10 and sweep % 5 == 0:
            seen.append(x.copy())
    return np.swapaxes(np.array(seen), 0, 1)


# ---------------------------------------------------------------- published rules


SAID = {
    "": "rules of the program", "hits": "published hits", "both": "both published",
}  # fmt: skip


def published(page: Page) -> None:
    """Temperature of a body with published rules of hits and of virtual particles."""
    page.heading("Published rules beside those of the program")
    page.text(
        "The same boxes with rules from the literature. Hits: each particle is reflected about "
        "the velocity that the body has at the beginning of the step, and the body takes the sum. "
        "Virtual particles: V + Omega x s and a thermal velocity, without the correction by what "
        "the motion of the body has of it. Estimates for R = 2 in 3D are + 4 % of kT/M and + 5 % "
        "of kT/I by the hits, + 12 % and + 20 % by the virtual particles; a sphere in an ideal "
        "gas, fresh in each step, had 1.12(1) and 1.18(1) with both. These rules are no option of "
        "the program: validation/published_rules.py replaces two of its functions, and compiles "
        "them apart. Their excess grows with the timestep. Runs of spheres of R = 3 and 5 are too "
        "short to tell alone."
    )
    rows, marks = [], []
    for which in ("hits", "both"):
        run_published(which)
    for one in with_published():
        label = f"{one.name}, {one.rule}, dt {one.timestep:g}"
        for which, said in SAID.items():
            run = f"published-{which}-{one.key}" if which else f"warm-{one.key}"
            files, note = ran(page, run, one.case(SHARE if which else 1.0))
            v, turning = over_theory(files["body-motion"])
            for what, (value, error) in (("<V^2> M/kT", v), ("<Omega^2> I/kT", turning)):
                rows.append(Comparison(f"{label}, {said}: {what}", value, error, 1.0, "", note))
            marks.append((f"{label}, {said}", v, turning))
    for said in SAID.values():
        some = [m for m in marks if m[0].endswith(said)]
        rows += [weighted(some, k, f", {said}") for k in (1, 2)]
    page.table(rows)
    fig, axis = plt.subplots(figsize=(6.5, 0.2 * len(marks) + 1))
    pair_of_marks(axis, marks)
    page.figure(fig, "Mean squares over equipartition, with rules of the program and published "
                "ones. Error bars: one standard error.", "_published")  # fmt: skip


def run_published(which: str) -> None:
    """Runs with published rules, in a process and with compiled code of their own."""
    store = RUNS / ("short" if SHORT else "") / "bodies" / f"code-{which}"
    script = Path(__file__).with_name("published_rules.py")
    subprocess.run(
        [sys.executable, script, which, *(["--short"] if SHORT else [])],
        check=True, env=os.environ | {"NUMBA_CACHE_DIR": str(store)},
    )  # fmt: skip


PARTS: dict[str, Callable[[Page], None]] = {
    "conservation": conservation, "equipartition": equipartition, "published": published,
    "memory": memory, "diffusion": diffusion, "barometric": barometric, "structure": structure,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies", "Bodies that move in the fluid, at rest")
    page.text(PREFACE)
    page.text("What a flow does to them, and they to a flow: [bodies in flow](bodies_in_flow.md). "
              "D in three boxes and tails: [over long times](bodies_long_times.md).")  # fmt: skip
    for name in parts:
        PARTS[name](page)
    page.heading("Not measured here")
    left = [[name, "not run for this page"] for name in PARTS if name not in parts]
    page.grid(["law", "reason"], [list(row) for row in LEFT_OUT] + left)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
