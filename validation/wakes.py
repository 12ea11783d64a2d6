"""Steady wakes behind a disk and a square in a channel, and vortex shedding."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from common import BLUE, GREY, RED, Page, found, long, main, plt, renamed

import mesokit
from mesokit import (
    SRD,
    Box,
    Case,
    Comparison,
    Disk,
    Fluid,
    MaxwellBoltzmann,
    Plates,
    Rectangle,
    Run,
    Solids,
    Uniform,
    theory,
)
from mesokit.theory.channel_cylinder import OFF_CENTRE, ONSET

ROOM = 8  # height of the channel over the diameter, as in the reference values
LENGTH = 4  # of the periodic box over the height
PLACE = 0.25  # of the body, over the length


class Flow(NamedTuple):
    """A wake: its aim, and the fluid."""

    reynolds: int
    diameter: int
    timestep: float
    steps: float
    density: int = 16


SHEDDING = Flow(100, 24, 1.5, 5e3, density=40)
HIGH, FAR = 120, 400  # of the channel and the box in which vortices are shed
FAST = 0.33
THEIR_BLOCKAGE = 0.1 / 0.41  # of Schafer and Turek
STEADY = (Flow(10, 8, 0.5, 1e4), Flow(20, 12, 1.0, 6e3), Flow(30, 16, 1.0, 1e4))
DRAG = {10: 3.29, 20: 2.23, 30: 1.83}  # about, to choose the force
EXCESS = 1.15  # of the viscosity over that of theory, about, to choose the velocity


def fluid(density: int, timestep: float, push: float) -> Fluid:
    """SRD at 90 degrees: the lowest viscosity there is."""
    return Fluid(
        density=density, timestep=timestep, collision=SRD(angle=90),
        thermostat=MaxwellBoltzmann(), force=Uniform(acceleration=(push, 0)),
    )  # fmt: skip


def viscosity_of_theory(density: int, timestep: float) -> float:
    """Kinematic."""
    return theory.transport(
        "srd", 2, density, timestep, angle=90, thermostat="maxwell-boltzmann"
    ).viscosity


def aim(flow: Flow) -> float:
    """The centre velocity that a flow should have."""
    theirs = viscosity_of_theory(flow.density, flow.timestep)
    return flow.reynolds * EXCESS * theirs / flow.diameter


def begun(case: Case, speed: float) -> tuple[Any, Any]:
    """Positions and velocities of a parabola in the fluid: near the steady state."""
    random = np.random.default_rng(case.run.seed)
    size, solids = np.array(case.box.size, float), Solids(case.walls, case.box)
    r = random.random((case.particles, 2)) * size
    bad = np.arange(len(r))
    while len(bad):
        bad = bad[solids.distance(r[bad]) < 1e-6]
        r[bad] = random.random((len(bad), 2)) * size
    v = random.standard_normal(r.shape)
    v -= v.mean(axis=0)
    v[:, 0] += 4 * speed * r[:, 1] * (size[1] - r[:, 1]) / size[1] ** 2
    return r, v


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


def inflow(field: Any, d: int, where: tuple[float, float] = (4, 6)) -> tuple[float, float, float]:
    """Highest velocity of the parabola before the body, its error, and in per cent by how much the
    velocity in the middle differs from it."""
    x, y = field.x["x"], field.x["y"]
    place = PLACE * (x[-1] + x[0])
    before = (x > place - where[1] * d) & (x < place - where[0] * d)
    u = field.value[before, :, 0].mean(axis=0)
    # neighbouring bins are correlated: the error of the mean of these is that of one in four
    error = np.sqrt((field.error[before, :, 0] ** 2).mean(axis=0) / (before.sum() / 4))
    shape = 4 * (y / (y[-1] + y[0])) * (1 - y / (y[-1] + y[0]))
    top = float((shape @ u) / (shape @ shape))
    spread = float(np.sqrt((shape**2 * error**2).sum() * 4) / (shape @ shape))
    middle = abs(y - (y[-1] + y[0]) / 2) < d / 4
    return top, spread, 100 * float((u[middle] / (top * shape[middle])).mean() - 1)


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
    picture = axis.pcolormesh(xs, ys, u, cmap="RdBu_r", vmin=-1, vmax=1, shading="nearest")
    axis.streamplot(xs, ys, np.nan_to_num(u), np.nan_to_num(v), color="k", linewidth=0.4,
                    arrowsize=0.5, density=1.2)  # fmt: skip
    corner = (-0.5, -0.5)
    solid = plt.Circle((0, 0), 0.5) if "disk" in title else plt.Rectangle(corner, 1, 1)
    solid.set(color="0.6", zorder=5)
    axis.add_patch(solid)
    axis.set(title=title, xlabel="x/D", ylabel="y/D", aspect="equal", xlim=(-2, 5))
    axis.figure.colorbar(picture, ax=axis, shrink=0.8)


def street() -> Case:
    """A disk at which vortices are shed."""
    d, flow = SHEDDING.diameter, SHEDDING
    nu = 1.05 * viscosity_of_theory(flow.density, flow.timestep)
    push = 8 * nu * FAST / HIGH**2 + 1.7 * FAST**2 * d / (2 * FAR * HIGH)
    return Case(
        run=Run(steps=long(flow.steps), warmup=long(flow.steps / 2), seed=11),
        box=Box([FAR, HIGH]),
        fluid=fluid(flow.density, flow.timestep, push),
        walls=[Plates(axis="y"), Disk(centre=[PLACE * FAR, HIGH / 2], radius=d / 2, name="body")],
        observe=[
            mesokit.VelocityField(every=10),
            mesokit.Forces(length=d, every=2),
            mesokit.FlowFrames(window=20, every=5),
        ],
    )


def frequency(time: Any, lift: Any) -> tuple[float, float, float]:
    """Dominant frequency of a signal, its error, and the share of the variance near it.

    A sine is fitted by least squares at each frequency; the error is that of blocks: the same for
    each quarter of the signal.
    """

    def best(t: Any, f: Any, low: float, high: float) -> tuple[float, float]:
        grid = np.linspace(low, high, 4000)
        centred = f - f.mean()
        window = np.hanning(len(f))
        power = np.abs(np.exp(-2j * np.pi * np.outer(grid, t)) @ (window * centred)) ** 2
        place = int(power.argmax())
        return float(grid[place]), float(power[place])

    span = time[-1] - time[0]
    overall, _ = best(time, lift, 3 / span, 0.25 / (time[1] - time[0]))
    quarters = [
        best(time[part], lift[part], 0.5 * overall, 1.5 * overall)[0]
        for part in np.array_split(np.arange(len(time)), 4)
    ]
    error = float(np.std(quarters, ddof=1) / 2)
    wave = np.stack([np.cos(2 * np.pi * overall * time), np.sin(2 * np.pi * overall * time)], 1)
    wave -= wave.mean(axis=0)
    fitted = wave @ np.linalg.lstsq(wave, lift - lift.mean(), rcond=None)[0]
    return overall, error, float(fitted.var() / lift.var())


def strouhal_at(reynolds: float, blockage: float) -> float:
    """About what it should be: that of the onset, risen as much as it rises from the onset to the
    flow of Schafer and Turek, at the same Reynolds number relative to the onset's."""
    (low, a), (high, b) = ((key, ONSET[key]) for key in (0.2, 0.3))
    theirs = next(r for r in OFF_CENTRE if r.what == "Strouhal number")
    share = (THEIR_BLOCKAGE - low) / (high - low)
    began = a.reynolds + share * (b.reynolds - a.reynolds)
    first = a.value + share * (b.value - a.value)
    # theirs are with the mean velocity, two thirds of that in the centre
    risen = (2 / 3 * theirs.value / first - 1) / (1.5 * theirs.reynolds / began - 1)
    onset = ONSET[blockage]
    return onset.value * (1 + risen * (reynolds / onset.reynolds - 1))


def shedding(page: Page) -> None:
    """About Reynolds number 100."""
    d, flow = SHEDDING.diameter, SHEDDING
    blockage = d / HIGH
    page.heading("Vortex shedding")
    nu = viscosity_of_theory(flow.density, flow.timestep)
    case = street()
    files = page.run("shedding", case, *begun(case, FAST))
    field, forces = files["velocity-field"], files["forces"]
    top, spread, misfit = inflow(field, d, (2.5, 3.5))
    re = top * d / nu
    place = list(forces.x["body"]).index("body")
    time, lift = forces.extra["time"], forces.extra["series"][:, place, 1]
    f, error, share = frequency(time, lift)
    strouhal = f * d / top
    strouhal_error = strouhal * math.hypot(error / f, spread / top)
    scale = 2 / (flow.density * top**2 * d)
    drag, drag_error = scale * forces.value[place, 0], scale * forces.error[place, 0]
    total = found(forces, "force on all solids")
    onset, expected = ONSET[blockage], strouhal_at(re, blockage)
    page.text(
        f"Disk, D = {d}, channel {HIGH} high (blockage {blockage:g}) and {FAR} long, SRD at 90 "
        f"degrees, density {flow.density}, timestep {flow.timestep}: viscosity {nu:.4f} by theory, "
        f"some per cent more by fluctuations. Centre velocity 2.5 to 3.5 diameters before the disk "
        f"{top:.3f} (in the middle {misfit:+.1f} %), Re = {re:.0f}: the Mach number is a third, so "
        "that some per cent of what is seen is compressibility. The box is periodic: vortices "
        "come round weakened, and four wavelengths fit the box, which may draw the frequency to "
        f"itself. At the onset of shedding at this blockage (Re = {onset.reynolds:g}) the Strouhal "
        f"number is {onset.value} ({onset.source}). It rises with Re: from the onset, between the "
        "tabulated blockages, to the 0.300 (0.200 with the centre velocity) that Schafer and Turek "
        "have at a Re of 150 by this definition and a blockage of 0.244. The expected one has "
        "risen likewise, relative to the Re of the onset."
    )
    page.table(
        [
            Comparison("Strouhal number f D/U, from the lift", strouhal, strouhal_error,
                       expected, "", f"at Re = {re:.0f}; {onset.value} at {onset.reynolds:g}"),
            Comparison("drag coefficient", drag, drag_error, math.nan, "", "with this U"),
            Comparison("share of the lift's variance at this frequency", 100 * share, 0.0,
                       math.nan, "%"),
            renamed(total, total.what, total.note),
        ]
    )  # fmt: skip
    page.check(
        f"vortices are shed at Re = {re:.0f}: Strouhal number {strouhal:.3f} +- "
        f"{strouhal_error:.3f}, expected {expected:.3f} (within 15 %)",
        abs(strouhal - expected) < 0.15 * expected,
    )
    page.check(
        f"shedding: force on the solids {total.percent:+.1f} +- "
        f"{100 * total.error / total.expected:.1f} % off the body force (within 3 %)",
        abs(total.percent) < 3,
    )
    fig, axes = plt.subplots(1, 2, figsize=(9.5, 3.2))
    axes[0].plot(time - time[0], scale * lift, color=BLUE, lw=0.7)
    axes[0].set(xlabel="time", ylabel="lift coefficient")
    grid = np.fft.rfftfreq(len(time), time[1] - time[0])
    power = np.abs(np.fft.rfft((lift - lift.mean()) * np.hanning(len(lift)))) ** 2
    axes[1].semilogy(grid * d / top, power / power.max(), color=BLUE, lw=0.8)
    axes[1].axvline(expected, color=GREY, ls="--", label="expected Strouhal number")
    axes[1].set(xlabel="f D/U", ylabel="power of the lift", xlim=(0, 0.6), ylim=(1e-5, 2))
    axes[1].legend()
    page.figure(fig, "Lift coefficient, and its spectrum.", "_shedding")
    page.figure(
        street_picture(files["flow-frames"]),
        "Velocity across the channel in the last 60 steps, over U; means of 4 by 4 cells.",
        "_street",
    )  # fmt: skip


def street_picture(frames: Any) -> Any:
    """The vortices at the end."""
    last = frames.value[-3:]
    density, v = (
        last[..., 0].mean(axis=0),
        (last[..., 0] * np.nan_to_num(last[..., 2])).mean(axis=0),
    )
    coarse = [a.reshape(FAR // 4, 4, HIGH // 4, 4).mean(axis=(1, 3)) for a in (v, density)]
    fig, axis = plt.subplots(figsize=(9, 3.2))
    with np.errstate(invalid="ignore", divide="ignore"):
        shown = (coarse[0] / coarse[1]).T / FAST
    picture = axis.pcolormesh(
        np.arange(0, FAR + 1, 4), np.arange(0, HIGH + 1, 4), shown, cmap="RdBu_r", vmin=-0.5,
        vmax=0.5,
    )  # fmt: skip
    axis.add_patch(plt.Circle((PLACE * FAR, HIGH / 2), SHEDDING.diameter / 2, color=GREY))
    axis.set(xlabel="x", ylabel="y", aspect="equal")
    fig.colorbar(picture, ax=axis, shrink=0.7, label="$v_y/U$")
    return fig


def make() -> int:
    """Write the page."""
    page = Page("wakes", "Wakes in a channel")
    steady(page)
    shedding(page)
    return page.write()


if __name__ == "__main__":
    main(make)
