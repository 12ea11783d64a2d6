"""Cases of kinetic Monte Carlo, for tests."""

from typing import Any

import numpy as np

from mesokit import Box, Case, Run, Simulation
from mesokit.method.kinetic_monte_carlo.section import Lattice


def lattice_case(
    size, model, kind="square", steps=0, seed=1, warmup=0, observe=(), trajectory=None, **lattice
):
    """A case on a lattice."""
    return Case(
        run=Run(steps=steps, seed=seed, warmup=warmup, method="kinetic-monte-carlo"),
        box=Box(list(size)),
        lattice=Lattice(kind=kind, model=model, **lattice),
        observe=observe,
        trajectory=trajectory,
    )


def lattice_engine(*size_and_model: Any, threads: int = 1, **given: Any) -> Any:
    """The engine of such a case, in its first state."""
    return Simulation(lattice_case(*size_and_model, **given), threads=threads).engine


def results_of(case: Any) -> Any:
    """Results of a run of it."""
    simulation = Simulation(case)
    simulation.run()
    return simulation.results


def near(comparisons: Any) -> set[str]:
    """Names of those comparisons that theory is known for, all of which must agree."""
    known = [one for one in comparisons if np.isfinite(one.expected) and np.isfinite(one.deviation)]
    assert {one.what: one.deviation for one in known if abs(one.deviation) > 4} == {}
    return {one.what for one in known}


class FakeLattice:
    """Sites as they are given, in place of an engine."""

    def __init__(self, sites: Any, time: float = 0.0) -> None:
        self.given, self.time, self.n = np.asarray(sites).ravel(), time, np.size(sites)

    def sites(self, ids: Any = None) -> Any:
        """States of all sites."""
        return self.given
