"""Steady wakes behind a disk and a square in a channel, and (see `shedding`) a vortex street."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from channel import PLACE, Flow, begun, fluid, inflow, viscosity_of_theory
from common import BLUE, RED, Page, found, long, main, plt
from matplotlib.colors import TwoSlopeNorm
from shedding import shedding

import mesokit
from mesokit import Box, Case, Comparison, Disk, Plates, Rectangle, Run, theory

ROOM = 8  # height of the channel over the diameter, as in the reference values
LENGTH = 4  # of the periodic box over the height
STEADY = (Flow(10, 8, 0.5, 4e4), Flow(20, 12, 1.0, 6e3), Flow(30, 16, 1.0, 1e4))
DRAG = {10: 3.29, 20: 2.23, 30: 1.83}  # about, to choose the force
SPEEDS = TwoSlopeNorm(0, -0.25, 1.5)  # over that in the middle: colours of maps, white at rest
EXCESS = 1.15  # of the viscosity over that of theory, about, to choose the velocity


def aim(flow: Flow) -> float:
    """The centre velocity that a flow should have."""
    theirs = viscosity_of_theory(flow.density, flow.timestep)
    return flow.reynolds * EXCESS * theirs / flow.diameter


def channel(page: Page, flow: Flow) -> Comparison:
    """The viscosity in a plain channel of the same height: fluctuations make it depend on size."""
    height, speed = ROOM * flow.diameter, aim(flow)
    nu = EXCESS * viscosity_of_theory(flow.density, flow.timestep)
    relaxation = height**2 / (math.pi**2 * nu * flow.timestep)
    case = Case(
        run=Run(steps=long(3 * relaxation), warmup=long(relaxation / 4), seed=7),
        box=Box([96, height]),
        fluid=fluid(flow.density, flow.timestep, 8 * nu * speed / height**2),
        walls=[Plates(axis="y")],
        observe=[mesokit.VelocityProfile(axis="y", bins_per_cell=1, every=20)],
    )
    profile = page.run(f"channel-{flow.diameter}-{flow.timestep}", case, *begun(case, speed))[
        "velocity-profile"
    ]
    return found(profile, "viscosity")


def body(shape: str, flow: Flow) -> Case:
    """A disk or a square in the middle of a channel."""
    d, height = flow.diameter, ROOM * flow.diameter
    nu, length = EXCESS * viscosity_of_theory(flow.density, flow.timestep), LENGTH * ROOM * d
    speed = aim(flow)
    # what the plates and the body take
    push = 8 * nu * speed / height**2 + DRAG[flow.reynolds] * speed**2 * d / (2 * length * height)
    centre = [PLACE * length, height / 2]
    solid = Disk(centre=centre, radius=d / 2, name="body")
    if shape == "square":
        solid = Rectangle(centre=centre, size=[d, d], name="body")
    return Case(
        run=Run(steps=long(flow.steps), warmup=long(flow.steps), seed=8),
        box=Box([length, height]),
        fluid=fluid(flow.density, flow.timestep, push),
        walls=[Plates(axis="y"), solid],
        observe=[
            mesokit.VelocityField(every=10),
            mesokit.Forces(length=d, every=10),
            mesokit.FlowRate(every=10),
        ],
    )


def momentum_change(files: Any) -> float:
    """By how much the fluid gained momentum per time, in per cent of the force on it."""
    rate, case = files["flow-rate"], files.case
    slope = np.polyfit(rate.x["time"], rate.value, 1)[0]
    mass = case.fluid.density * float(np.prod(case.box.size))
    return float(100 * slope * mass / found(files["forces"], "force on all solids").expected)


def wake_length(field: Any, d: int) -> tuple[float, float]:
    """Length, over D, of the part behind the body where the fluid on the axis flows back; error.

    The velocity within D/8 of the axis, fitted by a parabola between the rear and 1.3 D beyond the
    place where it changes sign.
    """
    x, y, u, error = field.x["x"], field.x["y"], field.value[..., 0], field.error[..., 0]
    rear, middle = PLACE * (x[-1] + x[0]) + d / 2, (y[-1] + y[0]) / 2
    near = abs(y - middle) < max(d / 8, 1)
    line = u[:, near].mean(axis=1)
    sigma = np.sqrt((error[:, near] ** 2).mean(axis=1) / max(near.sum() / 2, 1))
    length, spread, guess = math.nan, math.nan, 0.5 * d
    for _ in range(20):
        some = (x > rear + 0.5) & (x < rear + guess + 1.3 * d)
        s = x[some] - rear
        weight = 1 / sigma[some]
        basis = np.stack([np.ones_like(s), s, s**2], axis=1)
        matrix = np.linalg.pinv(basis * weight[:, None]) * weight
        c = matrix @ line[some]
        # neighbours along x are correlated over about two cells
        covariance = 2 * (matrix * sigma[some] ** 2) @ matrix.T
        roots = np.roots(c[::-1])
        real = [float(z.real) for z in roots if abs(z.imag) < 1e-9 and 2 * c[2] * z + c[1] > 0]
        if not real:
            return 0.0, math.nan
        length = real[0]
        slope = c[1] + 2 * c[2] * length
        gradient = np.array([1, length, length**2]) / slope
        spread = float(np.sqrt(gradient @ covariance @ gradient))
        guess = 0.5 * (guess + max(length, 0.0))
    return length / d, spread / d


def steady(page: Page) -> None:
    """Reynolds numbers 10, 20, 30, disk and square."""
    page.heading("Steady wakes")
    page.text(
        f"2D, SRD at 90 degrees, density 16, Maxwell-Boltzmann thermostat; body in the middle of a "
        f"channel {ROOM} diameters high and {LENGTH * ROOM} diameters long, periodic, driven by a "
        "uniform force. It starts from a parabola. U is the centre velocity of the "
        "parabola fitted 4 to 6 diameters before the body; Re = U D/nu. In brackets by how much "
        "the velocity in the middle differs from that parabola: the box is periodic, and at the "
        "higher Reynolds numbers the wake has not quite vanished when it meets the body again. "
        "In 2D the viscosity is raised by "
        "fluctuations and depends on the size of the system: nu is that of the curvature in a "
        "plain channel of the same height and fluid, measured here; at the scale of the body it is "
        "some per cent lower. Reference values for the disk: lattice Boltzmann, 2 %, between and "
        "just below the tabulated Reynolds numbers by a straight line (drag: of the logarithms); "
        "for the square: Breuer et al., L_r/D = -0.065 + 0.0554 Re; all at the measured Re. "
        "Forces and body force balance in a steady flow only: what the fluid still loses in "
        "momentum, in per cent of the body force, is the last column."
    )
    rows, points = [], []
    fig, axes = plt.subplots(1, 2, figsize=(9.5, 3.9))
    maps, panels = plt.subplots(3, 2, figsize=(10, 7.5))
    for row, flow in enumerate(STEADY):
        d = flow.diameter
        nu = channel(page, flow)
        for column, shape in enumerate(("disk", "square")):
            case = body(shape, flow)
            files = page.run(f"{shape}-{flow.reynolds}", case, *begun(case, aim(flow)))
            field, forces = files["velocity-field"], files["forces"]
            top, spread, misfit = inflow(field, d)
            re = top * d / nu.measured
            re_error = re * math.hypot(spread / top, nu.error / nu.measured)
            length, error = wake_length(field, d)
            place = list(forces.x["body"]).index("body")
            scale = 2 / (flow.density * top**2 * d)
            drag = scale * forces.value[place, 0]
            drag_error = math.hypot(scale * forces.error[place, 0], 2 * drag * spread / top)
            total = found(forces, "force on all solids")
            change = momentum_change(files)
            points.append((shape, re, re_error, length, error, drag, drag_error))
            known = reference(shape, re)
            rows.append(
                [shape, flow.reynolds, d, flow.timestep, f"{nu.measured:.4f} +- {nu.error:.4f}",
                 f"{top:.3f} ({misfit:+.1f} %)", f"{re:.1f} +- {re_error:.1f}",
                 f"{length:.2f} +- {error:.2f}", f"{known[0]:.2f}",
                 f"{drag:.2f} +- {drag_error:.2f}",
                 f"{known[1]:.2f}" if math.isfinite(known[1]) else "",
                 f"{total.percent:+.1f} +- {100 * total.error / total.expected:.1f} %",
                 f"{-change:+.1f} %"]
            )  # fmt: skip
            page.check(
                f"{shape} at Re = {re:.1f} +- {re_error:.1f}: L_r/D = {length:.2f} +- {error:.2f}, "
                f"reference {known[0]:.2f} (within 20 % and 2 s.e.)",
                abs(length - known[0]) < 0.2 * abs(known[0]) + 2 * error,
            )
            if math.isfinite(known[1]):
                page.check(
                    f"{shape} at Re = {re:.1f} +- {re_error:.1f}: drag coefficient {drag:.2f} +- "
                    f"{drag_error:.2f}, reference {known[1]:.2f} (within 10 %)",
                    abs(drag - known[1]) < 0.1 * known[1],
                )
            page.check(
                f"{shape} at Re = {re:.1f}: force on the solids {total.percent:+.1f} +- "
                f"{100 * total.error / total.expected:.1f} % off the body force (within 3 %)",
                abs(total.percent) < 3,
            )
            page.check(
                f"{shape} at Re = {re:.1f}: the same with what the fluid lost in momentum "
                f"{total.percent + change:+.1f} % (within 3 %)",
                abs(total.percent + change) < 3,
            )
            draw(panels[row, column], field, d, f"{shape}, Re = {re:.1f}", top)
    page.grid(
        ["body", "aim", "D", "timestep", "nu in the channel", "U (middle)", "Re", "L_r/D",
         "reference", "drag coefficient", "reference", "forces - body force",
         "momentum lost"], rows,
    )  # fmt: skip
    grid = np.linspace(10, 40, 31)
    axes[0].plot(grid, [reference("disk", r)[0] for r in grid], color=BLUE, label="disk, reference")
    axes[0].plot(grid, [reference("square", r)[0] for r in grid], "--", color=RED,
                 label="square, reference")  # fmt: skip
    axes[1].plot(grid, [reference("disk", r)[1] for r in grid], color=BLUE, label="disk, reference")
    for shape, colour, mark in (("disk", BLUE, "o"), ("square", RED, "s")):
        mine = np.array([p[1:] for p in points if p[0] == shape])
        for axis, k in ((axes[0], 2), (axes[1], 4)):
            axis.errorbar(mine[:, 0], mine[:, k], mine[:, k + 1], mine[:, 1], mark, color=colour,
                          label=f"{shape}, measured")  # fmt: skip
    axes[0].set(xlabel="Re", ylabel="$L_r/D$", ylim=(0, None))
    axes[1].set(xlabel="Re", ylabel="drag coefficient", ylim=(0, None))
    for axis in axes:
        axis.legend()
    page.figure(fig, "Length of the wake and drag coefficient.")
    page.figure(maps, "Velocity along x over that of the inflow, and streamlines.", "_maps")


def reference(shape: str, reynolds: float) -> tuple[float, float]:
    """L_r/D and drag coefficient."""
    if shape == "square":
        return (theory.square_wake_length(reynolds) if 5 < reynolds < 60 else math.nan), math.nan
    known = np.array([10.0, 20.0, 30.0, 40.0])
    if not 8 < reynolds < 40:
        return math.nan, math.nan
    place = min(max(int(np.searchsorted(known, reynolds)) - 1, 0), 2)
    found = []
    for what in ("L_r/D", "drag coefficient"):
        ends = [theory.channel_cylinder(what, r).value for r in known[place : place + 2]]
        if what == "L_r/D":  # nearly linear
            share = (reynolds - known[place]) / 10
            found.append(ends[0] + share * (ends[1] - ends[0]))
        else:
            share = math.log(reynolds / known[place]) / math.log(known[place + 1] / known[place])
            found.append(ends[0] * (ends[1] / ends[0]) ** share)
    return found[0], found[1]


def draw(axis: Any, field: Any, d: int, title: str, top: float) -> None:
    """The flow about the body."""
    x, y = field.x["x"], field.x["y"]
    place, middle = PLACE * (x[-1] + x[0]), (y[-1] + y[0]) / 2
    some = (x > place - 2 * d) & (x < place + 5 * d)
    part = abs(y - middle) < 2 * d
    u, v = (field.value[some][:, part, k].T / top for k in (0, 1))
    xs, ys = (x[some] - place) / d, (y[part] - middle) / d
    picture = axis.pcolormesh(xs, ys, u, cmap="RdBu_r", norm=SPEEDS, shading="nearest")
    axis.streamplot(xs, ys, np.nan_to_num(u), np.nan_to_num(v), color="k", linewidth=0.4,
                    arrowsize=0.5, density=1.2)  # fmt: skip
    corner = (-0.5, -0.5)
    solid = plt.Circle((0, 0), 0.5) if "disk" in title else plt.Rectangle(corner, 1, 1)
    solid.set(color="0.6", zorder=5)
    axis.add_patch(solid)
    axis.set(title=title, xlabel="x/D", ylabel="y/D", aspect="equal", xlim=(-2, 5))
    bar = axis.figure.colorbar(picture, ax=axis, shrink=0.8, ticks=[-0.25, 0, 0.5, 1, 1.5])
    bar.set_label("$v_x\\,/\\,U$")


def make() -> int:
    """Write the page."""
    page = Page("wakes", "Wakes in a channel")
    steady(page)
    shedding(page)
    return page.write()


if __name__ == "__main__":
    main(make)
