"""Bodies of all shapes that move in small fluids."""

import numpy as np

from mesokit import Rectangle, Sphere
from mesokit.method.mpcd.body.capsule import CapsuleBody
from mesokit.method.mpcd.body.cuboid import CuboidBody
from mesokit.method.mpcd.body.disk import DiskBody
from mesokit.method.mpcd.body.ellipse import EllipseBody
from mesokit.method.mpcd.body.rectangle import RectangleBody
from mesokit.method.mpcd.body.sphere import SphereBody
from mesokit.method.mpcd.body.spheroid import SpheroidBody
from mesokit.method.mpcd.body.union import UnionBody

L_SHAPE = (Rectangle(centre=(0, 0), size=(6, 2)), Rectangle(centre=(2, 2.5), size=(2, 3)))
DUMBBELL = (Sphere(centre=(-1.6, 0, 0), radius=1.7), Sphere(centre=(1.4, 0, 0), radius=1.3))
PLANAR = {
    "disk": (DiskBody, {"radius": 2}),
    "ellipse": (EllipseBody, {"size": (6, 3)}),
    "capsule": (CapsuleBody, {"length": 7, "radius": 1.5}),
    "rectangle": (RectangleBody, {"size": (5, 3)}),
    "union": (UnionBody, {"parts": L_SHAPE}),
}
SPATIAL = {
    "sphere": (SphereBody, {"radius": 2}),
    "spheroid": (SpheroidBody, {"half_length": 3, "radius": 1.5}),
    "capsule": (CapsuleBody, {"length": 6, "radius": 1.5}),
    "cuboid": (CuboidBody, {"size": (4, 3, 3)}),
    "union": (UnionBody, {"parts": DUMBBELL}),
}
SHAPES = [(name, 2) for name in PLANAR] + [(name, 3) for name in SPATIAL]
SIZES = {2: (16, 18), 3: (12, 13, 12)}


def body(name, d, **keys):
    """A body of a shape, with other keys."""
    kind, own = (PLANAR if d == 2 else SPATIAL)[name]
    return kind(**own, **keys)


# One of each sort of shape: a ball, one that turns, one of several parts.
SOME = {
    2: (body("disk", 2), body("rectangle", 2, density=20), body("union", 2)),
    3: (body("sphere", 3), body("spheroid", 3, density=20), body("union", 3)),
}
ROOM = {2: (26, 24), 3: (18, 17, 16)}


def blocks(samples, number=30):
    """Means of blocks of samples in time."""
    whole = np.asarray(samples)[: len(samples) // number * number]
    return whole.reshape(number, -1).mean(axis=1)


def pressures_in_time(fluid):
    """Parts of the pressure of a 2D fluid (300, parts), in each third step after the first 50."""
    fluid.advance(50)
    pressures = []
    for _ in range(300):
        fluid.advance(2)
        fluid.advance(1, measure=["stress"])
        pressures.append([-np.trace(part) / 2 for part in fluid.stress.values()])
    return pressures
