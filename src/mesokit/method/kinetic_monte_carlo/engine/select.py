"""Which way of choosing fits a model: all draw the same law, and differ in what an event costs."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine import classes
from mesokit.method.kinetic_monte_carlo.engine.attempts import Attempts
from mesokit.method.kinetic_monte_carlo.engine.classes import classes_of
from mesokit.method.kinetic_monte_carlo.engine.linear import Linear
from mesokit.method.kinetic_monte_carlo.engine.tree import tree_of
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE, Grid, length_of

Selection = Literal["auto", "classes", "groups", "tree", "linear", "attempts"]
ENOUGH = 0.15  # of attempts that are not in vain, whatever the states: then they are the fastest
FEW = 64  # different rates, that are a class each


def selected(select: Selection, rates: NDArray[np.float64]) -> Selection:
    """What "auto" stands for, by the rates (m,) of a site by its surroundings."""
    if select != "auto":
        return select
    if rates.min() >= ENOUGH * rates.max():
        return "attempts"
    return "classes" if len(np.unique(rates[rates > 0])) <= FEW else "groups"


def choice_of(select: Selection, rates: NDArray[np.float64], grid: Grid, planes: int) -> Any:
    """An empty choice among the sites of a lattice, or among so many places of bonds at each."""
    memory, select = length_of(grid), selected(select, rates)
    if select == "attempts":
        sites = int(np.prod(grid.size))
        highest = float(rates.max())
        return Attempts(grid.size, sites, planes, memory, highest, rates / highest)
    if select == "tree":
        return tree_of(rates, memory * planes)
    if select == "linear":
        return Linear(np.zeros(memory * planes), rates)
    home = np.zeros(memory * planes // TILE, np.int32)
    return classes_of(rates, memory * planes, home, grouped=select == "groups")


def clear(choice: Any) -> None:
    """Forget the rates of all sites."""
    if isinstance(choice, classes.Classes):
        classes.clear(choice)
    for array in (getattr(choice, "sums", None), getattr(choice, "of", None)):
        if array is not None and not isinstance(choice, classes.Classes):
            array.fill(0)
