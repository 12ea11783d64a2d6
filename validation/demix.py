"""A fluid that demixes: when it does, and its surface tension by three routes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from common import BLUE, GREEN, Page, long, main, mean_and_error, plt

import mesokit
from mesokit import Box, Comparison, Demix, Fluid, Run, Species, theory
from mesokit.report.style import sparse_logarithm

DENSITY, STEP = 10, 0.1
TWO = (Species(mass=1, density=DENSITY / 2), Species(mass=1, density=DENSITY / 2))
TENSION = 0.05  # the coupling at which the tension is measured
FILM, DROPLETS, SIDE = (40, 48), (9.0, 12.0, 17.0), 60
WAVE = (32, 160)
BLOCKS = 20


def fluid_of(size, coupling, kinds=TWO, positions=None, seed=1, stress=False) -> Any:
    """A fluid in memory; with `stress` that of each last step is measured."""
    watch = [mesokit.Stress()] if stress else []
    simulation = mesokit.Simulation(
        threads=1,
        run=Run(steps=0, seed=seed),
        box=Box(size),
        observe=watch,
        positions=positions,
        fluid=Fluid(species=kinds, timestep=STEP, collision=Demix(coupling)),
    )
    return simulation.engine


def spreading(coupling: float) -> tuple[float, float]:
    """Diffusion of the colour of a long wave, with its error over repetitions."""
    side, width, found = *WAVE, []
    k, time = 2 * math.pi / side, 20.0
    n = DENSITY * side * width // 2
    for seed in range(8):
        random = np.random.default_rng(seed)
        places = random.uniform(0, width, (2 * n, 2))
        x = np.linspace(0, side, 4001)
        for kind, amplitude in enumerate((0.3, -0.3)):  # quantiles of colour 0.3 cos(kx)
            share = (x + amplitude * np.sin(k * x) / k) / side
            places[kind * n : (kind + 1) * n, 0] = np.interp((np.arange(n) + 0.5) / n, share, x)
        engine = fluid_of(WAVE, coupling, positions=places, seed=seed + 1)
        charge = np.where(engine.species() == 0, 1.0, -1.0)
        engine.advance(20)  # until the flux has grown to its steady value
        first = (charge * np.cos(k * engine.positions()[:, 0])).sum()
        engine.advance(round(time / STEP))
        last = (charge * np.cos(k * engine.positions()[:, 0])).sum()
        found.append(math.log(first / last) / (k * k * time))
    mean, error = mean_and_error(found)
    return float(mean), float(error)


def threshold(page: Page, axis) -> None:
    """Colour spreads below the threshold and gathers above it."""
    page.heading("When it demixes")
    page.text(
        f"""A mixture in equal parts (density {DENSITY}, timestep {STEP}, {WAVE[0]} x {WAVE[1]}
        cells) starts with a wave of colour, 0.3 cos(2 pi x/{WAVE[0]}). How it fades or grows
        within 20 tau is its diffusion coefficient D; errors from 8 repetitions. The coupling
        takes density sqrt(kT/m) times itself from D, for this wave 3 % less: neighbours, 0.6 %;
        places within cells, 0.3 %; the amplitude, 2 %. Molecular chaos is low for D, as it is
        for the self-diffusion of a simple fluid in 2D ([theory](../theory.md)), and so for the
        threshold. Why the fall of D comes out another 11 % smaller (2.9 s.e.) is not known."""
    )
    couplings = np.array([0.0, 0.002, 0.004, 0.006, 0.008, 0.01, 0.012])
    expected = [theory.demixing_diffusion(2, DENSITY, STEP, c) for c in couplings]
    value, error = np.transpose([spreading(c) for c in couplings])
    note = "approximate: molecular chaos"
    page.table(
        [
            Comparison(f"D at coupling {c:g} a", v, e, x, "a^2/tau", note)
            for c, v, e, x in zip(couplings, value, error, expected, strict=True)
        ]
    )
    (slope, start), spread = np.polyfit(couplings, value, 1, w=1 / error, cov="unscaled")
    limit = -start / slope
    gradient = np.array([start / slope**2, -1 / slope])
    at_limit = math.sqrt(gradient @ spread @ gradient)
    k = 2 * math.pi / WAVE[0]
    # differences of neighbours; places within cells, twice; less flux where one species prevails
    lost = math.sin(k) / k * np.sinc(k / (2 * math.pi)) ** 2 * (1 - 0.3**2 / 4)
    known = DENSITY * lost
    fall = Comparison("fall of D with the coupling", -slope, spread[0, 0] ** 0.5, known, "a/tau")
    zero = Comparison(
        "threshold", limit, at_limit, theory.demixing_coupling(2, DENSITY, STEP), "a", note
    )
    page.table([fall, zero])
    axis.errorbar(couplings, value, error, fmt="o", c=BLUE, label="measured")
    axis.plot(couplings, expected, "k--", lw=1, label="theory: molecular chaos")
    axis.plot(couplings, start + slope * couplings, "-", lw=0.8, c=BLUE, label="fitted line")
    axis.axhline(0, lw=0.6, c="k")
    axis.set_xticks([0, 0.004, 0.008, 0.012])
    axis.legend()
    axis.set(xlabel="coupling  [$a$]", ylabel=r"diffusion of colour  [$a^2/\tau$]")
    away = (fall.measured - known) / fall.error
    page.check(f"D falls by density times coupling: {away:+.1f} s.e. (at most 3)", abs(away) < 3)
    page.check("colour spreads at 0.004 a", value[2] > 3 * error[2])
    page.check("colour gathers at 0.012 a", value[-1] < -3 * error[-1])


def film() -> tuple[Comparison, Comparison, np.ndarray, np.ndarray, np.ndarray]:
    """Tension of flat interfaces by the stress and by their capillary waves."""
    width, length = FILM
    n = DENSITY * width * length // 2
    random = np.random.default_rng(1)
    places = random.uniform(0, 1, (2 * n, 2)) * (width / 2, length)
    places[n:, 0] += width / 2
    engine = fluid_of(FILM, TENSION, positions=places, stress=True)
    charge = np.where(engine.species() == 0, 1.0, -1.0)
    engine.advance(long(3000))
    waves = np.arange(1, 5)
    tensions, squares = [], []
    for _ in range(BLOCKS):
        stress, heights = [], []
        for j in range(long(2000)):
            engine.advance(1, measure=["stress"])
            stress.append(sum(engine.stress.values()))
            if j % 20 == 0:
                heights.append(modes(engine.positions(), charge, waves))
        mean = np.mean(stress, axis=0)
        tensions.append((mean[1, 1] - mean[0, 0]) * width / 2)
        squares.append(np.mean(heights, axis=0))
    q = 2 * math.pi * waves / length
    square, error = mean_and_error(squares)
    value, spread = mean_and_error(tensions)
    found = Comparison("from the stress across a film", value, spread, math.nan, "kT/a")
    # of waves 1 to 3 together: kT/(L <q^2 h^2>), with the relative error of the mean
    longest, its_error = mean_and_error((q[:3] ** 2 * np.array(squares)[:, :3]).mean(axis=1))
    tension = 1 / (length * longest)
    waving = Comparison(
        "from capillary waves", tension, tension * its_error / longest, math.nan, "kT/a"
    )
    return found, waving, q, square, error


def modes(positions, charge, waves) -> np.ndarray:
    """Mean square of the modes of the two interfaces of the film, from the colour above them."""
    width, length = FILM
    x, y = positions[:, 0] % width, positions[:, 1] % length
    found = []
    # colour falls by 2 DENSITY at the middle and rises by it at the ends of the box
    for centre, fall in ((width / 2, 1.0), (0.0, -1.0)):
        away = (x - centre + width / 2) % width - width / 2
        near = abs(away) < width / 4
        phase = np.exp(-2j * math.pi * np.outer(waves, y[near]) / length)
        found.append(fall * (phase @ charge[near]) / (2 * DENSITY * length))
    # the particles of the ideal gas on both sides are Poisson noise: their number over the square
    noise = (DENSITY * width / 2 * length) / (2 * DENSITY * length) ** 2
    return (abs(np.array(found)) ** 2).mean(axis=0) - noise


def droplet(radius: float) -> tuple[float, ...]:
    """R of a droplet; density in it above that outside, kT in over kT out, with their errors."""
    inside = round(DENSITY * math.pi * radius**2)
    outside = DENSITY * SIDE * SIDE - inside
    kinds = tuple(Species(mass=1, density=number / SIDE**2) for number in (inside, outside))
    random = np.random.default_rng(2)
    places = np.empty((0, 2))
    while len(places) < outside:
        more = random.uniform(0, SIDE, (outside, 2))
        places = np.append(places, more[np.hypot(*(more - SIDE / 2).T) > radius], axis=0)
    angle, r = (
        random.uniform(0, 2 * math.pi, inside),
        radius * np.sqrt(random.uniform(0, 1, inside)),
    )
    drop = SIDE / 2 + np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)
    engine = fluid_of((SIDE, SIDE), TENSION, kinds, np.concatenate([drop, places[:outside]]))
    first = engine.species() == 0
    engine.advance(long(3000))
    jumps, radii, temperatures = [], [], []
    for _ in range(BLOCKS):
        jump, size, warmth = [], [], []
        for _ in range(long(2000) // 10):
            engine.advance(10)
            r, v = engine.positions(), engine.velocities()
            phase = np.exp(2j * math.pi * r[first] / SIDE).sum(axis=0)  # its centre, round the box
            centre = np.angle(phase) * SIDE / (2 * math.pi)
            far = np.hypot(*((r - centre + SIDE / 2) % SIDE - SIDE / 2).T)
            core, rest = far < radius - 4, (far > radius + 4) & (far < SIDE / 2)
            inner = core.sum() / (math.pi * (radius - 4) ** 2)
            outer = rest.sum() / (math.pi * ((SIDE / 2) ** 2 - (radius + 4) ** 2))
            jump.append(inner - outer)
            alone = (first & rest).sum() / rest.sum() * len(r)  # of its kind, dissolved
            size.append(
                math.sqrt(max(first.sum() - alone * (1 - inside / len(r)), 1) / (math.pi * inner))
            )
            warmth.append((v[core] ** 2).mean() / (v[rest] ** 2).mean())
        jumps.append(np.mean(jump))
        radii.append(np.mean(size))
        temperatures.append(np.mean(warmth))
    value, error = mean_and_error(jumps)
    warm, spread = mean_and_error(temperatures)
    print(
        f"R {np.mean(radii):.3f}, jump {value:.4f} +- {error:.4f}, kT {warm:.4f} +- {spread:.4f}",
        flush=True,
    )
    return float(np.mean(radii)), value, error, warm, spread


def tension(page: Page, axes) -> None:
    """Laplace's law, the stress across a film, and its capillary waves."""
    page.heading("Surface tension")
    page.text(
        f"""Coupling {TENSION} a, otherwise as above. Droplets in {SIDE} x {SIDE} cells: within
        each phase the fluid is an ideal gas, so that its pressure is density times kT, and
        the two differ by tension/R. R is the radius of the disk that the droplet's
        particles fill at the density inside, those dissolved outside taken off. A film of
        half of {FILM[0]} x {FILM[1]} cells: the stress along its two interfaces less that
        across, integrated over the box, is twice the tension. The height of each interface,
        from the colour on both sides of it, has waves of mean square kT/(tension L q^2),
        beside the Poisson noise of the ideal gas, which is taken off. Errors from {BLOCKS}
        blocks of each run."""
    )
    drops = [droplet(radius) for radius in DROPLETS]
    page.grid(
        [
            "R (a)",
            "density inside - outside",
            "kT inside / outside",
            "R times the difference (kT/a)",
        ],
        [
            [
                f"{r:.2f}",
                f"{jump:.3f} +- {e:.3f}",
                f"{t:.4f} +- {s:.4f}",
                f"{r * jump:.2f} +- {r * e:.2f}",
            ]
            for r, jump, e, t, s in drops
        ],
    )
    r, jump, error = (np.array(column) for column in list(zip(*drops, strict=True))[:3])
    weight = 1 / (r * error) ** 2  # of R times the difference
    laplace = float((weight * r * jump).sum() / weight.sum())
    first = Comparison("from Laplace's law", laplace, weight.sum() ** -0.5, math.nan, "kT/a")
    second, third, q, square, spread = film()
    page.table([first, second, third])
    line = np.linspace(0, 1.1 / r.min(), 2)
    axes[0].errorbar(1 / r, jump, error, fmt="o", c=BLUE, label="measured")
    axes[0].plot(line, laplace * line, "k--", lw=1, label="Laplace's law, fitted tension")
    axes[0].set(xlabel="$1/R$  [$a^{-1}$]", ylabel="pressure inside - outside  [$kT/a^2$]")
    axes[0].legend()
    axes[1].errorbar(q, square, spread, fmt="s", c=GREEN, label="measured")
    fine = np.geomspace(q[0] * 0.9, q[-1] * 1.1, 50)
    axes[1].loglog(fine, 1 / (second.measured * FILM[1] * fine**2), "k--", lw=1,
                   label="tension of the stress")  # fmt: skip
    axes[1].legend(loc="lower left")
    sparse_logarithm(axes[1].yaxis, *axes[1].get_ylim())
    axes[1].set_xticks([0.15, 0.3, 0.6], ["0.15", "0.3", "0.6"])
    axes[1].set_xticks([], minor=True)
    axes[1].set(xlabel="$q$  [$a^{-1}$]", ylabel=r"$\langle|h_q|^2\rangle$  [$a^2$]")
    chi = float((weight * (r * jump - laplace) ** 2).sum())
    page.check(f"pressure grows as 1/R: chi-square {chi:.1f} of 2 (at most 9)", chi < 9)
    for other in (second, third):
        away = (other.measured - laplace) / math.hypot(other.error, first.error)
        page.check(
            f"tension {other.what}: {away:+.1f} s.e. from Laplace's (at most 3)", abs(away) < 3
        )


def make() -> int:
    """Write docs/validation/demix.md; returns how many requirements were not met."""
    page = Page("demix", "A fluid that demixes")
    fig, axes = plt.subplots(1, 3, figsize=(11, 3.6))
    threshold(page, axes[0])
    tension(page, axes[1:])
    page.figure(
        fig,
        """Diffusion of colour against the coupling, with molecular chaos; pressure of
        droplets, with Laplace's law; mean square height of the waves of a flat interface,
        with the line for the tension from the stress. Bars are standard errors.""",
    )
    return page.write()


if __name__ == "__main__":
    main(make)
