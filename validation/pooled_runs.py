"""Forty runs of one case: whether the error bars of what they say together are honest."""

from __future__ import annotations

import shutil

import numpy as np
from common import BLUE, GREY, RUNS, SHORT, Page, long, main, plt

from mesokit import (
    SRD,
    Box,
    Case,
    FlowRate,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Study,
    Uniform,
    VelocityProfile,
)

SEEDS = 8 if SHORT else 40
WITHIN = 0.2  # of 1, asked for: the scatter of 40 runs is itself known to 11 %


def channel() -> Case:
    """A small channel, driven; a run lasts some thirty relaxation times of its flow."""
    return Case(
        run=Run(steps=long(4000), warmup=600),
        box=Box([12, 9]),
        fluid=Fluid(
            density=9.52, collision=SRD(angle=90), thermostat=MaxwellBoltzmann(),
            force=Uniform([0.02, 0]),
        ),
        walls=[Plates(axis="y")],
        observe=[VelocityProfile(axis="y", every=3), FlowRate(every=10)],
    )  # fmt: skip


def make() -> int:
    """Write the page."""
    page = Page("pooled_runs", "Runs of one case as one")
    page.text(
        f"A channel of 12 x 9 cells with {SEEDS} seeds. `mesokit merge` pools the blocks of time "
        "of all runs, and its error bars follow from these blocks; the scatter of the runs about "
        "their mean, over the root of their number, is what they should be. The table of a study "
        "pools the runs likewise. Chi-square of the seeds, by the error bars of the single runs, "
        "says whether these are right too: it is then about the degrees of freedom."
    )
    folder = RUNS / ("short" if SHORT else "") / "pooled_runs"
    shutil.rmtree(folder, ignore_errors=True)
    study = Study(channel(), seeds=SEEDS, output=folder)
    study.run()
    merged = study.merged()
    rows, ratios = [], []
    for row in study.table():
        pooled = merged[row.observable][row.key]
        ratios.append(pooled.error / row.scatter)
        rows.append([
            f"{pooled.what} [{pooled.unit}]" if pooled.unit else pooled.what,
            f"{pooled.measured:.5g}", f"{pooled.expected:.5g}",
            f"{pooled.error:.2g}", f"{row.scatter:.2g}", f"{ratios[-1]:.2f}",
            f"{row.number.error / row.scatter:.2f}",
            f"{row.seeds.chi2:.0f} of {row.seeds.dof}",
        ])  # fmt: skip
    page.grid(
        ["number", "pooled", "theory", "error bar, pooled", "scatter", "ratio",
         "ratio of the study's table", "chi-square of the seeds"],
        rows,
    )  # fmt: skip
    profile = merged["velocity-profile"]
    each = np.array([run.files["velocity-profile"].value for run in study.runs])
    scatter = each.std(axis=0, ddof=1) / np.sqrt(SEEDS)
    overall = float(np.sqrt(np.mean(profile.error**2) / np.mean(scatter**2)))
    page.text(f"Root mean square over the bins of the profile: {overall:.3f} times the scatter.")
    worst = max(abs(ratio - 1) for ratio in [*ratios, overall])
    page.check(
        f"pooled error bars are within {100 * WITHIN:.0f} % of the scatter (worst {worst:.3f})",
        worst < WITHIN,
    )
    fig, ax = plt.subplots(figsize=(6.4, 4))
    y = next(iter(profile.x.values()))
    ax.plot(y, scatter, "o", mfc="white", color=BLUE, label="scatter of the runs / $\\sqrt{n}$")
    ax.plot(y, profile.error, "-", color="black", label="error bar of the pooled profile")
    band = np.array([1 - 1 / np.sqrt(2 * SEEDS - 2), 1 + 1 / np.sqrt(2 * SEEDS - 2)])
    ax.fill_between(y, *(band[:, None] * profile.error), color=GREY, alpha=0.2, lw=0,
                    label="two thirds of the points are expected here")  # fmt: skip
    ax.set_xlabel("y")
    ax.set_ylabel("standard error of the velocity  [$a/\\tau$]")
    ax.set_ylim(0, None)
    ax.legend()
    page.figure(
        fig,
        "Standard error of the mean velocity in each bin: that of the pooled runs, with the band "
        "in which two thirds of the points should lie, and the scatter of the runs.",
    )
    return page.write()


if __name__ == "__main__":
    main(make)
