"""The Maxwell-Boltzmann thermostat: canonical energies of the cells, and no drag on the flow."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import BLUE, RED, Page, found, main, mean_and_error, plt, renamed, simulate
from scipy import stats

import mesokit
from mesokit import (
    SRD,
    Box,
    Comparison,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Surface,
    theory,
)

SIZE = {2: 120, 3: 24}
SNAPSHOTS = 15


def cell_energies(d: int, density: float) -> tuple[np.ndarray, np.ndarray]:
    """Occupancy, and kinetic energy about the mean velocity, of each cell with two or more.

    Without a grid shift the collision cells are those of the whole numbers, and velocities at the
    end of a step are those that thermostat and collision have just left. Each step draws anew.
    """
    size = SIZE[d]
    simulation = simulate(
        run=Run(steps=0, seed=int(10 * density) + d), box=Box([size] * d),
        fluid=Fluid(
            density=density, collision=SRD(angle=130), thermostat=MaxwellBoltzmann(), grid_shift=0
        ),
    )  # fmt: skip
    occupancy, energy = [], []
    simulation.engine.advance(20)
    for _ in range(SNAPSHOTS):
        simulation.engine.advance(5)
        place = np.floor(simulation.engine.positions()).astype(int)
        v = simulation.engine.velocities()
        cell = np.ravel_multi_index(tuple(place.T), (size,) * d, mode="wrap")
        n = np.bincount(cell, minlength=size**d)
        e = np.bincount(cell, (v**2).sum(axis=1), minlength=size**d)
        for k in range(d):
            e -= np.bincount(cell, v[:, k], minlength=size**d) ** 2 / np.maximum(n, 1)
        keep = n >= 2
        occupancy.append(n[keep])
        energy.append(e[keep] / 2)
    return np.concatenate(occupancy), np.concatenate(energy)


def canonical(page: Page, axes: Any) -> None:
    """Kolmogorov-Smirnov tests, variance and temperature."""
    page.heading("Energies of the cells")
    page.text(
        "SRD, 130 degrees, timestep 0.1, no grid shift; 15 snapshots 5 steps apart. The "
        "relative kinetic energy of a cell of N particles must follow Gamma(d(N - 1)/2, kT). "
        "'all N' is the test over all cells at once, of the probability integral of each cell's "
        "energy, which must be uniform; then come single occupancies with energies themselves."
    )
    rows, temperatures, worst = [], [], 1.0
    for axis, d in zip(axes, (2, 3), strict=True):
        for density in (3, 5, 10):
            n, energy = cell_energies(d, density)
            shape = d * (n - 1) / 2
            everything = stats.kstest(stats.gamma.cdf(energy, shape), "uniform")
            score = (energy - shape) / np.sqrt(shape)
            spread = (score**2).mean()
            error = (score**2).std() / math.sqrt(len(score))
            rows.append([f"{d}D", density, "all", len(n), f"{everything.statistic:.4f}",
                         f"{everything.pvalue:.3f}", f"{spread:.4f} +- {error:.4f}"])  # fmt: skip
            worst = min(worst, everything.pvalue)
            if density == 5:
                page.check(f"{d}D: at least 10^5 cells ({len(n)})", len(n) >= 1e5)
            for one in (2, density, 2 * density) if density == 5 else (density,):
                e = energy[n == one]
                test = stats.kstest(e, lambda x, one=one, d=d: theory.cell_energy_cdf(x, one, d))
                ratio = ((e - d * (one - 1) / 2) ** 2).mean() / theory.cell_energy_variance(one, d)
                error = ((e - e.mean()) ** 2).std() / e.var() / math.sqrt(len(e))
                rows.append([f"{d}D", density, one, len(e), f"{test.statistic:.4f}",
                             f"{test.pvalue:.3f}", f"{ratio:.4f} +- {error:.4f}"])  # fmt: skip
                worst = min(worst, test.pvalue)
                if density == 5:
                    x = np.linspace(0, np.quantile(e, 0.999), 300)
                    drawn = {"density": True, "histtype": "step", "color": BLUE}
                    name = "cells" if one == density else ""
                    axis.hist(e, 60, range=(0, x[-1]), label=name, **drawn)
                    pdf = theory.cell_energy_pdf(x, one, d)
                    name = "theory: gamma distribution" if one == density else ""
                    axis.plot(x, pdf, "k-", lw=0.8, label=name)
                    top = max(pdf.argmax(), 32 if d == 2 else 9)
                    aside = {"xytext": (4, 3), "textcoords": "offset points"}
                    axis.annotate(f"$N$ = {one}", (x[top], pdf[top]), **aside)
            temperature = energy.sum() / shape.sum()
            error = math.sqrt(shape.sum()) / shape.sum()
            temperatures.append(
                Comparison(f"temperature, {d}D, density {density}", temperature, error, 1, "kT")
            )
        axis.set(xlabel="kinetic energy of a cell  [$kT$]", title=f"{d}D", ylim=(0, 0.55),
                 ylabel="probability density  [$1/kT$]")  # fmt: skip
        axis.legend()
    page.grid(["", "density", "N", "cells", "largest distance", "p", "variance / theory"], rows)
    page.check(
        f"Kolmogorov-Smirnov: smallest p of {len(rows)} tests {worst:.3f} (above 0.001)",
        worst > 0.001,
    )
    page.table(temperatures)
    off = max(abs(c.percent) for c in temperatures)
    page.check(f"temperature within {off:.2f} % (at most 0.3 %)", off < 0.3)


def couette(page: Page, axis: Any, runs: int = 8, height: int = 16, speed: float = 0.3) -> None:
    """The slope between moving plates, and whether the line is bent as drag would bend it."""
    page.heading("Couette flow")
    page.text(
        f"Plates {height} cells apart that move at +-{speed}; SRD, 130 degrees, density 10, "
        "timestep 0.1; errors from the spread of 8 runs. A thermostat that damped the flow at a "
        "rate g would bend the line into sinh(y sqrt(g/nu)): g is what the cubic part of the "
        "profile, a cell and more away from the plates, says."
    )
    rows = []
    for d in (2, 3):
        size = [40, height] if d == 2 else [8, height, 8]
        nu = theory.transport(
            "srd", d, 10, 0.1, angle=130, thermostat="maxwell-boltzmann"
        ).viscosity
        slopes, rates, profiles = [], [], []
        for seed in range(runs):
            upper, lower = ((speed, *[0] * (d - 1)), (-speed, *[0] * (d - 1)))
            simulation = simulate(
                run=Run(steps=6000, warmup=1500, seed=seed + 1), box=Box(size),
                fluid=Fluid(
                    density=10, collision=SRD(angle=130), thermostat=MaxwellBoltzmann()
                ),
                walls=[Plates(axis="y", lower=Surface(velocity=lower),
                              upper=Surface(velocity=upper))],
                observe=[mesokit.VelocityProfile(every=20, bins_per_cell=2)],
            )  # fmt: skip
            result = simulation["velocity-profile"]
            profiles.append(result.value)
            slopes.append(found(result, "shear rate").measured)
            y = result.x["y"] - height / 2
            inside = abs(y) < height / 2 - 1
            basis = np.stack([y[inside], y[inside] ** 3], axis=1)
            line, cubic = np.linalg.lstsq(basis, result.value[inside], rcond=None)[0]
            rates.append(6 * nu * cubic / line)
        expected = found(result, "shear rate")
        rows.append(
            renamed(
                Comparison("", *mean_and_error(slopes), expected.expected, "1/tau"),
                f"shear rate, {d}D", "what is missing is slip at the plates",
            )
        )  # fmt: skip
        rows.append(Comparison(f"damping rate g, {d}D", *mean_and_error(rates), 0.0, "1/tau"))
        mean, error = mean_and_error(profiles)
        axis.errorbar(result.x["y"], mean, error, fmt="o" if d == 2 else "s",
                      color=BLUE if d == 2 else RED, ms=3, mfc="white", label=f"{d}D")  # fmt: skip
    axis.plot(result.x["y"], result.expected, "k-", lw=1, label="theory")
    axis.set(xlabel="y", ylabel="velocity", title="Couette flow")
    axis.legend()
    page.table(rows)
    for c in rows:
        if c.what.startswith("shear"):
            page.check(f"Couette {c.what}: {c.percent:+.1f} % (at most 4 %)", abs(c.percent) < 4)
        else:
            page.check(f"Couette {c.what}: {c.deviation:+.1f} s.e. from none", abs(c.deviation) < 3)


def make() -> int:
    """Write the page."""
    page = Page("thermostat", "The Maxwell-Boltzmann thermostat")
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.6))
    canonical(page, axes[:2])
    couette(page, axes[2])
    page.figure(fig, "Energies of cells of N particles (density 5) with the gamma distribution, "
                "and Couette flow with the straight line; errors below the points.")  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
