"""Hard spheres for the tests of their laws."""

import numpy as np
from scipy.spatial import cKDTree

from mesokit import Box, Case, HardSpheres, Run, Simulation


def gas(size, steps=0, walls=(), observe=(), given=None, **spheres):
    """A simulation of hard spheres, not run; `given` are arrays to start from."""
    case = Case(
        run=Run(steps, method="event-driven"),
        box=Box(size),
        walls=list(walls),
        observe=list(observe),
        spheres=HardSpheres(**spheres),
    )
    return Simulation(case, **(given or {}))


def smallest_gap(engine, reach=1.5):
    """Between the surfaces of any two, in a periodic box."""
    box, places, diameters = engine.box, engine.positions(), engine.diameters()
    pairs = cKDTree(places, boxsize=box).query_pairs(reach, output_type="ndarray")
    way = places[pairs[:, 0]] - places[pairs[:, 1]]
    way -= box * np.rint(way / box)
    reaches = 0.5 * (diameters[pairs[:, 0]] + diameters[pairs[:, 1]])
    return float((np.linalg.norm(way, axis=1) - reaches).min())


def same(one, other):
    """Whether two engines hold the same bits."""
    first, second = one.state(), other.state()
    return all(np.array_equal(first[name], second[name]) for name in first)
