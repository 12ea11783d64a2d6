"""Data files of LAMMPS, of atom styles atomic, bond, angle, molecular, full and sphere.

MDAnalysis takes the file apart into header and sections; it would keep numbers in single precision
and neither images nor the corner of the box, so that the columns are read here.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import one_of, show
from mesokit.case.snapshot import Snapshot, rows_of
from mesokit.errors import CaseError
from mesokit.io.optional import package

# columns before the coordinates: number, molecule, type, charge; or number, type, diameter, density
STYLES = {"atomic": 2, "bond": 3, "angle": 3, "molecular": 3, "full": 4, "sphere": 4}
ROUND = "sphere"  # the style that is only known where the file says so
COLUMNS = {5: "atomic", 6: "molecular", 7: "full"}  # without images, which are three more


def read(path: str) -> Snapshot:
    """The particles of a data file. Raises CaseError for one that cannot be read."""
    parser = package("MDAnalysis.topology.LAMMPSParser", "LAMMPS data files")
    try:
        style = _style(path)
        with parser.DATAParser(path) as data:
            header, sections = data.grab_datafile()
        return _snapshot(header, sections, style)
    except CaseError:
        raise
    except (OSError, EOFError, ValueError, KeyError, IndexError) as error:
        reason = getattr(error, "strerror", None) or f"{error}"
        raise CaseError(f"cannot be read as a LAMMPS data file: {reason}") from None


def _snapshot(header: dict[str, str], sections: dict[str, Any], style: str | None) -> Snapshot:
    if not sections.get("Atoms"):
        raise CaseError("it has no section Atoms")
    atoms = _numbers(sections, "Atoms")
    style = style or COLUMNS.get(atoms.shape[1] - 3 * (atoms.shape[1] > 7))
    before = STYLES.get(style or "")
    if before is None or atoms.shape[1] not in (before + 3, before + 6):
        raise CaseError(
            f"its {atoms.shape[1]} columns of Atoms are not those of style {show(style or '?')}; "
            f"expected {one_of(list(STYLES))}"
        )
    n, numbers = len(atoms), atoms[:, 0].astype(int)
    if len(np.unique(numbers)) < n or str(n) != header.get("atoms", str(n)).strip():
        raise CaseError(f"it has {n} lines of Atoms; expected one for each of its atoms")
    order = np.argsort(numbers)
    atoms, numbers = atoms[order], numbers[order]
    corners = np.array([header[f"{axis}lo {axis}hi"].split() for axis in "xyz"], float)
    velocities, spins = _velocities(sections, numbers)
    diameters = atoms[:, 2] if style == ROUND else None
    links = np.zeros((0, 2), int)
    if sections.get("Bonds"):
        links = rows_of(numbers, _numbers(sections, "Bonds")[:, 2:4].astype(int))
    with_images = atoms.shape[1] == before + 6
    return Snapshot(
        positions=atoms[:, before : before + 3],
        velocities=velocities,
        images=atoms[:, before + 3 :].astype(int) if with_images else None,
        masses=_masses(sections, atoms[:, 1 if before == 2 else 2])
        if diameters is None
        else atoms[:, 3] * np.pi / 6 * diameters**3,
        bonds=links,
        numbers=numbers,
        low=corners[:, 0],
        lengths=corners[:, 1] - corners[:, 0],
        tilts=np.array(header.get("xy xz yz", "0 0 0").split(), float),
        diameters=diameters,
        spins=spins,
    )


def _velocities(sections: dict[str, Any], numbers: NDArray[np.int64]) -> tuple[Any, Any]:
    """Velocities (n, 3), and angular velocities (n, 3) of spheres; None of what is not there."""
    if not sections.get("Velocities"):
        return None, None
    rows = _numbers(sections, "Velocities")
    found = np.zeros((len(numbers), rows.shape[1] - 1))
    found[rows_of(numbers, rows[:, 0].astype(int))] = rows[:, 1:]
    return found[:, :3], found[:, 3:6] if found.shape[1] >= 6 else None


def _masses(sections: dict[str, Any], kinds: NDArray[np.float64]) -> NDArray[np.float64] | None:
    if not sections.get("Masses"):
        return None
    table = _numbers(sections, "Masses")
    mass = dict(zip(table[:, 0].tolist(), table[:, 1].tolist(), strict=True))
    return np.array([mass[kind] for kind in kinds.tolist()])


def _numbers(sections: dict[str, Any], name: str) -> NDArray[np.float64]:
    """The lines of a section as a table."""
    try:
        return np.array([line.split() for line in sections[name]], float)
    except ValueError:
        raise CaseError(
            f"its section {name} is damaged; expected as many numbers in every line"
        ) from None


def _style(path: str) -> str | None:
    """The atom style that the heading of the section says, `Atoms # bond`; None where it does not.

    Raises CaseError for one that is not known.
    """
    with Path(path).open(encoding="utf-8") as file:
        headings = [line.partition("#")[2].strip() for line in file if line.startswith("Atoms")]
    style = headings[0] if headings and headings[0] else None
    if style is not None and style not in STYLES:
        raise CaseError(f"atom style {show(style)}: expected {one_of(list(STYLES))}")
    return style
