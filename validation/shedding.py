"""Vortices shed by a disk in a channel; a section of the page of `wakes`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from channel import PLACE, Flow, begun, fluid, inflow, viscosity_of_theory
from common import BLUE, GREY, Page, found, long, plt, renamed

import mesokit
from mesokit import Box, Case, Comparison, Disk, Plates, Run
from mesokit.theory.channel_cylinder import OFF_CENTRE, ONSET

SHEDDING = Flow(100, 24, 1.5, 5e3, density=40)
HIGH, FAR = 120, 400  # of the channel and the box in which vortices are shed
FAST = 0.33
THEIR_BLOCKAGE = 0.1 / 0.41  # of Schafer and Turek


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
