"""Bodies over long times: D in three boxes, tails of correlations, swimmers that turn, walls.

Usage: python validation/bodies_long_times.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from common import BLUE, GREEN, GREY, RED, Page, found, main, plt, renamed
from moving_bodies import (
    DENSITY,
    PREFACE,
    SLIP,
    STEP,
    VISCOSITIES,
    case_of,
    coefficients,
    met,
    ran,
    recorded,
    share_of,
    steps,
    viscosity,
)

from mesokit import (
    BodyDisplacement,
    Comparison,
    DiskBody,
    Plates,
    SphereBody,
    Squirming,
    theory,
)

RADIUS, PARTS_OF_RUN = 2.0, 20
SEEDS = 11, 12, 13  # of the runs of swimmers


def mean_of(values: np.ndarray) -> tuple[float, float]:
    """Mean over parts of a run, and its standard error."""
    return float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values)))


# ---------------------------------------------------------------- D and the size of the box


def boxes(page: Page) -> None:
    """Diffusion of a sphere in three boxes."""
    page.heading("Diffusion in three boxes")
    page.text(
        "One sphere of R = 2, SRD 130, in cubes of three sides. Theory is kT over the friction of "
        "Sangani and Acrivos in that box with the slip length of plates. The last row has the "
        "straight line through the three values against Hasimoto's factor of the box, at the "
        "factor 1 of a wide fluid: Stokes' D there."
    )
    rows, points = [], []
    eta, slip = viscosity("srd", 3), SLIP["srd", 3]
    for side, length in ((8, 2e5), (12, 4e5), (18, 3.6e5)):
        longest = side**2 / (4 * math.pi**2 * float(coefficients("srd", 3).viscosity))
        lag = min(math.ceil(6 * longest / STEP / 10) * 10, steps(length) // 8)
        case = case_of(SphereBody(radius=RADIUS), side, "srd", length,
                       BodyDisplacement(of="places", max_lag=lag, every=10))  # fmt: skip
        files, note = ran(page, f"box-{side}", case)
        c = found(files["body-displacement"], "diffusion coefficient")
        known = 1 / theory.sphere_friction_in_cube(RADIUS, side, eta, slip)
        wide = (1 + slip / (RADIUS + 2 * slip)) / (6 * math.pi * eta * RADIUS)
        rows.append(renamed(c, f"L = {side}: D", f"{note}, lags up to {lag} steps", known))
        met(page, rows[-1].what, rows[-1], 5)
        points.append((known / wide, c.measured, c.error))
    factor, value, error = np.array(points).T
    design = np.stack([np.ones(3), factor - 1], 1) / error[:, None]
    covariance = np.linalg.inv(design.T @ design)
    line = covariance @ design.T @ (value / error)
    rows.append(Comparison("line through the three, in a wide fluid: D", float(line[0]),
                           math.sqrt(covariance[0, 0]), wide, "a^2/tau"))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    axis.errorbar(factor, value, error, fmt="o", color=BLUE, mfc="white", label="measured")
    fine = np.array([0.0, 1.0])
    axis.plot(fine, fine * wide, color=GREY, label="kT over the friction in the box")
    axis.set(xlabel="friction of a wide fluid over that in the box", ylabel="$D$  [$a^2/\\tau$]",
             xlim=(0, 1), ylim=(0, None))  # fmt: skip
    axis.legend()
    page.figure(fig, "Diffusion coefficient of a sphere in boxes of side 8, 12 and 18 (from left "
                "to right). Error bars: one standard error.", "_boxes")  # fmt: skip


# ---------------------------------------------------------------- tails


def tails(page: Page) -> None:
    """Long-time tails of velocity and angular velocity."""
    page.heading("Long-time tails")
    side, number = 24, 8
    page.text(
        f"{number} spheres of R = 2 in a cube of side {side}, AT+a: correlations of one component "
        "of V and Omega, as means over windows of the lag, up to 40: R^2/nu is 10 and L^2/(10 nu) "
        "143. The tails are limits: a sphere of the fluid's density reaches 0.68 of that of V at "
        "1.25 R^2/nu, 0.78 at 2 and 0.92 at 6. So theory is drag with the memory of the fluid "
        "(`sphere_vacf`, `sphere_angular_vacf`: Zwanzig and Bixon, Hauge and Martin-Lof). To that "
        "of V is added what the tail in this periodic box (`vacf_modes`) has more than that of a "
        "wide fluid; the bare tail stands as a note. The law is asked for beyond R^2/nu. Before, "
        "V is below it: theory has no sound, which takes R/c = 2 to pass, and the spheres make "
        "their fluid 5 % more viscous. Omega is above it between 3 and 5: theory has no slip, "
        "which lowers the friction of rotation by 3 b/R, 8 %. None of these causes was measured "
        "apart. Error bars are the scatter of "
        f"{PARTS_OF_RUN} parts of the run."
    )
    body = SphereBody(radius=RADIUS, number=number)
    case = case_of(body, side, "at+a", 1e5)
    every = 5
    series = recorded(page, "tails", case, every, velocities_and_spins)
    nu = float(coefficients("at+a", 3).viscosity)
    D = 1 / theory.sphere_friction_in_cube(RADIUS, side, viscosity("at+a", 3), SLIP["at+a", 3])
    mass = DENSITY * body.solid(3).volume
    given = RADIUS, nu, DENSITY

    def moving(t: np.ndarray) -> np.ndarray:
        more = theory.vacf_modes(t, nu, D, DENSITY, [side] * 3)
        less = theory.vacf_tail(t, nu, D, DENSITY, 3)
        return theory.sphere_vacf(t, *given, mass) + more - less

    def turning(t: np.ndarray) -> np.ndarray:
        return theory.sphere_angular_vacf(t, *given, 0.4 * mass * RADIUS**2)

    rows, curves = [], []
    for of, unit, windows in (
        ("V", "a^2/tau^2", ((3, 5), (5, 10), (10, 15), (15, 25), (25, 40))),
        ("Omega", "1/tau^2", ((3, 5), (5, 10), (10, 14), (14, 20))),
    ):
        values = series[..., :3] if of == "V" else series[..., 3:]
        lags = np.arange(1, round(60 / (every * STEP)))
        time = lags * every * STEP
        kept = correlated_in_parts(values, lags)
        curves.append((of, time, kept.mean(axis=0), kept.std(axis=0, ddof=1)))
        for low, high in windows:
            inside = (time >= low) & (time < high)
            t = time[inside]
            tail = theory.vacf_tail if of == "V" else theory.angular_vacf_tail
            known = (moving if of == "V" else turning)(t).mean()
            c = Comparison(f"<{of}(0) {of}(t)>, {low} < t < {high}",
                           *mean_of(kept[:, inside].mean(axis=1)), float(known), unit,
                           f"tail {tail(t, nu, D, DENSITY, 3).mean():.2g}; {case.run.steps} steps",
                           )  # fmt: skip
            rows.append(c)
            if low >= 10:  # R^2/nu
                met(page, c.what, c, 20)
    page.table(rows)
    fig, both = plt.subplots(1, 2, figsize=(8, 3.6))
    for axis, (of, time, mean, scatter) in zip(both, curves, strict=True):
        use = slice(0, None, 3)
        error = scatter / math.sqrt(PARTS_OF_RUN)
        axis.errorbar(time[use], mean[use], error[use], fmt="o", color=BLUE, mfc="white", ms=3,
                      lw=0.8, label="measured")  # fmt: skip
        fine, late = np.geomspace(0.5, 60, 200), np.geomspace(5, 60, 100)
        tail = theory.vacf_tail if of == "V" else theory.angular_vacf_tail
        axis.plot(fine, (moving if of == "V" else turning)(fine), color=RED,
                  label="drag with memory")  # fmt: skip
        axis.plot(late, tail(late, nu, D, DENSITY, 3), "--", color=GREY,
                  label="tail in a wide fluid")  # fmt: skip
        name = {"V": "V", "Omega": r"\Omega"}[of]
        axis.set(xscale="log", yscale="log", xlabel=r"lag  [$\tau$]", xlim=(0.5, 60),
                 ylabel=rf"$\langle {name}(0)\,{name}(t)\rangle$")  # fmt: skip
        axis.set_ylim(1e-6 if of == "V" else 2e-7, None)
        axis.legend(fontsize=7)
    page.figure(fig, "Correlations of one component of the velocity and of the angular velocity of "
                "spheres, beside theory. Error bars: one standard error, where larger than "
                "the marks.", "_tails")  # fmt: skip


def velocities_and_spins(engine: Any) -> np.ndarray:
    """V and Omega of each body (bodies, 6)."""
    return np.hstack([engine.bodies.velocities, engine.bodies.spins])


def correlated_in_parts(values: np.ndarray, lags: np.ndarray) -> np.ndarray:
    """Mean product of one component at two times, for each part of a run and each lag."""
    kept = []
    for part in np.array_split(values, PARTS_OF_RUN):
        n = len(part) - lags[-1]
        kept.append([float((part[:n] * part[k : k + n]).mean()) for k in lags])
    return np.array(kept)


# ---------------------------------------------------------------- swimmers


def swimmers(page: Page) -> None:
    """How a swimmer turns, and how it spreads."""
    page.heading("Swimmers turn and spread")
    side, first = 20, 0.1
    page.text(
        f"A neutral squirmer (B1 = {first:g}) of R = 2 in 2D, AT+a, in a square of side {side}, "
        "beside the same disk that does not swim. D_r is that of the angle, from its mean square "
        "between lags of 20 and 100 time units; 1/D_r is about 200. The swimmer spreads with D + "
        "U^2/(2 D_r) at lags far beyond 1/D_r. It is measured as the growth of the mean square "
        "displacement between lags of 400 and 1000, where theory has the rest of the memory. "
        "There U is the measured speed along the axis, D that of the disk in the box by theory, "
        f"D_r the one measured without swimming. Error bars are the scatter of {PARTS_OF_RUN} "
        "parts of each of three runs; that of theory (from D_r and U) is in that of the last row."
    )
    rows, turning, speed = [], {}, (0.0, 0.0)
    every = 50
    for name, swim in (("at rest", None), ("swimming", Squirming(B1=first))):
        body = DiskBody(radius=RADIUS, swim=swim)
        case = case_of(body, side, "at+a", 4e6 if swim else 2e6)
        parts = []
        for seed in SEEDS:
            kept = f"swimmer-{name.replace(' ', '')}" + f"-{seed}" * (seed != SEEDS[0])
            one = replace(case, run=replace(case.run, seed=seed))
            series = recorded(page, kept, one, every, place_and_angle)
            parts += np.array_split(series, PARTS_OF_RUN)
        lags = (round(20 / (every * STEP)), round(100 / (every * STEP)))
        grown = [square_at(p[:, 2:3], lags) for p in parts]
        value, error = mean_of(np.array([(b - a) / (2 * 80.0) for a, b in grown]))
        turning[name] = value, error
        friction = theory.rotational_friction(RADIUS, viscosity("at+a", 2), 2, side,
                                              SLIP["at+a", 2], share_of("at+a", 2))  # fmt: skip
        rows.append(Comparison(f"{name}: D_r", value, error, 1 / friction, "1/tau",
                               f"{len(SEEDS)} runs of {case.run.steps} steps"))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
        if swim:
            ahead = [along_axis(p) / (every * STEP) for p in parts]
            speed = mean_of(np.array(ahead))
            low, high = 400.0, 1000.0
            lags = (round(low / (every * STEP)), round(high / (every * STEP)))
            growth = np.array([np.subtract(*square_at(p[:, :2], lags)[::-1]) for p in parts])
            spread = mean_of(growth / (4 * (high - low)))
    D_r, error = turning["at rest"]
    other = turning["swimming"]
    rows.append(Comparison("D_r swimming over D_r at rest", other[0] / D_r,
                           math.hypot(other[1] / D_r, error * other[0] / D_r**2), 1.0))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 10)
    D = 1 / theory.disk_friction_in_square(RADIUS, side, viscosity("at+a", 2), SLIP["at+a", 2])
    known = spread_between(D, speed[0], D_r, (low, high))
    doubt = (known - D) * math.hypot(2 * speed[1] / speed[0], error / D_r)
    own = spread_between(D, speed[0], other[0], (low, high))
    fraction = math.pi * RADIUS**2 / side**2
    expected = theory.squirmer_speed_in_box(
        theory.squirmer_speed(first, 2), fraction, SLIP["at+a", 2] / RADIUS
    )
    rows.append(Comparison("swimming: speed along the axis", *speed, expected, "a/tau",
                           f"Re {expected * RADIUS / VISCOSITIES['at+a', 2][0]:.2f}"))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 5)
    rows.append(Comparison("swimming: D + U^2/(2 D_r)", spread[0], math.hypot(spread[1], doubt),
                           known, "a^2/tau", f"D alone {D:.4f}; with the D_r of the swimmer "
                           f"{own:.3f}"))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 10)
    page.table(rows)


def spread_between(D: float, speed: float, D_r: float, lags: tuple[float, float]) -> float:
    """Growth of the mean square displacement of a swimmer between two lags, over 4 times their
    difference: D + U^2/(2 D_r) less what its memory has not lost yet."""
    low, high = lags
    memory = (math.exp(-D_r * low) - math.exp(-D_r * high)) / (D_r * (high - low))
    return float(D + (theory.swimmer_diffusion(D, speed, D_r, 2) - D) * (1 - memory))


def place_and_angle(engine: Any) -> list[float]:
    """Unwrapped place, angle turned through, and axis of the first body."""
    bodies = engine.bodies
    return [
        *bodies.places(unwrapped=True)[0], np.ravel(bodies.angles[0])[-1], *bodies.headings[0]
    ]  # fmt: skip


def square_at(values: np.ndarray, lags: Sequence[int]) -> list[float]:
    """Mean square displacement at each lag."""
    return [float(((values[k:] - values[:-k]) ** 2).sum(axis=1).mean()) for k in lags]


def along_axis(part: np.ndarray) -> float:
    """Mean displacement between two samples along the mean of both axes."""
    axis = 0.5 * (part[1:, 3:] + part[:-1, 3:])
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return float((np.diff(part[:, :2], axis=0) * axis).sum(axis=1).mean())


# ---------------------------------------------------------------- walls


def walls(page: Page) -> None:
    """Where swimmers are between plates."""
    page.heading("Swimmers between plates")
    wide = 16
    page.text(
        f"A squirmer (B1 = 0.15) of R = 2 between plates {wide} cells apart, 2D AT+a, 24 cells "
        "along them: heights of its centre. No law; a disk that does not swim is spread evenly "
        "but for the gap potential. A time of 1/D_r = 200 and a speed of 0.07 give a way of 14 "
        "cells, which is the width of the slit."
    )
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    edges = np.arange(RADIUS, wide - RADIUS + 0.5, 1.0)
    rows = []
    for name, second, colour, mark in (
        ("pusher", -0.3, BLUE, "o"), ("neutral", 0.0, GREEN, "s"), ("puller", 0.3, RED, "^"),
    ):  # fmt: skip
        body = DiskBody(radius=RADIUS, swim=Squirming(B1=0.15, B2=second))
        case = case_of(body, wide, "at+a", 6e5, size=[24, wide], walls=[Plates(axis="y")])
        series = recorded(page, f"plates-{name}", case, 50, height_and_heading)
        shares = np.array([
            np.histogram(p[:, 0], edges)[0] / len(p) for p in np.array_split(series, PARTS_OF_RUN)
        ])  # fmt: skip
        middle = 0.5 * (edges[1:] + edges[:-1])
        axis.errorbar(middle, shares.mean(0), shares.std(0, ddof=1) / math.sqrt(PARTS_OF_RUN),
                      fmt=f"{mark}-", color=colour, mfc="white", ms=4, lw=0.8,
                      label=name)  # fmt: skip
        near = np.array([
            np.mean((p[:, 0] < RADIUS + 1) | (p[:, 0] > wide - RADIUS - 1))
            for p in np.array_split(series, PARTS_OF_RUN)
        ])  # fmt: skip
        rows.append([name, f"{mean_of(near)[0]:.3f} +- {mean_of(near)[1]:.3f}",
                     f"{2 / (wide - 2 * RADIUS):.3f}", f"{case.run.steps} steps"])  # fmt: skip
    axis.axhline(1 / (wide - 2 * RADIUS), color=GREY, lw=1, label="spread evenly")
    axis.set(xlabel="height of the centre  [$a$]", ylabel="share of the time", ylim=(0, None))
    axis.legend(fontsize=7)
    page.grid(["swimmer", "share of the time within a cell of contact", "spread evenly", "run"],
              rows)  # fmt: skip
    page.figure(fig, "Heights of squirmers between plates, in bins of one cell. Error bars: one "
                f"standard error, of {PARTS_OF_RUN} parts of the run.", "_plates")  # fmt: skip


def height_and_heading(engine: Any) -> list[float]:
    """Height of the first body, and the part of its axis across the plates."""
    bodies = engine.bodies
    return [bodies.places(unwrapped=False)[0, 1], bodies.headings[0, 1]]


PARTS: dict[str, Callable[[Page], None]] = {
    "boxes": boxes, "tails": tails, "swimmers": swimmers, "walls": walls,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies_long_times", "Bodies over long times")
    page.text(PREFACE)
    for name in parts:
        PARTS[name](page)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
