"""Kinetic Monte Carlo: clocks, spins, quenches, exclusion, surfaces, islands, a lattice gas."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import BLUE, GREEN, RED, SHORT, Page, main, mean_and_error, plt
from scipy import stats

from mesokit import Box, Comparison, Run, Simulation, theory
from mesokit.method.kinetic_monte_carlo.engine.events import NEXT, events
from mesokit.method.kinetic_monte_carlo.model.exclusion import Exclusion
from mesokit.method.kinetic_monte_carlo.model.family import Family
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.islands import Islands
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.model.potts import Potts
from mesokit.method.kinetic_monte_carlo.model.random_deposition import RandomDeposition
from mesokit.method.kinetic_monte_carlo.model.rsos import RestrictedSolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.single_step import SingleStep
from mesokit.method.kinetic_monte_carlo.model.solid_on_solid import SolidOnSolid
from mesokit.method.kinetic_monte_carlo.model.wells import Link, Ring, Well, Wells
from mesokit.method.kinetic_monte_carlo.observe.island_density import IslandDensity as Clusters
from mesokit.method.kinetic_monte_carlo.observe.lattice_energy import LatticeEnergy
from mesokit.method.kinetic_monte_carlo.observe.magnetisation import Magnetisation
from mesokit.method.kinetic_monte_carlo.section import Lattice, Sublattices
from mesokit.method.kinetic_monte_carlo.start import AlternatingStart, SlabStart, UniformStart
from mesokit.report.style import sparse_logarithm

CRITICAL = 2 / math.log(1 + 2**0.5)  # kT/J of Ising's square lattice
BLOCKS, PARTS = 20, 16  # of a run; of a surface
# from an independent program, in C
DOMAINS = {251.5: 28.2, 1000.0: 56.6}  # length at a time, good to 2 %
EXCHANGE = {10.0: 1.80, 144.0: 2.61, 2079.0: 4.26}  # good to 1 %
ISLANDS = {1e4: (0.01551, 0.00011), 1e5: (0.00815, 0.00009), 1e6: (0.00400, 0.00007)}


def lattice(
    size: Any,
    model: Any,
    steps: int = 0,
    seed: int = 1,
    observe: Any = (),
    warmup: int = 0,
    **given: Any,
) -> Any:
    """A run on a lattice, ready to go."""
    return Simulation(
        run=Run(steps=steps, warmup=warmup, seed=seed, method="kinetic-monte-carlo"),
        box=Box(list(size)), lattice=Lattice(model=model, **given), observe=observe, threads=1,
    )  # fmt: skip


def few(number: float) -> int:
    """So many, or a tenth for a quick try."""
    return max(int(number / (10 if SHORT else 1)), 4)


def judge(page: Page, what: str, rows: list[Comparison], most: float = 3.5) -> None:
    """All within some standard errors."""
    worst = max(abs(c.deviation) for c in rows)
    page.check(f"{what}: largest deviation {worst:.1f} s.e. (below {most})", worst < most)


def within(page: Page, what: str, rows: list[Comparison], percent: float) -> None:
    """All within so many percent."""
    worst = max(abs(c.percent) for c in rows)
    page.check(f"{what}: within {worst:.2f} % (at most {percent} %)", worst < percent)


def clock(page: Page) -> None:
    """Waiting times, wells and walkers."""
    page.heading("The clock, wells and walkers (K1, K2)")
    engine = lattice((8, 8), RandomDeposition(flux=0.25)).engine
    times = [engine.course.clock[NEXT]]
    for _ in range(few(20_000)):
        events(*engine._arguments(), np.inf, 1)
        times.append(engine.course.clock[NEXT])
    chance = stats.kstest(np.diff(times) * 0.25 * 64, "expon").pvalue
    page.text(
        f"Waiting times of {len(times) - 1} events beside the exponential of the rate of all: "
        f"p = {chance:.3f} (Kolmogorov and Smirnov). Walkers in two wells that start in one; in a "
        "ring of 64 wells with barriers of 1.5 kT, D = rate a^2; rates at kT = 0.5 and 1 for a "
        "barrier of 3."
    )
    page.check(f"waiting times: p = {chance:.3f} (above 0.001)", chance > 1e-3)
    wells = Well(name="0"), Well(name="1", energy=-math.log(3))
    two = Wells(well=wells, link=(Link(hop="0 <-> 1", barrier=1.0),))
    out, back = math.exp(-1), math.exp(-1) / 3
    shares, decays = [], []
    for seed in range(few(10)):
        engine = lattice((400, 400), two, seed=seed, timestep=0.25, start=UniformStart()).engine
        found = []
        for _ in range(12):
            engine.advance(1)
            found.append(engine.sites().mean())
        gap = 0.75 - np.array(found)
        decays.append(-np.polyfit(0.25 * np.arange(1, 13), np.log(gap), 1, w=gap)[0])
        engine.advance(100)
        shares.append(engine.sites().mean())
    rows = [
        Comparison("part in the lower well", *mean_and_error(shares), out / (out + back)),
        Comparison("rate of relaxation", *mean_and_error(decays), out + back),
    ]
    spreads, slopes = [], []
    for seed in range(few(10)):
        model = Wells(ring=Ring(wells=64, barrier=1.5))
        engine = lattice((200, 200), model, seed=seed, timestep=2.0, start=UniformStart()).engine
        x = np.zeros(engine.n)
        for _ in range(10):
            before = engine.sites().astype(int)
            engine.advance(1)
            x += (engine.sites() - before + 32) % 64 - 32
        spreads.append(x.var() / 40)
        counts = []
        for k, kT in enumerate((0.5, 1.0)):
            wait = 20 * math.exp(3 / kT)
            ring = Wells(ring=Ring(wells=5, barrier=3.0), kT=kT)
            engine = lattice((128, 128), ring, seed=2 * seed + k, timestep=wait).engine
            engine.advance(1)
            counts.append(engine.happened().sum() / wait)
        slopes.append(math.log(counts[1] / counts[0]))
    rows += [
        Comparison("diffusion along a ring", *mean_and_error(spreads), math.exp(-1.5), "a^2/time"),
        Comparison("slope of Arrhenius", *mean_and_error(slopes), 3.0, "energy"),
    ]
    page.table(rows)
    judge(page, "wells and walkers", rows)
    within(page, "wells and walkers", rows, 1.0)


def equilibrium(page: Page) -> None:
    """Spins and states in equilibrium."""
    page.heading("Spins in equilibrium (K3)")
    page.text(
        "Ising spins, Metropolis, by dwell times: 4 x 4 at the critical temperature beside the sum "
        "over all states; 128^2 beside Onsager and Yang; three-state Potts at its critical "
        "temperature, beside an infinite lattice."
    )
    rows = []
    energy, spins = LatticeEnergy(every=1), Magnetisation(every=1)
    simulation = lattice(
        (4, 4), Ising(kT=CRITICAL), few(100_000), observe=[energy, spins], warmup=100, timestep=4.0
    )
    simulation.run()
    for name, what in (("lattice-energy", "mean energy"), ("magnetisation", "mean size")):
        one = next(c for c in simulation.results[name].comparisons if c.what == what)
        rows.append(Comparison(f"4^2 at T_c: {what}", one.measured, one.error, one.expected))
    exact = list(rows)
    for kT, start in ((2.0, UniformStart(state="up")), (3.0, None)):
        simulation = lattice(
            (128, 128), Ising(kT=kT), few(8000), observe=[energy, spins], warmup=300, start=start
        )
        simulation.run()
        one = simulation.results["lattice-energy"].comparisons[0]
        rows.append(Comparison(f"128^2, kT = {kT}: energy", one.measured, one.error, one.expected))
        if kT < CRITICAL:
            known = theory.yang_magnetisation(1.0, kT)
            size = simulation.results["magnetisation"].comparisons[1]
            rows.append(Comparison(f"128^2, kT = {kT}: size", size.measured, size.error, known))
    critical, known = theory.potts_critical_energy(1.0, 3)
    simulation = lattice(
        (32, 32), Potts(q=3, kT=critical), few(60_000), observe=[energy], warmup=5000
    )
    simulation.run()
    one = simulation.results["lattice-energy"].comparisons[0]
    rows.append(
        Comparison("Potts, q = 3, 32^2 at T_c: energy", one.measured, one.error, known, "",
                   "approximate: of an infinite lattice")
    )  # fmt: skip
    page.table(rows)
    judge(page, "4^2 at the critical temperature", exact)
    within(page, "spins in equilibrium", rows[:-1], 0.5 if SHORT else 0.3)


def quenches(page: Page, axis: Any) -> None:
    """Domains in time."""
    page.heading("Quenches (K4, K5, K6, K12)")
    page.text(
        "A chain of a million spins, Glauber's rates at temperature 0, exact in time (Glauber "
        "1963). 1024^2 spins at temperature 0 by Metropolis' rates: length of domains 2/(e + 2). "
        "256^2 spins that are exchanged at 0.6 T_c: 2/(e - e_eq), with Onsager's e_eq. 'Theory' of "
        "the last two is an independent program. Sublattices of 64^2 sites, at the default cycle, "
        "beside exact events."
    )
    engine = lattice(
        (1_000_000,), Ising(kT=0.0, dynamics="glauber"), kind="chain", timestep=0.5
    ).engine
    rows, now = [], 0
    for step in (1, 2, 4, 10, 40, 200):
        engine.advance(step - now)
        now, spins = step, engine.sites().reshape(BLOCKS, -1)
        walls = (spins[:, 1:] != spins[:, :-1]).mean(axis=1)
        time = 0.5 * step
        rows.append(
            Comparison(f"walls of a chain at {time:g}", *mean_and_error(walls),
                       float(theory.glauber_walls([time])[0]))
        )  # fmt: skip
    page.table(rows)
    judge(page, "walls of a chain", rows)

    side = 256 if SHORT else 1024
    rows = _domains(side, None, 1, axis, "exact events", BLUE)
    page.table(rows)
    within(page, "domains at temperature 0", rows, 6.0)
    slope = math.log(rows[1].measured / rows[0].measured) / math.log(1000 / 251.5)
    page.check(f"exponent {slope:.3f} (0.5, within 0.05)", abs(slope - 0.5) < 0.05)

    kT = 0.6 * CRITICAL
    rest = theory.onsager_energy(1.0, kT)
    lengths: list[list[float]] = [[] for _ in EXCHANGE]
    for seed in range(3):
        engine = lattice((256, 256), Ising(kT=kT, moves="exchange"), seed=seed, timestep=1.0).engine
        now = 0
        for k, time in enumerate(EXCHANGE):
            if SHORT and time > 200:
                continue
            engine.advance(round(time) - now)
            now = round(time)
            lengths[k].append(2 / (energy(engine) - rest))
    rows = []
    for (time, known), some in zip(EXCHANGE.items(), lengths, strict=True):
        if some:
            mean, error = mean_and_error(some)
            both_errors = math.hypot(error, 0.01 * known)
            rows.append(Comparison(f"exchange, length at {time:g}", mean, both_errors, known))
    page.table(rows)
    within(page, "domains by exchange", rows, 3.0)

    rows = []
    both: dict[str, list[list[float]]] = {"serial": [], "sublattices": []}
    for seed in range(few(8)):
        for name, blocks in (("serial", None), ("sublattices", Sublattices(block=64))):
            engine = lattice(
                (256, 256), Ising(kT=0.0), seed=seed, sublattices=blocks, timestep=1.0
            ).engine
            row = []
            for steps in (10, 40):
                engine.advance(steps)
                row.append(energy(engine))
            both[name].append(row)
    for k, time in enumerate((10, 50)):
        (one, error), (other, second) = (
            mean_and_error([row[k] for row in both[name]]) for name in ("sublattices", "serial")
        )
        rows.append(
            Comparison(f"energy at {time}, sublattices", one, math.hypot(error, second), other)
        )
    page.table(rows)
    judge(page, "sublattices beside exact events", rows, 3.0)
    axis.set(xlabel="time", ylabel="length of domains", xscale="log", yscale="log")
    sparse_logarithm(axis.yaxis, *axis.get_ylim())


def _domains(
    side: int, blocks: Any, seed: int, axis: Any, label: str, colour: str
) -> list[Comparison]:
    engine = lattice(
        (side, side), Ising(kT=0.0), seed=seed, timestep=0.5, sublattices=blocks
    ).engine
    times, lengths, now = [], [], 0
    known = {round(2 * time): (time, value) for time, value in DOMAINS.items()}
    rows = []
    for step in sorted({*np.geomspace(4, 2000, 25).astype(int).tolist(), *known}):
        engine.advance(step - now)
        now = step
        times.append(0.5 * step)
        lengths.append(2 / (energy(engine) + 2))
        if step in known:
            time, value = known[step]
            rows.append(
                Comparison(f"length of domains at {time:g}", lengths[-1], 0.02 * value, value)
            )
    axis.plot(times, lengths, "o", mfc="white", ms=4, color=colour, label=label)
    axis.plot(list(DOMAINS), list(DOMAINS.values()), "x", color=GREEN, label="independent program")
    axis.plot(times, lengths[-1] * np.sqrt(np.array(times) / times[-1]), "k--", lw=1,
              label="$t^{1/2}$")  # fmt: skip
    axis.legend()
    return rows


def energy(engine: Any) -> float:
    """Of a spin."""
    pairs = engine.pairs()[:, :-1]
    unlike = pairs[0, 1] + pairs[1, 0]
    return float(unlike - (pairs.sum() - unlike)) / (2 * engine.n)


def exclusion(page: Page, axis: Any) -> None:
    """Currents, and their fluctuations after a step."""
    page.heading("Exclusion (K7)")
    page.text(
        "Particles that hop to the right at rate 1. A ring of 50 particles on 100 sites; an open "
        "chain of 128 sites with rates 1 at both ends; and from a step, full to the left and empty "
        "to the right: particles that have passed the middle, t/4 + 1.77109 2^(-4/3) t^(1/3) - c, "
        "with the variance 2^(-8/3) 0.81319 t^(2/3) (Johansson 2000; Prahofer and Spohn 2002)."
    )
    rows = []
    for what, size, given, known in (
        ("ring", 100, {"start": SlabStart(part=0.5)}, theory.ring_current(50, 100)),
        ("open chain", 128, {"ends": ["x"]}, theory.open_current(128, 1.0, 1.0)),
    ):
        model = Exclusion(enter=1.0, leave=1.0) if "ends" in given else Exclusion()
        engine = lattice((size,), model, kind="chain", timestep=1.0, **given).engine
        engine.advance(5000)
        name = model.events().index("leave" if "ends" in given else "forward")
        found, over = [], 1 if "ends" in given else size
        for _ in range(BLOCKS):
            before = engine.happened()[name].sum()
            engine.advance(few(20_000))
            found.append((engine.happened()[name].sum() - before) / few(20_000) / over)
        rows.append(Comparison(f"{what}: current", *mean_and_error(found), known, "1/time"))
    passed, length = [], 2400
    for seed in range(few(600)):
        engine = lattice(
            (length,), Exclusion(), seed=seed, kind="chain", timestep=100.0,
            start=SlabStart(part=0.5),
        ).engine  # fmt: skip
        engine.advance(1)
        first = int(engine.sites()[length // 2 :].sum())
        engine.advance(9)
        passed.append((first, int(engine.sites()[length // 2 :].sum())))
    early, late = np.array(passed).T
    rows.append(
        Comparison("step: passed between 100 and 1000", *mean_and_error(late - early), 228.767)
    )
    square = (late - late.mean()) ** 2
    known = 2 ** (-8 / 3) * 0.81319 * 1000 ** (2 / 3)
    rows.append(
        Comparison("step: variance at 1000", *mean_and_error(square), known, "", "at late times")
    )
    page.table(rows)
    judge(page, "exclusion", rows)
    numbers = np.arange(late.min(), late.max() + 1)
    axis.bar(numbers, [(late == k).mean() for k in numbers], color=BLUE, alpha=0.5)
    axis.set(xlabel="particles that passed at $t = 1000$", ylabel="probability")


def surfaces(page: Page, axis: Any) -> None:
    """Widths, speeds and steps."""
    page.heading("Surfaces (K8, K10)")
    page.text(
        "Growth on a chain: independent columns, w^2 = t (1 - 1/L); single steps on a ring of 16, "
        "w^2 = (L + 1)/12; the speed of restricted growth (0.42 by an independent program); "
        "exponents of the width from 30 to 1000. Atoms that hop on a ring of 10 columns, bond 1.5 "
        "kT: steps as Boltzmann has them."
    )
    rows = []
    engine = lattice((1_000_000,), RandomDeposition(), kind="chain", timestep=20.0).engine
    engine.advance(1)
    blocks = engine.sites().reshape(BLOCKS, -1).var(axis=1)
    rows.append(Comparison("independent columns: w^2 at 20", *mean_and_error(blocks), 20.0, "a^2"))
    engine = lattice(
        (16,), SingleStep(up=1.0, down=0.2), kind="chain", start=AlternatingStart(), timestep=2.0
    ).engine
    engine.advance(1000)
    squares = []
    for _ in range(few(40_000)):
        engine.advance(1)
        squares.append(engine.sites().var())
    rest = len(squares) % BLOCKS
    blocks = np.reshape(squares[rest:], (BLOCKS, -1)).mean(axis=1)
    rows.append(Comparison("single steps: w^2", *mean_and_error(blocks), 17 / 12, "a^2"))
    page.table(rows)
    judge(page, "widths", rows)

    rows = []
    length = 2**15 if SHORT else 2**18
    for model, beta, colour in (
        (RestrictedSolidOnSolid(), 1 / 3, BLUE), (Family(), 1 / 4, RED),
    ):  # fmt: skip
        engine = lattice((length,), model, kind="chain", timestep=1.0).engine
        times, widths, now = np.unique(np.geomspace(1, 1000, 24).astype(int)), [], 0
        for time in times.tolist():
            engine.advance(time - now)
            now = time
            widths.append(engine.sites().reshape(PARTS, -1).var(axis=1))
        late = times >= 30
        slopes = np.polyfit(np.log(times[late]), 0.5 * np.log(np.array(widths)[late]), 1)[0]
        rows.append(
            Comparison(f"exponent of {model.rule}", *mean_and_error(slopes), beta, "",
                       "approximate: at late times")
        )  # fmt: skip
        axis.plot(times, np.sqrt(np.mean(widths, axis=1)), "o", mfc="white", ms=4, color=colour,
                  label=model.rule)  # fmt: skip
        guide = np.sqrt(np.mean(widths[-1])) * (times / times[-1]) ** beta
        axis.plot(times, guide, "--", color=colour, lw=1, label=f"$t^{{{beta:.2f}}}$")
        if isinstance(model, RestrictedSolidOnSolid):
            before = engine.sites().mean()
            engine.advance(100)
            speed = (engine.sites().mean() - before) / 100
            page.check(f"speed of restricted growth {speed:.4f} (0.42, within 0.003)",
                       abs(speed - 0.42) < 3e-3)  # fmt: skip
    axis.set(xlabel="time", ylabel="width", xscale="log", yscale="log")
    sparse_logarithm(axis.yaxis, *axis.get_ylim())
    axis.legend()
    page.table(rows)
    worst = max(abs(c.measured - c.expected) for c in rows)
    page.check(f"exponents: within {worst:.3f} (at most 0.02)", worst < 0.02)

    columns, q, most = 10, math.exp(-0.75), 40
    weight = q ** abs(np.arange(-most, most + 1.0))
    others = weight
    for _ in range(columns - 2):
        others = np.convolve(others, weight)
    middle = len(others) // 2
    exact = weight * others[middle - most : middle + most + 1]  # even: the rest has -dh
    exact /= exact.sum()
    engine = lattice(
        (columns,), SolidOnSolid(bond_energy=1.5, kT=1.0), kind="chain", timestep=20.0
    ).engine
    engine.advance(1000)
    found = np.zeros((BLOCKS, 4))
    looks = few(1000)
    for block in range(BLOCKS):
        for _ in range(looks):
            engine.advance(1)
            heights = engine.sites()
            found[block] += np.bincount(abs(heights - np.roll(heights, 1)), minlength=99)[:4]
    found /= looks * columns
    rows = [
        Comparison(f"steps of {k}", *mean_and_error(found[:, k]), exact[most + k] * (1 + (k > 0)))
        for k in range(4)
    ]
    page.table(rows)
    judge(page, "steps in equilibrium", rows)


def gases(page: Page) -> None:
    """Islands and a lattice gas."""
    page.heading("Islands and a lattice gas (K9, K13)")
    page.text(
        "Stable islands of a site after a tenth of a layer, by hops of an atom for each that comes "
        "down on a site; 'theory' is an independent program. A gas whose particles adsorb, desorb "
        "and hop, all rates 1: all states are as likely."
    )
    rows = []
    for hops, (known, other) in ISLANDS.items():
        found = []
        for seed in range(4):
            simulation = lattice(
                (256, 256), Islands(flux=1.0, hop_rate=hops / 4), 1, seed, timestep=0.1,
                observe=[Clusters(every=1, smallest=2)], start=UniformStart(),
            )  # fmt: skip
            simulation.run()
            found.append(simulation.results["islands"].value[-1])
        mean, error = mean_and_error(found)
        rows.append(Comparison(f"islands, D/F = {hops:.0e}", mean, math.hypot(error, other), known))
    page.table(rows)
    judge(page, "islands", rows)
    within(page, "islands", rows, 5.0)
    gas = LatticeGas(
        process=(
            GasProcess(name="adsorb", site="empty -> A", rate=1.0),
            GasProcess(name="desorb", site="A -> empty", rate=1.0),
            GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0),
        )
    )
    engine = lattice((128, 128), gas, timestep=1.0).engine
    engine.advance(20)
    parts, often = [], []
    for _ in range(BLOCKS):
        before, covered = engine.happened().sum(), []
        for _ in range(few(50)):
            engine.advance(1)
            covered.append(engine.sites().mean())
        parts.append(np.mean(covered))
        often.append((engine.happened().sum() - before) / (few(50) * engine.n))
    rows = [
        Comparison("coverage", *mean_and_error(parts), 0.5),
        Comparison("events of a site", *mean_and_error(often), 2.0, "1/time"),
    ]
    page.table(rows)
    judge(page, "lattice gas", rows)
    within(page, "lattice gas", rows, 1.0 if SHORT else 0.2)


def make() -> int:
    """Write the page."""
    page = Page("kinetic_monte_carlo", "Kinetic Monte Carlo", "sites, and inverse rates")
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.6))
    clock(page)
    equilibrium(page)
    quenches(page, axes[0])
    exclusion(page, axes[1])
    surfaces(page, axes[2])
    gases(page)
    page.figure(fig, "Domains after a quench to temperature 0; particles that have passed the "
                "middle from a step; widths of growing surfaces.")  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
