"""Text files of a potential: columns of distance, energy and, if there is one, force."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
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
    return _checked(sections[next(iter(sections)) if section is None else section])


def _checked(rows: list[tuple[int, list[float]]]) -> Floats:
    """As an array. Raises ValueError for the first row that is wrong."""
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
    if width == 3:
        _check_forces(values, [number for number, _ in rows])
    return values


def _check_forces(values: Floats, lines: list[int]) -> None:
    """That the force is minus the slope of the energy. Raises ValueError for the worst row."""
    r, energy, force = values.T
    work = -np.diff(r) * (force[1:] + force[:-1]) / 2.0
    change = np.diff(energy)
    off = np.abs(work - change)
    allowed = OFF * np.maximum(np.abs(work), np.abs(change)) + OFF * np.median(np.abs(change))
    worst = int(np.argmax(off / np.maximum(allowed, 1e-300)))
    if off[worst] > allowed[worst]:
        raise ValueError(
            f"line {lines[worst + 1]}: from the row before U changes by {change[worst]:g}, by the "
            f"forces it would be {work[worst]:g}; expected F = -dU/dr"
        )
