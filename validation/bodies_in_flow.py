"""Bodies in a flow: drag, slip, rotation, shear, slits, long bodies, pairs, settling, swimmers.

Usage: python validation/bodies_in_flow.py [parts...] [--short]

Parts are those of `PARTS`, all unless said.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from common import BLUE, GREY, PURPLE, RED, Page, found, main, plt, renamed
from moving_bodies import (
    PLATES,
    PREFACE,
    SLIP,
    VISCOSITIES,
    WARMUP,
    case_of,
    coefficients,
    fluid,
    gap_energy,
    met,
    ran,
    recorded,
    share_of,
    steps,
    viscosity,
)
from scipy.optimize import brentq

from mesokit import (
    BodyDrift,
    BodyStart,
    Box,
    CapsuleBody,
    Case,
    Comparison,
    DiskBody,
    EllipseBody,
    Plates,
    Run,
    Sphere,
    SphereBody,
    SpheroidBody,
    Squirming,
    Stress,
    UnionBody,
    theory,
)

SLIPS: list[tuple[str, str, float, float, float]] = []  # by what, where, b, error, of plates


# ---------------------------------------------------------------- slip


def viscosities(page: Page) -> None:
    """The viscosities that stand in theory."""
    page.heading("Viscosities")
    page.text(
        "Viscosities measured under shear ([viscosity_rules](viscosity_rules.md)) are 1 to 7 % "
        "above those of molecular chaos for rules +a, by the memory of long waves. Theory below "
        "has those of molecular chaos. Bodies of a few cells feel these: with them rotation and "
        "swimming give the same slip lengths (below). With those measured they differ in 2D; in 3D "
        "the error bars of swimming are too wide to tell. That of SRD+a in 3D at 90 degrees is "
        "measured here, in a cube of side 16 at the shear rate 0.1."
    )
    rows = []
    for (rule, d), (value, error) in VISCOSITIES.items():
        note = "from viscosity_rules"
        if (rule, d) == ("srd+a", 3):
            case = Case(
                run=Run(steps=steps(1e4), warmup=500, seed=5), observe=[Stress(every=1)],
                box=Box([16] * 3, shear_rate=0.1), fluid=fluid(rule),
            )  # fmt: skip
            files, note = ran(page, "viscosity-srd+a-3", case)
            c = found(files["stress"], "viscosity")
            value, error = c.measured, c.error
        chaos = float(coefficients(rule, d).viscosity)
        rows.append(Comparison(f"{d}D, {rule}: viscosity; theory: molecular chaos", value, error,
                               chaos, "a^2/tau", note))  # fmt: skip
    page.table(rows)


def rotation(page: Page) -> None:
    """Angular velocity over torque, and the slip length that it tells."""
    page.heading("Rotational mobility and slip, with and without angular momentum")
    page.text(
        "R = 3 under a torque, side 16 in 3D and 24 in 2D. Rules +a: the mobility is (1 - phi + d "
        "b/R) times that of a wide fluid, so that the slip length b follows from it. One per cent "
        "of the viscosity is 0.010 cells of b in 3D and 0.015 in 2D; it is not in the error bars. "
        "With the viscosities measured under shear b would be 0.128 and 0.186 in 2D, 0.065 and "
        "0.091 in 3D; swimming, which needs no viscosity, gives less. Theory of the mobility has "
        "the slip length of plates in SRD. SRD does not keep angular momentum; theory has a factor "
        "for that in the limit of a large body."
    )
    rows = []
    for d, rule, length, torque in (
        (2, "at+a", 1.5e5, 40.0), (2, "srd+a", 1.5e5, 40.0), (3, "at+a", 1.5e4, 240.0),
        (3, "srd+a", 1.5e4, 240.0), (3, "srd", 1.2e4, 180.0),
    ):  # fmt: skip
        body = DiskBody(radius=3, torque=torque) if d == 2 else SphereBody(
            radius=3, torque=(0.0, 0.0, torque)
        )  # fmt: skip
        side = 24 if d == 2 else 16
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"rotation-{d}-{rule}", case)
        c, eta = found(files["body-drift"], "rotational mobility"), viscosity(rule, d)
        known = 1 / theory.rotational_friction(3, eta, d, side, PLATES[d], share_of(rule, d))
        rows.append(renamed(c, f"{d}D, {rule}: rotational mobility", note, known))
        if "+a" in rule:
            unit = (4 if d == 2 else 8) * math.pi * eta * 3.0**d
            left = 1 - body.solid(d).volume / side**d
            b = 3 / d * (unit * c.measured - left)
            rows.append(slip_row("rotation", d, rule, b, 3 / d * unit * c.error))
        else:
            met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def swimming(page: Page) -> None:
    """Speed of neutral squirmers, and the slip length that it tells."""
    page.heading("Swimming speed and slip")
    page.text(
        "A neutral squirmer (B1 = 0.15, B2 = 0) of R = 3 in a periodic square of side 30 or cube "
        "of side 16. Its flow is a potential flow, so that the law holds at any Reynolds number. A "
        "slip length b lowers the speed to (1 - phi) U/(1 + (2 - c) b/R) with U = B1/2 in 2D and 2 "
        "B1/3 in 3D. So b follows from the speed, without the viscosity. The Mach number is 0.07 "
        "in 2D and 0.09 in 3D: compression may change the speed by its square, 0.5 to 0.8 %, which "
        "is 0.01 cells of b, and is not in the error bars. Theory of the speed has the slip length "
        "that rotation gives, and that of plates for SRD."
    )
    rows = []
    for d, rule, length in (
        (2, "at+a", 3e5), (2, "srd+a", 3e5), (3, "at+a", 4e4), (3, "srd+a", 4e4),
        (3, "srd", 4e4),
    ):  # fmt: skip
        kind, side = (DiskBody, 30) if d == 2 else (SphereBody, 16)
        body = kind(radius=3, swim=Squirming(B1=0.15))
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"swim-{d}-{rule}", case)
        c = found(files["body-drift"], "velocity along its own axis")
        share, fraction = share_of(rule, d), body.solid(d).volume / side**d
        wide = theory.squirmer_speed(0.15, d)
        full = theory.squirmer_speed_in_box(wide, fraction)
        known = theory.squirmer_speed_in_box(wide, fraction, SLIP[rule, d] / 3, share)
        b, error = 3 / (2 - share) * (full / c.measured - 1), 3 / (2 - share) * full * c.error
        rows.append(renamed(c, f"{d}D, {rule}: swimming speed", note, known))
        rows.append(slip_row("swimming", d, rule, b, error / c.measured**2))
        met(page, rows[-2].what, rows[-2], 3)
    page.table(rows)


def drag(page: Page) -> None:
    """Mobility of a drawn ball, and the slip length that it tells."""
    page.heading("Drag of a sphere and a disk, and slip by drag")
    page.text(
        "R = 3, drawn by a force with counter-force, in the boxes of the swimmers. Theory is "
        "Sangani and Acrivos with the slip length that rotation gives (SRD: that of plates) and "
        "the viscosity of molecular chaos. The slip length by drag is the least certain one: 1 % "
        "of mobility or viscosity is 0.04 to 0.06 cells."
    )
    rows = []
    for d, rule, length, force in (
        (2, "at+a", 3e4, 3.0), (2, "srd+a", 3e4, 3.0), (3, "at+a", 5e3, 30.0),
        (3, "srd+a", 5e3, 30.0), (3, "srd", 5e3, 30.0),
    ):  # fmt: skip
        kind, side = (DiskBody, 30) if d == 2 else (SphereBody, 16)
        body = kind(radius=3, force=(force, *[0.0] * (d - 1)), counter_force=True)
        case = case_of(body, side, rule, length, BodyDrift())
        files, note = ran(page, f"drag-{d}-{rule}", case)
        c, eta = found(files["body-drift"], "mobility along x"), viscosity(rule, d)
        friction = theory.disk_friction_in_square if d == 2 else theory.sphere_friction_in_cube
        reynolds = c.measured * force * 3 / VISCOSITIES[rule, d][0]
        rows.append(renamed(c, f"{d}D, {rule}: mobility", f"Re {reynolds:.2f}; {note}",
                            1 / friction(3.0, side, eta, SLIP[rule, d])))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
        b, low, high = (slip_of(c.measured + k * c.error, friction, side, eta) for k in (0, -1, 1))
        rows.append(slip_row("drag", d, rule, b, 0.5 * (high - low)))
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


def slip_row(by: str, d: int, rule: str, b: float, error: float) -> Comparison:
    """A row of a slip length, which is kept for the figure."""
    SLIPS.append((by, f"{d}D\n{rule}", b, error, PLATES[d]))
    return Comparison(f"{d}D, {rule}: slip length b by {by}", b, error, PLATES[d], "a", "of plates")


def slip_lengths(page: Page) -> None:
    """All slip lengths of the parts before."""
    fig, axis = plt.subplots(figsize=(6, 3.8))
    names = list(dict.fromkeys(row[1] for row in SLIPS))
    for by, colour, mark, shift in (
        ("rotation", PURPLE, "o", -0.15), ("swimming", BLUE, "s", 0.0), ("drag", RED, "^", 0.15),
    ):  # fmt: skip
        rows = [row for row in SLIPS if row[0] == by]
        if not rows:
            continue
        axis.errorbar([names.index(row[1]) + shift for row in rows], [row[2] for row in rows],
                      [row[3] for row in rows], fmt=mark, color=colour, mfc="white", ms=5,
                      label=f"by {by}")  # fmt: skip
    plates = [next(row[4] for row in SLIPS if row[1] == name) for name in names]
    left = np.arange(len(names)) - 0.3
    axis.hlines(plates, left, left + 0.6, color=GREY, lw=1.2, label="plates in SRD")
    axis.axhline(0, color=GREY, lw=0.5)
    axis.set(xticks=range(len(names)), xticklabels=names, ylabel="slip length", xlim=(-0.5, 4.5))
    axis.legend(fontsize=7)
    page.figure(fig, "Slip lengths at R = 3, those by rotation and by drag with the viscosity of "
                "molecular chaos. Error bars: one standard error.", "_slip")  # fmt: skip


# ---------------------------------------------------------------- shear


def shear(page: Page) -> None:
    """Turning in a shear flow and periods of Jeffery."""
    page.heading("Shear: turning, Jeffery periods")
    page.text(
        "Lees-Edwards shear, AT+a. Theory: half the rate for a sphere or disk; the mean angular "
        "velocity of an ellipse is rate/(r + 1/r), which is that of Jeffery's period 2 pi (r + "
        "1/r)/rate. Noise turns an ellipse too, with D_r = kT/(2 pi eta (a^2 + b^2)) in a wide "
        "fluid: the mean of Jeffery's angular velocity over the steady distribution of angles "
        "stands as theory. Re is rate R^2/nu, with the half length of an ellipse; its first "
        "effect is to slow the turning, and more so a longer body. Each ellipse makes some ten "
        "turns, so that error bars may be too small."
    )
    rows = []
    for name, body, side, length, rate in (
        ("disk R = 2", DiskBody(radius=2), 20, 1.2e5, 0.04),
        ("sphere R = 2", SphereBody(radius=2), 12, 3e4, 0.04),
        ("ellipse 8 x 4", EllipseBody(size=(8, 4)), 28, 6e4, 0.03),
        ("ellipse 9 x 3", EllipseBody(size=(9, 3)), 30, 6e4, 0.03),
    ):
        d = body.dimensions[0]
        case = case_of(body, side, "at+a", length, BodyDrift(), shear_rate=rate)
        files, note = ran(page, f"shear-{name}".replace(" ", ""), case)
        c = found(files["body-drift"], "angular velocity about z")
        aspect = body.size[0] / body.size[1] if isinstance(body, EllipseBody) else 1.0
        half = body.size[0] / 2 if isinstance(body, EllipseBody) else 2.0
        known = rate / (aspect + 1 / aspect)
        note = f"without noise {known:.4f}; {note}"
        if isinstance(body, EllipseBody):
            spread = 2 / (math.pi * viscosity("at+a", 2) * (body.size[0] ** 2 + body.size[1] ** 2))
            known = noisy_turning(aspect, spread, rate)
        reynolds = rate * half**2 / VISCOSITIES["at+a", d][0]
        one = Comparison(f"{name}: angular velocity", abs(c.measured), c.error, known, "1/tau",
                         f"rate {rate:g}, Re {reynolds:.2f}; {note}")  # fmt: skip
        rows.append(one)
        met(page, one.what, one, 5)
        if aspect > 1:
            period = 2 * math.pi / one.measured
            rows.append(Comparison(f"{name}: period", period, period * one.error / one.measured,
                                   2 * math.pi / known, "tau",
                                   f"Jeffery {theory.jeffery_period(aspect, rate):.0f}")
                        )  # fmt: skip
    page.table(rows)


def einstein(page: Page) -> None:
    """Viscosity of a suspension of disks."""
    page.heading("Einstein viscosity")
    rate, side, radius = 0.04, 30, 2.0
    page.text(
        f"Viscosity by `stress` of 2D AT+a with disks of R = 2 in a square of side {side}, over "
        f"that of the same box without bodies, at the rate {rate:g}. Theory is 1 + 2 phi (1 + 2 "
        "b/R)/(1 + 4 b/R), with the slip length that rotation gives, the first order in phi alone: "
        "encounters of disks add some phi^2 to it. A wave that a sinusoidal force drives stands on "
        "the page of [slow flows](bodies_slow_flow.md)."
    )
    rows, empty = [], (1.0, 0.0)
    for number in (0, 3, 6):
        length = 2e5
        if number:
            body = DiskBody(radius=radius, number=number)
            case = case_of(body, side, "at+a", length, Stress(), shear_rate=rate)
        else:
            case = Case(
                run=Run(steps=steps(length), warmup=WARMUP[2], seed=11), observe=[Stress()],
                box=Box([side, side], shear_rate=rate), fluid=fluid("at+a"),
            )  # fmt: skip
        files, note = ran(page, f"einstein-{number}", case)
        c = found(files["stress"], "viscosity")
        if not number:
            empty = c.measured, c.error
            rows.append(renamed(c, "without bodies: viscosity", note))
            continue
        phi = number * math.pi * radius**2 / side**2
        ratio = c.measured / empty[0]
        error = ratio * math.hypot(c.error / c.measured, empty[1] / empty[0])
        known = theory.suspension_viscosity(phi, 2, slip=SLIP["at+a", 2] / radius)
        rows.append(Comparison(f"phi = {phi:.3f}: eta/eta0", ratio, error, known, "", note))
        rows.append(Comparison(f"phi = {phi:.3f}: (eta/eta0 - 1)/phi", (ratio - 1) / phi,
                               error / phi, (known - 1) / phi, "", note))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 10)
    page.table(rows)


def noisy_turning(aspect: float, spread: float, rate: float) -> float:
    """Mean angular velocity of an axis in the plane of a shear flow, with noise (Fokker, Planck).

    `spread` is its rotational diffusion coefficient.
    """
    stretch = (aspect**2 - 1) / (aspect**2 + 1)
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
    b = SLIP["at+a", 3]
    page.text(
        "A sphere drawn along the middle of a slit, kept there (z fixed), AT+a; the plates take "
        "the force. Theory is Faxen's mobility with the periodic part, without slip. Slip of the "
        f"sphere, b = {b:g}, makes it faster by b/(R + 2 b) of Stokes' mobility where the plates "
        "are far away; that of the plates widens the slit by about b. The row below has both."
    )
    rows = []
    for radius, wide, side in ((2.0, 12, 16), (3.0, 12, 16)):
        body = SphereBody(
            radius=radius, force=(20.0, 0.0, 0.0), fixed=("z",),
            start=BodyStart("given", positions=[(side / 2, side / 2, wide / 2)]),
        )  # fmt: skip
        case = case_of(body, side, "at+a", 1.4e4, BodyDrift(), size=[side, side, wide],
                       walls=[Plates(axis="z")])  # fmt: skip
        files, note = ran(page, f"slit-{radius:g}", case)
        c = found(files["body-drift"], "mobility along x")
        unit = 6 * math.pi * viscosity("at+a", 3) * radius
        known = theory.slit_mobility(radius, wide / 2, side**2)
        slipping = theory.slit_mobility(radius, wide / 2 + b, side**2) + b / (radius + 2 * b)
        what = f"R/h = {2 * radius / wide:.2f}: mobility over that of Stokes"
        rows.append(Comparison(what, c.measured * unit, c.error * unit, known, "", note))
        rows.append(renamed(rows[-1], f"{what}, theory with slip", note, slipping))
        met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def long_bodies(page: Page) -> None:
    """Friction of spheroids and a capsule."""
    page.heading("Spheroids and a capsule")
    slip = SLIP["at+a", 3]
    page.text(
        "Orientation fixed, drawn by a force along and across the axis at once with "
        "counter-force, AT+a. Theory of spheroids is the mobility in a wide fluid, with the "
        "images of the box (the Fourier sum of their force) and the first order of the slip "
        f"length {slip:g}. That of the capsule is the same with Hasimoto's first term "
        "2.8373/(6 pi eta L) alone and without slip, which would add some per cent. Turning end "
        "over end is about a hinge; neither images nor slip are in its theory. The Reynolds number "
        "of the half length is about 1, where inertia slows a sphere by 6 % (two spheres, above). "
        "With a third of the force the law holds ([next page](bodies_more_flow.md))."
    )
    eta, rows = viscosity("at+a", 3), []
    bodies = (
        ("spheroid 8 x 4", SpheroidBody, {"half_length": 4.0, "radius": 2.0}, 18),
        ("spheroid 9 x 3", SpheroidBody, {"half_length": 4.5, "radius": 1.5}, 18),
        ("capsule 10 x 2", CapsuleBody, {"length": 10.0, "radius": 1.0}, 20),
    )
    for name, kind, keys, side in bodies:
        first = 2.8373 / (6 * math.pi * eta * side)
        if kind is SpheroidBody:
            axes = [keys["half_length"], keys["radius"], keys["radius"]]
            friction = theory.ellipsoid_friction(axes, eta)
            turning = friction.rotation[1]
            ways = [
                1 / friction.translation[k] + by_images(axes, k, side, eta)
                + by_slip(axes, k, slip, eta)
                for k in (0, 1)
            ]  # fmt: skip
        else:
            along, across, turning = theory.capsule_friction(10.0, 2.0, eta)
            ways = [1 / along - first, 1 / across - first]
        start = BodyStart("given", positions=[(side / 2,) * 3])
        drawn = kind(
            **keys, start=start, counter_force=True, force=(25.0, 25.0, 25.0),
            fixed=("orientation",),
        )  # fmt: skip
        files, note = ran(page, f"long-{name}-drawn".replace(" ", ""),
                          case_of(drawn, side, "at+a", 8e3, BodyDrift()))  # fmt: skip
        x, y, z = (found(files["body-drift"], f"mobility along {axis}") for axis in "xyz")
        rows.append(renamed(x, f"{name}, along: mobility", note, float(ways[0])))
        rows.append(Comparison(
            f"{name}, across: mobility", 0.5 * (y.measured + z.measured),
            0.5 * math.hypot(y.error, z.error), float(ways[1]), x.unit, note,
        ))  # fmt: skip
        turned = kind(**keys, start=start, torque=(0.0, 0.0, 120.0), hinge=(0.0, 0.0, 1.0))
        files, note = ran(page, f"long-{name}-turned".replace(" ", ""),
                          case_of(turned, side, "at+a", 8e3, BodyDrift()))  # fmt: skip
        c = found(files["body-drift"], "rotational mobility about z")
        rows.append(renamed(c, f"{name}, end over end: mobility", note, float(1 / turning)))
        for c in rows[-3:]:
            met(page, c.what, c, 5)
    page.table(rows)


def by_images(axes: list[float], along: int, side: float, eta: float) -> float:
    """What its images in a cube add to the mobility of an ellipsoid along one of its axes.

    The sum of (1 - n_i^2)/(eta L^3 k^2) (sin q/q)^2 over all waves k but 0, less its integral, with
    q^2 the sum of (k_j a_j)^2. Both with a factor exp(-w k^2), whose first order is taken off.
    """
    square, most, cut = np.square(axes), 20, 12.0
    w = cut / (most * 2 * math.pi / side) ** 2
    n = np.arange(-most, most + 1)
    k = 2 * math.pi / side * np.stack(np.meshgrid(n, n, n), -1).reshape(-1, 3)
    k = k[k.any(axis=1)]
    k2 = (k**2).sum(axis=1)
    q = np.sqrt(k**2 @ square)
    waves = ((1 - k[:, along] ** 2 / k2) / k2 * np.sinc(q / math.pi) ** 2 * np.exp(-w * k2)).sum()
    directions, weight = on_sphere(40)
    reach = np.sqrt(np.tensordot(square, directions**2, 1))
    size = np.linspace(1e-6, 8.5 / math.sqrt(w), 3000)
    inner = np.trapezoid(
        np.sinc(reach[..., None] * size / math.pi) ** 2 * np.exp(-w * size**2), size, axis=-1
    )
    whole = ((1 - directions[along] ** 2) * inner * weight).sum() / (2 * math.pi) ** 3
    return float((waves / side**3 - whole - 2 / 3 * w / side**3) / eta)


def on_sphere(number: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions (3, number, number) and their weights, which add up to 4 pi."""
    cosine, weight = np.polynomial.legendre.leggauss(number)
    angle = 2 * math.pi * (np.arange(number) + 0.5) / number
    z, phi = np.meshgrid(cosine, angle, indexing="ij")
    around = np.sqrt(1 - z**2)
    directions = np.stack([around * np.cos(phi), around * np.sin(phi), z])
    return directions, weight[:, None] * np.full(number, 2 * math.pi / number)


def by_slip(axes: list[float], along: int, slip: float, eta: float) -> float:
    """What a slip length adds to the mobility of an ellipsoid, to first order.

    It is b/eta times the integral of the square of the tangential force on unit surface, which for
    a unit force is that of a stick ellipsoid (Brenner 1964): w/(4 pi a b c), the same direction.
    """
    s, weight = on_sphere(64)
    w = 1 / np.sqrt(sum((s[j] / axes[j]) ** 2 for j in range(3)))
    tangential = 1 - (w * s[along] / axes[along]) ** 2
    total = (weight * w * tangential).sum()
    return float(slip * total / (eta * (4 * math.pi) ** 2 * math.prod(axes)))


# ---------------------------------------------------------------- many


def two_spheres(page: Page) -> None:
    """Speed of a rigid pair over that of one sphere."""
    page.heading("Two spheres")
    side, radius, slip = 18, 2.0, SLIP["at+a", 3]
    page.text(
        "A union of two equal spheres of R = 2 that do not touch, orientation fixed, drawn along "
        f"and across its line at once with counter-force, in a cube of side {side}, AT+a. The "
        "speed is that of one sphere in the same box under half the force. Theory is Rotne and "
        "Prager with the images of the box and reflections (`pair_speeds_in_cube`), with slip in "
        "the part of the sphere itself. Without a box the gain is far larger: it stands as a note. "
        "The Reynolds number of the sphere alone is 0.75, far above R/L = 0.11. A third of the "
        "force stands beside it: there the law holds, so that the lag is that of inertia. The "
        "pairs have about the same Reynolds number as the first."
    )
    rows = []
    unit = 6 * math.pi * viscosity("at+a", 3) * radius
    one = SphereBody(radius=radius, force=(20.0,) * 3, counter_force=True)
    files, note = ran(page, "pair-alone", case_of(one, side, "at+a", 8e3, BodyDrift()))
    three = [found(files["body-drift"], f"mobility along {axis}") for axis in "xyz"]
    alone = float(np.mean([c.measured for c in three]))
    unsure = math.hypot(*(c.error for c in three)) / 3
    own = unit / theory.sphere_friction_in_cube(radius, side, viscosity("at+a", 3), slip)
    plain = unit / theory.sphere_friction_in_cube(radius, side, viscosity("at+a", 3))
    rows.append(Comparison("one sphere: mobility over that of Stokes", alone * unit, unsure * unit,
                           own, "", note))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 5)
    weak = replace(one, force=(20.0 / 3.0,) * 3)
    files, note = ran(page, "pair-alone-weak", case_of(weak, side, "at+a", 6e4, BodyDrift()))
    three = [found(files["body-drift"], f"mobility along {axis}") for axis in "xyz"]
    value, error = np.mean([c.measured for c in three]), math.hypot(*(c.error for c in three)) / 3
    rows.append(Comparison("the same, a third of the force", float(value) * unit, error * unit,
                           own, "", note))  # fmt: skip
    met(page, rows[-1].what, rows[-1], 5)
    for distance in (6.0, 8.0):
        parts = tuple(
            Sphere(centre=(x, 0, 0), radius=radius) for x in (-distance / 2, distance / 2)
        )
        body = UnionBody(
            parts=parts, force=(40.0,) * 3, fixed=("orientation",), counter_force=True,
            start=BodyStart("given", positions=[(side / 2,) * 3]),
        )  # fmt: skip
        case = case_of(body, side, "at+a", 8e3, BodyDrift())
        files, note = ran(page, f"pair-{distance:g}", case)
        x, y, z = (found(files["body-drift"], f"mobility along {axis}") for axis in "xyz")
        wide = theory.pair_speeds(radius, distance)
        boxed = theory.pair_speeds_in_cube(radius, distance, side)
        across = 0.5 * (y.measured + z.measured), 0.5 * math.hypot(y.error, z.error)
        for way, (value, error), k in (
            ("in line", (x.measured, x.error), 0), ("side by side", across, 1),
        ):  # fmt: skip
            ratio = 2 * value / alone
            known = 1 + (boxed[k] - plain) / own
            rows.append(Comparison(
                f"d = {distance / radius:g} R, {way}: speed over that of one alone", ratio,
                ratio * math.hypot(error / value, unsure / alone), known, "",
                f"{wide[k]:.3f} in a wide fluid; {note}",
            ))  # fmt: skip
            met(page, rows[-1].what, rows[-1], 5)
    page.table(rows)


def settling(page: Page) -> None:
    """Hindered settling of spheres."""
    page.heading("Hindered settling")
    side, radius = 16, 2.0
    page.text(
        f"Spheres of R = 2 in a periodic cube of side {side}, each drawn by the same force with "
        "counter-force, AT+a, starts drawn anywhere without overlap. V0 is that of one sphere in "
        "a wide fluid, Stokes with the slip length of the page. To the measured speed is added "
        "what so few spheres lack (`settling_of_few`), with Ladd's viscosity at high frequency "
        "and S(0) of spheres that are as large as the gap law keeps them apart. Theory is (1 - "
        "phi)^5 of hard spheres; exponents of 4.5 and 5.5 stand as a note, and the same law with "
        "the volume that the gap law keeps, which lies too low at the larger phi. The "
        "law is not met. Most of the lag is where the "
        "spheres are: the gap law keeps these small ones a fifth of a radius apart, and spheres "
        "that stay apart settle more slowly ([next page](bodies_more_flow.md), which has the speed "
        "for their places). A third of the force brings 18 spheres a little nearer: inertia is a "
        "small part. One start for each fraction: the scatter of starts is not in the error bars."
    )
    gaps = np.linspace(1e-3, 0.5, 500)
    apart = float((1 - np.exp(-gap_energy(gaps))).mean() * 0.5)
    swollen = (1 + apart / (2 * radius)) ** 3
    slip, unit = SLIP["at+a", 3], 6 * math.pi * viscosity("at+a", 3) * radius
    free = (1 + slip / (radius + 2 * slip)) / unit
    rows, marks = [], []
    for number, force, length in (
        (6, 20.0, 7e3), (18, 20.0, 7e3), (30, 20.0, 7e3), (18, 7.0, 4e4),
    ):  # fmt: skip
        body = SphereBody(radius=radius, number=number, force=(force, 0.0, 0.0), counter_force=True)
        case = case_of(body, side, "at+a", length, BodyDrift())
        weak = "" if force == 20.0 else ", a third of the force"
        files, note = ran(page, f"settling-{number}{'-weak' if weak else ''}", case)
        c = found(files["body-drift"], "mobility along x")
        phi = number * 4 / 3 * math.pi * radius**3 / side**3
        x = phi * (1 + phi - 0.189 * phi**2)
        few = theory.settling_of_few(swollen * phi, number, viscosity=(1 + 1.5 * x) / (1 - x))
        few /= swollen ** (1 / 3)
        raw = c.measured / free
        bounds = [theory.hindered_settling(phi, n) for n in (5.0, 4.5, 5.5)]
        rows.append(Comparison(
            f"phi = {phi:.3f}, {number} spheres{weak}: V/V0", raw + few, c.error / free,
            bounds[0], "",
            f"Re {c.measured * force * radius / VISCOSITIES['at+a', 3][0]:.2f}; {raw:.3f} in this "
            f"box; {bounds[2]:.3f} to {bounds[1]:.3f}; exponent "
            f"{math.log(raw + few) / math.log(1 - phi):.2f}; {note}; "
            f"{(1 - swollen * phi) ** 5:.3f} with the gap law",
        ))  # fmt: skip
        met(page, rows[-1].what, rows[-1], 5)
        marks.append((phi, raw, raw + few, c.error / free))
    page.table(rows)
    fig, axis = plt.subplots(figsize=(5.5, 3.6))
    phi, raw, value, error = np.array(marks).T
    fine = np.linspace(0, 0.33, 100)
    axis.fill_between(fine, (1 - fine) ** 5.5, (1 - fine) ** 4.5, color=GREY, alpha=0.3, lw=0,
                      label=r"$(1 - \phi)^n$, n = 4.5 to 5.5")  # fmt: skip
    axis.plot(fine, (1 - swollen * fine) ** 5, "--", color=GREY, lw=1,
              label="$n = 5$, volume with the gap law")  # fmt: skip
    axis.errorbar(phi, value, error, fmt="o", color=BLUE, mfc="white", ms=5,
                  label="with the part of few spheres")  # fmt: skip
    axis.errorbar(phi, raw, error, fmt="s", color=RED, ms=4, label="in this box")
    axis.set(xlabel="volume fraction", ylabel="$V/V_0$", xlim=(0, 0.33), ylim=(0, 1))
    axis.legend()
    page.figure(fig, "Hindered settling of spheres. Error bars: one standard error, below the "
                "points where not seen.", "_settling")  # fmt: skip


# ---------------------------------------------------------------- flow of swimmers


def flow(page: Page) -> None:
    """Mean flow about pullers in 2D, in the frame of the axis of each."""
    page.heading("Flow about a squirmer")
    radius, side, half, b = 3.0, 40, 12, SLIP["at+a", 2]
    page.text(
        "2D, R = 3, pullers with B2 = 2 B1, AT+a, box of side 40; velocities in the frame of the "
        "box, at places about the centre, turned into the axes of the body. Theory is that of the "
        f"disk in its box, with the slip length that rotation gives ({b:g}): slip takes 4 % of B1 "
        "and 9 % of B2. Images take at most a tenth in these rings, as a mean over directions of "
        "the axis. The weak one has its axis fixed at 22.5 degrees from a side of the box, where "
        "the part with the symmetry of the lattice is across the flow of theory. Its Reynolds "
        "number is 0.4, of B2 R; that of the strong one is 1.4, and inertia screens its flow at "
        "nu/U = 9 cells."
    )
    tilted = BodyStart("given", positions=[(20, 20)], orientations=[(22.5,)])
    edges = np.arange(-half, half + 1)

    def look(engine: Any) -> np.ndarray:
        bodies = engine.bodies
        x, v = engine.positions(), engine.velocities()
        e = bodies.headings[0]
        turn = np.array([[e[0], e[1]], [-e[1], e[0]]])
        away = x - bodies.places(unwrapped=False)[0]
        away = (away - side * np.round(away / side)) @ turn.T
        v = v @ turn.T
        weights = np.ones(len(x)), v[:, 0], v[:, 1]
        return np.array([np.histogram2d(*away.T, bins=(edges, edges), weights=w)[0]
                         for w in weights])  # fmt: skip

    middle = edges[:-1] + 0.5
    x, y = np.meshgrid(middle, middle, indexing="ij")
    r, rows = np.hypot(x, y), []
    for name, B2, length, keys in (
        ("strong", 0.2, 4e4, {}), ("weak", 0.06, 4e5, {"fixed": ("orientation",), "start": tilted}),
    ):  # fmt: skip
        body = DiskBody(radius=radius, swim=Squirming(B1=B2 / 2, B2=B2), **keys)
        case = case_of(body, side, "at+a", length)
        often = 20 if name == "strong" else 50
        kept = recorded(page, f"flow-{name}", case, often, look)
        parts = np.array([some.sum(axis=0) for some in np.array_split(kept, 16)])
        whole = parts.sum(axis=0)
        mean = whole[1:] / np.maximum(whole[0], 1)
        each = parts[:, 1:] / np.maximum(parts[:, :1], 1)
        error = each.std(axis=0, ddof=1) / math.sqrt(len(parts))
        known = np.moveaxis(
            theory.squirmer_flow(np.stack([x, y], axis=-1), (1.0, 0.0), radius, B2 / 2, B2,
                                 b / radius, side**2), -1, 0)  # fmt: skip
        for low, high in ((3.8, 5), (5, 7), (7, 9)):
            ring = (r > low) & (r < high)
            weight = (known[:, ring] ** 2).sum()
            size = float((mean[:, ring] * known[:, ring]).sum() / weight)
            scatter = math.sqrt((known[:, ring] ** 2 * error[:, ring] ** 2).sum()) / weight
            what = f"{name}, B2 = {B2:g}, {low:g} < r < {high:g}: flow over theory"
            rows.append(Comparison(what, size, float(scatter), 1.0, "", f"{case.run.steps} steps"))
            if name == "weak":
                met(page, what, rows[-1], 5)
    page.table(rows)
    fig, axes = plt.subplots(1, 3, figsize=(9, 4), width_ratios=[1, 1, 0.05])
    for ax, field, title in zip(axes[:2], (mean, known), ("measured", "theory"), strict=True):
        free = r > radius
        speed = np.where(free, np.hypot(*field), np.nan)
        image = ax.imshow(speed.T, origin="lower", extent=[-half, half] * 2, cmap="viridis",
                          vmin=0, vmax=0.045)  # fmt: skip
        u, w = (np.where(free, f, 0.0) for f in field)
        ax.streamplot(middle, middle, u.T, w.T, color="white", density=0.9, linewidth=0.7)
        ax.add_patch(plt.Circle((0, 0), radius, color=GREY))
        ax.set(title=title, xlabel="along the axis  [$a$]", xlim=(-half, half), ylim=(-half, half))
    axes[0].set_ylabel("across  [$a$]")
    fig.colorbar(image, cax=axes[2], label="speed  [$a/\\tau$]")
    page.figure(fig, "Mean flow about the weak puller in 2D, in the axes of its body; right: "
                "theory with slip and images. Colour: speed.", "_flow")  # fmt: skip


PARTS: dict[str, Callable[[Page], None]] = {
    "viscosities": viscosities, "rotation": rotation, "swimming": swimming, "drag": drag,
    "slip_lengths": slip_lengths, "two_spheres": two_spheres, "settling": settling,
    "shear": shear, "einstein": einstein, "slit": slit, "long_bodies": long_bodies, "flow": flow,
}  # fmt: skip


def make(parts: Sequence[str] = tuple(PARTS)) -> int:
    """Write the page, of all parts or those named."""
    page = Page("bodies_in_flow", "Bodies that move in a flow")
    page.text(PREFACE)
    page.text(
        "How warm they are at rest, and where they are: [bodies](bodies.md). What is left open "
        "here: [more flows](bodies_more_flow.md), and swimmers [over long "
        "times](bodies_long_times.md)."
    )
    for name in parts:
        PARTS[name](page)
    if left := [[name, "not run for this page"] for name in PARTS if name not in parts]:
        page.heading("Not measured here")
        page.grid(["law", "reason"], left)
    return page.write()


if __name__ == "__main__":
    main(lambda: make([name for name in PARTS if name in sys.argv[1:]] or tuple(PARTS)))
