"""How the beads of a molecule are linked: bonds, and angles between bonds, as bead numbers.

A bond leads from a bead that is placed to one that is not, but for the last of a ring.
"""

import itertools
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Topology = Literal["chain", "ring", "star", "free"]
Links = tuple[tuple[int, ...], ...]


def bonds(topology: Topology, length: int, arms: int = 1) -> Links:
    """Pairs of beads: along a chain, round a ring, or from the centre of a star along each arm.

    >>> bonds("ring", 3), bonds("star", 5, 2)
    (((0, 1), (1, 2), (2, 0)), ((0, 1), (1, 2), (0, 3), (3, 4)))
    """
    if topology == "free":
        return ()
    if topology == "star":
        arm = (length - 1) // arms
        return tuple((0 if k % arm == 0 else k, k + 1) for k in range(arm * arms))
    links = tuple((k, k + 1) for k in range(length - 1))
    return links + (((length - 1, 0),) if topology == "ring" else ())


def angles(topology: Topology, length: int, arms: int = 1) -> Links:
    """Triples of beads, the second of which two bonds in a row share; none across a star's centre.

    >>> angles("chain", 4), angles("star", 5, 2)
    (((0, 1, 2), (1, 2, 3)), ((0, 1, 2), (0, 3, 4)))
    """
    links = bonds(topology, length, arms)
    return tuple((a, b, d) for a, b in links for c, d in links if b == c)


def pairs(length: int) -> Links:
    """All pairs of beads.

    >>> pairs(3)
    ((0, 1), (0, 2), (1, 2))
    """
    return tuple(itertools.combinations(range(length), 2))


def connectivity(links: Links, length: int) -> NDArray[np.float64]:
    """Matrix (length, length) of the force constants of springs between beads, each of 1."""
    matrix = np.zeros((length, length))
    for i, j in links:
        matrix[[i, j], [i, j]] += 1.0
        matrix[[i, j], [j, i]] -= 1.0
    return matrix


def stiffest_mode(links: Links, length: int) -> float:
    """Square of the highest frequency of beads of mass 1 and springs of force constant 1.

    >>> round(stiffest_mode(bonds("chain", 2), 2), 9), round(stiffest_mode(bonds("ring", 4), 4), 9)
    (2.0, 4.0)
    """
    return float(np.linalg.eigvalsh(connectivity(links, length))[-1])
