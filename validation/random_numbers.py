"""Philox beside xoshiro256++ and the Mersenne Twister: angles in buckets, distances, runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np
from common import BLUE, GREEN, GREY, RED, Page, main, plt
from scipy import stats
from xoshiro import REFERENCE, outputs, seeded, uniforms

from mesokit.scalar.random import CELL, Counter, unit_open, words

NUMBER, CELLS = 1_000_000, 1000  # angles in a sample; for Philox those of 1000 cells in 1000 steps
BUCKETS = range(1, 19)  # k: degrees of freedom of k + 1 buckets
SEEDS = 200  # samples of the tests of the second level, of NUMBER / 10 angles
LEVEL = 0.05
COLOURS = {"Philox4x32-10": BLUE, "xoshiro256++": RED, "MT19937": GREEN}


@numba.njit
def philox_angles(seed, number, cells):
    """Angles, in turns, as rule srd draws them with uniform angles: by step and cell."""
    found = np.empty(number)
    for i in range(number):
        counter = Counter(np.uint64(seed), np.uint64(1 + i // cells))
        found[i] = unit_open(words(counter, CELL, i % cells, 0)[0])
    return found


def stream(name: str, seed: int) -> Callable[[int], Any]:
    """What gives the next angles of a generator; Philox, which has no state, gets other seeds."""
    if name == "Philox4x32-10":
        seeds = iter(range(1000 * seed, 1000 * seed + 1000))
        return lambda number: philox_angles(next(seeds), number, CELLS)
    if name == "xoshiro256++":
        state = seeded(seed)
        return lambda number: uniforms(state, number)
    return np.random.Generator(np.random.MT19937(seed)).random


def chi_square(angles: Any, k: int) -> float:
    """T of k + 1 buckets, each of which expects N/(k + 1)."""
    count = np.bincount((angles * (k + 1)).astype(int), minlength=k + 1)
    expected = len(angles) / (k + 1)
    return float(((count - expected) ** 2 / expected).sum())


def runs(angles: Any) -> float:
    """p-value of the number of runs above and below half a turn: 1 + binomial(N - 1, 1/2)."""
    above = angles > 0.5
    changes, n = np.count_nonzero(above[1:] != above[:-1]), len(angles) - 1
    return float(2 * stats.norm.sf(abs(changes - n / 2) / np.sqrt(n / 4)))


def make() -> int:
    """Write the page."""
    page = Page("random_numbers", "Random numbers")
    page.text("""
        Rotation angles as rule `srd` draws them with `angle_distribution = "uniform"`, by step and
        cell, from Philox4x32-10 (Salmon et al., 2011), beside xoshiro256++ (Blackman and Vigna,
        2019) and the Mersenne Twister MT19937 (Matsumoto and Nishimura, 1998; that of NumPy). All
        three do well here. Philox was chosen for another reason: its numbers are a function of
        (seed, purpose, step, cell or particle), so that they are the same for any number of
        threads, in any order, and after any stop, while the other two hand out one sequence to
        whoever comes first. It passes the known answers of Random123 in
        `tests/execute/test_random.py`.""")
    known = tuple(int(x) for x in outputs(np.array([1, 2, 3, 4], np.uint64), len(REFERENCE)))
    page.check("xoshiro256++ gives its reference outputs", known == REFERENCE)
    buckets(page)
    second_level(page)
    histogram(page)
    return page.write()


def buckets(page: Page) -> None:
    """Chi-square for k = 1 to 18, each of a new sample."""
    page.heading("Angles in k + 1 buckets")
    page.text(f"""
        T is chi-square of {NUMBER:,} angles in k + 1 buckets of equal width, each of which expects
        N/(k + 1): k degrees of freedom, to which the critical value for {LEVEL:.0%} belongs. Each
        T is of a new sample. A perfect generator is above the critical value in one of twenty
        tests; such T are in bold.""")
    generators = {name: stream(name, 1) for name in COLOURS}
    rows, rejected = [], dict.fromkeys(COLOURS, 0)
    for k in BUCKETS:
        critical = float(stats.chi2.isf(LEVEL, k))
        row = [k, f"{critical:.2f}"]
        for name, draw in generators.items():
            t = chi_square(draw(NUMBER), k)
            rejected[name] += t > critical
            row.append(f"**{t:.2f}**" if t > critical else f"{t:.2f}")
        rows.append(row)
    page.grid(["k", "critical value", *COLOURS], rows)
    total, tests = sum(rejected.values()), len(BUCKETS) * len(COLOURS)
    low, high = stats.binom.interval(0.99, tests, LEVEL)
    page.text(f"""
        Above the critical value: {", ".join(f"{name} {n}" for name, n in rejected.items())} of
        {len(BUCKETS)} each. Of {tests} independent tests {tests * LEVEL:.1f} are expected, give or
        take {np.sqrt(tests * LEVEL * (1 - LEVEL)):.1f}; "all pass" would itself have a probability
        of {(1 - LEVEL) ** tests:.2f} only. None of this tells one generator from another.""")
    page.check(
        f"{total} of {tests} tests above the critical value ({low:.0f} to {high:.0f} in 99 %)",
        low <= total <= high,
    )


def second_level(page: Page) -> None:
    """P-values of many samples, which must be uniform."""
    page.heading("Many samples")
    page.text(f"""
        Three tests of {SEEDS} samples of {NUMBER // 10:,} angles: chi-square of 19 buckets; the
        largest distance of the distribution from the uniform one (Kolmogorov and Smirnov); the
        number of runs above and below half a turn (Wald and Wolfowitz), which sees the order. Of a
        perfect generator their p-values are uniform. The table has the number of p-values below
        {LEVEL:.0%}, of which {SEEDS * LEVEL:.0f} +- {np.sqrt(SEEDS * LEVEL * (1 - LEVEL)):.1f} are
        expected, and p of all of them being uniform (Kolmogorov and Smirnov again). The least of
        nine such p has a median of {1 - 0.5 ** (1 / 9):.2f}.""")
    rows, least = [], []
    for name in COLOURS:
        found = []
        for seed in range(1, SEEDS + 1):
            angles = stream(name, 100 + seed)(NUMBER // 10)
            found.append(
                [
                    stats.chi2.sf(chi_square(angles, 18), 18),
                    stats.kstest(angles, "uniform").pvalue,
                    runs(angles),
                ]
            )
        for test, p in zip(("chi-square", "distance", "runs"), np.array(found).T, strict=True):
            uniform = float(stats.kstest(p, "uniform").pvalue)
            rows.append([name, test, int((p < LEVEL).sum()), f"{uniform:.3f}"])
            least.append(uniform)
    page.grid(["generator", "test", f"p below {LEVEL:.0%}", "p that p are uniform"], rows)
    bound = 0.01 / len(least)
    page.check(
        f"smallest p of {len(least)} tests of p-values {min(least):.3f} (above {bound:.4f}, 1 % "
        "for all together)",
        min(least) > bound,
    )
    biased = stats.kstest(stream("MT19937", 1)(NUMBER) ** 1.01, "uniform").pvalue
    alternating = np.sort(stream("MT19937", 2)(NUMBER // 10).reshape(-1, 2)).ravel()
    page.check(
        f"a generator that is 1 % uneven is found (p = {biased:.1g}), and pairs that are sorted "
        f"(p = {runs(alternating):.1g})",
        biased < 1e-3 and runs(alternating) < 1e-3,
    )


def histogram(page: Page) -> None:
    """Buckets of one sample of each."""
    k = BUCKETS[-1]
    fig, axes = plt.subplots(1, 3, figsize=(9, 3), sharey=True)
    for ax, (name, colour) in zip(axes, COLOURS.items(), strict=True):
        angles = stream(name, 7)(NUMBER)
        count = np.bincount((angles * (k + 1)).astype(int), minlength=k + 1)
        expected = NUMBER / (k + 1)
        noise = np.sqrt(expected * (1 - 1 / (k + 1)))
        edges = np.linspace(0, 360, k + 2)
        ax.axhspan(expected - noise, expected + noise, color=GREY, alpha=0.2, lw=0,
                   label="one standard deviation")  # fmt: skip
        ax.axhline(expected, color="black", lw=1, label="expected")
        ax.stairs(count, edges, color=colour, lw=1.3, baseline=None, label="drawn")
        ax.set(title=name, xlabel="angle  [degrees]", xlim=(0, 360), xticks=range(0, 361, 90))
        ax.set_ylim(expected - 5 * noise, expected + 6.5 * noise)
    axes[0].set_ylabel("angles in a bucket")
    axes[0].legend(loc="upper left", ncols=1)
    page.heading("Histograms")
    page.figure(
        fig,
        f"""{NUMBER:,} angles in {k + 1} buckets, and what is expected, with one standard deviation
        of a bucket in grey (the axis does not begin at 0).""",
    )


if __name__ == "__main__":
    main(make)
