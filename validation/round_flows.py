"""Flow between turning cylinders and along a round pipe, against the exact solutions."""

from __future__ import annotations

from typing import Any

import numpy as np
from common import ANGLE, BLUE, GREY, RED, Page, found, long, main, plt, renamed

import mesokit
from mesokit import (
    SRD,
    Box,
    Case,
    Comparison,
    Cylinder,
    Disk,
    Fluid,
    MaxwellBoltzmann,
    Run,
    Surface,
    Uniform,
    theory,
)

INNER, OUTER, SPEED = 8.0, 20.0, 0.2  # radii, and the velocity of the surface that turns
SEEDS = (3, 5)  # independent runs
RADIUS, CENTRE = 10.0, 0.2  # of the pipe, and its velocity on the axis


def gap(turns: str, seed: int, steps: int) -> Case:
    """Two cylinders, of which one turns."""
    rates = {name: SPEED / radius for name, radius in (("inner", INNER), ("outer", OUTER))}
    surface = {name: Surface(rotation=rates[name] * (name == turns)) for name in rates}
    return Case(
        run=Run(steps=steps, warmup=long(5000), seed=seed),
        box=Box([42, 42]),
        fluid=Fluid(
            density=10, timestep=0.1, collision=SRD(angle=90), thermostat=MaxwellBoltzmann()
        ),
        walls=[
            Disk(centre=[21, 21], radius=INNER, surface=surface["inner"]),
            Disk(centre=[21, 21], radius=OUTER, fluid="inside", surface=surface["outer"]),
        ],
        observe=[
            mesokit.RadialProfile(of="azimuthal", bins_per_cell=2, every=50),
            mesokit.Forces(every=10),
        ],
    )


def pipe(steps: int) -> Case:
    """A round pipe along x."""
    nu = theory.transport("srd", 3, 10, 0.1, angle=ANGLE, thermostat="maxwell-boltzmann").viscosity
    return Case(
        run=Run(steps=steps, warmup=long(3000), seed=4),
        box=Box([8, 24, 24]),
        fluid=Fluid(
            density=10, timestep=0.1, collision=SRD(angle=ANGLE), thermostat=MaxwellBoltzmann(),
            force=Uniform(acceleration=(4 * nu * CENTRE / RADIUS**2, 0, 0)),
        ),
        walls=[Cylinder(centre=[0, 12, 12], axis="x", radius=RADIUS, fluid="inside")],
        observe=[
            mesokit.RadialProfile(of="axial", bins_per_cell=2, every=50),
            mesokit.FlowRate(every=10),
            mesokit.Forces(every=10),
        ],
    )  # fmt: skip


def together(runs: list[Comparison]) -> Comparison:
    """The mean of independent runs, by their errors."""
    weight = np.array([1 / c.error**2 for c in runs])
    mean = float(weight @ [c.measured for c in runs] / weight.sum())
    first = runs[0]
    return Comparison(
        first.what, mean, float(weight.sum() ** -0.5), first.expected, first.unit, first.note
    )


def couette(page: Page, axes: Any) -> None:
    """Either cylinder turning."""
    page.heading("Between two cylinders")
    page.text(
        f"2D, SRD at 90 degrees, density 10, timestep 0.1, Maxwell-Boltzmann thermostat; radii "
        f"{INNER:g} and {OUTER:g}. One cylinder turns, its surface at {SPEED}; the other is at "
        "rest. The profile does not depend on the viscosity: A r + B/r. Slip is what the fit "
        "of this form lacks at either surface, in per cent of the velocity of the one that turns; "
        "it leaves out the cell next to each surface. Chi-square is over all rings, with the "
        "correlations between them."
    )
    rows: list[Comparison] = []
    for axis, turns in zip(axes, ("inner", "outer"), strict=True):
        both = [page.run(f"{turns}-{s}", gap(turns, s, long(3e5))) for s in SEEDS]
        profiles = [files["radial-profile"] for files in both]
        for name in ("inner", "outer"):
            slip = together([found(p, f"slip at the {name}") for p in profiles])
            rows.append(renamed(slip, f"{turns} turns: {slip.what}", slip.note))
            page.check(
                f"{turns} cylinder turning: slip at the {name} surface {slip.measured:+.2f} +- "
                f"{slip.error:.2f} % of the surface speed (below 1 %)",
                abs(slip.measured) < 1,
            )
        for profile in profiles:
            chi = found(profile, "chi-square")
            p = float(chi.note.split("p = ")[1].split(",")[0])
            page.check(
                f"{turns} cylinder turning: chi-square of the profile per degree of freedom "
                f"{chi.measured:.2f} ({chi.note}; p above 0.001)",
                p > 0.001,
            )
        for torque in zip(*(files["forces"].comparisons for files in both), strict=True):
            c = together(list(torque))
            rows.append(renamed(c, f"{turns} turns: {c.what}", c.note))
        r, expected = profiles[0].x["r"], profiles[0].expected
        value = np.mean([p.value for p in profiles], axis=0)
        error = np.sqrt(np.sum([p.error**2 for p in profiles], axis=0)) / len(profiles)
        axis[0].errorbar(r, value, error, fmt="o", ms=3, color=BLUE, label="measured")
        axis[0].plot(r, expected, "-", color=GREY, lw=1, label="theory: $A r + B/r$, no slip")
        axis[0].set(ylabel="azimuthal velocity", title=f"{turns} cylinder turns")
        axis[0].legend()
        axis[1].errorbar(
            r, 100 * (value - expected) / SPEED, 100 * error / SPEED, fmt="o", ms=3, color=BLUE
        )
        axis[1].axhline(0, color=GREY, lw=1)
        axis[1].set(xlabel="r", ylabel="measured - theory\n[% of the speed]", ylim=(-3, 3))
    page.table(rows)


def hagen_poiseuille(page: Page, axis: Any) -> None:
    """The pipe."""
    page.heading("Along a round pipe")
    page.text(
        f"3D, SRD at 2.27 rad, density 10, timestep 0.1, thermostat; radius {RADIUS:g}, driven by "
        "a uniform force. The flow rate is compared with Hagen and Poiseuille twice: with the "
        "theoretical viscosity, which itself is good to about 1 %, and with that of the curvature "
        "of the measured parabola, which tests the wall alone."
    )
    files = page.run("pipe", pipe(long(1.5e5)))
    profile, rate, forces = files["radial-profile"], files["flow-rate"], files["forces"]
    flow, nu = found(rate, "flow rate"), found(profile, "viscosity")
    push = files.case.fluid.force.acceleration[0]
    own = theory.hagen_poiseuille_flow_rate(RADIUS, push, nu.measured)
    # both errors are of one flow, whose rate and curvature rise and fall together: an upper bound
    error = float(np.hypot(flow.error, own * nu.error / nu.measured))
    fitted = Comparison(
        "flow rate, with the viscosity of the curvature", flow.measured, error, own, flow.unit,
        "both errors as if independent",
    )  # fmt: skip
    rows = [
        *profile.comparisons,
        renamed(flow, "flow rate, with the theoretical viscosity"),
        fitted,
    ]
    page.table([*rows, *forces.comparisons])
    for c in rows[-2:]:
        percent = 100 * c.error / c.expected
        page.check(
            f"pipe: {c.what} {c.percent:+.2f} +- {percent:.2f} % off Hagen-Poiseuille (within 1 %)",
            abs(c.percent) < 1,
        )
    slip = found(profile, "slip")
    page.check(
        f"pipe: slip at the wall {slip.measured:+.2f} +- {slip.error:.2f} % of the centre velocity "
        "(below 1 %)", abs(slip.measured) < 1,
    )  # fmt: skip
    r = profile.x["r"]
    axis[0].errorbar(r, profile.value, profile.error, fmt="o", ms=3, color=RED, label="measured")
    axis[0].plot(r, profile.expected, "-", color=GREY, lw=1, label="theory, with its viscosity")
    axis[0].plot(r, profile.fit, "--", color=RED, lw=1, label="fitted parabola")
    axis[0].set(ylabel="velocity along the pipe", title="round pipe")
    axis[0].legend()
    for line, style, aside in ((profile.expected, "o", -0.08), (profile.fit, "x", 0.08)):
        axis[1].errorbar(
            r + aside, 100 * (profile.value - line) / CENTRE, 100 * profile.error / CENTRE,
            fmt=style, ms=3, color=RED if style == "o" else GREY,
            label="less theory" if style == "o" else "less the fit",
        )  # fmt: skip
    axis[1].axhline(0, color=GREY, lw=1)
    axis[1].set(xlabel="r", ylabel="measured - line\n[% of the centre]", ylim=(-3, 3))
    axis[1].legend(ncols=2)


def make() -> int:
    """Write the page."""
    page = Page("round_flows", "Flow between turning cylinders and along a pipe")
    fig, axes = plt.subplots(2, 3, figsize=(12, 6), height_ratios=[2, 1], sharex="col")
    couette(page, axes.T[:2])
    hagen_poiseuille(page, axes.T[2])
    page.figure(
        fig, "Profiles with the exact solutions, and what they lack. Error bars: one standard "
        "error; neighbouring rings are correlated.",
    )  # fmt: skip
    return page.write()


if __name__ == "__main__":
    main(make)
