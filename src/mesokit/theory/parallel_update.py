"""Update of all contacts of a lattice at once (Jacobi), and where it diverges (derived here)."""

from typing import Literal

from mesokit.theory._check import one_of, positive

Lattice = Literal["chain", "square", "cubic", "triangular", "bcc", "fcc"]
# Largest eigenvalue over all waves q of the sum over bonds n of (1 - cos(q n)) n n: the matrix of
# relative velocities per force, over its value for one contact.
LARGEST = {"chain": 2.0, "square": 2.0, "cubic": 2.0, "triangular": 3.0, "bcc": 8 / 3, "fcc": 4.0}


def parallel_factor(lattice: Lattice, relaxation: float = 1.0) -> float:
    """What one update of all contacts at once makes of the worst error: 1 - w lambda.

    Equal grains without friction, all contacts closed: lambda is 2 in a chain, a square or cubic
    lattice (the error changes sign and never settles), 3 in a triangular one (it doubles), 8/3
    (bcc), 4 (fcc). Sweeps one contact after the other settle always.

    Parameters: `lattice` of grains that touch; `relaxation` w, the share of each change that is
    applied. Raises ValueError for another word or number. Exact in an infinite lattice.

    >>> [parallel_factor(lattice) for lattice in ("chain", "square", "triangular")]
    [-1.0, -1.0, -2.0]
    """
    one_of(tuple(LARGEST), lattice=lattice)
    positive(relaxation=relaxation)
    return 1 - relaxation * LARGEST[lattice]


def largest_relaxation(lattice: Lattice) -> float:
    """The relaxation below which updates of all contacts at once settle: 2/lambda.

    Parameters: `lattice` as `parallel_factor`.

    >>> round(largest_relaxation("triangular"), 6)
    0.666667
    """
    one_of(tuple(LARGEST), lattice=lattice)
    return 2 / LARGEST[lattice]
