"""A pair potential from a table: columns of distance, energy and, if there is one, force."""

from __future__ import annotations

import functools
import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, show, tag
from mesokit.case.given.file import FileName, FromContents
from mesokit.errors import CaseError
from mesokit.potential.protocol import Pair, central
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import address, real

FEWEST = 4  # rows of a table
OFF = 0.2  # of the change of the energy from row to row, by which the force may miss it


def rows_of(text: str, section: str | None = None) -> Floats:
    """The rows (n, 2 or 3) of r, U and maybe F. Raises ValueError, with the line.

    A file of plain columns, or one of LAMMPS, with sections: a keyword, a line `N ...`, and rows of
    a number, r, U and F. Of several sections `section` names one (the first unless said).

    >>> rows_of("# r U\\n1 4\\n2 1\\n3 0.2\\n4 0")
    array([[1. , 4. ],
           [2. , 1. ],
           [3. , 0.2],
           [4. , 0. ]])
    """
    here: str | None = None
    sections: dict[str | None, list[tuple[int, list[float]]]] = {}
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].split()
        if not words or words[0] == "N":
            continue
        try:
            row = [float(word) for word in words]
        except ValueError:
            if len(words) > 1:
                raise ValueError(f"line {number}: expected numbers, not {line.strip()!r}") from None
            here = words[0]
            continue
        sections.setdefault(here, []).append((number, row[1:] if here is not None else row))
    if not sections:
        raise ValueError("expected rows of r, U and maybe F; there are none")
    if section is not None and section not in sections:
        known = ", ".join(str(name) for name in sections if name is not None) or "none"
        raise ValueError(f"no section {section!r}; there are {known}")
    rows = sections[next(iter(sections)) if section is None else section]
    width = len(rows[0][1])
    for (number, row), (_, before) in zip(rows, [(0, [0.0]), *rows], strict=False):
        start = f"line {number}:"
        if len(row) != width or width not in (2, 3):
            raise ValueError(f"{start} {len(row)} numbers; expected r, U and maybe F in each row")
        if not np.isfinite(row).all():
            raise ValueError(f"{start} expected finite numbers")
        if row[0] <= before[0]:
            above = f"more than the {before[0]:g} before" if before[0] else "a distance above 0"
            raise ValueError(f"{start} r = {row[0]:g}; expected {above}")
    if len(rows) < FEWEST:
        raise ValueError(f"{len(rows)} rows; expected {FEWEST} or more")
    values = np.array([row for _, row in rows])
    if width == 2:
        return values
    r, energy, force = values.T  # which must be minus the slope of the energy
    work = -np.diff(r) * (force[1:] + force[:-1]) / 2.0
    change = np.diff(energy)
    off = np.abs(work - change)
    allowed = OFF * np.maximum(np.abs(work), np.abs(change)) + OFF * np.median(np.abs(change))
    worst = int(np.argmax(off / np.maximum(allowed, 1e-300)))
    if off[worst] > allowed[worst]:
        raise ValueError(
            f"line {rows[worst + 1][0]}: from the row before U changes by {change[worst]:g}, by "
            f"the forces it would be {work[worst]:g}; expected F = -dU/dr"
        )
    return values


Floats = NDArray[np.float64]
INTERVALS = 4096  # in the square of the distance, of the table that compiled code reads
TABLES: dict[str, Floats] = {}  # such tables, for good: kernels have their addresses


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
        """Content of the file: r, U and maybe F. Raises CaseError."""
        try:
            return rows_of(self.contents.decode(), self.section)
        except ValueError as error:
            decoded = not isinstance(error, UnicodeDecodeError)
            raise self.wrong(str(error) if decoded else "expected a text file") from None

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
        level = energy - lift
        curve = CubicHermiteSpline(r, level, -force[0]) if force else CubicSpline(r, level)
        squares = np.linspace(r[0] ** 2, r[-1] ** 2, INTERVALS + 1)
        places = np.clip(np.sqrt(squares), r[0], r[-1])
        value = curve(places)
        slope = curve(places, 1) / (2.0 * places) * (squares[1] - squares[0])
        rise, first, last = np.diff(value), slope[:-1], slope[1:]
        third = first + last - 2 * rise
        return np.column_stack([value[:-1], first, rise - first - third, third])

    def kernel(self) -> Cubics:
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
    """A number of a table; compiled, so that plain Python can call it too."""
    return real(table, index)


@central.register(Cubics)
def _(potential, square):
    place = min(max((square - potential.near) * potential.per, 0.0), INTERVALS - 1e-9)
    first = int(place)
    t, c = place - first, 4 * first
    b, quadratic = number(potential.table, c + 1), number(potential.table, c + 2)
    cubic = number(potential.table, c + 3)
    energy = number(potential.table, c) + t * (b + t * (quadratic + t * cubic))
    force_over_r = -2.0 * potential.per * (b + t * (2.0 * quadratic + t * 3.0 * cubic))
    if square < potential.near:
        energy -= 0.5 * force_over_r * (square - potential.near)
    inside = square < potential.far
    return (energy if inside else 0.0), (force_over_r if inside else 0.0)
