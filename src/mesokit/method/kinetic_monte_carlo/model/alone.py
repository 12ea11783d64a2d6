"""Sites alone: models in which nothing that happens depends on a neighbour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.model.protocol import Model
from mesokit.method.kinetic_monte_carlo.model.table import TableModel


def rates_alone(model: Model) -> NDArray[np.float64] | None:
    """Rates (s, s) of a site from each state to each other; None where neighbours matter."""
    if not isinstance(model, TableModel):
        return None
    processes, states = model.processes(), len(model.states())
    if any(one.neighbour is not None or one.counted for one in processes):
        return None
    found = np.zeros((states, states))
    for one in processes:
        found[one.site] += one.rate_at((), states)
    return found
