"""Solutes that act on the fluid by a potential: an ideal gas about them, depletion, diffusion."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
from common import BLUE, GREY, Page, found, long, main, mean_and_error, plt

import mesokit
from mesokit import SRD, WCA, Box, Case, Comparison, Fluid, Run, Simulation, every, theory
from mesokit.method.mpcd.solutes import Polymer, Solutes
from mesokit.potential.thermal import effective_radius, energies, excluded_volume

DENSITY, SIZE = 5.0, 20
DISK = WCA(sigma=3.0)
GAPS = (4.0, 5.0, 5.7, 7.0)  # between the centres of two disks at rest
SHELLS = np.array([2.7, 2.8, 2.9, 3.0, 3.1, 3.2, 3.3, 3.5, 4.0, 5.0, 6.0, 8.0])
STEPS = 20_000
CUBE, SPHERE, MASS, SEEDS = 12, WCA(sigma=2.0), 170.0, 6
DIFFUSION_STEPS, EARLY_STEPS = 30_000, 15_000


def look_at_rest(places: list[list[float]], steps: int, often: int, look: Any) -> None:
    """Run disks so heavy that they stay, in 2D, and look at the engine every so many steps."""
    simulation = Simulation(
        run=Run(steps=long(steps)), box=Box([SIZE, SIZE]),
        fluid=Fluid(density=DENSITY), beads=np.array(places), threads=1,
        solutes=Solutes(
            [Polymer(len(places))], mass=1e6, coupling="potential", solvent_pair=DISK, skin=0.05
        ),
        callbacks=[every(often, lambda simulation: look(simulation.engine))],
    )  # fmt: skip
    simulation.run()


def density(page: Page) -> None:
    """In shells about one disk."""
    middle, counts = np.array([10.0, 10.0]), []

    def look(engine: Any) -> None:
        away = np.sqrt(((engine.positions() - middle) ** 2).sum(axis=1))
        counts.append(np.histogram(away, SHELLS)[0])

    look_at_rest([[10.0, 10.0]], STEPS, 10, look)
    blocks = np.array_split(np.array(counts, float), 40)
    value, error = mean_and_error([block.mean(axis=0) for block in blocks])
    area = math.pi * np.diff(SHELLS**2)
    fine = np.linspace(SHELLS[0], SHELLS[-1], 53_001)
    weight = 2 * math.pi * fine * np.exp(-energies((DISK.kernel(),), fine))
    pieces = 0.5 * (weight[1:] + weight[:-1]) * np.diff(fine)
    which = np.searchsorted(SHELLS, 0.5 * (fine[1:] + fine[:-1])) - 1
    expected = DENSITY * np.bincount(which, pieces)
    page.heading("Density about a disk at rest")
    page.text(
        f"WCA with sigma = 3 and epsilon = kT, {SIZE} x {SIZE} cells, density {DENSITY:g}. Theory "
        "is exp(-U/kT) of an ideal gas, averaged over each shell; nothing is fitted, for the "
        "number of particles follows from the excluded volume."
    )
    rows = [
        Comparison(f"density, {a:g} < r < {b:g}", v / s, e / s, t / s, "1/a^2")
        for a, b, v, e, t, s in zip(
            SHELLS[:-1], SHELLS[1:], value, error, expected, area, strict=True
        )
    ]
    page.table(rows)
    square = float((((value - expected) / error)[expected > 0.5] ** 2).mean())
    page.check(f"mean square deviation of the shells: {square:.2f} standard errors^2", square < 2.5)
    fig, ax = plt.subplots(figsize=(6, 4))
    r = np.linspace(2.6, 8.0, 600)
    ax.plot(
        r,
        DENSITY * np.exp(-energies((DISK.kernel(),), r)),
        color=GREY,
        lw=1,
        label=r"theory: $n\,e^{-U/kT}$",
    )
    middle_of = 0.5 * (SHELLS[1:] + SHELLS[:-1])
    ax.errorbar(middle_of, value / area, error / area, fmt="o", color=BLUE, mfc="white", ms=4,
                label="measured, in shells")  # fmt: skip
    ax.set(xlabel="$r$  [$a$]", ylabel="density  [$a^{-2}$]")
    ax.legend()
    page.figure(
        fig,
        "Density of the fluid about a disk that pushes it away. Error bars, one standard error, "
        "are mostly below the points.",
        "_density",
    )


def mean_force(gap: float) -> float:
    """-dW/dr of two disks, W = -n kT times the integral of f f', f = exp(-U/kT) - 1."""

    def overlap(r: float) -> float:
        x = np.linspace(-7.0, 14.0, 1401)
        X, Y = np.meshgrid(x, x[x <= 7.0], indexing="ij")
        radii = np.linspace(0.0, 30.0, 6001)
        f = np.exp(-energies((DISK.kernel(),), radii)) - 1.0
        first, second = np.hypot(X, Y), np.hypot(X - r, Y)
        both = np.interp(first, radii, f) * np.interp(second, radii, f)
        return float(both.sum()) * (x[1] - x[0]) ** 2

    excluded = excluded_volume(DISK.kernel(), 2, 1.0, DISK.reach)
    room = SIZE**2 - 2 * excluded  # by which the number of particles was chosen
    density = DENSITY * room / (room + overlap(gap))
    return density * (overlap(gap + 0.05) - overlap(gap - 0.05)) / 0.1


def depletion(page: Page) -> None:
    """The force of the fluid on two disks whose shells overlap."""
    rows = []
    for gap in GAPS:
        places = [[10 - gap / 2, 10.0], [10 + gap / 2, 10.0]]
        forces: list[float] = []

        def look(engine: Any, places: Any = places, forces: list[float] = forces) -> None:
            v = engine.solutes.velocities
            forces.append(0.5e6 * (v[1, 0] - v[0, 0]) / (200 * engine.numbers.timestep))
            engine.solutes.begin(places, 0.0)  # held where they were

        look_at_rest(places, STEPS, 200, look)
        value, error = mean_and_error(forces[1:])  # the first is of how they began
        expected = mean_force(gap)
        rows.append(Comparison(f"force at r = {gap:g}", value, error, expected, "kT/a"))
    page.heading("Depletion")
    page.text(
        "Two such disks at rest, with no potential between them: the momentum that they take "
        "apart. Theory is the potential of mean force of an ideal gas, exact: an attraction where "
        "the shells from which they keep the fluid overlap, nothing beyond. Where they share room "
        "the fluid is thinner by as much, for its number of particles does not know of that."
    )
    page.table(rows)
    off = max(abs(c.measured - c.expected) / c.error for c in rows)
    page.check(f"all forces within {off:.1f} standard errors of theory", off < 3.0)


def diffusion(page: Page) -> None:
    """Of a sphere in 3D, beside Enskog and Stokes with slip."""
    values = []
    for seed in range(1, SEEDS + 1):
        case = sphere_case(seed, DIFFUSION_STEPS)
        files = page.run(f"sphere-{seed}", case)
        values.append(found(files["mean-square-displacement"], "diffusion coefficient"))
    value, error = mean_and_error([c.measured for c in values])
    radius = effective_radius(SPHERE.kernel(), 1.0, SPHERE.reach)
    eta = DENSITY * theory.transport("srd", 3, DENSITY, 0.1, angle=130.0).viscosity
    hits = theory.enskog_friction(radius, DENSITY, MASS)
    expected = theory.slip_sphere_diffusion(radius, eta, hits, CUBE)
    stokes = theory.slip_sphere_diffusion(radius, eta, None, CUBE)
    page.heading("Friction and diffusion of a sphere")
    page.text(
        f"WCA with sigma = 2 ({radius:.3f} as a hard sphere), mass {MASS:g}, in {CUBE}^3 cells of "
        f"SRD at 130 degrees, density {DENSITY:g}, timestep 0.1: eta = {eta:.3f}. At short times "
        "the fluid has given nothing back, and the friction is that of hits (Enskog): found from "
        "the change of velocity, -(M/t) ln(1 - M <(v(t) - v(0))^2>/(2 d kT)). It rises first, "
        "for a soft hit takes some tenths of tau, and falls when the flow comes back. "
        "Theory of the diffusion adds "
        f"kT/(4 pi eta R) = {1 / (4 * math.pi * eta * radius):.5f} (slip) and kT/zeta = "
        f"{1 / hits:.5f} (Enskog); images of the box make it "
        f"{theory.diffusion_in_box(1.0, CUBE, eta) - 1.0:+.5f}. It is approximate: the two "
        "frictions are not independent, and a mean free path is far shorter than the radius. "
        f"Without the part of Enskog it would be {stokes:.5f}. Neither of the two comparisons "
        "below is an independent test: the 9 steps are those of the largest friction in the same "
        "runs, and what is required of D was set after the first three runs, which were 22 % below "
        "the sum."
    )
    early = early_friction(page, hits)
    page.table(
        [
            Comparison("friction at 9 steps", *early, hits, "m/tau", "Enskog"),
            Comparison("D", value, error, expected, "a^2/tau", f"{SEEDS} runs"),
        ]
    )
    page.check(
        f"friction by hits {100 * (early[0] / hits - 1):+.1f} +- {100 * early[1] / hits:.1f} % off "
        "Enskog's, within 10 %",
        abs(early[0] / hits - 1) < 0.1,
    )
    page.check(
        f"D = {value:.5f} +- {error:.5f} lies between Stokes alone and the sum",
        stokes - 2 * error < value < expected + 2 * error,
    )


def early_friction(page: Page, hits: float) -> tuple[float, float]:
    """From the changes of velocity over some steps; its value at two steps, and the error."""
    seen: list[Any] = []

    def look(simulation: Simulation) -> None:
        seen.append(simulation.engine.solutes.velocities[0].copy())

    simulation = sphere(1, EARLY_STEPS, [every(1, look)])
    simulation.run()
    v, lags = np.array(seen), np.unique(np.geomspace(1, 200, 25).astype(int))
    found_at = []
    for lag in lags.tolist():
        square = ((v[lag:] - v[:-lag]) ** 2).sum(axis=1)
        whole = len(square) // 20 * 20
        found_at.append(mean_and_error(square[:whole].reshape(20, -1).mean(axis=1)))
    square, spread = np.array(found_at).T * MASS / 6.0
    rate = MASS / (0.1 * lags)
    friction = np.array([-rate * np.log1p(-square), rate * spread / (1.0 - square)])
    good = square < 0.9
    lags, friction = lags[good], friction[:, good]
    fig, ax = plt.subplots(figsize=(6, 4))
    ax.errorbar(0.1 * lags, friction[0], friction[1], fmt="o", color=BLUE, mfc="white", ms=4,
                label="measured")  # fmt: skip
    ax.axhline(hits, color="k", lw=1, label="theory: Enskog, of hits alone")
    ax.set(
        xscale="log",
        xlabel=r"$t$  [$\tau$]",
        ylabel=r"friction $\zeta$  [$m/\tau$]",
        ylim=(0, None),
    )
    ax.legend()
    page.figure(fig, "Friction of a sphere from the change of its velocity in a time.", "_friction")
    soon = int(np.flatnonzero(lags == 9)[0])
    return float(friction[0, soon]), float(friction[1, soon])


def sphere(seed: int, steps: int, callbacks: list[Any]) -> Simulation:
    """One sphere in a fluid, in 3D, looked at."""
    case = sphere_case(seed, steps)
    return Simulation(dataclasses.replace(case, observe=()), threads=1, callbacks=callbacks)


def sphere_case(seed: int, steps: int) -> Case:
    """The same, whose displacement is followed."""
    return Case(
        run=Run(steps=long(steps), warmup=200, seed=seed), box=Box([CUBE] * 3),
        fluid=Fluid(density=DENSITY, collision=SRD(angle=130)),
        solutes=Solutes(
            [Polymer(1)], mass=MASS, coupling="potential", solvent_pair=SPHERE, skin=0.05
        ),
        observe=[mesokit.MeanSquareDisplacement(of="beads", every=5, max_lag=400)],
    )  # fmt: skip


def make() -> int:
    """Write the page."""
    page = Page("colloids", "Colloids that act on the fluid by a potential")
    density(page)
    depletion(page)
    diffusion(page)
    return page.write()


if __name__ == "__main__":
    main(make)
