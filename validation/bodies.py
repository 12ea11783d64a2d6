"""Bodies that move in the fluid: how warm they are, how they drift, diffuse, turn and swim.

Usage: python validation/bodies.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from common import BLUE, GREEN, GREY, PURPLE, RED, RUNS, SHORT, Page, found, main, plt, renamed
from scipy.optimize import brentq

from mesokit import (
    SRD,
    ATPlusA,
    BodyCorrelation,
    BodyDisplacement,
    BodyDrift,
    BodyMotion,
    BodyStart,
    BodyTracks,
    Box,
    CapsuleBody,
    Case,
    Comparison,
    DiskBody,
    EllipseBody,
    Fluid,
    GapPotential,
    MaxwellBoltzmann,
    Plates,
    Rectangle,
    Run,
    Simulation,
    Sphere,
    SphereBody,
    SpheroidBody,
    Squirming,
    SRDPlusA,
    Stress,
    UnionBody,
    every,
    theory,
)

LENGTH = 0.1  # of all run lengths: 1 is a page of some 15 hours
DENSITY, STEP = 10, 0.1
RULES: dict[str, tuple[Any, Any]] = {
    "at+a": (ATPlusA(), None),
    "srd+a": (SRDPlusA(angle=90), MaxwellBoltzmann()),
    "srd": (SRD(angle=130), MaxwellBoltzmann()),
}
DUMBBELL = (Sphere(centre=(-1.6, 0, 0), radius=1.7), Sphere(centre=(1.4, 0, 0), radius=1.3))
L_SHAPE = (Rectangle(centre=(0, 0), size=(6, 2)), Rectangle(centre=(2, 2.5), size=(2, 3)))
WARMUP = {2: 1000, 3: 400}  # steps, in which a flow in these boxes builds up
SURE = 3.0  # standard errors within which a law is met
LEFT_OUT = (
    ("published rules of hits and virtual particles", "they are not part of the program"),
    ("D(L) over three boxes; long-time tails", "the noise is larger than the effect in these runs"),
    ("hindered settling; structure at rest", "many spheres need longer runs than these"),
    ("D + U^2/(d (d - 1) D_r) of swimmers; swimmers at a wall",
     "runs of many times 1/D_r, 1000 time units at R = 3"),
    ("two spheres", "they drift apart: many short runs would be needed"),
    ("spheroid in the shear plane, 3D", "2D ellipses take its place"),
)  # fmt: skip


def steps(number: float) -> int:
    """So many steps, times LENGTH; few for a quick try."""
    return max(int(number * LENGTH / (50 if SHORT else 1)), 150)


def fluid(rule: str, timestep: float = STEP) -> Fluid:
    """A fluid of 10 particles per cell."""
    collision, thermostat = RULES[rule]
    return Fluid(
        density=DENSITY, timestep=timestep, collision=collision,
        **({"thermostat": thermostat} if thermostat else {}),
    )  # fmt: skip


def coefficients(rule: str, d: int, timestep: float = STEP) -> Any:
    """Transport coefficients of theory."""
    collision, thermostat = RULES[rule]
    return theory.transport(
        rule, d, DENSITY, timestep, angle=getattr(collision, "angle", None),
        thermostat="maxwell-boltzmann" if thermostat else "none",
    )  # fmt: skip


def viscosity(rule: str, d: int) -> float:
    """Dynamic."""
    return float(coefficients(rule, d).dynamic_viscosity)


def case_of(body: Any, side: int, rule: str, length: float, *observe: Any, **more: Any) -> Case:
    """Bodies in a periodic cube or square; `more` has timestep, shear_rate or walls."""
    bodies = body if isinstance(body, tuple) else (body,)
    planar = 3 not in bodies[0].dimensions or isinstance(
        getattr(bodies[0], "parts", (None,))[0], Rectangle
    )
    d = 2 if planar else 3
    size = more.pop("size", [side] * d)
    number, warmup = steps(length), WARMUP[d]
    return Case(
        run=Run(steps=number, warmup=warmup, seed=11),
        box=Box(size, shear_rate=more.pop("shear_rate", 0.0)),
        fluid=fluid(rule, more.pop("timestep", STEP)), bodies=bodies, observe=list(observe), **more,
    )  # fmt: skip


def ran(page: Page, name: str, case: Case) -> Any:
    """Results of a run, and a note of its length."""
    return page.run(name, case), f"{case.run.steps} steps"


def met(page: Page, what: str, c: Comparison, percent: float) -> None:
    """Check that a number is within 3 standard errors, or so many per cent, of theory.

    An error bar above so many per cent can only show that the law is not met.
    """
    near, allowed = abs(c.measured - c.expected), percent / 100 * abs(c.expected)
    if c.error > allowed and near < SURE * c.error:
        return
    page.check(
        f"{what}: {c.percent:+.1f} +- {100 * c.error / abs(c.expected):.1f} % off theory (within "
        f"{percent:g} % or {SURE:g} s.e.)",
        near < max(SURE * c.error, allowed),
    )


# ---------------------------------------------------------------- slip


def swimming(page: Page) -> None:
    """Speed of neutral squirmers, and the slip length that it tells."""
    page.heading("Slip length, by swimming speed")
    page.text(
        "A neutral squirmer (B1 = 0.15, B2 = 0) of R = 3 in a periodic square of side 30 or cube "
        "of side 16. Its flow is a potential flow, so that the law holds at any Reynolds number. A "
        "slip length b lowers the speed to (1 - phi) U/(1 + (2 - c) b/R) with U = B1/2 in 2D and 2 "
        "B1/3 in 3D. So b follows from the speed, without the viscosity. The Mach number is 0.07 "
        "in 2D and 0.09 in 3D: compression may change the speed by its square, 0.5 to 0.8 %, which "
        "is 0.01 cells of b, and is not in the error bars. The column of theory has the slip "
        "length that the program takes, which is that of plates in SRD; the rows of b have that "
        "number beside what is measured."
    )
    rows, lengths = [], []
    for d, rule, length in (
        (2, "at+a", 6e5), (2, "srd+a", 6e5), (3, "at+a", 1.2e5), (3, "srd+a", 1.2e5),
        (3, "srd", 1.2e5),
    ):  # fmt: skip
        kind, side = (DiskBody, 30) if d == 2 else (SphereBody, 16)
        body = kind(radius=3, swim=Squirming(B1=0.15))
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"swim-{d}-{rule}", case)
        c = found(files["body-drift"], "velocity along its own axis")
        share = 0.0
        if "+a" not in rule:
            known = coefficients(rule, d)
            share = known.viscosity_collisional / known.viscosity
        full = theory.squirmer_speed_in_box(
            theory.squirmer_speed(0.15, d), body.solid(d).volume / side**d
        )
        b, error = 3 / (2 - share) * (full / c.measured - 1), 3 / (2 - share) * full * c.error
        error /= c.measured**2
        plates = 0.151 if d == 3 else 0.220
        rows.append(renamed(c, f"{d}D, {rule}: swimming speed", note))
        rows.append(Comparison(f"{d}D, {rule}: slip length b", b, error, plates, "a", "of plates"))
        lengths.append((f"{d}D\n{rule}", b, error, plates))
    page.table(rows)
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    names, value, scatter, known = zip(*lengths, strict=True)
    places = np.arange(len(names))
    axis.errorbar(places, value, scatter, fmt="o", color=PURPLE, mfc="white", label="measured")
    axis.plot(places, known, "_", ms=18, color=GREY, label="plates in SRD")
    axis.axhline(0, color=GREY, lw=0.5)
    axis.set(xticks=places, xticklabels=names, ylabel="slip length")
    axis.legend()
    page.figure(fig, "Slip lengths by swimming, R = 3. Error bars: one standard error.", "_slip")


def drag(page: Page) -> None:
    """Mobility of a drawn ball, and the slip length that it tells."""
    page.heading("Drag of a sphere and a disk, and slip by drag")
    page.text(
        "R = 3, drawn by a force with counter-force, box as before. Theory is Sangani and Acrivos "
        "with the slip length of plates and the viscosity of molecular chaos, which is good to 1 "
        "or 2 %. The slip length that follows is less certain than that by swimming: 1 % of "
        "mobility is 0.04 to 0.06 cells."
    )
    rows = []
    for d, rule, length, force in (
        (2, "at+a", 4e5, 3.0), (2, "srd+a", 4e5, 3.0), (3, "at+a", 6e4, 30.0),
        (3, "srd+a", 6e4, 30.0),
    ):  # fmt: skip
        kind, side = (DiskBody, 30) if d == 2 else (SphereBody, 16)
        body = kind(radius=3, force=(force, *[0.0] * (d - 1)), counter_force=True)
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"drag-{d}-{rule}", case)
        c = found(files["body-drift"], "mobility along x")
        met(page, f"{d}D, {rule}, mobility", c, 5)
        rows.append(renamed(c, f"{d}D, {rule}: mobility", note))
        friction = theory.disk_friction_in_square if d == 2 else theory.sphere_friction_in_cube
        eta = viscosity(rule, d)
        b = slip_of(c.measured, friction, side, eta)
        near = 0.5 * (slip_of(c.measured + c.error, friction, side, eta)
                      - slip_of(c.measured - c.error, friction, side, eta))  # fmt: skip
        plates = 0.151 if d == 3 else 0.220
        rows.append(Comparison(f"{d}D, {rule}: slip length b", b, near, plates, "a", "of plates"))
    page.table(rows)


def slip_of(mobility: float, friction: Any, side: float, eta: float) -> float:
    """The slip length at which theory has this mobility; its line goes on below zero."""
    free, some = (1 / friction(3.0, side, eta, b) for b in (0.0, 0.3))
    if mobility < free:
        return float(0.3 * (mobility - free) / (some - free))
    most = 1 / friction(3.0, side, eta, 50.0)
    if mobility >= most:
        return math.nan
    return float(brentq(lambda b: 1 / friction(3.0, side, eta, b) - mobility, 0.0, 50.0))


# ---------------------------------------------------------------- rest


def conservation(page: Page) -> None:
    """Momentum, and the energy without virtual particles, over many steps."""
    page.heading("Conservation")
    page.text(
        "Momentum of fluid and bodies relative to sum m |v| of the start, and energy relative to "
        "itself: SRD+a without thermostat and without virtual particles, which would bring heat."
    )
    rows = []
    for name, body, size in (
        ("disk, R = 2", DiskBody(radius=2, virtual="none"), [16, 16]),
        ("union, an L", UnionBody(parts=L_SHAPE, virtual="none"), [16, 18]),
        ("sphere, R = 2", SphereBody(radius=2, virtual="none"), [10, 10, 10]),
    ):
        number = steps(1e6 if len(size) == 2 else 2e5)
        simulation = Simulation(
            threads=1, run=Run(steps=0, seed=4), box=Box(size), bodies=(body,),
            fluid=Fluid(density=DENSITY, timestep=STEP, collision=SRDPlusA(angle=90)),
        )  # fmt: skip
        engine = simulation.engine
        _, start, energy = engine.totals()
        scale = np.linalg.norm(engine.velocities(), axis=1).sum()
        engine.advance(number)
        _, momentum, now = engine.totals()
        drifts = np.linalg.norm(momentum - start) / scale, abs(now / energy - 1)
        rows.append([name, number, *(f"{x:.1e}" for x in drifts)])
        page.check(
            f"{name}, {number} steps: momentum {drifts[0]:.1e}, energy {drifts[1]:.1e} (below "
            "1e-10)",
            max(drifts) < 1e-10,
        )
    page.grid(["body", "steps", "momentum drift", "energy drift"], rows)


def equipartition(page: Page) -> None:
    """Mean squares over those of equipartition, for shapes and timesteps."""
    page.heading("Equipartition")
    page.text(
        "<V^2> M/(d kT) and the mean of <Omega_i^2> I_i/kT over axes of the body; AT+a, except "
        "where another rule is named. The velocity has the share 1 - M/M_all, as all momentum is "
        "zero."
    )
    rows, marks = [], []
    for name, body, side, rule, timestep, length in shapes():
        observe = [BodyMotion()]
        case = case_of(body, side, rule, length, *observe, timestep=timestep)
        files, note = ran(page, f"warm-{name}-{rule}-{timestep}".replace(" ", ""), case)
        motion = files["body-motion"]
        label = f"{name}, {rule}, dt {timestep:g}"
        v = found(motion, "mean square velocity")
        spins = [c for c in motion.comparisons if c.what.startswith("mean square angular")]
        turning = Comparison(
            f"{label}: angular velocity", float(np.mean([c.measured for c in spins])),
            math.hypot(*(c.error for c in spins)) / len(spins), 1.0, "kT/I",
        )  # fmt: skip
        rows += [renamed(v, f"{label}: velocity", note), turning]
        marks.append((label, v.measured / v.expected, v.error / v.expected, turning))
        counts = [found(motion, what).measured for what in ("second hits", "put back")]
        rows[-1] = renamed(turning, turning.what, f"{counts[0]:.2g} second hits, {counts[1]:.2g} "
                           "put back in a step")  # fmt: skip
        for c in rows[-2:]:
            met(page, c.what, c, 1)
    page.table(rows)
    fig, axis = plt.subplots(figsize=(6.5, 4.6))
    places = np.arange(len(marks))
    for shift, k, colour, label in ((-0.1, 0, BLUE, "velocity"), (0.1, 1, RED, "angular velocity")):
        value = [m[1] if k == 0 else m[3].measured for m in marks]
        error = [m[2] if k == 0 else m[3].error for m in marks]
        axis.errorbar(value, places + shift, xerr=error, fmt="o", color=colour, mfc="white", ms=4,
                      label=label)  # fmt: skip
    axis.axvline(1, color=GREY, lw=1)
    axis.set(yticks=places, yticklabels=[m[0] for m in marks], xlabel="mean square / theory")
    axis.tick_params(axis="y", labelsize=7)
    axis.legend(fontsize=7)
    page.figure(
        fig, "Mean squares over equipartition. Error bars: one standard error.", "_equipartition"
    )


def shapes() -> Iterator[tuple[str, Any, int, str, float, float]]:
    """Name, body, side of the box, rule, timestep and base length of each run at rest."""
    for dt in (0.05, 0.1, 0.3):
        yield "sphere R = 2", SphereBody(radius=2), 12, "at+a", dt, 1.5e5
    yield "sphere R = 2", SphereBody(radius=2), 12, "srd", STEP, 1.5e5
    yield "sphere R = 3", SphereBody(radius=3), 16, "at+a", STEP, 6e4
    yield "sphere R = 5", SphereBody(radius=5), 20, "at+a", STEP, 2e4
    yield "spheroid 6 x 3", SpheroidBody(half_length=3, radius=1.5), 12, "at+a", STEP, 1e5
    yield "union of spheres", UnionBody(parts=DUMBBELL), 12, "at+a", STEP, 1e5
    for radius, side in ((2, 16), (3, 24), (5, 30)):
        yield f"disk R = {radius}", DiskBody(radius=radius), side, "at+a", STEP, 3e5
    yield "disk R = 2", DiskBody(radius=2), 16, "at+a", 0.3, 3e5
    yield "union, an L", UnionBody(parts=L_SHAPE), 20, "at+a", STEP, 3e5


def diffusion(page: Page) -> None:
    """Diffusion of places and angles beside the mobilities of theory."""
    page.heading("Diffusion, kT times mobility")
    page.text(
        "From the mean square displacement of places and of angles, and from the orientation. "
        "Theory is kT times the mobility of the drag laws in the same box, with the slip length of "
        "plates. SRD does not conserve angular momentum: its rotation has the factor 1/(1 - c/3)."
    )
    rows = []
    for name, body, side, rule, length in (
        ("disk R = 2", DiskBody(radius=2), 20, "at+a", 6e5),
        ("sphere R = 2", SphereBody(radius=2), 12, "at+a", 1e5),
        ("sphere R = 2", SphereBody(radius=2), 12, "srd", 1e5),
    ):
        d, lag = body.dimensions[0], min(400, steps(length) // 8)
        for of, observed in (
            ("places", BodyDisplacement(of="places", max_lag=lag)),
            ("angles", BodyDisplacement(of="angles", max_lag=lag)),
            ("orientation", BodyCorrelation(of="orientation", max_lag=lag * 2, every=5)),
        ):
            case = case_of(body, side, rule, length, observed)
            files, note = ran(page, f"diffusion-{d}-{rule}-{of}", case)
            for c in files[observed.quantity].comparisons:
                rows.append(renamed(c, f"{name}, {rule}: {c.what} ({of})", f"{note}; {c.note}"))
    page.table(rows)


def memory(page: Page) -> None:
    """What one timestep takes of the velocity, and how the rest decays."""
    page.heading("Velocity autocorrelation: its start and its first step")
    page.text(
        "V and Omega of one body, read after every step. C(0) is kT/M (1 - M/M_all) and kT/I. "
        "One timestep takes zeta dt/M of the velocity, where zeta is the friction by hits "
        "(`enskog_friction`) plus that by virtual particles, and zeta_r dt/I of the angular "
        "velocity; of the latter theory has the hits alone. The first order in dt is an upper "
        "bound where dt is not small: beside it stands 1 - exp(-zeta dt/M) as a note."
    )
    rows = []
    fig, axis = plt.subplots(figsize=(5.5, 3.8))
    for name, body, side, rule, virtual, length in (
        ("sphere R = 3", SphereBody, 16, "srd", "fill", 6e4),
        ("sphere R = 3", SphereBody, 16, "srd", "none", 6e4),
        ("disk R = 3", DiskBody, 24, "at+a", "none", 3e5),
    ):
        d = body.dimensions[0]
        one = body(radius=3, virtual=virtual)
        case = case_of(one, side, rule, length)
        series = recorded(page, f"memory-{d}-{rule}-{virtual}", case)
        mass = one.mass_in(d, DENSITY)
        inertia = (0.5 if d == 2 else 0.4) * mass * 9
        whole = mass + DENSITY * (side**d - one.solid(d).volume)
        hits = theory.enskog_friction(3, DENSITY, mass, d, inertia=inertia)
        surface = 2 * math.pi * 3 if d == 2 else 4 * math.pi * 9
        drawn = theory.friction_by_virtual_particles(
            surface, DENSITY, STEP, d, angle=130 if rule == "srd" else None
        )
        both = hits + (drawn if virtual == "fill" else 0.0)
        turned = theory.enskog_rotational_friction(3, DENSITY, mass, inertia, d)
        label = f"{name}, {rule}, virtual {virtual}"
        first = kept_by(series[:, :d], (0, 1))
        lost = STEP * both / mass
        rows.append(Comparison(f"{label}: <V^2>", *blocks(first[0]),
                               theory.velocity_variance(mass, whole), "a^2/tau^2",
                               f"{case.run.steps} steps"))  # fmt: skip
        rows.append(Comparison(f"{label}: part of V that a step takes", *one_less(first), lost, "",
                               f"1 - exp: {1 - math.exp(-lost):.3f}"))  # fmt: skip
        spin = kept_by(series[:, d:], (0, 1))
        rows.append(Comparison(f"{label}: <Omega^2>", *blocks(spin[0]), 1 / inertia, "1/tau^2"))
        if virtual == "none":
            lost = STEP * turned / inertia
            rows.append(Comparison(f"{label}: part of Omega that a step takes", *one_less(spin),
                                   lost, "", f"1 - exp: {1 - math.exp(-lost):.3f}"))  # fmt: skip
        lags = range(0, 40)
        curve = np.array([x.mean() for x in kept_by(series[:, :d], lags)])
        axis.plot(np.array(lags) * STEP, curve / curve[0], "o-", ms=3, lw=1, mfc="white",
                  label=label, color=(BLUE, RED, GREEN)[len(axis.lines) % 3])  # fmt: skip
    page.table(rows)
    axis.axhline(0, color=GREY, lw=1)
    axis.set(xlabel="time", ylabel="$C(t)/C(0)$")
    axis.legend(fontsize=7)
    page.figure(fig, "Correlation of the velocity at two times.", "_memory")


def recorded(page: Page, name: str, case: Case) -> np.ndarray:
    """Velocity and angular velocity of the first body after every step, kept on disk."""
    folder = RUNS / ("short" if SHORT else "") / page.name
    folder.mkdir(parents=True, exist_ok=True)
    file, asked = folder / f"{name}.npy", folder / f"{name}.toml"
    if file.exists() and asked.exists() and asked.read_text() == case.to_toml():
        return np.load(file)
    print(f"  recording {name}: {case.particles} particles", flush=True)
    d, rows = case.box.dimension, []

    def look(simulation: Any) -> None:
        bodies = simulation.engine.bodies
        spin = np.atleast_2d(bodies.spins)[0]
        rows.append([*bodies.velocities[0], *(spin[2:] if d == 2 else spin)])

    Simulation(case, threads=1, callbacks=[every(1, look)]).run()
    series = np.array(rows)[case.run.warmup :]
    np.save(file, series)
    asked.write_text(case.to_toml())
    return series


def kept_by(series: np.ndarray, lags: Any) -> list[np.ndarray]:
    """Products at two times, the mean over components, for each lag."""
    n = len(series) - max(lags)
    return [(series[:n] * series[k : k + n]).mean(axis=1) for k in lags]


def blocks(values: np.ndarray) -> tuple[float, float]:
    """Mean and standard error, from 20 blocks."""
    means = np.array([b.mean() for b in np.array_split(values, 20)])
    return float(means.mean()), float(means.std(ddof=1) / math.sqrt(20))


def one_less(pair: list[np.ndarray]) -> tuple[float, float]:
    """1 - C(1)/C(0), and its standard error from 20 blocks."""
    whole = pair[1].mean() / pair[0].mean()
    scatter = blocks(pair[1] - whole * pair[0])[1] / pair[0].mean()
    return float(1 - whole), float(scatter)


def rotation(page: Page) -> None:
    """Angular velocity over torque."""
    page.heading("Rotational mobility, with and without angular momentum")
    page.text(
        "R = 3 under a torque, side 16 in 3D and 24 in 2D. Theory has the images of the box, the "
        "slip length of plates, and for SRD the factor of a fluid without angular momentum in "
        "the limit of a large body. For rules +a the slip length follows from the mobility, "
        "(1 - phi + d b/R) over that of a wide fluid; 1 % of viscosity is 0.010 cells of it in 3D "
        "and 0.015 in 2D."
    )
    rows = []
    for d, rule, length, torque in (
        (2, "at+a", 5e5, 40.0), (3, "at+a", 6e4, 240.0), (3, "srd+a", 6e4, 240.0),
        (3, "srd", 6e4, 180.0),
    ):  # fmt: skip
        body = DiskBody(radius=3, torque=torque) if d == 2 else SphereBody(
            radius=3, torque=(0.0, 0.0, torque)
        )  # fmt: skip
        side = 24 if d == 2 else 16
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"rotation-{d}-{rule}", case)
        c = found(files["body-drift"], "rotational mobility")
        rows.append(renamed(c, f"{d}D, {rule}: rotational mobility", note))
        if "+a" in rule:
            met(page, rows[-1].what, c, 5)
            # mobility is (1 - phi + d b/R)/unit
            unit = (4 if d == 2 else 8) * math.pi * viscosity(rule, d) * 3.0**d
            left = 1 - body.solid(d).volume / side**d
            b, error = 3 / d * (unit * c.measured - left), 3 / d * unit * c.error
            plates = 0.151 if d == 3 else 0.220
            rows.append(Comparison(f"{d}D, {rule}: slip length b", b, error, plates, "a",
                                   "of plates"))  # fmt: skip
    page.table(rows)


# ---------------------------------------------------------------- shear


def shear(page: Page) -> None:
    """Turning in a shear flow, periods of Jeffery, and Einstein's viscosity."""
    page.heading("Shear: turning, Jeffery periods")
    page.text(
        "Lees-Edwards shear at the rate 0.02, AT+a. Theory: half the rate for a sphere or disk; "
        "the mean angular velocity of an ellipse is rate/(r + 1/r), which is that of Jeffery's "
        "period 2 pi (r + 1/r)/rate. Noise turns an ellipse too, with D_r = kT/(2 pi eta (a^2 + "
        "b^2)) in a wide fluid: the mean of Jeffery's angular velocity over the steady "
        "distribution of angles stands as theory. Re is rate R^2/nu, with the half length of an "
        "ellipse."
    )
    rows, rate = [], 0.02
    for name, body, side, length in (
        ("disk R = 3", DiskBody(radius=3), 30, 3e5),
        ("sphere R = 3", SphereBody(radius=3), 16, 8e4),
        ("ellipse 10 x 5", EllipseBody(size=(10, 5)), 36, 4e5),
        ("ellipse 12 x 4", EllipseBody(size=(12, 4)), 40, 3e5),
    ):
        d = body.dimensions[0]
        case = case_of(body, side, "at+a", length, BodyDrift(), shear_rate=rate)
        files, note = ran(page, f"shear-{name}".replace(" ", ""), case)
        c = found(files["body-drift"], "angular velocity about z")
        aspect = body.size[0] / body.size[1] if isinstance(body, EllipseBody) else 1.0
        half = body.size[0] / 2 if isinstance(body, EllipseBody) else 3.0
        known = rate / (aspect + 1 / aspect)
        note = f"without noise {known:.4f}; {note}"
        if isinstance(body, EllipseBody):
            known = noisy_turning(*body.size, rate)
        reynolds = rate * half**2 / coefficients("at+a", d).viscosity
        one = Comparison(f"{name}: angular velocity", abs(c.measured), c.error, known, "1/tau",
                         f"Re {reynolds:.2f}; {note}")  # fmt: skip
        rows.append(one)
        met(page, one.what, one, 5)
        if aspect > 1:
            period = 2 * math.pi / one.measured
            rows.append(Comparison(f"{name}: period", period, period * one.error / one.measured,
                                   2 * math.pi / known, "tau",
                                   f"Jeffery {theory.jeffery_period(aspect, rate):.0f}")
                        )  # fmt: skip
    page.table(rows)
    page.heading("Einstein viscosity")
    page.text(
        "Viscosity by `stress` of 2D AT+a with disks of R = 3, over that of the same box without "
        "bodies, at the rate 0.02. Theory is 1 + 2 phi (1 + 2 b/R)/(1 + 4 b/R), with the slip "
        "length of plates."
    )
    rows, values = [], []
    for number, side in ((0, 34), (1, 34), (2, 34)):
        length = 2e5
        if number:
            body = DiskBody(radius=3, number=number)
            case = case_of(body, side, "at+a", length, Stress(), shear_rate=rate)
        else:
            n = steps(length)
            case = Case(run=Run(steps=n, warmup=WARMUP[2], seed=11), observe=[Stress()],
                        box=Box([side, side], shear_rate=rate), fluid=fluid("at+a"))  # fmt: skip
        files, note = ran(page, f"einstein-{number}", case)
        c = found(files["stress"], "viscosity")
        values.append((c.measured, c.error))
        if number:
            phi = number * math.pi * 9 / side**2
            ratio = c.measured / values[0][0]
            error = ratio * math.hypot(c.error / c.measured, values[0][1] / values[0][0])
            rows.append(Comparison(f"phi = {phi:.3f}: eta/eta0", ratio, error,
                                   theory.suspension_viscosity(phi, 2, slip=0.22 / 3), "",
                                   note))  # fmt: skip
    page.table(rows)


def noisy_turning(length: float, wide: float, rate: float) -> float:
    """Mean angular velocity of an ellipse in a shear flow, with noise (Fokker and Planck)."""
    spread = 1 / (2 * math.pi * viscosity("at+a", 2) * (length**2 + wide**2) / 4)
    stretch = (length**2 - wide**2) / (length**2 + wide**2)
    turning = rate / 2 * np.array([stretch / 2, 1, stretch / 2])  # modes -2, 0, 2 of d phi/dt
    modes = np.arange(-40, 41)  # of exp(2 i n phi)
    matrix = np.diag(-4.0 * spread * modes**2).astype(complex)
    for shift, part in zip((-1, 0, 1), turning, strict=True):
        matrix -= np.diag(2j * modes[max(shift, 0) : len(modes) + min(shift, 0)] * part, -shift)
    middle = len(modes) // 2
    matrix[middle] = 0
    matrix[middle, middle] = 1
    wanted = np.zeros(len(modes), complex)
    wanted[middle] = 1
    p = np.linalg.solve(matrix, wanted)
    return float((turning @ p[middle - 1 : middle + 2]).real)


# ---------------------------------------------------------------- walls and shapes


def slit(page: Page) -> None:
    """A sphere drawn along the middle of a slit."""
    page.heading("Between plates")
    page.text(
        "A sphere drawn along the middle of a slit, kept there (z fixed), AT+a; the plates take "
        "the force. Theory is Faxen's mobility with the periodic part, without slip."
    )
    rows = []
    for radius, wide, side in ((2.0, 12, 16), (3.0, 12, 16)):
        body = SphereBody(
            radius=radius, force=(20.0, 0.0, 0.0), fixed=("z",),
            start=BodyStart("given", positions=[(side / 2, side / 2, wide / 2)]),
        )  # fmt: skip
        case = case_of(body, side, "at+a", 8e4, BodyDrift(), size=[side, side, wide],
                       walls=[Plates(axis="z")])  # fmt: skip
        files, note = ran(page, f"slit-{radius:g}", case)
        c = found(files["body-drift"], "mobility along x")
        unit = 6 * math.pi * viscosity("at+a", 3) * radius
        known = theory.slit_mobility(radius, wide / 2, side**2)
        rows.append(Comparison(f"R/h = {2 * radius / wide:.2f}: mobility over that of Stokes",
                               c.measured * unit, c.error * unit, known, "", note))  # fmt: skip
    page.table(rows)


def barometric(page: Page) -> None:
    """Heights of a heavy disk above a plate."""
    page.heading("Barometric heights")
    scale, wide, radius = 2.0, 16, 2.0
    page.text(
        "A disk of R = 2 between two plates, drawn down by kT/2 a cell, 2D AT+a. Theory is "
        "Boltzmann's factor of this force and of the gap potential. It diffuses over the scale of "
        "2 cells in about 400 time units, so that short runs have few independent heights."
    )
    body = DiskBody(radius=radius, force=(0.0, -1.0 / scale))
    case = case_of(body, 12, "at+a", 1e6, BodyTracks(), size=[12, wide], walls=[Plates(axis="y")])
    files, note = ran(page, "barometric", case)
    result = files["body-tracks"]
    column = result.x["component"].tolist().index("y")
    heights = np.asarray(result.value)[:, 0, column]
    y = np.linspace(radius + 1e-3, wide - radius - 1e-3, 4001)
    gap = GapPotential()
    sigma = gap.range / 2 ** (1 / 6)

    def repelled(g: np.ndarray) -> np.ndarray:
        x = (sigma / np.minimum(g, gap.range)) ** 6
        return 4 * gap.depth * (x**2 - x) + gap.depth

    weight = np.exp(-y / scale - np.minimum(repelled(y - radius) + repelled(wide - radius - y), 99))
    known = float((y * weight).sum() / weight.sum())
    value, error = float(heights.mean()), spread(heights)
    page.table([Comparison("mean height", value, error, known, "a", note)])


def spread(values: np.ndarray) -> float:
    """Standard error of a mean, from 10 blocks."""
    means = [b.mean() for b in np.array_split(values, 10)]
    return float(np.std(means, ddof=1) / math.sqrt(10))


def long_bodies(page: Page) -> None:
    """Friction of spheroids and a capsule."""
    page.heading("Spheroids and a capsule")
    page.text(
        "Orientation fixed, drawn along or across the axis with counter-force, AT+a. Theory is the "
        "mobility in a wide fluid less Hasimoto's first term 2.8373/(6 pi eta L), without slip; "
        "the next term and slip make a body faster by some per cent. Turning end over end is about "
        "a hinge; images are left out of its theory."
    )
    eta, rows = viscosity("at+a", 3), []
    bodies = (
        ("spheroid 8 x 4", SpheroidBody, {"half_length": 4.0, "radius": 2.0}, 18, 2e4),
        ("spheroid 9 x 3", SpheroidBody, {"half_length": 4.5, "radius": 1.5}, 18, 2e4),
        ("capsule 10 x 2", CapsuleBody, {"length": 10.0, "radius": 1.0}, 20, 1.3e4),
    )
    for name, kind, keys, side, length in bodies:
        if kind is SpheroidBody:
            axes = [keys["half_length"], keys["radius"], keys["radius"]]
            known = theory.ellipsoid_friction(axes, eta)
            along, across = known.translation[0], known.translation[1]
            turning = known.rotation[1]
        else:
            along, across, turning = theory.capsule_friction(10.0, 2.0, eta)
        start = BodyStart("given", positions=[(side / 2,) * 3])
        for what, friction, more in (
            ("along", along, {"force": (40.0, 0.0, 0.0), "fixed": ("orientation",)}),
            ("across", across, {"force": (0.0, 40.0, 0.0), "fixed": ("orientation",)}),
            ("end over end", turning, {"torque": (0.0, 0.0, 200.0), "hinge": (0.0, 0.0, 1.0)}),
        ):
            drawn = "force" in more
            body = kind(**keys, **more, start=start, counter_force=drawn)
            case = case_of(body, side, "at+a", length, BodyDrift())
            files, note = ran(page, f"long-{name}-{what}".replace(" ", ""), case)
            if drawn:
                c = found(files["body-drift"], "mobility along")
                expected = 1 / friction - 2.8373 / (6 * math.pi * eta * side)
            else:
                c = found(files["body-drift"], "rotational mobility about z")
                expected = 1 / friction
            rows.append(renamed(c, f"{name}, {what}: mobility", note, float(expected)))
    page.table(rows)


# ---------------------------------------------------------------- flow of swimmers


def flow(page: Page) -> None:
    """Mean flow about a puller in 2D, in the frame of its own axis."""
    page.heading("Flow about a squirmer")
    page.text(
        "2D, R = 3, B1 = 0.1, B2 = 0.2 (a puller), AT+a, box of side 40; velocities in the frame "
        "of the box, at places about the centre, turned into the axes of the body. Theory is that "
        "of a wide fluid: a box of 13 radii turns some of it back, most where it decays as 1/r."
    )
    radius, half, B1, B2 = 3.0, 12, 0.1, 0.2
    body = DiskBody(radius=radius, swim=Squirming(B1=B1, B2=B2))
    case = case_of(body, 40, "at+a", 2e5)
    folder = RUNS / ("short" if SHORT else "") / page.name
    folder.mkdir(parents=True, exist_ok=True)
    file, asked = folder / "flow.npy", folder / "flow.toml"
    if not (file.exists() and asked.exists() and asked.read_text() == case.to_toml()):
        print(f"  recording flow: {case.particles} particles", flush=True)
        kept: list[np.ndarray] = []

        def look(simulation: Any) -> None:
            engine = simulation.engine
            bodies = engine.bodies
            x, v = engine.positions(), engine.velocities()
            e = bodies.headings[0]
            turn = np.array([[e[0], e[1]], [-e[1], e[0]]])
            away = x - bodies.places(unwrapped=False)[0]
            away = (away - 40 * np.round(away / 40)) @ turn.T
            v = v @ turn.T
            edges = np.arange(-half, half + 1)
            sums = [np.histogram2d(*away.T, bins=(edges, edges), weights=w)[0]
                    for w in (np.ones(len(x)), v[:, 0], v[:, 1])]  # fmt: skip
            if simulation.step >= case.run.warmup:
                kept.append(np.array(sums))

        Simulation(case, threads=1, callbacks=[every(10, look)]).run()
        np.save(file, np.array([b.sum(axis=0) for b in np.array_split(np.array(kept), 16)]))
        asked.write_text(case.to_toml())
    parts = np.load(file)
    whole = parts.sum(axis=0)
    mean = whole[1:] / np.maximum(whole[0], 1)
    each = parts[:, 1:] / np.maximum(parts[:, :1], 1)
    error = each.std(axis=0, ddof=1) / math.sqrt(len(parts))
    middle = np.arange(-half, half) + 0.5
    x, y = np.meshgrid(middle, middle, indexing="ij")
    places = np.stack([x, y], axis=-1)
    known = np.moveaxis(theory.squirmer_flow(places, (1.0, 0.0), radius, B1, B2), -1, 0)
    r = np.hypot(x, y)
    rows = []
    for low, high in ((3.8, 5), (5, 7), (7, 9)):
        ring = (r > low) & (r < high)
        weight = (known[:, ring] ** 2).sum()
        size = float((mean[:, ring] * known[:, ring]).sum() / weight)
        scatter = float(math.sqrt((known[:, ring] ** 2 * error[:, ring] ** 2).sum()) / weight)
        rows.append(Comparison(f"flow over theory, {low:g} < r < {high:g}", size, scatter, 1.0, "",
                               f"{case.run.steps} steps"))  # fmt: skip
    page.table(rows)
    fig, axes = plt.subplots(1, 2, figsize=(8.4, 4), sharey=True)
    for ax, field, title in zip(axes, (mean, known), ("measured", "theory"), strict=True):
        free = r > radius
        speed = np.where(free, np.hypot(*field), np.nan)
        image = ax.imshow(speed.T, origin="lower", extent=[-half, half] * 2, cmap="viridis",
                          vmin=0, vmax=0.25)  # fmt: skip
        u, w = (np.where(free, f, 0.0) for f in field)
        ax.streamplot(middle, middle, u.T, w.T, color="white", density=0.9, linewidth=0.7)
        ax.add_patch(plt.Circle((0, 0), radius, color=GREY))
        ax.set(title=title, xlabel="along the axis  [$a$]", xlim=(-half, half), ylim=(-half, half))
    axes[0].set_ylabel("across  [$a$]")
    fig.colorbar(image, ax=axes[1], label="speed  [$a/\\tau$]")
    page.figure(fig, "Mean flow about a puller in 2D, turned into the axes of its body; right: "
                "theory of a wide fluid. Colour: speed.", "_flow")  # fmt: skip


PARTS: dict[str, Callable[[Page], None]] = {
    "swimming": swimming, "drag": drag, "equipartition": equipartition, "memory": memory,
    "conservation": conservation, "rotation": rotation, "shear": shear, "slit": slit,
    "long_bodies": long_bodies, "diffusion": diffusion, "barometric": barometric, "flow": flow,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies", "Bodies that move in the fluid")
    page.text(
        f"Density {DENSITY} of particles, timestep {STEP} unless said, no-slip surfaces with "
        "virtual particles (`fill`), bodies of the fluid's density. The tables state run lengths "
        f"in steps. These are runs of {LENGTH:g} of the full length, so that many error bars are "
        "wide: a row that agrees within a wide error bar says little, and is not listed as met. "
        "Runs of few relaxation times have error bars that are too small."
    )
    for name in parts:
        PARTS[name](page)
    page.heading("Not measured here")
    left = [[name, "not run for this page"] for name in PARTS if name not in parts]
    page.grid(["law", "reason"], [list(row) for row in LEFT_OUT] + left)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
