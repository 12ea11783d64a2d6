"""One picture of the flow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.report.flow.beads import frames_of
from mesokit.report.flow.data import Flow
from mesokit.report.flow.kinds import Panel, panels_of, quieted
from mesokit.report.flow.region import Ranges, frames_in, region_of
from mesokit.report.flow.solids import Section
from mesokit.report.flow.source import choose, sources

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.io.trajectory_reader import TrajectoryReader
    from mesokit.observe.shared.result import Result
    from mesokit.report.flow.state import State

CHOICES = ("region", "window", "axes", "at")  # what a user may say of a picture, and of a film


def picture(
    case: Case,
    results: Mapping[str, Result],
    trajectory: TrajectoryReader | State | None = None,
    kind: str = "four",
    region: Ranges | None = None,
    window: tuple[float, float] | None = None,
    axes: tuple[str, str] | None = None,
    at: float | None = None,
) -> Any:
    """A Matplotlib figure of the flow, averaged over a time.

    Parameters
    ----------
    case, results, trajectory: of the run; a `State` of its engine is a trajectory of one frame.
    kind: "quiver", "streamlines", "particles", "density", "speed", "vorticity" or "four".
    region: ((x0, x1), (y0, y1)) in cells, the whole box unless said.
    window: (t0, t1), the times averaged over, all unless said.
    axes: of the picture in 3D, those of the first map unless said; it averages along the third.
    at: where along the third axis solids are shown, in the middle unless said.

    Raises CaseError for a kind, region, window, axes or place that there is not, RunError where
    the run kept nothing to draw.

    >>> from mesokit import Box, FlowFrames, Run, Simulation
    >>> simulation = Simulation(run=Run(steps=40), box=Box([8, 8]), observe=[FlowFrames(window=20)])
    >>> simulation.run()
    >>> figure = picture(simulation.case, simulation.results, kind="speed", region=((0, 4), (0, 8)))
    >>> len(figure.axes)  # the panel and its colour bar
    2
    """
    panels = panels_of(kind)
    found = sources(case, results, trajectory, axes)
    chosen = [choose(found, panel.NEEDS, kind, window is not None) for panel in panels]
    section = Section(case, chosen[0].axes, at)
    flows = [source.flow(frames_in(source.time, window)) for source in chosen]
    shown = region_of(region, flows[0].axes, flows[0].size)
    from mesokit.report.flow.canvas import Canvas

    width, note = quieted(panels, flows, shown)
    solutes = frames_of(case, trajectory, chosen[0].axes)
    beads = solutes.at(window and window[1]) if solutes else None
    flows = [replace(flow, smoothing=width, beads=beads) for flow in flows]
    reaches = [panel.reach(flow, shown) for panel, flow in zip(panels, flows, strict=True)]
    averaged = [f for f, panel in zip(flows, panels, strict=True) if panel.NEEDS != "particles"]
    mean = _mean(averaged[0], window) if averaged else ""
    when = rf"solutes at $t = {beads.time:.4g}\,\tau$" if beads else ""
    how = "projection" if all(panel.NEEDS == "particles" for panel in panels) else "mean"
    notes = [section.note(how), mean, note(flows[0]), _few(case, panels, flows), when]
    drawn = Canvas(panels, flows, reaches, shown, section, notes=notes)
    drawn.show(flows)
    return drawn.figure


def _mean(flow: Flow, window: tuple[float, float] | None) -> str:
    """What velocities and densities are means of, and how sure they are."""
    text = "mean of the run"
    if window is not None:
        text = rf"mean of $t = {window[0]:g}$ to ${window[1]:g}\,\tau$"
    error = flow.error if flow.error is None or flow.sure is None else flow.error[flow.sure]
    if error is not None and (error > 0).any():
        size = float(np.nanmedian(error[error > 0]))
        text += rf"; median standard error of the velocity {size:.2g} $a/\tau$"
    return text


def _few(case: Case, panels: Sequence[Panel], flows: Sequence[Flow]) -> str:
    """How many particles are shown, if not all."""
    for panel, flow in zip(panels, flows, strict=True):
        if panel.NEEDS == "particles" and flow.particles is not None:
            shown = len(flow.particles)
            return f"{shown} of {case.particles} particles" if 0 < shown < case.particles else ""
    return ""
