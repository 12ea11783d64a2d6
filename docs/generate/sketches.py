"""Draw the sketches of the guide: what walls do to particles, by the functions that runs use."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("Agg")  # no screen

import matplotlib.pyplot as plt
from matplotlib.patches import Rectangle

from mesokit import Box, Disk, Plates, Surface
from mesokit.geometry.protocol import Chance, first_hit, happens, rebound, unmet
from mesokit.geometry.solids.clearance import centres
from mesokit.geometry.solids.solids import Solids
from mesokit.report.style import COLOURS, STYLE

IMAGES = Path(__file__).resolve().parents[1] / "images"
SOLID, SEEN = "0.8", "0.35"
REAL, VIRTUAL = COLOURS[:2]

# --- bounce-back ----------------------------------------------------------------------------------

RULES = {
    "no-slip": ("turned back", "v' = -v"),
    "slip": ("mirrored", "v' = v - 2 (v·n) n"),
    "diffuse": ("sent out at random", "v' drawn at the wall's kT"),
}
ASIDE = {  # of the names of both velocities
    "no-slip": ((0.1, 0.05), (-0.38, -0.22)),
    "slip": ((-0.28, -0.28), (-0.42, 0.02)),
    "diffuse": ((-0.28, -0.28), (0.12, -0.1)),
}
START, VELOCITY, TIME = np.array([0.7, 1.45]), np.array([1.3, -1.45]), 1.75
SHOWN_DRAW, DRAWS = 10, 60


def hit_of(rule: str, number: int) -> tuple[Any, Any, float]:
    """Where the flight hits the lower plate, the velocity after it, and the time that is left."""
    solids = Solids([Plates("y", lower=Surface(rule))], Box([8, 8]))  # which holds the memory
    solid = solids.kernel
    place, v, left = (*START,), (*VELOCITY,), TIME
    contact = unmet(solid)
    while left == TIME or not happens(solid, contact):  # some contacts are the end of what is seen
        time, contact = first_hit(solid, place, v, (0.0, 0.0), left, contact)
        place, left = tuple(np.array(place) + time * VELOCITY), left - time
    chance = Chance(np.uint64(7), np.uint64(1), number, 0, 1.0)
    place, after = rebound(solid, contact, place, v, chance)
    return np.array(place), np.array(after), left


def arrow(
    ax: Any, start: Any, by: Any, colour: str, label: str, aside: tuple[float, float]
) -> None:
    """A velocity, with its name."""
    style = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", start + by, start, arrowprops=style)
    ax.text(*(start + 0.6 * by + aside), label, color=colour, fontsize=12, style="italic")


def bounce_back() -> Any:
    """The flight of one timestep at a plate, by each rule of surfaces."""
    figure, axes = plt.subplots(1, 3, figsize=(7.6, 2.8), layout="constrained")
    for letter, (rule, (words, formula)), ax in zip("abc", RULES.items(), axes, strict=True):
        ax.add_patch(Rectangle((-1, -1), 6, 1, facecolor=SOLID, edgecolor="none", hatch="//"))
        ax.axhline(0, color="black", lw=1.5)
        place, after, left = hit_of(rule, SHOWN_DRAW)
        aside = 0.08 * np.array([VELOCITY[1], -VELOCITY[0]]) / np.hypot(*VELOCITY)
        aside = aside if rule == "no-slip" else 0 * aside  # there and back on the same line
        for number in range(DRAWS) if rule == "diffuse" else ():
            _, other, _ = hit_of(rule, number)
            ax.plot(*np.transpose([place, place + 0.45 * other]), color="0.72", lw=0.6, zorder=1)
        end = place + left * after
        ax.plot(*np.transpose([START - aside, place - aside]), color=REAL, lw=1.2)
        ax.plot(*np.transpose([place + aside, end + aside]), color=VIRTUAL, lw=1.2, ls="--")
        ax.plot(*(START - aside), "o", mfc="white", mec=REAL, ms=7)
        ax.plot(*(end + aside), "o", color=VIRTUAL, ms=7)
        ax.plot(*place, "o", color="black", ms=3)
        ax.annotate("", place + (0, 0.62), place, arrowprops={"arrowstyle": "->", "color": SEEN})
        ax.text(place[0] - 0.24, 0.5, "n", color=SEEN, style="italic")
        beside, away = ASIDE[rule]
        arrow(ax, START - aside, 0.42 * VELOCITY, REAL, "v", beside)
        arrow(ax, end + aside, 0.42 * after, VIRTUAL, "v'", away)
        ax.set_xlabel(f"{words}\n{formula}", fontsize=10)
        ax.set_title(f"({letter})  {rule}", fontsize=11, loc="left")
        ax.set(xlim=(0, 4.1), ylim=(-0.45, 2.75), aspect="equal", xticks=[], yticks=[])
    return figure


# --- virtual particles ----------------------------------------------------------------------------

SHIFT, DENSITY, SHOWN = (0.35, -0.4), 6.0, (7, 6)
SPAN = {"arrowstyle": "<->", "color": "black", "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
BEHIND = {"facecolor": "white", "edgecolor": "none", "pad": 1}


def particles_about(ax: Any, wall: Any, rng: np.random.Generator) -> None:
    """A wall, the cells that it cuts, and the particles of the fluid and of the wall in them."""
    width, height = SHOWN
    solids = Solids([wall], Box([12, 12]))
    fine = np.stack(np.meshgrid(np.linspace(0, width, 281), np.linspace(-1, height, 281)), -1)
    clear = solids.distance(fine).reshape(281, 281)
    ax.contourf(*np.moveaxis(fine, -1, 0), clear, [-99, 0], colors=[SOLID])
    ax.contour(*np.moveaxis(fine, -1, 0), clear, [0], colors="black", linewidths=1.5)
    # the first cell of the grid lies below 0 where it is shifted that way
    middle = centres((width + 2, height + 2), tuple(1.0 - s for s in SHIFT))
    part = solids.open_part(middle, 1.0)
    for place in middle - 0.5:
        ax.add_patch(Rectangle(place, 1, 1, fill=False, ec="0.55", lw=0.6))
    cut = (part > 1e-9) & (part < 1 - 1e-9)
    for place in middle[cut] - 0.5:
        ax.add_patch(Rectangle(place, 1, 1, fill=False, ec="black", lw=1.4, zorder=3))
        drawn = place + rng.random((rng.poisson(DENSITY), 2))
        ax.plot(*drawn[solids.distance(drawn) < 0].T, "o", mfc="white", mec=VIRTUAL, ms=3.6)
    number = rng.poisson(DENSITY * width * (height + 1))
    r = rng.random((number, 2)) * (width, height + 1) - (0, 1)
    ax.plot(*r[solids.distance(r) > 0].T, "o", color=REAL, ms=2.6)
    ax.set(aspect="equal", xticks=[], yticks=[])


def virtual_particles() -> Any:
    """Cells that a plate and a disk cut, when the grid is shifted."""
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.7), layout="constrained")
    rng = np.random.default_rng(4)
    particles_about(axes[0], Plates("y"), rng)
    axes[0].set(xlim=(0, 6), ylim=(-0.75, 4.2))
    axes[0].annotate("", (0.18, SHIFT[1]), (0.18, 0), arrowprops=SPAN)
    axes[0].text(0.05, 0.12, "shift", fontsize=9, bbox=BEHIND)
    particles_about(axes[1], Disk([3.1, 1.75], 1.45), rng)
    axes[1].set(xlim=(0, 6), ylim=(-0.75, 4.2))
    axes[0].set_title("(a)  plate, grid shifted by 0.4 of a cell", fontsize=11, loc="left")
    axes[1].set_title("(b)  disk", fontsize=11, loc="left")
    handles = [
        plt.Line2D([], [], marker="o", ls="", color=REAL, ms=4, label="particle of the fluid"),
        plt.Line2D(
            [], [], marker="o", ls="", mfc="white", mec=VIRTUAL, ms=5, label="virtual particle"
        ),
        Rectangle((0, 0), 1, 1, fill=False, ec="black", lw=1.4, label="cell that is cut"),
        Rectangle((0, 0), 1, 1, facecolor=SOLID, ec="black", lw=1.0, label="solid"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


if __name__ == "__main__":
    with plt.rc_context(STYLE):
        for draw in (bounce_back, virtual_particles):
            draw().savefig(IMAGES / f"{draw.__name__}.png", dpi=170, metadata={"Software": None})
