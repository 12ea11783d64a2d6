"""Films of the flow: one picture after another, with the same colours in all."""

from __future__ import annotations

import base64
import numbers
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import one_of, show
from mesokit.errors import CaseError
from mesokit.io.atomic import replacing
from mesokit.report.caption import at
from mesokit.report.finish.origin import Origin, origin_of
from mesokit.report.finish.saving import foot_strip
from mesokit.report.flow.beads import BeadFrames, frames_of
from mesokit.report.flow.bodies import BodyFrames, bodies_of, left_out
from mesokit.report.flow.colouring import in_film
from mesokit.report.flow.encode import ENCODERS, Pixels
from mesokit.report.flow.kinds import Panel, legend_of, panels_of, usual
from mesokit.report.flow.noise import averaged, note, smooth, smoothing
from mesokit.report.flow.region import Region, View, frames_in, region_of, require_none
from mesokit.report.flow.site_frames import PER_DECADE, geometric, require_spacing
from mesokit.report.flow.site_kinds import SITE_KINDS, own_kind, site_picture
from mesokit.report.flow.site_picture import look
from mesokit.report.flow.solids import Section
from mesokit.report.flow.source import AT_ONCE, Source, choose_one, sources
from mesokit.report.progress import FilmReporter, Reporter
from mesokit.seam.in_units import of_case

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.io.trajectory_reader import TrajectoryReader
    from mesokit.report.flow.canvas import Canvas
    from mesokit.report.flow.data import Array
    from mesokit.seam.result import Result

SCALED = 24  # frames that the colours are chosen from
DPI = {".mp4": 160, ".gif": 100}
SLOWEST, FASTEST = 0.1, 100.0  # frames per second


@dataclass(frozen=True)
class Film:
    """A film that was written: its file, its frames, and how many of them are shown per second."""

    path: Path
    frames: int
    fps: float

    def __fspath__(self) -> str:
        return os.fspath(self.path)

    def _repr_html_(self) -> str:
        """The film itself, for notebooks."""
        data = base64.b64encode(self.path.read_bytes()).decode()
        if self.path.suffix.lower() == ".gif":
            return f'<img src="data:image/gif;base64,{data}">'
        return f'<video controls loop src="data:video/mp4;base64,{data}"></video>'


@of_case
def animate(
    case: Case,
    results: Mapping[str, Result],
    trajectory: TrajectoryReader | None,
    path: str | Path,
    kind: str | None = None,
    fps: float = 15.0,
    progress: Reporter | None = None,
    run: str = "",
    **choices: Any,
) -> Film:
    """Write a film with a picture for each frame of the observable flow-frames, or a trajectory.

    Parameters
    ----------
    case, results, trajectory: of the run.
    path: the file, which ends in .mp4 or .gif.
    kind: as for `picture`; unless said the first of these for which the run has kept frames: that
        of the method, such as "disks", "speed", "density", "particles".
    fps: frames shown per second.
    progress: reporter of the frames drawn (none unless said).
    run: its name, for the line below the film and the metadata of the file.
    choices: `region`, `window`, `axes`, `at`, `traces` and `colour`, as for `picture`; `average`,
        how many frames, one after another, each picture of a flow is the mean of: unless said as
        few as lift the flow above its noise, at most a quarter of them.

    Raises CaseError for an ending or a choice that there is not, RunError where the run kept no
    frames or the file cannot be written. Whatever goes wrong, an old file stays as it was.

    >>> import tempfile
    >>> from mesokit import Box, FlowFrames, Run, Simulation
    >>> simulation = Simulation(run=Run(steps=40), box=Box([8, 8]), observe=[FlowFrames(window=20)])
    >>> simulation.run()
    >>> simulation.animate(Path(tempfile.mkdtemp()) / "film.gif", "quiver").frames
    2
    """
    view, path = View(**choices), Path(path)
    ending = path.suffix.lower()
    if ending not in ENCODERS:
        raise CaseError(f"output = {show(str(path))}: expected a name that ends in .mp4 or .gif")
    if not isinstance(fps, numbers.Real) or not SLOWEST <= fps <= FASTEST:
        raise CaseError(f"fps = {show(fps)}: expected a number from {SLOWEST:g} to {FASTEST:g}")
    require_spacing(view.time)
    progress = progress or FilmReporter(quiet=True)
    if (kind or own_kind(case)) in SITE_KINDS:
        return _of_sites(
            kind or str(own_kind(case)), case, trajectory, view, path, fps, progress, run
        )
    require_none(view, ("states",))
    if kind is not None:
        panels_of(kind, case, view.colour)
    seen = view._replace(colour=in_film(trajectory, view.colour))
    found = sources(case, results, trajectory, seen)
    kind = kind or usual(case, found, "speed", in_time=True)
    panels = panels_of(kind, case, view.colour)
    source = choose_one(found, {panel.NEEDS for panel in panels}, kind)
    frames = frames_in(source.time, view.window)
    whole = np.intersect1d(frames, source.whole)
    frames = whole if len(whole) else frames
    of_sites = any(panel.NEEDS == "sites" for panel in panels)
    section = Section(case, source.axes, None if of_sites else view.at)
    first = source.flow(frames[:1])
    shown = region_of(view.region, first.axes, first.size)
    from mesokit.report.flow.canvas import Canvas

    number = _averaged(view.average, panels, source, frames, shown)
    means = np.lib.stride_tricks.sliding_window_view(frames, number)
    if view.time == "log":
        means = means[geometric(source.time[means[:, -1]], PER_DECADE)]
    some = np.unique(np.linspace(0, len(means) - 1, SCALED).astype(int))
    flows = [source.flow(mean) for mean in means[some]]
    width, clear = smoothing(panels, flows, shown)
    flows = [smooth(flow, width) for flow in flows]
    reaches = [max(panel.reach(flow, shown) for flow in flows) for panel in panels]
    how = "projection" if all(panel.NEEDS in AT_ONCE for panel in panels) else "mean"
    notes = [
        first.note if of_sites else section.note(how),
        note(panels, flows[0], clear),
        legend_of(panels),
    ]
    notes += [f"flow: mean of {number} frames"] if number > 1 else []
    notes += [first.spheres.note] if first.spheres else []
    solutes = frames_of(case, trajectory, source.axes)
    if solutes:
        first = replace(first, beads=solutes.at(source.time[means[0][-1]]))
    cut = section.plane, view.at is not None
    moving = bodies_of(case, trajectory, source.axes, *cut, view.traces)
    if moving:
        first = replace(first, bodies=moving.at(source.time[means[0][-1]]))
        notes.append(moving.where(kind == "bodies"))
        if how == "mean":
            notes.append(_smeared(moving, source.time, number))
    notes.append(left_out(case, trajectory))
    drawn = Canvas(panels, [first] * len(panels), reaches, shown, section, True, notes)
    drawn.figure.set_dpi(DPI[ending])
    progress.start(len(means), case.particles, "drawing")
    pictures = _pictures(drawn, source, means, progress, width, solutes, moving)
    return _write(path, drawn.figure, pictures, len(means), fps, progress, origin_of(case, run))


def _smeared(moving: BodyFrames, time: Array, number: int) -> str:
    """Caption: that bodies go farther than their size while the flow is averaged; "" if not."""
    if len(time) < 2:
        return ""
    gone = moving.gone(number * float(time[1] - time[0]))
    if not gone > 1.0:
        return ""
    return f"flow smeared: bodies go {gone:.2g} times their size in the time of a mean"


def _write(
    path: Path,
    figure: Any,
    pictures: Iterator[Pixels],
    number: int,
    fps: float,
    progress: Reporter,
    origin: Origin,
) -> Film:
    """Write pictures of a figure into a file."""
    ending = path.suffix.lower()
    foot = foot_strip(origin, figure.get_size_inches()[0], DPI[ending])
    whole_pictures = (np.concatenate([picture, foot]) for picture in pictures)
    try:
        with replacing(path) as temporary:
            temporary.touch()  # a folder that cannot be written to says so before long work
            ENCODERS[ending](temporary, whole_pictures, float(fps), origin.metadata(ending[1:]))
    finally:
        progress.finish()
    return Film(path, number, float(fps))


def _of_sites(
    kind: str,
    case: Case,
    trajectory: TrajectoryReader | None,
    view: View,
    path: Path,
    fps: float,
    progress: Reporter,
    run: str,
) -> Film:
    """Write a film of one of the kinds of pictures of sites. Raises CaseError for one that shows
    all times in one picture."""
    import matplotlib as mpl

    if not SITE_KINDS[kind].MOVES:
        moving = [name for name, each in SITE_KINDS.items() if each.MOVES]
        raise CaseError(
            f"kind = {show(kind)}: one picture of all times; expected {one_of(('sites', *moving))}"
        )
    drawn = site_picture(kind, case, trajectory, view)
    rows = np.arange(len(drawn.frames))
    if view.time == "log":
        rows = geometric(drawn.frames.time, PER_DECADE)
    drawn.figure.set_dpi(DPI[path.suffix.lower()])
    progress.start(len(rows), case.particles, "drawing")

    def pictures() -> Iterator[Pixels]:
        for done, row in enumerate(rows, start=1):
            with mpl.rc_context(look()):
                drawn.show(int(row))
                drawn.figure.canvas.draw()
            yield np.asarray(drawn.figure.canvas.buffer_rgba())[..., :3]
            progress.update(done)

    return _write(path, drawn.figure, pictures(), len(rows), fps, progress, origin_of(case, run))


def _averaged(
    given: int | None,
    panels: Sequence[Panel],
    source: Source,
    frames: NDArray[np.int64],
    region: Region,
) -> int:
    """The number of frames whose mean each picture shows. Raises CaseError for a wrong one."""
    if all(panel.NEEDS in AT_ONCE for panel in panels):
        if given not in (None, 1):
            raise CaseError(f"average = {show(given)}: particles are shown as they are at one time")
        return 1
    if given is None:
        return averaged(panels, source, frames, region)
    if not isinstance(given, int) or not 0 < given <= len(frames):
        raise CaseError(
            f"average = {show(given)}: expected a whole number of frames from 1 to {len(frames)}"
        )
    return given


def _pictures(
    drawn: Canvas,
    source: Source,
    means: NDArray[np.int64],
    progress: Reporter,
    width: float,
    solutes: BeadFrames | None,
    moving: BodyFrames | None,
) -> Iterator[Pixels]:
    """The pictures of a film, one by one: each the mean of a row of frames, at its end."""
    canvas: Any = drawn.figure.canvas
    for done, mean in enumerate(means, start=1):
        now = source.time[mean[-1]]
        beads = solutes.at(now) if solutes else None
        bodies = moving.at(now) if moving else None
        flow = replace(smooth(source.flow(mean), width), beads=beads, bodies=bodies)
        stamp = at(now)
        if flow.spheres is not None and flow.spheres.remark:
            stamp += f", {flow.spheres.remark}"
        drawn.show([flow] * len(drawn.panels), stamp)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[..., :3]
        progress.update(done)
