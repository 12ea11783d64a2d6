"""Disks and the forces between them, for the scripts beside this one."""

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection


def draw_disks(ax, engine, colours="#dde5ee"):
    """Disks of an engine, to scale."""
    size = engine.diameters()
    look = {"units": "xy", "offsets": engine.positions(), "offset_transform": ax.transData}
    ax.add_collection(
        EllipseCollection(
            size, size, 0 * size, facecolors=colours, edgecolors="0.45", linewidths=0.2, **look
        )
    )


def draw_forces(ax, engine, widest, largest=None):
    """A line between two grains that touch, `widest` points wide for the `largest` force.

    The largest force is five times the mean unless said, and no line is wider.
    """
    found, places = engine.contacts(), engine.positions()
    forces = found.normal_forces
    largest = 5 * forces.mean() if largest is None else largest
    one, other = found.pairs.T
    ends = np.where(found.at_walls[:, None], found.places, places[other])
    near = np.linalg.norm(ends - places[one], axis=1) < 2 * engine.diameters().max()
    lines = np.stack([places[one], ends], axis=1)[near]
    wide = widest * np.minimum(forces[near] / largest, 1)
    ax.add_collection(LineCollection(lines, linewidths=wide, colors="#12284c", zorder=3))
