"""Which way of choosing fits a model: all draw the same law, and differ in what an event costs."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.attempts import Attempts
from mesokit.method.kinetic_monte_carlo.engine.classes import Classes, classes_of, rank
from mesokit.method.kinetic_monte_carlo.engine.classes import clear as clear_classes
from mesokit.method.kinetic_monte_carlo.engine.linear import Linear
from mesokit.method.kinetic_monte_carlo.engine.tree import Tree, tree_of
from mesokit.method.kinetic_monte_carlo.lattice.grid import TILE, Grid, length_of
from mesokit.method.kinetic_monte_carlo.model.exchange import Exchanges

Selection = Literal["auto", "classes", "groups", "tree", "linear", "attempts"]
ENOUGH = 0.15  # of attempts that are not in vain, whatever the states: then they are the fastest
ORDER = ("lists", "lengths", "highest", "refused")
FEW = 64  # different rates, that are a class each


def selected(select: Selection, rates: NDArray[np.float64]) -> Selection:
    """What "auto" stands for, by the rates (m,) of a site by its surroundings."""
    if select != "auto":
        return select
    if rates.min() >= ENOUGH * rates.max():
        return "attempts"
    return "classes" if len(np.unique(rates[rates > 0])) <= FEW else "groups"


def choice_of(
    select: Selection, model: Any, grid: Grid, home: NDArray[np.int32] | None = None
) -> Any:
    """An empty choice among the sites of a lattice, or among its bonds; `home` has the part of each
    tile, where there are several."""
    rates, memory, planes = model.rates, length_of(grid), planes_of(model, grid)
    if home is not None:
        grouped = selected(select, rates) not in ("attempts", "classes")
        return classes_of(rates, memory * planes, np.tile(home, planes), grouped)
    select = selected(select, rates)
    if select == "attempts":
        highest = float(rates.max())
        sites = int(np.prod(grid.size))
        return Attempts(grid.size, sites, planes, memory, highest, rates / highest)
    if select == "tree":
        return tree_of(rates, memory * planes)
    if select == "linear":
        return Linear(np.zeros(memory * planes), rates)
    one = np.zeros(memory * planes // TILE, np.int32)
    return classes_of(rates, memory * planes, one, grouped=select == "groups")


def planes_of(model: Any, grid: Grid) -> int:
    """Places at each site: one for the site, or one for each of its bonds."""
    return grid.neighbours if isinstance(model, Exchanges) else 1


def clear(choice: Any) -> None:
    """Let nothing be able to happen."""
    if isinstance(choice, Classes):
        clear_classes(choice)
    elif isinstance(choice, Tree):
        choice.sums.fill(0)
    elif isinstance(choice, Linear):
        choice.of.fill(0)


def order_of(choice: Any) -> dict[str, NDArray[Any]]:
    """What a choice has beside what follows from the states: the order of its lists."""
    return {name: getattr(choice, name) for name in ORDER} if isinstance(choice, Classes) else {}


def set_order(choice: Any, order: dict[str, NDArray[Any]]) -> None:
    """Go on with such an order."""
    if isinstance(choice, Classes):
        for name in ORDER:
            getattr(choice, name)[:] = order[name]
        rank(choice)
