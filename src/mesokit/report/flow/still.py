"""One picture of the flow."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.caption import at, rounded, symbols
from mesokit.report.flow.beads import frames_of
from mesokit.report.flow.bodies import bodies_of, left_out
from mesokit.report.flow.data import Flow
from mesokit.report.flow.kinds import Panel, legend_of, panels_of, usual
from mesokit.report.flow.noise import note, smooth, smoothing
from mesokit.report.flow.region import View, frames_in, region_of, require_none
from mesokit.report.flow.site_kinds import SITE_KINDS, own_kind, site_still
from mesokit.report.flow.solids import Section
from mesokit.report.flow.source import AT_ONCE, choose, sources
from mesokit.report.flow.state import State
from mesokit.seam.in_units import of_case
from mesokit.seam.result import Result


@of_case
def picture(
    case: Case,
    results: Mapping[str, Result],
    trajectory: TrajectoryReader | State | None = None,
    kind: str | None = None,
    **choices: Any,
) -> Any:
    """A Matplotlib figure of the flow, averaged over a time; of particles as they are at its end.

    Parameters
    ----------
    case, results, trajectory: of the run; a `State` of its engine is a trajectory of one frame.
    kind: "quiver", "streamlines", "particles", "density", "speed", "vorticity", "four", of
        spheres "disks" and "force-chains", of birds "flock", of bodies that move "bodies", of
        sites "sites", "space-time", "profiles", "heights" or "occupied"; unless said that of the
        method, else "four", or what the run has kept enough for.
    choices: the rest.
    region: ((x0, x1), (y0, y1)) in cells, the whole box unless said.
    window: (t0, t1), the times averaged over, all unless said.
    axes: of the picture in 3D, those of the first map unless said; it averages along the third.
    at: where along the third axis solids and bodies are cut, in the middle unless said; of spheres
        and shaded bodies those behind it.
    colour: of disks and spheres: "speed" (unless said), "spin", "neighbours", "psi6" or "kind".
    states: names of those of kind "occupied"; all but the first unless said.
    traces: time over which the paths of the centres of bodies are shown, none unless said.
    time: "log" for profiles at times whose ratios are alike, else "linear".

    Raises CaseError for a kind, region, window, axes or place that there is not, RunError where
    the run kept nothing to draw.

    >>> from mesokit import Box, FlowFrames, Run, Simulation
    >>> simulation = Simulation(run=Run(steps=40), box=Box([8, 8]), observe=[FlowFrames(window=20)])
    >>> simulation.run()
    >>> figure = picture(simulation.case, simulation.results, kind="speed", region=((0, 4), (0, 8)))
    >>> len(figure.axes)  # the panel and its colour bar
    2
    """
    view = View(**choices)
    if view.average is not None:
        raise CaseError(f"average = {show(view.average)}: only of films; a picture has a window")
    if (kind or own_kind(case)) in SITE_KINDS:
        return site_still(kind or str(own_kind(case)), case, trajectory, view)
    if kind is not None:
        panels_of(kind, case, view.colour)
    require_none(view, ("states", "time"))
    window, found = view.window, sources(case, results, trajectory, view)
    kind = kind or usual(case, found, "four", in_time=window is not None)
    panels = panels_of(kind, case, view.colour)
    chosen = [choose(found, panel.NEEDS, kind, window is not None) for panel in panels]
    of_sites = any(panel.NEEDS == "sites" for panel in panels)
    section = Section(case, chosen[0].axes, None if of_sites else view.at)
    flows = [source.flow(frames_in(source.time, window)) for source in chosen]
    shown = region_of(view.region, flows[0].axes, flows[0].size)
    from mesokit.report.flow.canvas import Canvas

    width, clear = smoothing(panels, flows, shown)
    solutes = frames_of(case, trajectory, chosen[0].axes)
    beads = solutes.at(window and window[1]) if solutes else None
    cut = section.plane, view.at is not None
    moving = bodies_of(case, trajectory, chosen[0].axes, *cut, view.traces)
    bodies = moving.at(window and window[1]) if moving else None
    flows = [replace(smooth(flow, width), beads=beads, bodies=bodies) for flow in flows]
    reaches = [panel.reach(flow, shown) for panel, flow in zip(panels, flows, strict=True)]
    averaged = [f for f, panel in zip(flows, panels, strict=True) if panel.NEEDS not in AT_ONCE]
    mean = _mean(averaged[0], window) if averaged else ""
    when = f"solutes at {at(beads.time, 4)}" if beads else ""
    how = "projection" if all(panel.NEEDS in AT_ONCE for panel in panels) else "mean"
    notes = [
        flows[0].note if of_sites else section.note(how),
        mean,
        note(panels, flows[0], clear),
        legend_of(panels),
    ]
    notes += [_few(case, panels, flows), when]
    if moving and bodies:
        length = min(view.traces or 0.0, bodies.time)
        paths = f", their paths of {at(length, 4, '')}" if length else ""
        notes += [f"bodies at {at(bodies.time, 4)}{paths}", moving.where(kind == "bodies")]
    notes.append(left_out(case, trajectory))
    for spheres in filter(None, (flow.spheres for flow in flows)):
        notes += [f"at {at(spheres.time, 4)}", spheres.remark, spheres.note]
    if any(panel.NEEDS == "headings" for panel in panels):
        notes.append(f"at {at(flows[0].time, 6)}")
    drawn = Canvas(panels, flows, reaches, shown, section, of_sites, notes=notes)
    drawn.show(flows, at(flows[0].time, 6) if of_sites else "")
    return drawn.figure


def _mean(flow: Flow, window: tuple[float, float] | None) -> str:
    """The time over which velocities and densities are means, and the standard error."""
    text = "mean of the run"
    if window is not None:
        text = f"mean of $t = {rounded(window[0], 6)}$ to {at(window[1], 6, '')}"
    error = flow.error if flow.error is None or flow.sure is None else flow.error[flow.sure]
    if error is not None and (error > 0).any():
        size = float(np.nanmedian(error[error > 0]))
        text += f"; median standard error of the velocity {size:.2g} {symbols('a/tau')}"
    return text


def _few(case: Case, panels: Sequence[Panel], flows: Sequence[Flow]) -> str:
    """The number of particles shown, if not all."""
    for panel, flow in zip(panels, flows, strict=True):
        found = flow.particles if flow.spheres is None else flow.spheres.places
        if panel.NEEDS in AT_ONCE and found is not None:
            shown = len(found)
            return f"{shown} of {case.particles} particles" if 0 < shown < case.particles else ""
    return ""
