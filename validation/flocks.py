"""Flocks: lone birds, crowds, order against noise, giant fluctuations, isotropy, both noises."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import BLUE, GREEN, GREY, PURPLE, RED, Page, long, main, mean_and_error, plt

from mesokit import AngularNoise, Box, Comparison, Flock, Run, Simulation, VectorialNoise, theory
from mesokit.method.flock.observe.number_fluctuations import counts_in_squares

BLOCKS = 20
SEEDS, WINDOWS, WINDOW = 3, 3, 3_000  # runs of giant fluctuations; windows of each, in steps
# from an independent program, in C: noise: order, standard error
SMALL = {
    0.5: (0.9861, 0.0001), 1.0: (0.9453, 0.0003), 2.0: (0.7911, 0.0009), 3.0: (0.5544, 0.0017),
    4.0: (0.2376, 0.0026), 5.0: (0.0719, 0.0003),
}  # fmt: skip
LARGE = {
    1.0: (0.918, 0.003), 2.0: (0.704, 0.008), 3.0: (0.386, 0.013), 3.5: (0.191, 0.012),
    4.0: (0.081, 0.005), 4.5: (0.0330, 0.0006),
}  # fmt: skip
JUMP = {0.573: 0.786, 0.589: 0.763, 0.605: 0.737, 0.621: 0.041, 0.637: 0.026}
SPREADS = (2.23, 6.93, 22.4, 71.4, 218.0, 599.0)  # of numbers in squares of side 1, 2, 4, ... 32


def flock(size: Any, steps: int = 0, seed: int = 1, observe: Any = (), **birds: Any) -> Any:
    """A flock, ready to run."""
    return Simulation(
        run=Run(steps=steps, seed=seed, method="flock"), box=Box(size), flock=Flock(**birds),
        observe=observe, threads=1,
    )  # fmt: skip


def order(engine: Any) -> float:
    """Polar order."""
    return float(np.linalg.norm(engine.headings().mean(axis=0)))


def mean_order(engine: Any, before: int, steps: int, every: int = 5) -> tuple[float, float]:
    """Mean order and its error after some steps."""
    engine.advance(before)
    values = []
    for _ in range(max(steps // every, BLOCKS)):
        engine.advance(every)
        values.append(order(engine))
    rest = len(values) % BLOCKS
    mean, error = mean_and_error(np.reshape(values[rest:], (BLOCKS, -1)).mean(axis=1))
    return float(mean), float(error)


def judge(page: Page, what: str, rows: list[Comparison], most: float = 3.5) -> None:
    """All within some standard errors, a few more of which chance allows in many rows."""
    worst = max(abs(c.deviation) for c in rows)
    page.check(f"{what}: largest deviation {worst:.1f} s.e. (below {most})", worst < most)


def alone(page: Page) -> None:
    """A bird alone: a walk whose steps remember."""
    page.heading("A bird alone (V1)")
    page.text(
        "40 000 birds that do not see one another (reach 1e-6), speed 0.3: mean square "
        "displacement after n steps, beside l^2 [n (1 + a)/(1 - a) - 2 a (1 - a^n)/(1 - a)^2]; "
        "a is the mean cosine of the turn in a step: sin(eta/2)/(eta/2) for angular noise in 2D, 1 "
        "- eta/(2 pi) in 3D, and 1 - eta^2/3 (3D) or an elliptic integral (2D) for vectorial "
        "noise."
    )
    rows = []
    for size in ((30, 30), (16, 16, 16)):
        for noise in (AngularNoise(2.0), AngularNoise(5.0), VectorialNoise(0.5)):
            engine = flock(size, number=40_000, radius=1e-6, speed=0.3, noise=noise).engine
            start = engine.positions(unwrapped=True)
            for steps in (10, 100):
                engine.advance(steps - engine.step)
                square = ((engine.positions(unwrapped=True) - start) ** 2).sum(axis=1)
                expected = theory.msd_persistent_walk(steps, 0.3, noise.memory(len(size)))
                rows.append(
                    Comparison(
                        f"{len(size)}D, {noise.rule} {noise.strength:g}, {steps} steps",
                        square.mean(), square.std() / math.sqrt(engine.n), float(expected), "a^2",
                    )
                )  # fmt: skip
    page.table(rows)
    judge(page, "lone birds", rows)
    worst = max(abs(c.percent) for c in rows)
    page.check(f"lone birds: within {worst:.2f} % (at most 2 %)", worst < 2)


def crowd(page: Page) -> None:
    """All see all."""
    page.heading("All see all (V2)")
    page.text(
        "400 birds in a box where each is in reach of each: all turn from one direction, each on "
        "its own, so that the mean square of the order is a^2 + (1 - a^2)/N exactly. With noise 2 "
        "pi nobody heeds the others, and the mean order is sqrt(pi/4N), or sqrt(8/(3 pi N)) in 3D."
    )
    rows = []
    for size in ((2, 2), (2, 2, 2)):
        for strength in (1.0, 2.0, 4.0, 2 * math.pi):
            noise = AngularNoise(strength)
            engine = flock(size, number=400, radius=2.0, noise=noise).engine
            engine.advance(20)
            values = []
            for _ in range(long(20_000)):
                engine.advance(1)
                values.append(order(engine))
            square = np.square(values)  # samples do not know of one another
            a, error = theory.angular_memory(strength, len(size)), 1 / math.sqrt(len(values))
            name = f"{len(size)}D, noise {strength:.3g}"
            expected = theory.mean_square_order(max(a, 0.0), 400)
            rows.append(
                Comparison(
                    f"{name}: mean square order", square.mean(), square.std() * error, expected
                )
            )
            if strength > 6:
                expected = theory.disordered_order(400, len(size))
                rows.append(
                    Comparison(f"{name}: order", np.mean(values), np.std(values) * error, expected)
                )
    page.table(rows)
    judge(page, "all see all", rows)


def against_noise(page: Page, axis: Any) -> None:
    """Vicsek's figure 2."""
    page.heading("Order against noise (V3)")
    page.text(
        "Density 4, speed 0.03, angular noise (Vicsek et al. 1995, figure 2a), birds that move "
        "along their new headings; 'expected' are the values of an independent program. The order "
        "`original` of that paper, where birds move along their old headings, is beside it."
    )
    for number, known, steps, look in ((300, SMALL, 60_000, "o"), (4000, LARGE, 40_000, "s")):
        side, rows = math.sqrt(number / 4), []
        for strength, (expected, other) in known.items():
            noise = AngularNoise(strength)
            engine = flock((side, side), number=number, speed=0.03, noise=noise).engine
            mean, error = mean_order(engine, long(8_000), long(steps))
            both = math.hypot(error, other)
            rows.append(
                Comparison(f"N = {number}, noise {strength:g}", mean, both, expected, "",
                           f"own error {error:.5f}")
            )  # fmt: skip
        page.table(rows)
        judge(page, f"order of {number} birds", rows)
        axis.errorbar(
            list(known), [c.measured for c in rows], [c.error for c in rows], fmt=look, mfc="white",
            color=BLUE if number == 300 else RED, label=f"N = {number}",
        )  # fmt: skip
        axis.plot(list(known), [c.expected for c in rows], "k-", lw=0.8, zorder=1,
                  label="independent program" if number == 300 else None)  # fmt: skip
    side, rows = math.sqrt(300 / 4), []
    for strength in (1.0, 3.0):
        engine = flock(
            (side, side), number=300, speed=0.03, noise=AngularNoise(strength), order="original"
        ).engine
        mean, error = mean_order(engine, long(8_000), long(60_000))
        rows.append(Comparison(f"N = 300, noise {strength:g}, original order", mean, error))
    page.table(rows)
    axis.set(xlabel=r"noise $\eta$", ylabel=r"polar order $\phi$", ylim=(0, 1))
    axis.legend()


def fluctuations(page: Page, axis: Any) -> None:
    """Giant number fluctuations."""
    page.heading("Giant number fluctuations (V4)")
    page.text(
        "Box 128 x 128, density 2, speed 0.5, angular noise 1.57: standard deviation of the "
        f"number of birds in squares of side 1 to 32, of {SEEDS} flocks from random starts, after "
        "2,000 steps. Waves as long as the box come and go over thousands of steps, and blocks in "
        f"one run do not see all of that: the errors are from {SEEDS} runs in {WINDOWS} windows of "
        f"{WINDOW} steps each, whose scatter is in the table too. The values of an independent "
        "program are of one run whose errors are not known, and so as uncertain as a window."
    )
    sides, spreads, orders = [1, 2, 4, 8, 16, 32], [], []
    for seed in range(SEEDS):
        noise = AngularNoise(1.57)
        engine = flock((128, 128), seed=seed + 1, density=2, speed=0.5, noise=noise).engine
        engine.advance(long(2_000))
        for _ in range(WINDOWS):
            variances = []
            for _ in range(max(long(WINDOW) // 50, 4)):
                engine.advance(50)
                places = engine.positions()
                variances.append(
                    [
                        ((counts_in_squares(places, a, engine.box) - 2 * a * a) ** 2).mean()
                        for a in sides
                    ]
                )
                orders.append(order(engine))
            spreads.append(np.sqrt(np.mean(variances, axis=0)))
    number, windows = 2.0 * np.square(sides), np.array(spreads)
    value, error = mean_and_error(windows)
    scatter = windows.std(axis=0, ddof=1)
    random = np.sqrt(number * (1 - number / (2 * 128**2)))
    columns = (sides, number, value, error, scatter, SPREADS, random)
    page.grid(
        ["side", "mean number", "standard deviation", "error", "scatter of windows",
         "independent program", "at random"],
        [[f"{x:.4g}" for x in row] for row in zip(*columns, strict=True)],
    )  # fmt: skip
    slopes = np.polynomial.polynomial.polyfit(np.log(number[2:]), np.log(windows[:, 2:].T), 1)[1]
    early = np.log(windows[:, 1:3] / windows[:, :2]) / np.log(4)
    (slope, off), (first, _) = mean_and_error(slopes), mean_and_error(early)
    page.check(
        f"exponent over the four largest squares {slope:.3f} +- {off:.3f} (0.79 by an independent "
        "program, 0.8 by Toner and Tu; within 0.05)",
        abs(slope - 0.79) < 0.05,
    )
    page.check(
        f"over the first three {first[0]:.2f} and {first[1]:.2f} (0.82 to 0.85, within 0.03)",
        bool(((first > 0.79) & (first < 0.88)).all()),
    )
    worst = np.abs((value - np.array(SPREADS)) / np.hypot(scatter, error)).max()
    page.check(f"the other program's spreads: at most {worst:.1f} scatters off (3)", worst < 3)
    mean = float(np.mean(orders))
    page.check(f"polar order {mean:.4f} (0.817, within 0.005)", abs(mean - 0.817) < 0.005)
    axis.errorbar(number, value, error, fmt="o", mfc="white", color=BLUE, label="flock")
    axis.plot(number, SPREADS, "x", color=RED, label="independent program")
    axis.plot(number, random, "k-", lw=0.8, label="at random")
    axis.plot(number, value[0] * (number / 2) ** 0.8, "--", color=GREY, label=r"$n^{0.8}$")
    axis.set(xscale="log", yscale="log", xlabel="mean number", ylabel="standard deviation")
    axis.legend()


def isotropy(page: Page) -> None:
    """No direction is better than another."""
    page.heading("Isotropy (V5)")
    page.text(
        "200 flocks of 192 birds, each with a seed of its own, after 100 steps at noise 1.5: the "
        "mean heading must know nothing of the axes. That any cells, threads and slices give the "
        "same bits is a law of the tests (`tests/laws/test_flock.py`)."
    )
    turns = []
    for seed in range(max(long(200), 60)):
        noise = AngularNoise(1.5)
        engine = flock((8, 8), seed=seed + 1, density=3, noise=noise).engine
        engine.advance(100)
        x, y = engine.headings().mean(axis=0)
        turns.append(math.atan2(y, x))
    rows = []
    for name, function in (("cos 4", np.cos), ("sin 4", np.sin)):
        values = function(4 * np.array(turns))
        error = math.sqrt(0.5 / len(turns))
        rows.append(Comparison(f"mean {name} x direction", values.mean(), error, 0.0))
    page.table(rows)
    judge(page, "isotropy", rows, 3.0)


def jump(page: Page, axis: Any) -> None:
    """The transition with vectorial noise is a jump."""
    page.heading("Vectorial noise (V6)")
    page.text(
        "Box 64 x 64, density 2, speed 0.5, from a random start (Gregoire and Chate 2004): the "
        "order jumps between strengths of 0.605 and 0.621, where bands form. Means over the last "
        "part of each run; 'expected' are the values of an independent program, good to some 0.01."
    )
    rows, met = [], True
    for strength, expected in JUMP.items():
        noise = VectorialNoise(strength)
        engine = flock((64, 64), density=2, speed=0.5, noise=noise).engine
        mean, error = mean_order(engine, long(30_000), long(20_000))
        rows.append(Comparison(f"strength {strength}", mean, error, expected))
        met &= abs(mean - expected) < 0.02 if expected > 0.1 else mean < 0.1
    page.table(rows)
    page.check("below the jump within 0.02, above it less than 0.1", met)
    axis.errorbar(
        list(JUMP), [c.measured for c in rows], [c.error for c in rows], fmt="o", mfc="white",
        color=PURPLE, label="L = 64",
    )  # fmt: skip
    axis.plot(list(JUMP), list(JUMP.values()), "x", color=GREEN, label="independent program")
    axis.set(xlabel=r"strength of vectorial noise", ylabel=r"polar order $\phi$", ylim=(0, 1))
    axis.legend()


def make() -> int:
    """Write the page."""
    page = Page("flocks", "Flocks", "range of sight and timestep are 1")
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.6))
    alone(page)
    crowd(page)
    against_noise(page, axes[0])
    fluctuations(page, axes[1])
    isotropy(page)
    jump(page, axes[2])
    page.figure(fig, "Order against angular noise, giant number fluctuations, and the jump of the "
                "order with vectorial noise.")  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
