"""Panels side by side: parts that stay, and parts drawn anew in each frame of a film."""

import math
import textwrap
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl

from mesokit.report.caption import unbroken
from mesokit.report.flow import beads, body_panel
from mesokit.report.flow.data import Flow
from mesokit.report.flow.kinds import Panel
from mesokit.report.flow.layout import LINE, Box, layout
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale
from mesokit.report.flow.solids import Section
from mesokit.report.notebook import ShownFigure
from mesokit.report.style import STYLE, labelled

LOOK = STYLE | {
    "xtick.direction": "out",
    "ytick.direction": "out",
    "xtick.top": False,
    "ytick.right": False,
    "axes.labelsize": 10,
    "hatch.linewidth": 0.4,
}
NAMED = 3.0  # inches of a flat panel that has its name beside the colour bar
MARGIN, LETTERS = 0.12, 15.0  # of the note: inches at its sides, letters in an inch
MARK = 0.5  # inches of a mark in the legend, and of the room around it


def columns_of(names: Sequence[str], width: float) -> int:
    """Columns of a legend with a mark beside each name, in a figure so many inches wide."""
    widest = MARK + max(map(len, names), default=0) / LETTERS
    return min(max(int(width / widest), 1), max(len(names), 1))


class Canvas:
    """A figure with axes, labels, colour bars and solids, into which flows are drawn.

    Parameters
    ----------
    panels: what is drawn.
    flows: one for each panel, of the grids and axes that will be drawn.
    reaches: the largest number that each panel shows.
    region: part of the box in view.
    section: through its solids.
    stamp: whether a time is written above.
    notes: written below.
    """

    def __init__(
        self,
        panels: Sequence[Panel],
        flows: Sequence[Flow],
        reaches: Sequence[float],
        region: Region,
        section: Section,
        stamp: bool = False,
        notes: Sequence[str] = (),
    ) -> None:
        self.panels, self.reaches, self.region = panels, reaches, region
        self.section = section
        scales = [p.scale(f, r) for p, f, r in zip(panels, flows, reaches, strict=True)]
        self.view = section.view(region)
        bars = [scale is not None for scale in scales]
        width = layout(self.view.extent, bars, stamp).size[0] - 2 * MARGIN
        note = unbroken("; ".join(filter(None, notes)))
        lines = textwrap.wrap(note, max(12, int(width * LETTERS)), break_long_words=False)
        marks = [beads.keys(flow.beads) for flow in flows[:1] if flow.beads is not None]
        marks += [body_panel.keys(flow.bodies) for flow in flows[:1] if flow.bodies is not None]
        named = [name for _, names in marks for name in names]
        if named:
            rows = math.ceil(len(named) / columns_of(named, width))
            lines += [""] * rows  # room for the legend of the kinds
        self.place = layout(self.view.extent, bars, stamp, len(lines))
        with mpl.rc_context(LOOK):
            self.figure = ShownFigure(figsize=self.place.size)
            self.axes = [self._add(box) for box in self.place.panels]
            for number, (ax, scale) in enumerate(zip(self.axes, scales, strict=True)):
                if not self._anew(flows[number]):
                    section.draw(ax, self.view)
                self._frame(ax, number, flows[0].axes)
                if scale is not None:
                    self._bar(self.place.bars[number], scale)
            top = 1 - 0.06 / self.place.size[1]
            across, down = self.place.size
            for number, line in enumerate(reversed(lines)):
                self.figure.text(MARGIN / across, (0.06 + LINE * number) / down, line, size=8)
            if named:
                self._key([mark for some, _ in marks for mark in some], named)
            self.stamp = self.figure.text(0.5, top, "", ha="center", va="top")
        self.still = [set(ax.get_children()) for ax in self.axes]

    def _frame(self, ax: Any, number: int, names: tuple[str, str]) -> None:
        """Limits, labels at the left and lower edge of the figure, and a title among several."""
        (left, low), (right, high) = self.view.low, self.view.high
        ax.set(xlim=(left, right), ylim=(low, high), aspect="equal")
        box = self.place.panels[number]
        for axis, room in (("x", box.width / 0.45), ("y", box.height / 0.3)):
            ax.locator_params(axis=axis, nbins=min(6, max(1, int(room))), steps=[1, 2, 5, 10])
        if (number + 1) % self.place.columns:  # the last number would touch the first of the next
            ax.xaxis.get_major_locator().set_params(prune="upper")
        if number + self.place.columns >= len(self.panels):
            ax.set_xlabel(labelled(f"${names[0]}$", "a"))
        else:
            ax.tick_params(labelbottom=False)
        if number % self.place.columns == 0:
            ax.set_ylabel(labelled(f"${names[1]}$", "a"))
        else:
            ax.tick_params(labelleft=False)
        if len(self.panels) > 1:
            named = not self.place.flat or box.width > NAMED
            title = f"({'abcd'[number]}) {self.panels[number].TITLE * named}".rstrip()
            ax.set_title(title, loc="left", fontsize=10)

    def _key(self, marks: Sequence[Any], names: Sequence[str]) -> None:
        """A legend of the kinds of beads and bodies, at the lower right of the figure."""
        columns = columns_of(names, float(self.figure.get_size_inches()[0]) - 2 * MARGIN)
        where: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 0.0), "ncols": columns}
        self.figure.legend(marks, names, fontsize=8, borderaxespad=0.1, frameon=False, **where)

    def _add(self, box: Box) -> Any:
        width, height = self.figure.get_size_inches()
        return self.figure.add_axes(
            (box.left / width, box.bottom / height, box.width / width, box.height / height)
        )

    def _bar(self, box: Box, scale: Scale) -> None:
        ax = self._add(box)
        if not self.place.flat:
            _ticks(self.figure.colorbar(scale.mappable(), cax=ax, label=scale.label), scale, 6)
            return
        bar = self.figure.colorbar(scale.mappable(), cax=ax, orientation="horizontal")
        ax.xaxis.set_ticks_position("top")
        _ticks(bar, scale, 4)
        ax.tick_params(labelsize=8, pad=1, length=2)
        ax.text(-0.03, 0.5, scale.label, transform=ax.transAxes, ha="right", va="center", size=9)

    def _anew(self, flow: Flow) -> bool:
        """Whether solids are drawn anew in each frame, as plates move or solids are taken away."""
        return flow.spheres is not None and (bool(flow.spheres.plates) or self.section.opens)

    def show(self, flows: Sequence[Flow], stamp: str = "") -> None:
        """Draw flows, one for each panel, in place of those before."""
        self.stamp.set_text(stamp)
        rows = zip(self.panels, self.axes, self.still, flows, self.reaches, strict=True)
        with mpl.rc_context(LOOK):
            for panel, ax, still, flow, reach in rows:
                for artist in set(ax.get_children()) - still:
                    artist.remove()
                limits = ax.get_xlim(), ax.get_ylim()
                panel.draw(ax, flow, self.region, reach)
                if flow.spheres is not None and self._anew(flow):
                    spheres = flow.spheres
                    self.section.draw(ax, self.view, spheres.plates, spheres.time)
                if flow.bodies is not None and panel.NEEDS != "bodies":
                    body_panel.draw_over(ax, flow.bodies)
                if flow.beads is not None:
                    beads.draw(ax, flow.beads, self.region)
                ax.set(xlim=limits[0], ylim=limits[1])


def _ticks(bar: Any, scale: Scale, most: int) -> None:
    """A few round numbers, or names of the whole ones."""
    from matplotlib.ticker import FuncFormatter

    if scale.names:
        bar.set_ticks(range(len(scale.names)), labels=scale.names)
        bar.ax.minorticks_off()
        return
    if scale.logarithmic:
        return
    bar.ax.locator_params(nbins=most)
    if bar.orientation == "horizontal":  # a power beside the bar would stand over its numbers
        bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
