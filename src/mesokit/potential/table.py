"""A pair potential from a table."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import FileName, FromContents, component, param, show, tag
from mesokit.errors import CaseError
from mesokit.potential.protocol import Pair, breaks, central
from mesokit.potential.table_file import rows_of
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import address, real

Floats = NDArray[np.float64]
INTERVALS = 4096  # in the square of the distance, of the table that compiled code reads
TABLES: dict[str, Floats] = {}  # such tables, for good: kernels know them by address


@component
class Table(FromContents, Pair):
    """U(r) from a text file with rows of r, U and, if known, the force F = -dU/dr.

    Distances in cells rise from row to row, the last is the cut-off; energies are in units of the
    case, kT where that is 1. Lines may end in a comment (#). Tables of LAMMPS are read as they are.
    Between the rows U is a cubic spline, or, where there are forces, the cubics that have both;
    nearer than the first row the push (the force over the distance) is that of the first row.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "soft.txt"
    >>> soft = Table.from_function(lambda r: 5 * (1 - r) ** 2, file, start=0.1, end=1.0)
    >>> soft.reach
    1.0
    """

    rule: Literal["table"] = tag("table")
    file: FileName = param(doc="text file with rows of r, U and maybe F, relative to the case")
    section: str | None = param(
        None, doc="keyword of one of several tables in a file of LAMMPS (the first unless said)"
    )
    shift: bool = param(True, doc="whether the energy is shifted to 0 at the cut-off")

    def __post_init__(self) -> None:
        try:
            _ = self.rows
        except CaseError as error:
            raise ValueError(str(error)) from None

    @classmethod
    def from_function(
        cls,
        energy: Callable[[Floats], Any],
        file: str | Path,
        start: float,
        end: float,
        rows: int = 2000,
    ) -> Table:
        """Write what a function says to a file, which is then that of the potential.

        Parameters
        ----------
        energy : function of distances
            Takes an array of distances in cells, gives the energies.
        file : path
            A text file to write.
        start, end : float
            First and last distance.
        rows : int
            Of the table, at equal distances.

        Raises
        ------
        CaseError
            For what is no such function, and a file that cannot be written.
        """
        if not 0 < start < end < math.inf or rows < 2:
            raise CaseError(
                f"Table: start = {start}, end = {end}, rows = {rows}: expected 0 < start < end and "
                "two rows at least"
            )
        r = np.linspace(start, end, rows)
        try:
            table = np.column_stack([r, np.broadcast_to(np.asarray(energy(r), float), r.shape)])
        except (TypeError, ValueError):
            raise CaseError("Table: energy: expected a number for each distance") from None
        try:
            np.savetxt(file, table, "%.17g", header="r U")
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            name = show(str(file), 500)
            raise CaseError(f"Table: file = {name}: cannot be written: {reason}") from None
        return cls(file=str(file))

    @functools.cached_property
    def rows(self) -> Floats:
        """What the file holds: r, U and maybe F. Raises CaseError."""
        try:
            return rows_of(self.contents.decode(), self.section)
        except UnicodeDecodeError:
            raise self.wrong("expected a text file") from None
        except ValueError as error:
            raise self.wrong(str(error)) from None

    @property
    def reach(self) -> float:
        return float(self.rows[-1, 0])

    @property
    def diameter(self) -> float:
        """How large a bead is: where the energy comes down to 1."""
        r, energy = self.rows[:, :2].T
        high = np.flatnonzero(energy - energy[-1] > 1.0)
        return float(r[high[-1]] if len(high) else r[0])

    def mixed(self, other: Pair) -> Table | None:
        """The same table, where both hold the same; there is no rule to mix others."""
        if not isinstance(other, Table) or self.shift != other.shift:
            return None
        return self if np.array_equal(self.rows, other.rows) else None

    @functools.cached_property
    def cubics(self) -> Floats:
        """Coefficients (intervals, 4) of U in equal intervals of the squared distance, rising."""
        from scipy.interpolate import CubicHermiteSpline, CubicSpline

        r, energy, *force = self.rows.T
        lift = energy[-1] if self.shift else 0.0
        if force:
            curve = CubicHermiteSpline(r, energy - lift, -force[0])
        else:
            curve = CubicSpline(r, energy - lift)
        squares = np.linspace(r[0] ** 2, r[-1] ** 2, INTERVALS + 1)
        places = np.clip(np.sqrt(squares), r[0], r[-1])
        value = curve(places)
        slope = curve(places, 1) / (2.0 * places) * (squares[1] - squares[0])
        rise, first, last = np.diff(value), slope[:-1], slope[1:]
        third = first + last - 2 * rise
        return np.column_stack([value[:-1], first, rise - first - third, third])

    def kernel(self) -> Cubics:
        """Parameters for the scalar function below."""
        near, far = self.rows[0, 0] ** 2, self.rows[-1, 0] ** 2
        digest = hashlib.sha256(self.cubics.tobytes()).hexdigest()
        return Cubics(
            address(TABLES.setdefault(digest, self.cubics)), near, far, INTERVALS / (far - near)
        )


class Cubics(NamedTuple):
    """Where the coefficients are, squares of the first and the last distance, and intervals per
    square of a cell."""

    table: int
    near: float
    far: float
    per: float


@scalar
def number(table, index):
    """A number of a table; compiled, so that it may be asked from plain Python too."""
    return real(table, index)


@central.register(Cubics)
def _(potential, square):
    place = min(max((square - potential.near) * potential.per, 0.0), INTERVALS - 1e-9)
    first = int(place)
    t, c = place - first, 4 * first
    b, quadratic, cubic = (
        number(potential.table, c + 1),
        number(potential.table, c + 2),
        number(potential.table, c + 3),
    )
    energy = number(potential.table, c) + t * (b + t * (quadratic + t * cubic))
    force_over_r = -2.0 * potential.per * (b + t * (2.0 * quadratic + t * 3.0 * cubic))
    if square < potential.near:
        energy -= 0.5 * force_over_r * (square - potential.near)
    inside = square < potential.far
    return (energy if inside else 0.0), (force_over_r if inside else 0.0)


@breaks.register(Cubics)
def _(potential, square):
    return False
