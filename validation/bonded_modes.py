"""Velocity modes of bonded fluids: dimers and decamers, against both forms of the theory."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from common import ANGLE, BLUE, GREY, RED, Page, long, main, plt

import mesokit
from mesokit import SRD, Box, Case, Comparison, Fluid, Harmonic, MaxwellBoltzmann, Run, theory
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.observe.shared.modes import transverse_units
from mesokit.method.mpcd.start.fluid import start

WAVES = {"1": (1, 0, 0), "sqrt 2": (1, 1, 0), "2": (2, 0, 0)}
SIGNS = {"1": "1", "sqrt 2": r"$\sqrt{2}$", "2": "2"}
SEEDS = (1, 2, 3, 4)
AMPLITUDE = 0.4  # of the wave: thermal noise of one mode is about 0.003
EVERY = 4  # steps between two samples


class Kind(NamedTuple):
    """A bonded fluid: beads of a molecule, U = K r^2, length of the cubic box, steps followed."""

    name: str
    beads: int
    K: float
    length: int
    steps: int


NU = theory.transport(
    "srd", 3, 10, 0.1, angle=ANGLE, thermostat="maxwell-boltzmann"
).viscosity  # of free particles
DIMERS = Kind("dimers", 2, 1 / 6, 30, 600)
DECAMERS = Kind("decamers", 10, 1.0, 24, 600)


def case(
    kind: Kind, seed: int, steps: int = 1, observe: tuple[Any, ...] = (), rate: float = 0.0
) -> Case:
    """The fluid of the thesis: SRD at 2.27 rad, density 10, timestep 0.1."""
    return Case(
        run=Run(steps=steps, warmup=200 if observe else 0, seed=seed),
        box=Box([kind.length] * 3, shear_rate=rate),
        fluid=Fluid(
            density=10, timestep=0.1, collision=SRD(angle=ANGLE), thermostat=MaxwellBoltzmann(),
            molecule=Molecule(length=kind.beads, bond=Harmonic(K=kind.K)),
        ),
        observe=observe,
    )  # fmt: skip


def decay(kind: Kind, wave: tuple[int, ...], seed: int) -> tuple[Any, Any]:
    """Time, and what is left of a helical wave, which has no nonlinear term."""
    fluid = CPU(case(kind, seed), 1)
    start(fluid)
    fluid.advance(100)  # chains of independent Gaussian bonds at rest are in equilibrium
    k = 2 * math.pi * np.array(wave) / kind.length
    first, second = transverse_units(k)
    r, v = fluid.positions(unwrapped=True), fluid.velocities()
    phase = (r @ k)[:, None]
    v += AMPLITUDE * (np.cos(phase) * first + np.sin(phase) * second)
    start(fluid, r, v)
    found = []
    for _ in range(kind.steps // EVERY):
        _, momentum = fluid.modes(k[None])
        # cos and sin have the modes 1/2 and 1/2i
        found.append((momentum[0] @ first).real - (momentum[0] @ second).imag)
        fluid.advance(EVERY)
    found = np.array(found) / (AMPLITUDE * fluid.n)
    return np.arange(len(found)) * EVERY * fluid.numbers.timestep, found / found[0]


def mode_time(page: Page, kind: Kind) -> tuple[Comparison, Comparison]:
    """Normal-mode time and mean square bond length of the fluid at rest."""
    observe = (
        mesokit.NormalModes(every=5, modes=3, max_lag=4000),
        mesokit.MoleculeSize(every=20),
    )
    small = kind._replace(length=12)
    files = page.run(f"{kind.name}-rest", case(small, 7, long(2e4), observe))
    slowest = next(c for c in files["normal-modes"].comparisons if "time 1" in c.what)
    size = next(c for c in files["molecule-size"].comparisons if "end-to-end" in c.what)
    return slowest, size


def background(page: Page, kind: Kind, tau: float) -> Comparison:
    """What collisions and flights carry of the viscosity, in shear that is slow for molecules."""
    slow = case(kind._replace(length=12), 7, long(6e4), (mesokit.Stress(every=2),), 0.5 / tau)
    parts = [
        next(
            c
            for c in page.run(f"{kind.name}-sheared", slow)["stress"].comparisons
            if name in c.what
        )
        for name in ("kinetic", "collisional")
    ]
    return Comparison(
        f"{kind.name}: background viscosity", sum(c.measured for c in parts),
        math.hypot(*(c.error for c in parts)), NU, "a^2/tau",
        "approximate: of free particles",
    )  # fmt: skip


def make() -> int:
    """Write the page."""
    page = Page("bonded_modes", "Velocity modes of dimers and decamers")
    page.text(
        f"SRD in 3D at 2.27 rad, density 10, timestep 0.1, nu = {NU:.4f} without bonds; U = K r^2. "
        f"A helical shear wave of amplitude {AMPLITUDE} decays in a cubic box; what is left of it, "
        f"the mean of {len(SEEDS)} runs with the standard error of that, up to the time when it "
        "falls below two standard errors for good. Theory has no free parameter but the "
        "normal-mode time, which is measured in the fluid at rest (12^3 cells); the stress time is "
        "half of it. 'Long waves' is the thesis' formula, 'finite k' has the elastic kernel of "
        "molecules as long as the wave (docs/theory-polymers.md). It is given with two "
        "viscosities of the background, which collisions and flights carry: that of free "
        "particles, and that of the same molecules, from the kinetic and collisional stress in "
        "slow Lees-Edwards shear. Tied beads move together and exchange less momentum in "
        "collisions."
    )
    fig, axes = plt.subplots(2, 2, figsize=(10, 6), sharex="col", height_ratios=[2, 1])
    rows: list[Comparison] = []
    for column, kind in enumerate((DIMERS, DECAMERS)):
        slowest, size = mode_time(page, kind)
        base = background(page, kind, slowest.measured / 2)
        rows += [
            Comparison(f"{kind.name}: {c.what}", c.measured, c.error, c.expected, c.unit, c.note)
            for c in (slowest, size)
        ]
        rows.append(base)
        modes = theory.linear_modes(kind.beads)
        bond = theory.mean_square_bond(K=kind.K)
        diffusion = bond / 3 / (slowest.measured * modes.eigenvalues[1]) / kind.beads
        times = theory.rouse_times_from_slowest(modes, mode_time=slowest.measured).stress
        for (label, wave), colour, mark in zip(
            WAVES.items(), (BLUE, RED, GREY), ("o", "s", "^"), strict=True
        ):
            curves = [decay(kind, wave, seed) for seed in SEEDS]
            t, value = curves[0][0], np.mean([c for _, c in curves], axis=0)
            error = np.std([c for _, c in curves], axis=0, ddof=1) / math.sqrt(len(SEEDS))
            error[1:] = np.sqrt(np.mean(error[1:] ** 2))  # of all: few runs tell it badly at each
            k = 2 * math.pi * math.hypot(*wave) / kind.length
            late = np.flatnonzero(np.abs(value) > 2 * error[-1])[-1]
            use = t <= t[late]
            laws = {
                "long waves": theory.transverse_correlation_chain(k, t, NU, 1 / kind.beads, times),
            } | {
                name: theory.transverse_correlation_finite_k(
                    k,
                    t,
                    nu,
                    1 / kind.beads,
                    theory.GaussianMolecule(modes, slowest.measured, bond, diffusion),
                )
                for name, nu in (("finite k", NU), ("finite k, measured background", base.measured))
            }
            for (name, law), limit in zip(laws.items(), (0.03, 0.015, 0.015), strict=True):
                off = np.abs(value - law)[use]
                worst = int(np.argmax(off))
                rms = float(np.sqrt(np.mean(off**2)))
                rows.append(
                    Comparison(
                        f"{kind.name}, |k_n| = {label}: largest deviation, {name}", off[worst],
                        error[-1], math.nan, "",
                        f"at {t[worst]:.1f} of {t[late]:.0f} tau; rms {rms:.4f}",
                    )
                )  # fmt: skip
                page.check(
                    f"{kind.name}, |k_n| = {label}: largest deviation {off[worst]:.4f} +- "
                    f"{error[-1]:.4f}, {name} (below {limit})",
                    off[worst] < limit,
                )
            measured, waves = laws["finite k, measured background"], laws["long waves"]
            last = colour == GREY
            some = slice(0, None, 3)
            look = {"fmt": mark, "mfc": "white", "color": colour}
            axes[0, column].errorbar(
                t[some], value[some], error[some], ms=3, label=f"$|k_n|$ = {SIGNS[label]}", **look
            )
            few = slice(2 * "os^".index(mark), None, 8)
            axes[1, column].errorbar(
                t[few], (value - measured)[few], error[few], ms=3, elinewidth=0.8, **look
            )
            for law, dash, name in ((measured, "-", "finite $k$"), (waves, ":", "long waves")):
                label = f"theory, {name}" if last else ""
                axes[0, column].plot(t, law, dash, color=colour, lw=1, label=label)
                axes[1, column].plot(t, value - law, dash, color=colour, lw=0.8)
        axes[0, column].set(title=kind.name, ylabel="$C(t)$")
        axes[0, column].legend()
        axes[1, column].axhline(0, color="k", lw=0.5)
        axes[1, column].set(
            xlabel="time", ylabel="measured\n- theory", ylim=(-0.065, 0.065), xlim=(-2, 62)
        )
    page.table(rows)
    page.figure(
        fig,
        "Waves of wave number |k_n|, in 2 pi/L. Full lines: theory for finite k with the measured "
        "background; dotted: for long waves. Below what is measured less each of them; error bars, "
        "at some points, are one standard error of the mean of four runs.",
    )
    return page.write()


if __name__ == "__main__":
    main(make)
