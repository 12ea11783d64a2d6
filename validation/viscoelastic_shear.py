"""Sheared fluids: figures 4.1, 4.2, 6.1 and 6.2 of the thesis, viscosities, thinning."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, NamedTuple

import lees_edwards_profile
import numpy as np
from common import BLUE, GREEN, GREY, PURPLE, RED, SHORT, Page, found, long, mean_and_error, plt
from scipy.optimize import curve_fit

from mesokit import Case, Comparison, MeanSquareDisplacement, Result, Stress, theory
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.expected.molecules import without_bonds
from mesokit.method.mpcd.start.fluid import start
from mesokit.potential.thermal import lengths

WAVE, LONG, ACROSS, SEEDS = 0.2, 240, 12, range(1, 3 if SHORT else 7)
END = 220.0  # of the decay of the wave that is used


class Bead(NamedTuple):
    """A free particle: friction, its standard error, hydrodynamic radius; the fluid's viscosity."""

    friction: float
    error: float
    radius: float
    viscosity: float


def with_rate(case: Case, rate: float, K: float | None = None, steps: int | None = None) -> Case:
    """The same at another shear rate, with another spring, for another time."""
    fluid, run = case.fluid, case.run
    if K is not None:
        bond = dataclasses.replace(fluid.molecule.bond, K=K)
        fluid = dataclasses.replace(fluid, molecule=dataclasses.replace(fluid.molecule, bond=bond))
    if steps is not None:
        run = dataclasses.replace(run, steps=steps)
    box = dataclasses.replace(case.box, shear_rate=rate)
    return dataclasses.replace(case, box=box, fluid=fluid, run=run)


STRENGTHS = {"full": (1.0, 400), "half": (0.5, 400), "no": (0.0, 50)}  # of the shift, samples


def within_cells(name: str) -> tuple[Any, Any, Comparison]:
    """Deviation from the line against the place within a cell, and the shear rate there.

    In the box of the thesis; the error is from the scatter over steps, as shifts are independent.
    """
    strength, samples = STRENGTHS[name]
    series = lees_edwards_profile.within_cells(strength, samples // (10 if SHORT else 1), 4)
    places = (np.arange(series.shape[1]) + 0.5) / series.shape[1]
    slope_of = np.linalg.pinv(np.stack([np.ones(len(places)), places - 0.5], axis=1))[1]
    slope, error = mean_and_error(series @ slope_of)
    rate, note = lees_edwards_profile.RATE, f"{name} grid shift, box of the figure"
    what = "shear rate within cells"
    return *mean_and_error(series), Comparison(what, rate + slope, error, rate, "1/tau", note)


def profiles(results: dict[str, tuple[Case, Result]], cells: dict[str, Any]) -> Any:
    """Figures 4.1 and 4.2."""
    fig, axes = plt.subplots(1, 3, figsize=(13, 3.8))
    full = results["full"][1]
    length = results["full"][0].box.size[1]
    axes[0].plot(full.x["y"], full.value, ".", ms=2.5, color=BLUE, label="measured")
    axes[0].plot(full.x["y"], full.expected, "-", color=GREEN, lw=1, label="theory")
    axes[0].set(title="figure 4.1", xlabel="y", ylabel="velocity", xlim=(0, length))
    axes[0].legend()
    for (shift, (_, result)), mark, colour in zip(
        results.items(), ("o", "^", "s"), (BLUE, GREY, RED), strict=True
    ):
        y = result.x["y"]
        show = (y > length / 2 - 3) & (y < length / 2 + 3)
        axes[1].errorbar(y[show], result.value[show], result.error[show], fmt=mark, ms=3, lw=0.8,
                         color=colour, label=f"{shift} shift")  # fmt: skip
        mean, error, _ = cells[shift]
        places = (np.arange(len(mean)) + 0.5) / len(mean)
        axes[2].errorbar(places, mean, error, fmt=mark, color=colour, label=f"{shift} shift")
    axes[1].plot(y[show], full.expected[show], "-", color=GREEN, lw=1)
    axes[1].set(title="figure 4.2", xlabel="y", ylabel="velocity")
    axes[2].axhline(0, color=GREEN, lw=1)
    axes[2].set(xlabel="place within the cell", ylabel="velocity - line", ylim=(-0.06, 0.06))
    axes[1].legend()
    return fig


def background(page: Page, case: Case, tau: float) -> Comparison:
    """What collisions and flights carry of the viscosity, in shear that is slow for molecules."""
    molecule, run = case.fluid.molecule, dataclasses.replace(case.run, warmup=1000)
    slow = dataclasses.replace(case, title="background", observe=(Stress(every=2),), run=run)
    slow = with_rate(slow, min(0.1, round(0.5 / tau, 2)), steps=long(6000))
    stress = page.run(f"background-{molecule.length}-{molecule.bond.K:.3g}", slow)["stress"]
    parts = [found(stress, name) for name in ("kinetic", "collisional")]
    return Comparison(
        "background viscosity", sum(c.measured for c in parts),
        math.hypot(*(c.error for c in parts)), without_bonds(case).viscosity, "a^2/tau",
        "approximate: of free particles",
    )  # fmt: skip


def bonds(page: Page, name: str, case: Case, bead: Bead, rate: float, K: float) -> Comparison:
    """Bond length of trimers in one flow, beside theory for the measured friction of a bead."""
    measured = found(page.run(f"{name}-{rate}", with_rate(case, rate, K))["bond-length"], "root")
    expected = theory.trimer_bond_length(K, rate, bead.viscosity, bead.radius)
    what = f"bond length, shear rate {rate}, K = {K:.4g}"
    return Comparison(what, measured.measured, measured.error, expected, "a")


def trimers(held: list[tuple[float, float, Comparison]], free: list[tuple[float, Comparison]],
            bead: Bead) -> Any:  # fmt: skip
    """Figures 6.1 and 6.2, for the thesis' hydrodynamic radius and for that of this fluid."""
    rates = np.geomspace(1e-3, 100, 200)
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    for radius, style, label in ((0.3, "--", "$R_H = 0.3$"), (bead.radius, "-", "this fluid")):
        K = [theory.trimer_spring_constant(2, g, bead.viscosity, radius) for g in rates]
        axes[0].loglog(rates, K, style, color=GREY, label=label)
        some = rates[rates < 10]
        size = [theory.trimer_bond_length(1, g, bead.viscosity, radius) for g in some]
        axes[1].loglog(some, size, style, color=GREY, label=label)
    inverse = [
        theory.trimer_spring_constant(c.measured, g, bead.viscosity, bead.radius)
        for g, _, c in held
    ]
    axes[0].plot([g for g, _, _ in held], inverse, "o", mfc="white", color=BLUE,
                 label="K of the measured length")  # fmt: skip
    axes[0].plot([g for g, _, _ in held], [K for _, K, _ in held], "x", color=RED, label="K given")
    axes[1].errorbar(
        [g for g, _ in free], [c.measured for _, c in free], [c.error for _, c in free], fmt="o",
        mfc="white", color=BLUE, label="measured",
    )  # fmt: skip
    axes[0].set(title="figure 6.1", xlabel="shear rate", ylabel="K for a bond length of 2")
    axes[1].set(title="figure 6.2", xlabel="shear rate", ylabel="bond length, K = 1")
    for ax in axes:
        ax.legend()
    return fig


def decay(case: Case, seed: int) -> tuple[Any, Any]:
    """What is left of a helical wave along a long box: time, share of the start."""
    box = dataclasses.replace(case.box, size=(ACROSS, ACROSS, LONG), shear_rate=0.0)
    run = dataclasses.replace(case.run, seed=seed, warmup=0)
    fluid = CPU(dataclasses.replace(case, box=box, run=run, observe=()), 1)
    start(fluid)
    fluid.advance(100)
    k = 2 * math.pi / LONG
    r, v = fluid.positions(unwrapped=True), fluid.velocities()
    v[:, 0] += WAVE * np.cos(k * r[:, 2])
    v[:, 1] += WAVE * np.sin(k * r[:, 2])
    start(fluid, r, v)
    left = []
    for _ in range(int(END / (40 * fluid.numbers.timestep)) + 1):
        _, momentum = fluid.modes(np.array([[0.0, 0.0, k]]))
        left.append((momentum[0, 0].real - momentum[0, 1].imag) / (WAVE * fluid.n))
        fluid.advance(40)
    return np.arange(len(left)) * 40 * fluid.numbers.timestep, np.array(left)


def from_decay(case: Case, tau: float) -> tuple[Comparison, Any, Any, float]:
    """Apparent viscosity from the late decay: the slow pole, brought to k = 0 by its equation.

    The rate g = k^2 (nu + e tau/(1 - g tau)) with e = kT/(n m) gives tau and so nu + e tau. The
    error is from leaving out one run at a time.
    """
    k, nu = 2 * math.pi / LONG, without_bonds(case).viscosity
    share = case.fluid.kT / (case.fluid.mass * case.fluid.molecule.length)
    every = [decay(case, seed) for seed in SEEDS]
    t, left = every[0][0], np.array([c for _, c in every])
    late = t > 3 * tau

    def fitted(curve: Any) -> float:
        rate = curve_fit(lambda t, a, g: a * np.exp(-g * t), t[late], curve[late], (1, k * k * nu))
        slow = rate[0][1]
        beyond = slow / k**2 - nu
        return float(nu + share * beyond / (share + beyond * slow))

    without = [fitted(np.delete(left, i, axis=0).mean(axis=0)) for i in range(len(left))]
    error = math.sqrt((len(left) - 1) * np.var(without))
    what = f"decay of a wave of {LONG} cells"
    return Comparison(what, fitted(left.mean(axis=0)), error, unit="a^2/tau"), t, left, k


def routes(page: Page, case: Case, bead: Bead, slowest: Comparison) -> Any:
    """Three routes to the viscosity of a fluid of dimers; returns the figure."""
    nu, share = without_bonds(case).viscosity, 1 / case.fluid.molecule.length
    tau, spread = slowest.measured / 2, slowest.error / 2
    wave, t, left, k = from_decay(case, tau)
    rates = (0.02, 0.05, 0.1)
    sheared = []
    for rate in rates:
        stress = page.run(f"dimers-{rate}", with_rate(case, rate))["stress"]
        sheared.append(
            dataclasses.replace(found(stress, "viscosity"), what=f"stress, shear rate {rate}")
        )
    stress = page.run(f"dimers-{rates[-1]}", with_rate(case, rates[-1]))["stress"]
    rest = found(stress, "kinetic").measured + found(stress, "collisional").measured
    measured_time = Comparison("theory, measured mode time", nu + share * tau, share * spread)
    length = math.sqrt(theory.mean_square_bond(K=case.fluid.molecule.bond.K))
    hydrodynamic = theory.zimm_times(2, bead.friction, bead.viscosity, length).stress[0]
    expected = nu + share * hydrodynamic
    rows = [
        dataclasses.replace(c, expected=measured_time.measured, note="") for c in (wave, *sheared)
    ]
    page.table([
        *rows,
        Comparison("theory, measured mode time", measured_time.measured, measured_time.error,
                   expected, "a^2/tau", "beside theory from the friction of a bead"),
    ])  # fmt: skip
    all_of = [wave, *sheared, measured_time]
    for i, a in enumerate(all_of):
        for b in all_of[i + 1 :]:
            if a in sheared and b in sheared:
                continue
            apart = (a.measured - b.measured) / math.hypot(a.error, b.error)
            page.check(f"{a.what} and {b.what}: {apart:+.1f} s.e. apart (at most 2)",
                       abs(apart) < 2)  # fmt: skip
    page.text(
        f"Kinetic and collisional part of the sheared dimers are {rest:.3f} together, where free "
        f"particles have {nu:.3f}; theory leaves that difference out. From the friction of a "
        f"free bead alone theory has {expected:.3f}."
    )
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    mean, error = mean_and_error(left)
    axes[0].errorbar(t, mean, error, fmt="o", ms=3, mfc="white", color=BLUE, label="measured")
    law = theory.transverse_correlation_chain(k, t, nu, share, [tau])
    axes[0].semilogy(t, law, "-", color=RED, lw=1, label="theory")
    axes[0].semilogy(t, np.exp(-nu * k * k * t), ":", color=GREY, label="without bonds")
    axes[0].set(xlabel="time", ylabel="amplitude / start")
    axes[1].errorbar(rates, [c.measured for c in sheared], [c.error for c in sheared], fmt="s",
                     mfc="white", color=BLUE, label="stress")  # fmt: skip
    axes[1].errorbar([0], [wave.measured], [wave.error], fmt="o", mfc="white", color=PURPLE,
                     label="decay of a wave")  # fmt: skip
    axes[1].axhspan(measured_time.measured - measured_time.error,
                    measured_time.measured + measured_time.error, color=RED, alpha=0.3,
                    label="theory")  # fmt: skip
    axes[1].set(xlabel="shear rate", ylabel="viscosity", ylim=(7.2, 8.0))
    for ax in axes:
        ax.legend()
    return fig


def thinning(page: Page, case: Case, bead: Bead) -> Any:
    """Viscosity of FENE dumbbells against shear rate; returns the figure."""
    molecule, nu, rho = case.fluid.molecule, without_bonds(case).viscosity, case.fluid.density
    pairs = rho / molecule.length
    radii, _, density = lengths(molecule.bond_potentials, 3, 1.0, molecule.bond.longest)
    square = np.trapezoid(radii**2 * density, radii)
    friction = theory.pair_friction(
        bead.friction, bead.radius, float(np.trapezoid(density / radii, radii))
    )
    at_rest = theory.dumbbell_viscosity(pairs, friction, square / 3) / rho
    rates = (0.01, 0.03, 0.1, 0.2, 0.4)
    rows, points = [], []
    for rate in rates:
        steps = case.run.steps * (3 if rate < 0.02 else 1)
        files = page.run(f"fene-{rate}", with_rate(case, rate, steps=steps))
        stress, across = files["stress"], files["bond-length"]
        c = found(stress, "bond part")
        of_size = theory.dumbbell_viscosity(pairs, friction, across.value[0, 1, 1]) / rho
        rows.append(
            dataclasses.replace(c, what=f"bond part, shear rate {rate}", expected=of_size,
                                note="theory: Giesekus, of the measured size across the flow")
        )  # fmt: skip
        points.append(found(stress, "viscosity"))
    slow = dataclasses.replace(rows[0], what="bond part, slow flow", expected=at_rest,
                               note="theory: at zero shear rate, no measured size")  # fmt: skip
    page.table([slow, *rows])
    page.check(f"slow flow: {slow.percent:+.1f} % from theory at zero shear rate (at most 5 %)",
               abs(slow.percent) < 5)  # fmt: skip
    for c in rows:
        page.check(f"{c.what}: {c.percent:+.1f} % from Giesekus (at most 5 %)", abs(c.percent) < 5)
    fig, ax = plt.subplots(figsize=(5.5, 3.8))
    ax.errorbar(rates, [c.measured for c in points], [c.error for c in points], fmt="o",
                mfc="white", color=BLUE, label="measured")  # fmt: skip
    ax.plot(rates, [nu + c.expected for c in rows], "x", color=RED,
            label="Giesekus, of the measured size")  # fmt: skip
    ax.axhline(nu + at_rest, color=GREEN, lw=1, label="theory, zero shear rate")
    fine = np.geomspace(0.005, 0.6, 100)
    tau, b = friction / (4 * molecule.bond.k), molecule.bond.k * molecule.bond.R0**2
    ax.plot(fine, [nu + at_rest * theory.fene_p_thinning(g, tau, b) for g in fine], "--",
            color=GREY, label="FENE-P")  # fmt: skip
    ax.set(xscale="log", xlabel="shear rate", ylabel="viscosity")
    ax.legend()
    return fig


def free_bead(page: Page, simple: Case) -> tuple[Bead, Comparison]:
    """Friction of a free particle, of a large box, from its diffusion in a small one."""
    observe = (MeanSquareDisplacement(every=4, max_lag=400, particles=5000),)
    files = page.run("free-bead", dataclasses.replace(simple, observe=observe))
    c = found(files["mean-square-displacement"], "diffusion")
    eta, length = without_bonds(simple).dynamic_viscosity, simple.box.size[0]
    lacking = c.measured - theory.diffusion_in_box(c.measured, length, eta)
    friction = 1 / (c.measured + lacking)
    return Bead(friction, c.error * friction**2, friction / (6 * math.pi * eta), eta), c
