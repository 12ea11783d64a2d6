"""Molecules whose bonds are a list: dendrimers, networks and others of one piece."""

import functools
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.topology import Links, connectivity


def read_links(file: str, columns: int) -> tuple[tuple[int, ...], ...]:
    """Rows of so many bead numbers from a text file; # begins a comment. Raises ValueError."""
    try:
        text = Path(file).read_text(encoding="utf-8")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise ValueError(f"{file!r}: cannot be read: {reason}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{file!r}: expected a text file") from None
    rows = []
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if len(words) != columns or not all(word.isdecimal() for word in words):
            raise ValueError(
                f"{file!r}: line {number}: {line.strip()!r}: expected {columns} bead numbers from 0"
            )
        rows.append(tuple(int(word) for word in words))
    return tuple(rows)


def problem(links: Links, length: int, columns: int) -> str | None:
    """The error in rows of bead numbers, "" if there is none."""
    seen = set()
    for n, row in enumerate(links, 1):
        where = f"row {n}, {list(row)}"
        if len(row) != columns or len(set(row)) < columns:
            return f"{where}: expected {columns} different beads"
        if not all(0 <= bead < length for bead in row):
            return f"{where}: expected beads from 0 to {length - 1} (length = {length})"
        if min(row, row[::-1]) in seen:
            return f"{where}: said before"
        seen.add(min(row, row[::-1]))
    return None


def linked_parts(bonds: Links, length: int) -> int:
    """Into how many parts beads and bonds fall.

    >>> linked_parts(((0, 1), (2, 3)), 5)
    3
    """
    from scipy.sparse.csgraph import connected_components

    return int(connected_components(connectivity(bonds, length), directed=False)[0])


def spanning(bonds: Links, length: int) -> Links:
    """Bonds that lead from bead 0 to all others, each from one that is reached already.

    >>> spanning(((2, 1), (2, 0), (0, 1)), 3)
    ((0, 1), (0, 2))
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    rows, columns = np.array(bonds, np.int64).reshape(-1, 2).T
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(length, length)).tocsr()
    order, before = breadth_first_order(graph, 0, directed=False)
    return tuple((int(before[bead]), int(bead)) for bead in order[1:])


@component
class FreeMolecule(Molecule):
    """A molecule of solutes with these bonds and angles, as rows of its beads from 0."""

    linked: Many[tuple[int, ...]] = param((), doc="pairs of beads")
    bent: Many[tuple[int, ...]] = param((), doc="triples of beads")

    @property
    def bonds(self) -> Links:
        return self.linked

    @property
    def angles(self) -> Links:
        return self.bent

    @property
    def loops(self) -> int:
        """Bonds beyond those that hold it together."""
        return len(self.linked) - self.length + 1

    @functools.cached_property
    def tree(self) -> Links:
        """For every bead but the first a bond to one before it; () where some have none."""
        before = [self.length] * self.length
        for i, j in self.linked:
            before[max(i, j)] = min(before[max(i, j)], i, j)
        if any(one >= bead for bead, one in enumerate(before) if bead):
            return ()
        return tuple((before[bead], bead) for bead in range(1, self.length))

    def mean_square_bond(self, dimension: int, kT: float) -> float | None:
        """Mean over its bonds of the square length; with loops only of springs that feel no others:
        n - 1 vectors share the energy of all bonds."""
        square = super().mean_square_bond(dimension, kT)
        if square is None or self.loops == 0:
            return square
        if self.bond.spring() is None or self.bending is not None or self.pair is not None:
            return None
        return square * (self.length - 1) / len(self.linked)


def phantom(molecule: FreeMolecule, kT: float, normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places (n, d) of beads that are linked by springs, in equilibrium, from normal numbers.

    Modes of the connectivity matrix are independent, of variance kT/(k eigenvalue).
    """
    spring = molecule.bond.spring()
    assert spring is not None
    values, vectors = np.linalg.eigh(connectivity(molecule.bonds, molecule.length))
    spread = np.sqrt(kT / (spring.k * values[1:]))
    return np.asarray(vectors[:, 1:] @ (spread[:, None] * normal[1:]))
