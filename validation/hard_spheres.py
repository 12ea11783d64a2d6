"""Hard disks and spheres: pressure, collision rates, diffusion, cooling, contact times, gravity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from common import BLUE, Page, long, main, mean_and_error, plt
from scipy.spatial import cKDTree

from mesokit import (
    Box,
    Comparison,
    HardCollision,
    HardSpheres,
    MeanSquareDisplacement,
    Plates,
    RandomStart,
    Run,
    RunError,
    Simulation,
    SphereKind,
    theory,
)

BLOCKS = 20
CAPTION = (
    "Disks: pressure beside the virial series, and what it is over theory, with standard errors "
    "(above they are smaller than the points). Grey: the series ends too soon there."
)
UNITS = "diameter of the largest kind, kT at the start and mass of a sphere are 1"
# 870 disks in a square box, beta P d^2: Li, Nishikawa, Hoellmer, Carillo, Maggs and Krauth (2022)
DISKS = {0.67: 7.986779, 0.68: 8.513249, 0.69: 8.969898, 0.70: 9.12966, 0.71: 9.06469}
# 4000 disks, e = 0.9, packing fraction 0.1: temperature at these times over t_H, another program
COOLED = {
    0.5: (0.4482, 0.0018),
    1.0: (0.2537, 0.0011),
    1.5: (0.1641, 0.0007),
    2.0: (0.1153, 0.0008),
}
ELASTIC = {0.02: 0.0370, 0.1: 0.1697, 0.3: 0.4299}  # shares at rate * contact time, the same


def spheres(size: Any, walls: Any = (), seed: int = 1, positions: Any = None, **given: Any) -> Any:
    """The engine of some hard spheres, from a random start unless said."""
    given.setdefault("start", RandomStart())
    return Simulation(
        run=Run(steps=0, seed=seed, method="event-driven"),
        box=Box(size),
        walls=walls,
        spheres=HardSpheres(**given),
        positions=positions,
    ).engine


def pressure(engine: Any, time: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Z and the collisions of a sphere per time, with their errors, over so much time."""
    steps = max(BLOCKS, round(long(time) / engine.timestep))
    engine.advance(max(1, steps // 5))
    d, n = engine.dimension, engine.n
    kT = 2 * engine.totals()[2] / (d * (n - 1))
    zs, rates = [], []
    for _ in range(BLOCKS):
        virial, events, began = engine.virial, engine.collisions[0], engine.time
        engine.advance(steps // BLOCKS)
        passed = engine.time - began
        zs.append(1 + (engine.virial - virial) / (d * n * kT * passed))
        rates.append(2 * (engine.collisions[0] - events) / (n * passed))
    return mean_and_error(zs), mean_and_error(rates)


def three_dimensions(page: Page) -> None:
    """E3: equation of state in 3D."""
    page.heading("Spheres: pressure and collision rate (E3)")
    page.text(
        "1372 spheres, periodic. Z by the virial beside Kolafa's equation of state, the rate "
        "of collisions beside the one that belongs to that Z, and Z by the rate beside Z by "
        "the virial, which is exact."
    )
    rows, worst, identity = [], 0.0, 0.0
    for phi, time in ((0.1, 900.0), (0.3, 160.0), (0.45, 70.0)):
        size = [(1372 * math.pi / 6 / phi) ** (1 / 3)] * 3
        engine = spheres(size, number=1372, timestep=time / 200)
        (z, dz), (rate, drate) = pressure(engine, time)
        known = theory.compressibility(phi, 3)
        rows.append(Comparison(f"Z at {phi}", z, dz, known))
        worst = max(worst, abs(z / known - 1))
        expected = 6 * (known - 1) / math.sqrt(math.pi)
        rows.append(Comparison(f"collision rate at {phi}", rate, drate, expected, "1/tau"))
        identity = max(identity, abs((z - 1) / (rate * math.sqrt(math.pi) / 6) - 1))
    page.table(rows)
    page.check(f"Z within {100 * worst:.2f} % (0.3 %)", worst < 0.003)
    page.check(f"Z - 1 and the rate agree within {100 * identity:.3f} % (0.2 %)", identity < 0.002)


def two_dimensions(page: Page) -> None:
    """E4: equation of state in 2D."""
    page.heading("Disks: pressure (E4)")
    page.text("4000 disks, periodic, beside the virial series to its tenth coefficient.")
    rows, worst, densities = [], 0.0, (0.2, 0.4, 0.5, 0.6)
    measured = []
    for phi in densities:
        size = [math.sqrt(4000 * math.pi / 4 / phi)] * 2
        engine = spheres(size, number=4000, timestep=1.0)
        (z, dz), _ = pressure(engine, 60 / phi)
        known = theory.compressibility(phi, 2)
        note = "approximate: the series ends" if phi > 0.5 else ""
        rows.append(Comparison(f"Z at {phi}", z, dz, known, "", note))
        measured.append((z, dz))
        if phi <= 0.5:
            worst = max(worst, abs(z / known - 1))
    page.table(rows)
    page.check(f"Z within {100 * worst:.2f} % up to 0.5 (0.3 %)", worst < 0.003)
    page.figure(pressures(densities, measured), CAPTION)


def pressures(densities: Sequence[float], measured: Sequence[tuple[float, float]]) -> Any:
    """A figure of Z, with its error, at some densities; below what it is over theory."""
    fig, (ax, rest) = plt.subplots(
        2, 1, figsize=(5, 5), sharex=True, gridspec_kw={"height_ratios": (3, 2)}
    )
    line = np.linspace(0.05, 0.65, 60)
    ax.plot(
        line, [theory.compressibility(x, 2) for x in line], color="k", label="theory: virial series"
    )
    values, errors = np.array(measured).T
    look = {"fmt": "o", "color": BLUE, "mfc": "white"}
    ax.errorbar(densities, values, errors, label="measured", **look)
    ax.set_ylabel(r"$P/(n k_B T)$")
    ax.legend()
    known = np.array([theory.compressibility(x, 2) for x in densities])
    rest.axhline(0, color="k")
    rest.errorbar(densities, 100 * (values / known - 1), 100 * errors / known, capsize=3, **look)
    rest.axvspan(0.53, line[-1], color="0.9", zorder=0)
    rest.set(
        xlabel="packing fraction", ylabel="measured over\ntheory - 1  [%]", xlim=(line[0], line[-1])
    )
    return fig


def many_disks(page: Page) -> None:
    """E5: 870 disks about the freezing."""
    page.heading("870 disks in a square box (E5)")
    page.text(
        "beta P d^2 near freezing, where boxes of this size have a loop; beside Li et al., J. "
        "Chem. Phys. 157, 234111 (2022), who have eight digits by event-chain Monte Carlo."
    )
    rows, worst = [], 0.0
    for phi, known in DISKS.items():
        engine = spheres([30, 30], number=870, packing_fraction=phi, timestep=1.0)
        (z, dz), _ = pressure(engine, 8000.0)
        factor = phi * 4 / math.pi
        rows.append(Comparison(f"beta P d^2 at {phi}", factor * z, factor * dz, known))
        if phi < 0.685:
            worst = max(worst, abs(factor * z / known - 1))
    page.table(rows)
    page.check(f"within {100 * worst:.2f} % at 0.67 and 0.68 (0.1 %)", worst < 0.001)
    deviation = max(abs(row.deviation) for row in rows)
    page.check(f"all within {deviation:.1f} standard errors (3.5)", deviation < 3.5)


def motion(page: Page) -> None:
    """E7 and S2: free times, diffusion, free paths."""
    page.heading("Free times, free paths and diffusion (E7)")
    page.text(
        "1372 spheres at a density of 0.5; Lue (2005) has a mean free time of 0.13031 and, "
        "for a box of this size, D = 0.247. Dilute gases whose free path is 500 radii: "
        "sqrt(2) times the flux of others gives 0.5554/phi radii in 2D and 0.2357/phi in 3D, over "
        "the pair distribution at contact (1.0017 and 1.0012 here)."
    )
    engine = spheres([14] * 3, number=1372, timestep=1.0)
    _, (rate, drate) = pressure(engine, 200.0)
    rows = [Comparison("mean free time", 1 / rate, drate / rate**2, 0.13031, "tau")]
    moved = MeanSquareDisplacement(every=1, max_lag=200).accumulator(engine.case)
    for _ in range(max(200, long(1500))):
        engine.advance(1)
        moved.observe(engine)
    slope = moved.result()["diffusion coefficient"]
    note = "approximate: known to 2 %"
    rows.append(Comparison("D", slope.measured, slope.error, 0.247, "a^2/tau", note))
    paths = []
    for d, phi, factor in ((2, 1.11e-3, 0.5554), (3, 4.7e-4, 0.2357)):
        volume = math.pi / 4 if d == 2 else math.pi / 6
        gas = spheres([(2000 * volume / phi) ** (1 / d)] * d, number=2000, timestep=100.0)
        _, (rate, drate) = pressure(gas, 40_000.0)
        speed = float(np.linalg.norm(gas.velocities(), axis=1).mean())
        mean_speed = math.sqrt(math.pi / 2) if d == 2 else math.sqrt(8 / math.pi)
        path = mean_speed / rate * 2
        expected = factor / phi / theory.contact_value(phi, d)
        what = f"free path in radii, {d}D, packing fraction {phi}"
        rows.append(Comparison(what, path, path * drate / rate, expected))
        paths.append(abs(path / expected - 1))
        assert abs(speed / mean_speed - 1) < 0.1
    page.table(rows)
    page.check(
        f"mean free time within {abs(rows[0].percent):.2f} % (0.5 %)", abs(rows[0].percent) < 0.5
    )
    page.check(f"D within {abs(rows[1].percent):.1f} % (4 %)", abs(rows[1].percent) < 4)
    page.check(f"free paths within {100 * max(paths):.2f} % (2 %)", max(paths) < 0.02)


def cooling(page: Page) -> None:
    """E8: Haff's law."""
    page.heading("A gas that cools (E8)")
    haff = theory.haff_time(0.9, theory.enskog_rate(0.4 / math.pi, 1.0, 1.0, 0.1, 2), 2)
    page.text(
        f"4000 disks, e = 0.9, packing fraction 0.1, t_H = {haff:.2f}: temperature over that "
        "of the start, mean of four runs, beside Haff's law, of molecular chaos, and "
        "another program. Disks that meet again collide less often, so the gas stays warmer."
    )
    gases = [
        spheres(
            [math.sqrt(1000 * math.pi / 0.1)] * 2,
            seed=seed,
            number=4000,
            timestep=haff / 2,
            collision=HardCollision(0.9),
        )
        for seed in range(1, 5)
    ]
    rows, worst, other = [], 0.0, 0.0
    for time, (known, _) in COOLED.items():
        for gas in gases:
            gas.advance(1)
        value, error = mean_and_error([gas.totals()[2] / (gas.n - 1) for gas in gases])
        law = float(theory.haff_temperature(time, 1.0))
        note = f"approximate: molecular chaos; another program {known}"
        rows.append(Comparison(f"T at {time} t_H", value, error, law, "", note))
        worst, other = max(worst, abs(value / law - 1)), max(other, abs(value / known - 1))
    page.table(rows)
    page.check(f"within {100 * worst:.1f} % of the law (5 %)", worst < 0.05)
    page.check(f"within {100 * other:.1f} % of the other program (3 %)", other < 0.03)


def contact_times(page: Page) -> None:
    """E9: what a contact time does."""
    page.heading("Contact times (E9)")
    rate = theory.enskog_rate(1 / math.pi, 1.0, 1.0, 0.25, 2)
    page.text(
        "Elastic disks at 0.25: the share of collisions that come sooner than the contact "
        "time after the last of one of both, beside another program, whose error is not known."
    )
    rows = []
    for x, known in ELASTIC.items():
        engine = spheres(
            [56.05] * 2,
            number=1000,
            timestep=20.0,
            collision=HardCollision(contact_time=x / rate),
        )
        engine.advance(1)
        engine.end_warmup()
        engine.advance(max(2, long(60)))
        pairs, _, elastic = engine.collisions
        share = elastic / pairs
        error = math.sqrt(share * (1 - share) / pairs)
        note = "approximate: another program"
        rows.append(Comparison(f"share at rate t_c = {x}", share, error, known, "", note))
    page.table(rows)
    worst = max(abs(row.percent) for row in rows)
    page.check(f"shares within {worst:.1f} % (2 %)", worst < 2)


def collapse(page: Page) -> None:
    """E10: what a gas does that loses nearly all."""
    page.heading("A gas that collapses (E10)")
    page.text(
        "1024 disks, e = 0.2, packing fraction 0.25, means of eight starts. Without a contact time "
        "some collide without end; with one of 10^-4 mean free times of the start the gas goes on "
        "for 2000. Beside it an independent event-driven program: eight starts without a contact "
        "time, which end after 5.3 +- 1.2 free times, and one run with it."
    )
    rate = theory.enskog_rate(1 / math.pi, 1.0, 1.0, 0.25, 2)
    size, ended, seen = [math.sqrt(1024 * math.pi)] * 2, [], []
    for seed in range(1, 9):
        gas = spheres(size, seed=seed, number=1024, collision=HardCollision(0.2))
        try:
            gas.advance(4000)
        except RunError as error:
            ended.append(float(str(error).split("t = ")[1].split(":")[0]) * rate)
        law = HardCollision(0.2, contact_time=1e-4 / rate)
        gas = spheres(size, seed=seed, number=1024, timestep=20 / rate, collision=law)
        gas.advance(max(2, long(100)))
        seen.append((2 * gas.collisions[0] / 1024, gas.totals()[2] / 1023))
    values, errors = mean_and_error(seen)
    note = "approximate: one run of that program"
    page.table(
        [
            Comparison(
                "ends after, in free times",
                *mean_and_error(ended),
                5.3,
                "",
                "approximate: eight starts of an independent event-driven program, 5.3(12)",
            ),
            Comparison("collisions of each", values[0], errors[0], 1488, "", note),
            Comparison("temperature", values[1], errors[1], 1.6e-4, "", note),
        ]
    )
    page.text(
        f"Single runs end after {min(ended):.2f} to {max(ended):.2f} free times, and have "
        f"{min(seen)[0]:.0f} to {max(seen)[0]:.0f} collisions of each with a contact time."
    )
    page.check(f"{len(ended)} of 8 end without a contact time (all)", len(ended) == 8)
    page.check("all go on for 2000 free times with one", len(seen) == 8)


def mixtures(page: Page) -> None:
    """E11: two sizes."""
    page.heading("Mixtures (E11)")
    page.text("Half of diameter 1, half of 0.6, packing fraction 0.4.")
    kinds, rows = [SphereKind(1.0), SphereKind(0.6)], []
    for size, moments in (([11] * 3, (0.8, 0.68, 0.608)), ([40] * 2, (0.8, 0.68))):
        engine = spheres(size, kinds=kinds, packing_fraction=0.4, timestep=0.5)
        (z, dz), _ = pressure(engine, 160.0)
        d = len(size)
        phi = sum(engine.diameters() ** d) * (math.pi / (4 if d == 2 else 6)) / size[0] ** d
        known = theory.mixture_compressibility(phi, moments, d)
        note = "approximate: equation of state of a mixture"
        rows.append(Comparison(f"Z in {d}D", z, dz, known, "", note))
    page.table(rows)
    worst = max(abs(row.percent) for row in rows)
    page.check(f"within {worst:.2f} % (0.5 %)", worst < 0.5)


def gravity(page: Page) -> None:
    """E12: weight and heights."""
    page.heading("Gravity (E12)")
    page.text(
        "30 disks over a floor, the ceiling twenty scale heights up: impulse on the plates over N "
        "m g t, and the mean height over kT/mg, in which disks that exclude one another add N "
        "B_2/(2 L h) = 0.1 % (L: length of the floor, h = kT/mg)."
    )
    n, length, g = 30, 1000.0, 0.02
    places = np.column_stack([length * (np.arange(n) + 0.5) / n, 2.0 + np.arange(n) % 3])
    engine = spheres(
        [length, 600],
        walls=[Plates("y")],
        number=n,
        gravity=[0, -g],
        timestep=500.0,
        positions=places,
    )
    engine.advance(20)
    before, momentum = engine.wall_impulse.copy(), engine.totals()[1][1]
    began = engine.time
    heights, temperatures = [], []
    for _ in range(max(2 * BLOCKS, long(40_000))):
        engine.advance(1)
        heights.append(engine.positions()[:, 1].mean() - 0.5)
        temperatures.append((engine.velocities()[:, 1] ** 2).mean())
    taken = -(engine.wall_impulse - before)[:, 1].sum() - (engine.totals()[1][1] - momentum)
    share = taken / (n * g * (engine.time - began))
    rounded = len(heights) // BLOCKS * BLOCKS
    means = np.reshape([heights[:rounded], temperatures[:rounded]], (2, BLOCKS, -1)).mean(2)
    scale = np.mean(temperatures) / g
    height, error = mean_and_error(means[0] * g / means[1])
    expected = 1 + n * math.pi / 2 / (2 * length * scale)
    page.table(
        [
            Comparison("impulse over N m g t", share, 0.0, 1.0, "", "exact"),
            Comparison("mean height over kT/mg", height, error, expected),
        ]
    )
    page.check("the plates take what gravity gives", abs(share - 1) < 1e-9)
    away = abs(height - expected) / error
    page.check(f"mean height within {away:.1f} standard errors (3)", away < 3)


def exact(page: Page) -> None:
    """E1, E2, E13: what is conserved, and what changes no bit."""
    page.heading("What is exact (E1, E2, E13)")
    page.text(
        "10^6 collisions of smooth spheres of two sizes, and of perfectly rough ones (which turn "
        "as hot as they fly), at a packing fraction of 0.4; a run in steps of 1 and of 1/8, read "
        "at each; and one that goes on from what a checkpoint keeps."
    )
    rows, grid = [], []
    for d, size in ((2, [40.5] * 2), (3, [12.5] * 3)):
        for kinds, beta in (([SphereKind(1.0), SphereKind(0.6)], -1.0), ([SphereKind(1.0)], 1.0)):
            engine = spheres(
                size,
                kinds=kinds,
                packing_fraction=0.4,
                timestep=1.0,
                collision=HardCollision(1.0, tangential=beta),
            )
            first = sum(engine.energies().values())
            ratios, gap = [], math.inf
            while engine.collisions[0] < long(1e6) or len(ratios) < 2 * BLOCKS:
                engine.advance(1)
                energies = engine.energies()
                turning = energies["rotation"] / (1 if d == 2 else 3)
                ratios.append(turning / (energies["translation"] / d))
                gap = min(gap, smallest_gap(engine))
            lost = abs(sum(energies.values()) / first - 1)
            momentum = np.abs(engine.totals()[1]).max() / engine.n
            what = f"{'rough' if beta > 0 else 'smooth'}, {d}D"
            grid.append([what, f"{lost:.1e}", f"{momentum:.1e}", f"{gap:.1e}"])
            page.check(
                f"{what}: energy within {lost:.1e} (1e-12), momentum {momentum:.1e} (1e-12), "
                f"smallest gap {gap:.1e} (-1e-12)",
                lost < 1e-12 and momentum < 1e-12 and gap > -1e-12,
            )
            if beta > 0:
                kept = len(ratios) // 10
                blocks = np.array_split(ratios[kept:], BLOCKS)
                value = mean_and_error([block.mean() for block in blocks])
                rows.append(Comparison(f"rotation over translation, {d}D", *value, 1.0))
    page.grid(["", "energy", "momentum of each", "smallest gap"], grid)
    page.table(rows)
    worst = max(abs(row.percent) for row in rows)
    page.check(f"rotation as hot as translation within {worst:.2f} % (1 %)", worst < 1)
    page.check("the same bits in steps of 1 and 1/8, and resumed", same_bits())


def smallest_gap(engine: Any) -> float:
    """Between the surfaces of any two."""
    places, diameters = engine.positions(), engine.diameters()
    pairs = cKDTree(places, boxsize=engine.box).query_pairs(1.2, output_type="ndarray")
    way = places[pairs[:, 0]] - places[pairs[:, 1]]
    way -= engine.box * np.rint(way / engine.box)
    reaches = 0.5 * (diameters[pairs[:, 0]] + diameters[pairs[:, 1]])
    return float((np.linalg.norm(way, axis=1) - reaches).min())


def same_bits() -> bool:
    """Whether the length of steps, looks in between and a resume change nothing."""
    given = {"packing_fraction": 0.45, "collision": HardCollision(0.9, contact_time=1e-5)}
    whole, fine, other = (spheres([40, 41.5], timestep=t, **given) for t in (1.0, 0.125, 1.0))
    whole.advance(50)
    for _ in range(200):
        fine.advance(1)
        fine.positions()
    other.restore({**fine.state(), "step": np.array(25)})
    other.advance(25)
    one, two = whole.state(), other.state()
    return all(np.array_equal(one[name], two[name]) for name in one)


def make() -> int:
    """The page; how many requirements were not met."""
    page = Page("hard_spheres", "Hard disks and spheres", UNITS)
    for part in (
        exact,
        three_dimensions,
        two_dimensions,
        many_disks,
        motion,
        cooling,
        contact_times,
        collapse,
        mixtures,
        gravity,
    ):
        part(page)
    return page.write()


if __name__ == "__main__":
    main(make)
