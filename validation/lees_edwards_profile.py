"""Lees-Edwards shear: linear in bins of a tenth of a cell, a staircase without the grid shift."""

from __future__ import annotations

from typing import Any

import numpy as np
from common import ANGLE, BLUE, GREY, RED, Page, found, main, mean_and_error, plt, simulate

import mesokit
from mesokit import SRD, Box, Comparison, Fluid, MaxwellBoltzmann, Run, theory

LENGTH, RATE, BINS = 30, 0.1, 10


def parts(strength: float, steps: int, every: int) -> dict[str, Any]:
    """The sheared cube."""
    return {
        "run": Run(steps=steps, warmup=500, seed=1),
        "box": Box([LENGTH] * 3, shear_rate=RATE),
        "fluid": Fluid(
            density=10, timestep=0.1, collision=SRD(angle=ANGLE), thermostat=MaxwellBoltzmann(),
            grid_shift=strength,
        ),
        "observe": [mesokit.VelocityProfile(bins_per_cell=BINS, every=every)],
    }  # fmt: skip


def within_cells(strength: float, samples: int, every: int) -> np.ndarray:
    """Deviation from the line against the place within a cell, (samples, BINS), over all cells."""
    simulation = mesokit.Simulation(threads=1, **parts(strength, 0, 1))
    simulation.engine.advance(300)
    y = (np.arange(LENGTH * BINS) + 0.5) / BINS
    found = []
    for _ in range(samples):
        simulation.engine.advance(every)
        _, mass, momentum, _ = simulation.engine.moments((1,), (LENGTH * BINS,))
        deviation = momentum[0] / mass - theory.lees_edwards_velocity(y, LENGTH, RATE)
        found.append(deviation.reshape(LENGTH, BINS).mean(axis=0))
    return np.array(found)


def make() -> int:
    """Write the page."""
    page = Page("lees_edwards_profile", "Profile of sheared fluid")
    shifted = simulate(**parts(1.0, 2000, 5))["velocity-profile"]
    fixed = simulate(**parts(0.0, 300, 5))["velocity-profile"]
    page.text(
        f"SRD in a cube of {LENGTH}^3 cells (density 10, 2.27 rad, timestep 0.1, Maxwell-Boltzmann "
        f"thermostat) at shear rate {RATE}, measured in {LENGTH * BINS} slices of a/10 every 5 "
        "steps. Neighbouring slices rise and fall with the same eddies, so their errors are not "
        "independent and a chi-square over slices would be wrong. Fourier modes of the deviation "
        "from the line are independent of each other in a uniform fluid: the chi-square is "
        "taken over them, each with its own error from blocking in time."
    )
    slope, chi = found(shifted, "shear rate"), found(shifted, "chi-square")
    page.table([slope, chi])
    page.check(f"slope {slope.percent:+.2f} % from the shear rate (at most 1 %)",
               abs(slope.percent) < 1)  # fmt: skip
    page.check(
        f"linear: chi-square per degree of freedom {chi.measured:.2f}, {chi.note}",
        float(chi.note.split("p = ")[1].split(",")[0]) > 0.001,
    )
    places = (np.arange(BINS) + 0.5) / BINS
    slope_of = np.linalg.pinv(np.stack([np.ones(BINS), places - 0.5], axis=1))[1]
    rows, shapes = [], {}
    for name, strength, samples in (("full grid shift", 1.0, 300), ("no grid shift", 0.0, 50)):
        series = within_cells(strength, samples, 4)
        shapes[name] = mean_and_error(series)
        slope_within, uncertainty = mean_and_error(series @ slope_of)
        rows.append(
            Comparison(f"shear rate within cells, {name}", RATE + slope_within, uncertainty, RATE,
                       "1/tau", "" if strength else "approximate: cells that move as one have 0")
        )  # fmt: skip
    page.text(
        "Without the grid shift the fluid of a cell moves as one: the shear rate within cells "
        "is far below the mean one, and the profile is a staircase. With it every step has a "
        "staircase of its own and only their mean is linear; errors come from the scatter over "
        "steps, whose shifts are independent."
    )
    page.table(rows)
    smooth, steps = rows
    page.check(f"same slope within cells with the shift: {smooth.deviation:+.1f} s.e.",
               abs(smooth.deviation) < 3)  # fmt: skip
    page.check(f"staircase without it: slope within cells {steps.percent:+.0f} %",
               steps.percent < -30)  # fmt: skip
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    y = shifted.x["y"]
    show = (y > 12) & (y < 18)
    for edge in range(12, 19):
        axes[0].axvline(edge, color=GREY, lw=0.4)
    for result, marker, colour, name in (
        (shifted, "o", BLUE, "full grid shift"), (fixed, "s", RED, "no grid shift"),
    ):  # fmt: skip
        axes[0].errorbar(y[show], result.value[show], result.error[show], fmt=marker, ms=3,
                         lw=0.8, color=colour, label=name)  # fmt: skip
        mean, error = shapes[name]
        axes[1].errorbar(places, mean, error, fmt=marker, color=colour, label=name)
    axes[0].plot(y[show], shifted.expected[show], "k-", lw=1, label="theory: linear", zorder=0)
    axes[0].set(xlabel="y", ylabel="velocity", xlim=(12, 18))
    axes[0].legend(loc="upper left")
    axes[1].axhline(0, color="k", lw=1, label="theory: linear", zorder=0)
    axes[1].set(xlabel="place within the cell", ylabel="velocity - linear", xlim=(0, 1))
    axes[1].legend()
    page.figure(
        fig, "Left: the middle of the profile, with cell boundaries. Right: deviation from the "
        "straight line against the place within a cell, mean over all cells. Error bars: one "
        "standard error, mostly below the points.",
    )  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
