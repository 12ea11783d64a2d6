"""Cases of kinetic Monte Carlo, for tests."""

from typing import Any

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
