"""The viscosity of one 3D SRD fluid by three independent routes.

A shear wave that decays, the stress of sheared fluid, and the curvature of a channel flow must
give the same number, and that of the theory.
"""

from __future__ import annotations

import math

import numpy as np
from common import ANGLE, BLUE, RED, Page, found, main, plt, renamed, simulate

import mesokit
from mesokit import SRD, Box, Comparison, Fluid, MaxwellBoltzmann, Plates, Run, Uniform, theory
from mesokit.report.style import sparse_logarithm

DENSITY, TIMESTEP = 10, 0.1
RULE = SRD(angle=ANGLE)
THEORY = theory.transport("srd", 3, DENSITY, TIMESTEP, angle=ANGLE)
UNIT = "a^2/tau"


def wave_run(seed: int, length: int, start: float, times: int, every: int) -> np.ndarray:
    """Amplitude over time of one sine wave v_x ~ sin(k y) in a cubic box at rest.

    A cube and a single wave: longer boxes and crossed waves are unstable. The thermal part of the
    amplitude is taken out at the start, so that it is `start` exactly.
    """
    random = np.random.default_rng(seed)
    n, k = DENSITY * length**3, 2 * np.pi / length
    positions = random.random((n, 3)) * length
    velocities = random.standard_normal((n, 3))
    velocities -= velocities.mean(axis=0)
    wave = np.sin(k * positions[:, 1])
    thermal = wave @ velocities[:, 0]
    velocities[:, 0] += (start * n / 2 - thermal) / (wave @ wave) * wave
    simulation = mesokit.Simulation(
        threads=1, positions=positions, velocities=velocities, run=Run(steps=0, seed=seed),
        box=Box([length] * 3), fluid=Fluid(density=DENSITY, timestep=TIMESTEP, collision=RULE),
    )  # fmt: skip
    amplitude = np.zeros(times + 1)
    for i in range(times + 1):
        if i:
            simulation.engine.advance(every)
        _, momentum = simulation.engine.modes(np.array([[0.0, k, 0.0]]))
        amplitude[i] = -2 * momentum[0, 0].imag / n
    return amplitude


def shear_wave(runs: int = 40, length: int = 20, start: float = 0.4) -> tuple:
    """Viscosity from the mean decay of many waves; the error from leaving out one run at a time."""
    times, every = 20, 8
    k = 2 * np.pi / length
    curves = np.array([wave_run(seed + 1, length, start, times, every) for seed in range(runs)])
    t = np.arange(times + 1) * every * TIMESTEP

    def fit(curve: np.ndarray) -> float:
        return theory.transverse_viscosity_fit(k, t[1:], curve[1:] / start, 0.01).viscosity

    nu = fit(curves.mean(axis=0))
    without = np.array([fit(np.delete(curves, i, axis=0).mean(axis=0)) for i in range(runs)])
    error = math.sqrt((runs - 1) * without.var())
    return (
        Comparison("decay of a shear wave", nu, error, THEORY.viscosity, UNIT),
        t,
        curves / start,
        k,
    )


def sheared(steps: int = 5000) -> tuple[list[Comparison], mesokit.Result]:
    """Viscosity, and its two parts, from the stress under Lees-Edwards shear."""
    simulation = simulate(
        run=Run(steps=steps, warmup=300, seed=2),
        box=Box([20, 20, 20], shear_rate=0.1),
        fluid=Fluid(
            density=DENSITY, timestep=TIMESTEP, collision=RULE, thermostat=MaxwellBoltzmann()
        ),
        observe=[mesokit.Stress(every=1)],
    )
    stress = simulation["stress"]
    rows = [
        renamed(found(stress, "viscosity"), "Lees-Edwards stress", expected=THEORY.viscosity),
        renamed(
            found(stress, "kinetic"), "its kinetic part", "correlated collisions, see text",
            THEORY.viscosity_kinetic,
        ),
        renamed(
            found(stress, "collisional"), "its collisional part", "", THEORY.viscosity_collisional
        ),
    ]  # fmt: skip
    return rows, stress


def channel(steps: int = 25_000) -> tuple[Comparison, mesokit.Result]:
    """Viscosity from the curvature of the Poiseuille profile, which slip does not bias."""
    simulation = simulate(
        run=Run(steps=steps, warmup=4000, seed=3),
        box=Box([12, 24, 12]),
        fluid=Fluid(
            density=DENSITY, timestep=TIMESTEP, collision=RULE, thermostat=MaxwellBoltzmann(),
            force=Uniform(acceleration=(0.004, 0, 0)),
        ),
        walls=[Plates(axis="y")],
        observe=[mesokit.VelocityProfile(every=20)],
    )  # fmt: skip
    profile = simulation["velocity-profile"]
    curvature = found(profile, "viscosity")
    return renamed(curvature, "Poiseuille curvature", expected=THEORY.viscosity), profile


def make() -> int:
    """Write the page."""
    page = Page("viscosity_routes", "One viscosity by three routes")
    wave, t, curves, k = shear_wave()
    stress_rows, _ = sheared()
    curvature, profile = channel()
    page.text(
        f"SRD in 3D, density {DENSITY}, angle 2.27 rad, timestep {TIMESTEP}: the theory "
        f"(molecular chaos, Poisson occupancy) gives nu = {THEORY.viscosity:.4f}. Shear wave: "
        f"{len(curves)} cubes of 20^3 cells at rest, one wave of amplitude 0.4, no thermostat. "
        "Stress: 20^3 cells, shear rate 0.1, 5000 steps. Channel: 12 x 24 x 12 cells, no-slip "
        "plates, acceleration 0.004, 25,000 steps; the slices next to the plates are left out. "
        "The last two are held at kT by the Maxwell-Boltzmann thermostat, which at this angle and "
        "density changes the viscosity by less than 0.1 %."
    )
    routes = [wave, stress_rows[0], curvature]
    page.table([wave, *stress_rows, curvature])
    for c in routes:
        share = 100 * c.error / c.measured
        page.check(f"{c.what}: standard error {share:.2f} % (at most 1 %)", share < 1)
        page.check(f"{c.what}: {c.percent:+.2f} % from theory (at most 2 %)", abs(c.percent) < 2)
    weights = np.array([c.error**-2 for c in routes])
    values = np.array([c.measured for c in routes])
    mean = float(weights @ values / weights.sum())
    chi2 = float(weights @ (values - mean) ** 2)
    error = float(weights.sum() ** -0.5)
    page.table([Comparison("weighted mean of the routes", mean, error, THEORY.viscosity, UNIT)])
    page.check(
        f"the three agree with each other: chi-square {chi2:.2f} for 2 degrees of freedom",
        chi2 < 9.2,
    )
    page.text(
        "The parts of the stress deviate in opposite directions, and the sum is right: at a mean "
        "free path of 0.1 cells successive collisions happen among the same particles, which "
        "molecular chaos leaves out. They raise the kinetic part much as they raise "
        "self-diffusion (by 14 %). At timestep 1 each part agrees with theory "
        "(see [the other rules](viscosity_rules.md))."
    )
    fig, axes = plt.subplots(1, 2, figsize=(9, 3.8))
    mean_curve = curves.mean(axis=0)
    spread = curves.std(axis=0, ddof=1) / math.sqrt(len(curves))
    axes[0].errorbar(t, mean_curve, spread, fmt="o", color=BLUE, mfc="white", label="shear wave")
    axes[0].plot(t, np.exp(-THEORY.viscosity * k**2 * t), "k-", lw=1, label="theory")
    axes[0].set(xlabel="time", ylabel="amplitude / start", yscale="log")
    sparse_logarithm(axes[0].yaxis, *axes[0].get_ylim())
    axes[0].legend()
    y = profile.x["y"]
    axes[1].errorbar(y, profile.value, profile.error, fmt="o", ms=2, color=BLUE, label="channel")
    axes[1].plot(y, profile.expected, "k-", lw=1, label="theory, no slip")
    axes[1].plot(y, profile.fit, "--", color=RED, label="fit")
    axes[1].set(xlabel="y", ylabel="velocity")
    axes[1].legend()
    page.figure(fig, "Decay of the shear wave (errors below the points), and the channel flow.")
    return page.write()


if __name__ == "__main__":
    main(make)
