"""Transport coefficients of every collision rule in 2D and 3D against molecular chaos.

Viscosity of all rules from the Lees-Edwards stress; self-diffusion and sound of SRD.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import ANGLE, BLUE, GREY, RED, Page, found, main, mean_and_error, plt, renamed, simulate

import mesokit
from mesokit import (
    AT,
    SRD,
    ATPlusA,
    Box,
    Comparison,
    Fluid,
    MaxwellBoltzmann,
    NoThermostat,
    Run,
    SRDPlusA,
    theory,
)

RATE = 0.1
SIZE = {2: 32, 3: 16}
# rule, density, timestep, steps; what an independent program measured for the same fluid
CASES: dict[int, list[tuple[Any, float, float, int, str]]] = {
    2: [
        (SRD(angle=90), 10, 0.1, 12_000, "0.752(5), 0.745(4)"),
        (AT(), 10, 0.1, 12_000, "0.813(14)"),
        (SRDPlusA(angle=90), 10, 0.1, 12_000, "0.378(3)"),
        (ATPlusA(), 10, 0.1, 12_000, "0.442(5)"),
        (SRD(angle=90), 10, 0.02, 12_000, ""),
        (AT(), 10, 0.02, 12_000, ""),
        (SRDPlusA(angle=90), 10, 0.02, 12_000, ""),
        (ATPlusA(), 10, 0.02, 12_000, ""),
    ],
    3: [
        (SRD(angle=ANGLE), 10, 0.1, 2500, "0.857(8), 0.865(11)"),
        (SRD(angle=ANGLE), 10, 1.0, 2500, ""),
        (AT(), 10, 0.1, 2500, "0.823(8)"),
        (SRDPlusA(angle=ANGLE), 10, 0.1, 2500, ""),
        (ATPlusA(), 10, 0.1, 2500, "0.411(3)"),
        (SRD(angle=ANGLE), 10, 0.02, 2500, ""),
        (AT(), 10, 0.02, 2500, ""),
        (SRDPlusA(angle=ANGLE), 10, 0.02, 2500, ""),
        (ATPlusA(), 10, 0.02, 2500, ""),
    ],
}
NAMES = {"srd": "SRD", "at": "AT-a", "srd+a": "SRD+a", "at+a": "AT+a"}


def coefficients(rule: Any, d: int, density: float, dt: float, thermostat: str) -> Any:
    """Transport coefficients at molecular chaos."""
    angle = getattr(rule, "angle", None)
    return theory.transport(rule.rule, d, density, dt, angle=angle, thermostat=thermostat)


def one_loop(d: int, chaos: Any, density: float, dt: float, length: float) -> float:
    """Molecular chaos with the fluctuations of the fluid added."""
    cutoff = 2 if dt < 0.5 else 8
    loss = chaos.sound_attenuation or chaos.viscosity
    if length <= cutoff:
        length = cutoff + 1e-9
    return theory.viscosity_renormalised(
        d, chaos.viscosity, loss, density, box_length=length, cutoff=cutoff
    )


def viscosities(page: Page) -> list[tuple[str, Comparison, float]]:
    """A table for each dimension; returns what the figure shows."""
    shown = []
    for d, cases in CASES.items():
        rows, parts = [], []
        for rule, density, dt, steps, other in cases:
            own = rule.rule.startswith("at")
            bath = NoThermostat() if own else MaxwellBoltzmann()
            result = simulate(
                run=Run(steps=steps, warmup=500, seed=5),
                box=Box([SIZE[d]] * d, shear_rate=RATE),
                fluid=Fluid(density=density, timestep=dt, collision=rule, thermostat=bath),
                observe=[mesokit.Stress(every=1)],
            )["stress"]
            chaos = coefficients(rule, d, density, dt, bath.rule)
            # shear tears up waves longer than 2 pi sqrt(nu/rate) before they add to the viscosity
            length = min(SIZE[d], 2 * math.pi * math.sqrt(chaos.viscosity / RATE))
            loop = one_loop(d, chaos, density, dt, length)
            name = f"{NAMES[rule.rule]} {d}D"
            if hasattr(rule, "angle"):
                name += f" {rule.angle:.0f} deg"
            name += f" dt {dt:g}"
            total = renamed(found(result, "viscosity"), name, "", chaos.viscosity)
            rows.append([total, loop, other])
            parts.append(
                [
                    name,
                    *(
                        f"{c.measured:.4f} +- {c.error:.4f} ({c.expected:.4f}, {c.percent:+.1f} %)"
                        for c in (found(result, "kinetic"), found(result, "collisional"))
                    ),
                ]
            )
            shown.append((name, total, loop))
        page.heading(f"Viscosity in {d}D")
        page.grid(
            ["fluid", "measured", "s.e.", "molecular chaos", "deviation", "in s.e.",
             "with one loop", "deviation", "in s.e.", "shear wave elsewhere"],
            [
                [c.what, f"{c.measured:.4f}", f"{c.error:.4f}", f"{c.expected:.4f}",
                 f"{c.percent:+.1f} %", f"{c.deviation:+.1f}", f"{loop:.4f}",
                 f"{100 * (c.measured / loop - 1):+.1f} %",
                 f"{(c.measured - loop) / c.error:+.1f}", other]
                for c, loop, other in rows
            ],
        )  # fmt: skip
        page.grid(["fluid", "kinetic part (theory)", "collisional part (theory)"], parts)
        limit = 5 if d == 2 else 4
        for c, loop, _ in rows:
            low, high = min(c.expected, loop), max(c.expected, loop)
            outside = max(low - c.measured, c.measured - high, 0) / c.expected
            page.check(
                f"{c.what}: {100 * outside:.1f} % outside the span from molecular chaos to one "
                f"loop (at most {limit} %), standard error {100 * c.error / c.measured:.1f} %",
                100 * outside <= limit and c.error < 0.015 * c.measured,
            )
    return shown


def diffusion() -> list[Comparison]:
    """Self-diffusion of SRD particles without a thermostat."""
    rows = []
    cases = [
        # d, size, density, angle, timestep, steps, longest lag
        (3, 16, 5, 90.0, 1.0, 400, 40),
        (2, 64, 5, 90.0, 1.0, 400, 40),
        (3, 16, 10, ANGLE, 0.1, 800, 200),
    ]
    for d, size, density, angle, dt, steps, lag in cases:
        result = simulate(
            run=Run(steps=steps, warmup=100, seed=6),
            box=Box([size] * d),
            fluid=Fluid(density=density, timestep=dt, collision=SRD(angle=angle)),
            observe=[
                mesokit.MeanSquareDisplacement(every=4, particles=density * size**d, max_lag=lag)
            ],
        )["mean-square-displacement"]
        c = found(result, "diffusion")
        name = f"D, {d}D density {density}, {angle:.0f} deg, dt {dt:g}"
        rows.append(renamed(c, name, c.note))
    return rows


def sound(seeds: int = 6) -> list[Comparison]:
    """Sound from the longest waves: adiabatic without a thermostat, isothermal with it.

    The error comes from the spread of independent runs, each of some 100 decay times.
    """
    rows = []
    for d, size, steps, angle in ((2, 16, 25_000, 90.0), (3, 10, 6000, ANGLE)):
        unit = tuple(map(tuple, np.eye(d, dtype=int).tolist()))
        for bath, name in ((NoThermostat(), "free"), (MaxwellBoltzmann(), "thermostatted")):
            results = [
                simulate(
                    run=Run(steps=steps, warmup=500, seed=seed + 1),
                    box=Box([size] * d),
                    fluid=Fluid(
                        density=10, timestep=0.1, collision=SRD(angle=angle), thermostat=bath
                    ),
                    observe=[mesokit.LongitudinalModes(every=3, waves=unit, max_lag=600)],
                )["longitudinal-modes"]
                for seed in range(seeds)
            ]
            for what, symbol in (("sound speed", "c"), ("sound attenuation", "Gamma")):
                one = found(results[0], what)
                mean, error = mean_and_error([found(r, what).measured for r in results])
                rows.append(
                    Comparison(f"{symbol}, SRD {d}D, {name}", mean, error, one.expected, one.unit)
                )
    return rows


def make() -> int:
    """Write the page."""
    page = Page("viscosity_rules", "Transport coefficients of every collision rule")
    page.text(
        f"Viscosity from the Lees-Edwards stress at shear rate {RATE} (boxes of 32^2 and 16^3 "
        "cells, density 10). SRD and SRD+a are held at kT by the Maxwell-Boltzmann thermostat, "
        "AT holds itself. Molecular chaos leaves out two things. Thermal "
        "eddies carry momentum too ('with one loop'): this "
        "adds a term that grows with the logarithm of the size in 2D and a few per cent where the "
        "viscosity is low, as with the +a rules; its cut-off is known to a factor of about 1.5 "
        "only, and the shear itself cuts off waves longer than 2 pi sqrt(nu/rate). And at a mean "
        "free path of 0.1 cells particles collide with each other again and again: the kinetic "
        "part, small here, comes out higher (in 2D with the eddies by more than itself) and the "
        "collisional part 1 to 2 % lower; at 0.02 cells it is up to 7 % lower, the most with rules "
        "+a and in 2D. At timestep 1 the parts agree with theory one by one. "
        "The last column is what an independent program found from the decay of shear waves."
    )
    shown = viscosities(page)
    page.heading("Self-diffusion of SRD particles")
    page.text(
        "Mean free path of a cell: molecular chaos is good, but for the slow (logarithmic) growth "
        "in 2D. Mean free path of 0.1 cells: the flow that a particle stirs up pushes it on, which "
        "`theory.self_diffusion` adds to molecular chaos."
    )
    moved = diffusion()
    page.table(moved)
    for c in moved:
        limit = 3.5 if "dt 0.1" in c.what else 2
        page.check(f"{c.what}: {c.percent:+.1f} % (at most {limit} %)", abs(c.percent) < limit)
    page.heading("Sound in SRD fluids")
    page.text(
        "From the longest longitudinal waves of the box. Energy that is conserved makes sound "
        "adiabatic, c^2 = (d + 2)/d kT/m; a thermostat makes it isothermal, c^2 = kT/m. "
        "The waves of these small boxes (16^2 and 10^3 cells) are short, and fluctuations raise "
        "the attenuation Gamma as they raise the viscosity: it is shown beside its molecular-chaos "
        "limit for long waves, not required to meet it."
    )
    heard = sound()
    page.table(heard)
    for c in heard:
        if c.what.startswith("c,"):
            page.check(
                f"{c.what}: {c.percent:+.1f} %, {c.deviation:+.1f} s.e. (at most 2 %)",
                abs(c.percent) < 2,
            )
    page.figure(draw(shown), "Measured viscosities over those of molecular chaos.")
    return page.write()


def draw(shown: list[tuple[str, Comparison, float]]) -> Any:
    """Viscosities over those of molecular chaos."""
    fig, ax = plt.subplots(figsize=(8, 4))
    place = np.arange(len(shown))
    chaos = np.array([c.expected for _, c, _ in shown])
    ax.errorbar(
        place, [c.measured / e for (_, c, _), e in zip(shown, chaos, strict=True)],
        [c.error / e for (_, c, _), e in zip(shown, chaos, strict=True)],
        fmt="o", color=BLUE, label="measured",
    )  # fmt: skip
    ax.plot(place, [loop / c.expected for _, c, loop in shown], "_", ms=18, color=RED, mew=2,
            label="theory, with one loop")  # fmt: skip
    ax.axhline(1, color=GREY, lw=1, label="theory, molecular chaos")
    ax.set_xticks(place, [name for name, _, _ in shown], fontsize=7, rotation=90)
    ax.set(ylabel="viscosity / molecular chaos")
    ax.legend()
    return fig


if __name__ == "__main__":
    main(make)
