"""A number for each bin as a colour."""

from typing import Any

from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale


def heat_map(ax: Any, flow: Flow, values: Array, region: Region, scale: Scale) -> None:
    """Colour the bins of `values` (nx, ny) that overlap with the region; nan stays white."""
    x, y = region.bins(flow.size, values.shape)
    dx, dy = spacing(flow, values)
    ax.imshow(
        values[x, y].T,
        origin="lower",
        cmap=scale.colours,
        vmin=scale.low,
        vmax=scale.high,
        extent=(x.start * dx, x.stop * dx, y.start * dy, y.stop * dy),
        interpolation="nearest",
    )
