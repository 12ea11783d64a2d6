"""Hops of atoms that have bonds to their neighbours, as several models have them."""

from collections.abc import Callable, Sequence

from mesokit.case.amounts import number
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.table import Process
from mesokit.seam.method import Row

EMPTY, ATOM = 0, 1


def hop(rate: Callable[[int], float]) -> Process:
    """A hop of an atom to an empty neighbour, at a rate by the number of its bonds."""
    return Process(
        "hop",
        (ATOM, EMPTY),
        lambda counts: rate(counts[ATOM]),
        ((ATOM,),),
        ((EMPTY,), ATOM),
    )


def diffusion_rows(kind: Kind, rate: float, flux: float) -> Sequence[Row]:
    """The diffusion coefficient of a lone atom that hops to each neighbour at a rate, and how often
    it hops while one atom comes down on a site."""
    diffusion = rate * kind.neighbours / (2 * kind.dimension)
    rows = [("diffusion coefficient", number(diffusion, "a^2/time"), "of a lone atom")]
    if flux and rate:
        hops = number(rate * kind.neighbours / flux)
        note = f"a lone atom hops {hops} times in the time in which one comes down on a site"
        rows.append(("D/F", number(diffusion / flux), note))
    return rows
