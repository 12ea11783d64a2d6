"""Slip at no-slip plates, for each kind of virtual particles and three mean free paths."""

from __future__ import annotations

from typing import Any

import numpy as np
from common import ANGLE, BLUE, GREEN, GREY, PURPLE, RED, Page, found, main, plt, simulate

import mesokit
from mesokit import (
    SRD,
    Box,
    CaseError,
    Comparison,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Run,
    Uniform,
    theory,
)

HEIGHT, CENTRE = 12, 0.2
REFERENCE = 24  # the height for which slip is quoted in per cent of the centre velocity
TIMESTEPS = (0.02, 0.1, 0.5)
COLOURS = (BLUE, RED, GREEN, PURPLE)


def kinds() -> list[str]:
    """The kinds of virtual particles that plates know, the default first."""
    known = [Plates(axis="y").virtual]
    for kind in ("extrapolate", "fill", "top-up", "none"):
        try:
            Plates(axis="y", virtual=kind)
        except CaseError:
            continue
        if kind not in known:
            known.append(kind)
    return known


def channel(d: int, timestep: float, kind: str, steps: int) -> tuple[Any, Any]:
    """Velocity and density profile of a channel flow with the same centre velocity."""
    angle = ANGLE if d == 3 else 90.0
    nu = theory.transport(
        "srd", d, 10, timestep, angle=angle, thermostat="maxwell-boltzmann"
    ).viscosity
    push = 8 * nu * CENTRE / HEIGHT**2
    relaxation = HEIGHT**2 / (np.pi**2 * nu) / timestep
    simulation = simulate(
        run=Run(steps=steps, warmup=int(6 * relaxation), seed=9),
        box=Box([16, HEIGHT, 12] if d == 3 else [192, HEIGHT]),
        fluid=Fluid(
            density=10, timestep=timestep, collision=SRD(angle=angle),
            thermostat=MaxwellBoltzmann(), force=Uniform(acceleration=(push, *[0.0] * (d - 1))),
        ),
        walls=[Plates(axis="y", virtual=kind)],
        observe=[mesokit.VelocityProfile(every=25), mesokit.DensityProfile(every=25)],
    )  # fmt: skip
    return simulation["velocity-profile"], simulation["density-profile"]


def extrapolated(virtual: float, bins: int = 40, height: int = 10) -> float:
    """Slip length for a mean free path far below a cell, `virtual` times the density in the solid.

    Then particles hardly move between collisions, and the mean velocity solves
    u(y) = < mean velocity of the cell around y >, averaged over grid shifts: a random walk with
    triangular steps that plates absorb (a Milne problem). u becomes y + b away from the plate.
    """
    n = bins * height
    y = (np.arange(n) + 0.5) / bins
    matrix = np.zeros((n, n))
    for start in range(1 - bins, n):
        low, high = max(start, 0), min(start + bins, n)
        weight = (high - low) + virtual * (low - start)
        matrix[low:high, low:high] += 1 / (bins * weight)
    free = y < height - 2
    system = np.eye(free.sum()) - matrix[np.ix_(free, free)]
    known = matrix[np.ix_(free, ~free)]
    # far from the plate u is given as y + c; c is such that the slope is 1 below, too
    forced, offset = (
        np.linalg.solve(system, known @ v) for v in (y[~free], np.ones((~free).sum()))
    )
    middle = (y[free] > 3) & (y[free] < height - 3)
    slopes = [np.polyfit(y[free][middle], u[middle], 1)[0] for u in (forced, offset)]
    u = forced + (1 - slopes[0]) / slopes[1] * offset
    slope, intercept = np.polyfit(y[free][middle], u[middle], 1)
    return float(intercept / slope)


def make() -> int:
    """Write the page."""
    page = Page("wall_slip", "Slip at no-slip plates")
    page.text(
        f"Channel flow of SRD (density 10; 2.27 rad in 3D, 90 degrees in 2D), {HEIGHT} cells high, "
        f"centre velocity {CENTRE} without slip, Maxwell-Boltzmann thermostat, in 3D (16 x {HEIGHT}"
        f" x 12 cells) and 2D (192 x {HEIGHT}). A parabola is fitted where slices are a cell or "
        "more away from the plates and extrapolated to them. Slip is a property of the plate: "
        "u = b du/dy with the slip length b, in cells; in a slit of height H it is "
        "4b/H / (1 + 4b/H) of the centre velocity. A low slit shows b best; the last columns give "
        f"what it means for {REFERENCE} cells."
    )
    rows, rates = [], {}
    example, densities = {}, []
    names = kinds()
    default = names[0]
    cases = [(3, dt, kind) for dt in TIMESTEPS for kind in names]
    cases += [(2, 0.1, kind) for kind in names]
    for d, dt, kind in cases:
        steps = {0.02: 16_000, 0.1: 20_000, 0.5: 12_000}[dt]
        velocity, density = channel(d, dt, kind, steps)
        slip, nu = found(velocity, "slip"), found(velocity, "viscosity")
        share, error = slip.measured / 100, slip.error / 100
        length, spread = HEIGHT / 4 * share / (1 - share), HEIGHT / 4 * error / (1 - share) ** 2
        ratio = 4 * length / REFERENCE
        there, uncertain = (
            100 * ratio / (1 + ratio),
            100 * 4 * spread / REFERENCE / (1 + ratio) ** 2,
        )
        rates[d, dt, kind] = length, spread, there, uncertain
        chi = found(density, "chi-square")
        lower, upper = (
            found(density, "density in the cell at the l"),
            found(density, "density in the cell at the u"),
        )
        p = float(chi.note.split("p = ")[1].split(",")[0])
        densities.append((f"{d}D dt {dt:g} {kind}", p, lower, upper))
        rows.append(
            [f"{d}D", f"{dt:g}", kind, f"{length:.3f} +- {spread:.3f}",
             f"{slip.measured:.1f} +- {slip.error:.1f} %", f"{there:.2f} +- {uncertain:.2f} %",
             f"{nu.percent:+.1f} +- {100 * nu.error / nu.expected:.1f} %",
             f"{lower.measured:.3f}, {upper.measured:.3f} +- {lower.error:.3f}", f"{p:.2g}"]
        )  # fmt: skip
        if (d, dt) == (3, 0.1):
            example[kind] = velocity
    page.grid(
        ["", "timestep", "virtual", "slip length", f"slip at {HEIGHT} cells",
         f"slip at {REFERENCE} cells", "viscosity - theory", "density at the plates",
         "uniform density: p"], rows,
    )  # fmt: skip
    for (d, dt, kind), (_, _, there, error) in rates.items():
        if kind == default:
            page.check(
                f"'{kind}' (default), {d}D, timestep {dt:g}: slip {there:.2f} +- {error:.2f} % of "
                f"the centre velocity at {REFERENCE} cells (at most 2 %)",
                abs(there) <= 2,
            )
    worst = min(p for _, p, _, _ in densities)
    page.check(
        f"density uniform up to the plates: smallest p of {len(densities)} chi-square tests "
        f"{worst:.2g} (above 0.001)",
        worst > 0.001,
    )
    off = max(abs(c.deviation) for _, _, *both in densities for c in both)
    page.check(
        f"density in the cells next to the plates: at most {off:.1f} s.e. from the mean", off < 4
    )
    page.heading("Why")
    factors = np.array([0.5, 0.75, 1, 1.5, 2, 3, 4, 6])
    lengths = np.array([extrapolated(q) for q in factors])
    page.text(
        "Virtual particles at the mean velocity of the plate make the cell that a plate cuts as "
        "slow as if the fluid stood still beyond the plate. To continue the linear profile, it "
        "would have to move backwards there. What is missing is the slip. For a mean free path "
        "far below a cell the mean velocity obeys a random walk with triangular steps that the "
        "solid absorbs, which gives the slip length without a simulation: "
        f"{extrapolated(1):.3f} cells for virtual particles as dense as the fluid, "
        f"{extrapolated(2):.3f} for twice as dense ones, and none at a factor of about 2.7. "
        "A longer mean free path makes the cut cells matter less, and slip becomes smaller. "
        "Virtual particles are a thermal bath whatever their number, so that a higher density of "
        "them leaves equilibrium as it is. 'extrapolate' keeps their density and instead lets them "
        "move as the linear profile would go on into the solid."
    )
    page.table(
        [
            Comparison(f"slip length, timestep {dt:g}, 'fill'", *rates[3, dt, "fill"][:2],
                       extrapolated(1), "a", "approximate: limit of a short mean free path")
            for dt in TIMESTEPS
        ]
    )  # fmt: skip
    fig, axes = plt.subplots(1, 2, figsize=(9.5, 3.9))
    for (kind, velocity), colour, mark in zip(example.items(), COLOURS, "os^D", strict=False):
        y = velocity.x["y"]
        near = y < 3.2
        axes[0].errorbar(y[near], velocity.value[near], velocity.error[near], fmt=mark, ms=3,
                         mfc="white", color=colour, label=f"'{kind}'")  # fmt: skip
        axes[0].plot(y[near], velocity.fit[near], "--", color=colour, lw=0.8,
                     label="fitted parabolas" if mark == "o" else "")  # fmt: skip
    axes[0].plot(y[near], velocity.expected[near], "-", color=GREY, label="theory, no slip")
    axes[0].set(xlabel="y", ylabel="velocity", xlim=(0, 3.2), ylim=(0, None))
    axes[0].legend()
    axes[1].plot(factors, lengths, "-", color=GREY, label=r"theory, mean free path $\ll a$")
    for dt, colour, mark in zip(TIMESTEPS, COLOURS, "os^", strict=False):
        value, error, *_ = rates[3, dt, "fill"]
        axes[1].errorbar(1, value, error, fmt=mark, color=colour, mfc="white",
                         label=rf"'fill', timestep {dt:g} $\tau$")  # fmt: skip
    axes[1].axhline(0, color="k", lw=0.5)
    axes[1].set(xlabel="density of virtual particles / density", ylabel="slip length")
    axes[1].legend()
    page.figure(
        fig, "Left: 3D channel, timestep 0.1, next to a plate. Right: slip length of 'fill', "
        "whose virtual particles are as dense as the fluid, beside theory for any density "
        "of them. Error bars: one standard error.",
    )  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
