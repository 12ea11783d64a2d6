"""Functions of a time lag: displacement, memory of a velocity, decay of modes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.caption import mathematics, symbols
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, ERROR, labelled, points, sparse_logarithm, theory_of
from mesokit.seam.result import Result
from mesokit.seam.units import Units

SHOWN = 6  # curves in one figure
ALIKE = 0.01  # how near a line is to a curve that shows the same
LINEAR, ANGULAR = "mean square displacement", "mean square angular displacement"
DEEPEST = 1e-4  # of the largest modulus, the least that is drawn


def draw_displacement(result: Result, figure: Any, ax: Any) -> None:
    """Both axes logarithmic; the ratio to theory below."""
    time, below = result.x["time"], None
    use = time > 0
    t, value, error = time[use], result.value[use], result.error[use]
    if ax is None and result.expected is not None and len(t):
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
    elif ax is None:
        ax = figure.subplots()
    angular = result.label.startswith(ANGULAR)
    components, name = result.extra.get("components", ""), ANGULAR if angular else LINEAR
    along = f" {'about' if angular else 'along'} {', '.join(components)}" if components else ""
    seen = f"{result.label.removeprefix(name).strip()}{along}".strip()
    points(ax, t, value, error, label=f"measured{f' ({seen})' if seen else ''}, {ERROR}")
    if result.expected is not None:
        ax.plot(t, result.expected[use], color="black", label=theory_of(result), zorder=3)
        _better(result, ax, below)
    elif len(t):
        _straight(ax, result, t, value)
    if result.fit is not None:
        late = "fit of the diffusion coefficient"
        ax.plot(t, result.fit[use], "--", color=COLOURS[1], lw=1.5, label=late, zorder=4)
    if len(t):
        ax.set(xscale="log", yscale="log")
        sparse_logarithm(ax.xaxis, t[0], t[-1])
    ax.set_ylabel(labelled(name, result.units["value"]))
    legend_above(ax, columns=1)
    if below is not None:
        theory = np.asarray(result.expected)[use]
        below.axhline(1, color="black", lw=1)
        points(below, t, value / theory, error / theory, ms=3)
        rough = result.theory.endswith("approximate")
        below.set_ylabel("measured\n/ chaos" if rough else "measured\n/ theory")
    (below or ax).set_xlabel(labelled("time lag $t$", result.units["time"]))


def _better(result: Result, ax: Any, below: Any) -> None:
    """Draw late lags where the coefficient of theory differs from the slope of its curve."""
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
    """Draw a line of slope 1, by the diffusion coefficient of theory or else through the data."""
    diffusion = "a^2/tau", Units().of("a^2/tau")
    known = [c for c in result.comparisons if c.unit in diffusion and np.isfinite(c.expected)]
    if known and result.extra.get("components"):
        slope = 2 * len(result.extra["components"]) * known[0].expected
        late = t  # from where diffusion holds, as before it places go less far
        if result.fit is not None:
            late = result.x["time"][np.isfinite(result.fit)]
        expected = f"{known[0].expected:.3g} {symbols(known[0].unit)}"
        label = f"{mathematics(f'theory: {known[0].what}')}, {expected}"
        ax.plot(late, slope * late, "-", color="black", label=label, zorder=3)
    else:
        ax.plot(t, value[-1] * t / t[-1], ":", color="0.5", label="slope 1", zorder=1)


def draw_memory(result: Result, ax: Any) -> None:
    """Logarithmic in value and time, as a power law follows an exponential."""
    _logarithmic(result, ax)
    letter = r"\Omega" if result.label.startswith("angular") else "v_x"
    product = rf"$|\langle {letter}(0)\, {letter}(t)\rangle|$"
    ax.set_ylabel(labelled(product, result.units["value"]))


def draw_modulus(result: Result, figure: Any, ax: Any) -> None:
    """Relaxation modulus, and the storage and loss moduli from its Fourier transform."""
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
        points(right, w[use], value[use], _bars(value[use], error[use]), k, label=label)
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
            bars = _bars(size[use], result.error[use])
            points(ax, time[use], size[use], bars, mfc=fill, label=label)
    if result.expected is not None:
        line = abs(result.expected)[late]
        ax.plot(time[late], line, color="black", label=theory_of(result), zorder=3)
    tail = result.extra.get("tail")
    if tail is not None and np.isfinite(tail).any():
        ax.plot(time, tail, "--", color=COLOURS[1], lw=1.5, label="theory: hydrodynamic tail")
    if (size[late] > 0).any():
        ax.set(xscale="log", yscale="log")
        noise = np.nanmedian(result.error[late]) if np.isfinite(result.error[late]).any() else 0.0
        largest = size[late].max()
        ax.set_ylim(0.2 * max(noise, 1e-6 * largest), 3 * largest)
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    legend_above(ax, columns=1)


def _bars(value: Any, error: Any) -> Any:
    """Error bars (2, n) on a logarithmic axis, where bars to zero go below the picture."""
    return np.stack([np.where(error < value, error, (1 - 1e-12) * value), error])


def draw_modes(result: Result, ax: Any) -> None:
    """One curve for each of the longest waves, until all are below noise."""
    time = result.x["time"]
    if not len(time):
        return
    end = _end(time, result)
    for i, k in enumerate(result.x["wavenumber"][:SHOWN]):
        _mode(result, ax, i, time <= end, rf"$k = {k:.4g}\,a^{{-1}}$")
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    ax.set_xlim(0, end)
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    kind = result.label[0].upper()  # transverse or longitudinal
    ax.set_ylabel(rf"$C_v^{kind}(k, t)\,/\,C_v^{kind}(k, 0)$")
    legend_above(ax)


def draw_normal_modes(result: Result, ax: Any) -> None:
    """One curve for each of the slowest modes, as far as they are above noise."""
    for i, p in enumerate(result.x["mode"][:SHOWN]):
        clear = np.logical_and.accumulate(result.value[:, i] > 2 * result.error[:, i])
        _mode(result, ax, i, clear, f"$p = {p}$")
    ax.set_yscale("log", nonpositive="mask")
    ax.set_xlabel(labelled("time lag $t$", result.units["time"]))
    ax.set_ylabel(r"$\langle X_p(0) X_p(t)\rangle\,/\,\langle X_p^2\rangle$")
    legend_above(ax)


def _mode(result: Result, ax: Any, i: int, use: Any, label: str) -> None:
    """Draw one mode at the lags `use`, and its theory, on a fine grid if there is one."""
    time = result.x["time"][use]
    points(ax, time, result.value[use, i], result.error[use, i], i, lw=0.8, label=label)
    if result.expected is not None:
        line, theory = result.expected[use, i], theory_of(result) if i == 0 else None
        if "curve" in result.extra:
            time, line = result.extra["curve_time"], result.extra["curve"][:, i]
        ax.plot(time, line, color="black", lw=1, label=theory)


def _end(time: NDArray[np.float64], result: Result) -> float:
    """The lag after which the longest wave stays small."""
    curve = result.value if result.expected is None else result.expected
    alive = np.flatnonzero(abs(curve[:, 0]) > 0.03)
    last = min(alive[-1] + 1 if len(alive) else 1, len(time) - 1)
    return float(time[max(last, min(4, len(time) - 1))]) or 1.0
