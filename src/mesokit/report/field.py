"""Maps of a whole run, drawn as pictures of the flow are; with solids where the case is known."""

from dataclasses import replace
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.observe.flow_frames import average
from mesokit.report.caption import symbols
from mesokit.report.flow import quiver
from mesokit.report.flow.data import Flow
from mesokit.report.flow.kinds import Panel
from mesokit.report.flow.map_sources import FieldSource
from mesokit.report.flow.maps import density, speed
from mesokit.report.flow.noise import note, smooth, smoothing
from mesokit.report.flow.region import region_of
from mesokit.report.flow.setting import Setting
from mesokit.report.flow.solids import Section
from mesokit.report.flow.source import axes_of
from mesokit.report.style import labelled
from mesokit.seam.result import Result

FEW = 10  # samples: of fewer a mean says how many
NO_FLUID = "0.85"  # grey of bins without fluid, where the solids are unknown
DENSITIES = 0.5, 99.5  # percent of the bins: from where to where the colours of a density go
FLAT = 0.5  # of the highest density: where the lowest is above it, colours start there


def draw(result: Result, ax: Any, case: Case | None) -> Any:
    """Speed and arrows, or density, into a new figure; into given axes the colours alone."""
    if result.drawing == "frames":
        result = average(result)
    axes = axes_of(result)
    setting = _setting(result, axes) if case is None else Setting.of(case, axes)
    flow = FieldSource(setting, result).flow(np.zeros(0, np.int64))
    section, region = Section(case, axes), region_of(None, axes, flow.size)
    panels: tuple[Panel, ...] = (speed, quiver)
    if flow.density is not None:
        panels, flow = (density,), _ranged(flow, setting)
    width, clear = smoothing(panels, [flow], region)
    flow = smooth(flow, width)
    reaches = [panel.reach(flow, region) for panel in panels]
    if ax is None:
        from mesokit.report.flow.canvas import Canvas

        notes, flows = [section.note(), _note(result, flow)], [flow] * len(panels)
        notes.append(note(panels, flow, clear))
        drawn = Canvas(panels, flows, reaches, region, section, notes=notes)
        drawn.show(flows)
        figure, ax = drawn.figure, drawn.axes[0]
    else:
        figure, view = ax.figure, section.view(region)
        scale = panels[0].scale(flow, reaches[0])
        section.draw(ax, view)
        panels[0].draw(ax, flow, region, reaches[0])
        ax.set(xlim=(view.low[0], view.high[0]), ylim=(view.low[1], view.high[1]), aspect="equal")
        ax.set(xlabel=labelled(f"${axes[0]}$", "a"), ylabel=labelled(f"${axes[1]}$", "a"))
        assert scale is not None
        figure.colorbar(scale.mappable(), ax=ax, label=scale.label)
    if case is None:
        ax.set_facecolor(NO_FLUID)
    return figure


def _setting(result: Result, axes: tuple[str, str]) -> Setting:
    """The box, from the coordinates of a result."""
    x, y = (result.x[axis] for axis in axes)
    size = float(x[0] + x[-1]), float(y[0] + y[-1])
    dimension = len(result.x.get("component", ())) or int(result.extra.get("dimension", 2))
    return Setting(axes, ["xyz".index(axis) for axis in axes], size, dimension, (False, False))


def _ranged(flow: Flow, setting: Setting) -> Flow:
    """Colours from the lowest density that is no cut cell, as a fluid is hardly compressible."""
    assert flow.density is not None
    values = flow.density
    if setting.case is None:  # a bin that was empty all the time is solid
        values = np.where(values > 0, values, np.nan)
    kept = flow.surely(values)
    kept = kept[np.isfinite(kept)]
    low, high = np.percentile(kept, DENSITIES) if len(kept) else (0.0, 1.0)
    return replace(flow, density=values, lowest=float(low) if FLAT * high < low < high else 0.0)


def _note(result: Result, flow: Flow) -> str:
    """The quantity that was averaged, and its standard error."""
    name, unit = "density", f"1/a^{flow.dimension}"
    if flow.density is None:
        name, unit = "velocity", "a/tau"
    text = f"mean {name} of the run"
    error = result.error if flow.sure is None else result.error[flow.sure]
    if result.samples < FEW:
        text += f", of {result.samples} sample" + "s" * (result.samples != 1)
    if (error > 0).any():
        text += f"; median standard error {np.nanmedian(error[error > 0]):.2g} {symbols(unit)}"
    if flow.density is not None and result.expected is not None:
        text += f"; uniform would be {np.nanmax(result.expected):.4g} {symbols(unit)}"
    return text
