"""How far to average a velocity, over bins or frames, so that it exceeds its thermal noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.report.caption import in_cells
from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region
from mesokit.report.flow.smooth import smoothed

if TYPE_CHECKING:
    from mesokit.report.flow.kinds import Panel
    from mesokit.report.flow.source import Source

CLEAR = 2.5  # times the noise: what a picture should show
WIDTHS = (0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0)  # of smoothing, in bins
PART, TRIED = 4, 6  # a mean takes at most a fourth of the frames; frames that are tried


def smooth(flow: Flow, width: float) -> Flow:
    """The flow with its velocity, and the sample of its noise, averaged over about so many bins.

    Parameters
    ----------
    flow: a picture's flow.
    width: in bins, 0 to leave the flow as it is.

    >>> velocity = np.zeros((8, 8, 2))
    >>> velocity[4, 4] = 1.0
    >>> flow = Flow(("x", "y"), (8.0, 8.0), 2, velocity=velocity)
    >>> float(smooth(flow, 1.0).speed.max()) < 0.3
    True
    """
    if not width or flow.velocity is None:
        return flow

    def mean(values: Array) -> Array:
        return np.stack([smoothed(v, flow.periodic, width) for v in np.moveaxis(values, -1, 0)], -1)

    noise = None if flow.noise is None else mean(flow.noise)
    return replace(flow, velocity=mean(flow.velocity), noise=noise, smoothing=width)


def smoothing(panels: Sequence[Panel], flows: Sequence[Flow], region: Region) -> tuple[float, bool]:
    """Least width in bins that lifts velocities above noise in all panels, and whether it does.

    The widest is one eighth of the shorter side of the map, and at most WIDTHS[-1].
    """
    known = _known(flows)
    if not known:
        return 0.0, True
    assert known[0].velocity is not None
    widest, width = max(1.0, min(known[0].velocity.shape[:2]) / 8), 0.0
    for width in (w for w in WIDTHS if w <= widest):
        if _clear(panels, [smooth(flow, width) for flow in known], region):
            return width, True
    return width, False  # the widest


def averaged(
    panels: Sequence[Panel], source: Source, frames: NDArray[np.int64], region: Region
) -> int:
    """How many frames one picture of a film averages over: as few as lift the flow above its noise.

    At most a quarter of them, so that the film still moves.
    """
    most, number = max(1, len(frames) // PART), 1
    while number < most:
        ends = np.unique(np.linspace(number, len(frames), TRIED).astype(int))
        flows = _known([source.flow(frames[end - number : end]) for end in ends])
        if not flows or _clear(panels, flows, region):
            break
        number = min(2 * number, most)
    return number


def _known(flows: Sequence[Flow]) -> list[Flow]:
    """Flows with a velocity and a sample of its noise."""
    return [flow for flow in flows if flow.velocity is not None and flow.noise is not None]


def _clear(panels: Sequence[Panel], flows: Sequence[Flow], region: Region) -> bool:
    """Whether each panel of a velocity has a median range of `CLEAR` times that of the noise."""
    return all(
        np.median([panel.reach(flow, region) for flow in flows])
        >= CLEAR * np.median([panel.reach(replace(f, velocity=f.noise), region) for f in flows])
        for panel in panels
        if panel.NEEDS == "velocity"
    )


def note(panels: Sequence[Panel], flow: Flow, clear: bool) -> str:
    """Words for the caption: the width of smoothing, and what would help where noise remains."""
    if flow.velocity is None or all(panel.NEEDS != "velocity" for panel in panels):
        return ""
    said = []
    if flow.smoothing:
        width = flow.smoothing * max(spacing(flow, flow.velocity))
        said.append(f"velocity smoothed over ${width:.3g}{in_cells()}$")
    if not clear:
        fine = " and bins_per_cell = 1" * (min(spacing(flow, flow.velocity)) < 1)
        said.append(
            f"hardly above the noise: a longer run, or flow-frames with a longer window{fine}, "
            "would show more"
        )
    return "; ".join(said)
