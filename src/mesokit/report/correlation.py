"""Functions of a time lag: displacement, memory of a velocity, decay of modes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.caption import mathematics, symbols
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, MARKERS, labelled, sparse_logarithm
from mesokit.seam.result import Result
from mesokit.seam.units import Units

SHOWN = 6  # curves in one figure
ALIKE = 0.01  # how near a line is to a curve that tells the same
DEEPEST = 1e-4  # of the largest modulus, the least that is drawn


def draw_displacement(result: Result, figure: Any, ax: Any) -> None:
    """Both axes logarithmic; the ratio to theory below."""
    time, below = result.x["time"], None
    use = time > 0
    if ax is None and result.expected is not None and use.any():
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
    else:
        ax = figure.subplots() if ax is None else ax
    t = time[use]
    components = result.extra.get("components", "")
    of = result.label.removeprefix("mean square displacement").strip()
    along = f"along {', '.join(components)}" if components else ""
    seen = " ".join(filter(None, (of, along)))
    ax.errorbar(
        t,
        result.value[use],
        result.error[use],
        fmt="o",
        mfc="white",
        color=COLOURS[0],
        label=f"measured{f' ({seen})' if seen else ''}, $\\pm$ one standard error",
        zorder=2,
    )
    if result.expected is not None:
        label = mathematics(f"theory: {result.theory}")
        ax.plot(t, result.expected[use], "-", color="black", label=label, zorder=3)
        _better(result, ax, below)
    elif use.any():
        _straight(ax, result, t, result.value[use])
    if result.fit is not None:
        late = "fit of the diffusion coefficient"
        ax.plot(t, result.fit[use], "--", color=COLOURS[1], lw=1.5, label=late, zorder=4)
    if len(t):
        ax.set_xscale("log")
        ax.set_yscale("log")
        sparse_logarithm(ax.xaxis, t[0], t[-1])
    ax.set_ylabel(labelled("mean square displacement", result.units["value"]))
    legend_above(ax, columns=1)
    if below is not None:
        theory = np.asarray(result.expected)[use]
        ratio, error = result.value[use] / theory, result.error[use] / theory
        below.axhline(1, color="black", lw=1)
        below.errorbar(t, ratio, error, fmt="o", mfc="white", ms=3, color=COLOURS[0])
        rough = result.theory.endswith("approximate")
        below.set_ylabel("measured\n/ chaos" if rough else "measured\n/ theory")
    (below or ax).set_xlabel(labelled("time lag $t$", result.units["time"]))


def _better(result: Result, ax: Any, below: Any) -> None:
    """Late lags of a diffusion coefficient that theory knows better than the curve."""
    known = [c for c in result.comparisons if c.what == "diffusion coefficient"]
    time, curve, axes = result.x["time"], np.asarray(result.expected), result.extra["components"]
    if result.fit is None or len(time) < 2 or not (known and np.isfinite(known[0].expected)):
        return
    slope = 2 * len(axes) * known[0].expected
    if abs((curve[-1] - curve[-2]) / (time[-1] - time[-2]) / slope - 1) < ALIKE:
        return
    late = np.isfinite(result.fit) & (time >= 0.1 * time[-1])
    style: Any = {"ls": "-.", "color": COLOURS[2], "lw": 1.5, "zorder": 3}
    label = f"theory: diffusion coefficient, {known[0].expected:.3g} {symbols(known[0].unit)}"
    ax.plot(time[late], slope * time[late], label=label, **style)
    if below is not None:
        below.plot(time[late], slope * time[late] / curve[late], **style)


def _straight(ax: Any, result: Result, t: Any, value: Any) -> None:
    """Where no curve is known: that of the diffusion coefficient of theory, or else slope 1."""
    diffusion = "a^2/tau", Units().of("a^2/tau")
    known = [c for c in result.comparisons if c.unit in diffusion and np.isfinite(c.expected)]
    if known and result.extra.get("components"):
        slope = 2 * len(result.extra["components"]) * known[0].expected
        late = t if result.fit is None else t[t >= 0.1 * result.x["time"][-1]]
        expected = f"{known[0].expected:.3g} {symbols(known[0].unit)}"
        label = f"{mathematics(f'theory: {known[0].what}')}, {expected}"
        ax.plot(late, slope * late, "-", color="black", label=label, zorder=3)
    else:
        ax.plot(t, value[-1] * t / t[-1], ":", color="0.5", label="slope 1", zorder=1)


def draw_memory(result: Result, figure: Any, ax: Any) -> None:
    """Logarithmic in value and time, as a power law follows an exponential."""
    ax = figure.subplots() if ax is None else ax
    _logarithmic(result, ax)
    ax.set_ylabel(labelled(r"$|\langle v_x(0)\, v_x(t)\rangle|$", result.units["value"]))


def draw_modulus(result: Result, figure: Any, ax: Any) -> None:
    """Relaxation modulus, and what its Fourier transforms say is stored and lost."""
    right: Any = None
    if ax is None and "frequency" in result.extra:
        ax, right = figure.subplots(1, 2)
    ax = figure.subplots() if ax is None else ax
    _logarithmic(result, ax)
    ax.set_ylabel(labelled("$|G(t)|$", result.units["value"]))
    if right is None:
        return
    w = result.extra["frequency"]
    largest = 0.0
    for k, (name, label) in enumerate((("storage", "$G'$"), ("loss", "$G''$"))):
        value, error = result.extra[name], result.extra[f"{name}_error"]
        use = value > 0
        right.errorbar(
            w[use],
            value[use],
            _bars(value[use], error[use]),
            fmt=MARKERS[k],
            mfc="white",
            color=COLOURS[k],
            label=label,
            zorder=2,
        )
        line = result.extra.get(f"{name}_theory")
        if line is not None and (line > 0).any():
            right.plot(w, line, color="black", lw=1.2, label=None if k else "theory", zorder=3)
            largest = max(largest, line.max())
        largest = max(largest, value.max(initial=0.0))
    right.set_xscale("log")
    right.set_yscale("log", nonpositive="mask")
    if largest > 0:
        noise = np.nanmedian(result.extra["storage_error"])
        right.set_ylim(max(min(0.2 * noise, 0.1 * largest), DEEPEST * largest), 3 * largest)
    sparse_logarithm(right.xaxis, w[0], w[-1])
    right.set_xlabel(labelled(r"frequency $\omega$", "1/tau"))
    right.set_ylabel(labelled("modulus", result.units["value"]))
    legend_above(right)


def _logarithmic(result: Result, ax: Any) -> None:
    """Size of a correlation, negative values filled."""
    time = result.x["time"]
    late, size = time > 0, abs(result.value)
    signs = {"measured, positive": result.value > 0, "measured, negative": result.value < 0}
    for (label, sign), fill in zip(signs.items(), ("white", COLOURS[0]), strict=True):
        use = late & sign
        if use.any():
            ax.errorbar(
                time[use],
                size[use],
                _bars(size[use], result.error[use]),
                fmt="o",
                mfc=fill,
                color=COLOURS[0],
                label=label,
                zorder=2,
            )
    if result.expected is not None:
        line, label = abs(result.expected), mathematics(f"theory: {result.theory}")
        ax.plot(time[late], line[late], "-", color="black", label=label, zorder=3)
    tail = result.extra.get("tail")
    if tail is not None and np.isfinite(tail).any():
        ax.plot(time, tail, "--", color=COLOURS[1], lw=1.5, label="theory: hydrodynamic tail")
    if (size[late] > 0).any():
        ax.set_xscale("log")
        ax.set_yscale("log")
        noise = np.nanmedian(result.error[late]) if np.isfinite(result.error[late]).any() else 0.0
        largest = size[late].max()
        ax.set_ylim(0.2 * max(noise, 1e-6 * largest), 3 * largest)
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    legend_above(ax, columns=1)


def _bars(value: Any, error: Any) -> Any:
    """Error bars (2, n) on a logarithmic axis: those that reach zero have no lower end in sight."""
    return np.stack([np.where(error < value, error, (1 - 1e-12) * value), error])


def draw_modes(result: Result, figure: Any, ax: Any) -> None:
    """One curve for each of the longest waves, up to where all have died."""
    ax = figure.subplots() if ax is None else ax
    time, shown = result.x["time"], min(SHOWN, len(result.x["wavenumber"]))
    if not len(time):
        return
    end = _end(time, result)
    for i, k in enumerate(result.x["wavenumber"][:shown]):
        colour, use = COLOURS[i % len(COLOURS)], time <= end
        ax.errorbar(
            time[use],
            result.value[use, i],
            result.error[use, i],
            fmt=MARKERS[i % len(MARKERS)],
            mfc="white",
            color=colour,
            lw=0.8,
            label=rf"$k = {k:.4g}\,a^{{-1}}$",
            zorder=2,
        )
        if result.expected is not None:
            fine, line = time[use], result.expected[use, i]
            if "curve" in result.extra:
                fine, line = result.extra["curve_time"], result.extra["curve"][:, i]
            label = mathematics(f"theory: {result.theory}") if i == 0 else None
            ax.plot(fine, line, color="black", lw=1, label=label)
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    ax.set_xlim(0, end)
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    kind = result.label[0].upper()  # transverse or longitudinal
    ax.set_ylabel(rf"$C_v^{kind}(k, t)\,/\,C_v^{kind}(k, 0)$")
    legend_above(ax)


def draw_normal_modes(result: Result, figure: Any, ax: Any) -> None:
    """One curve for each of the slowest modes, as far as they are above noise."""
    ax = figure.subplots() if ax is None else ax
    time = result.x["time"]
    for i, p in enumerate(result.x["mode"][:SHOWN]):
        colour = COLOURS[i % len(COLOURS)]
        use = np.logical_and.accumulate(result.value[:, i] > 2 * result.error[:, i])
        ax.errorbar(
            time[use],
            result.value[use, i],
            result.error[use, i],
            fmt=MARKERS[i % len(MARKERS)],
            mfc="white",
            color=colour,
            lw=0.8,
            label=f"$p = {p}$",
            zorder=2,
        )
        if result.expected is not None:
            label = mathematics(f"theory: {result.theory}") if i == 0 else None
            ax.plot(time[use], result.expected[use, i], color="black", lw=1, label=label)
    ax.set_yscale("log", nonpositive="mask")
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    ax.set_ylabel(r"$\langle X_p(0) X_p(t)\rangle\,/\,\langle X_p^2\rangle$")
    legend_above(ax)


def _end(time: NDArray[np.float64], result: Result) -> float:
    """The lag after which the longest wave stays small."""
    curve = result.value if result.expected is None else result.expected
    alive = np.flatnonzero(abs(curve[:, 0]) > 0.03)
    last = min(alive[-1] + 1 if len(alive) else 1, len(time) - 1)
    return float(time[max(last, min(4, len(time) - 1))]) or 1.0
