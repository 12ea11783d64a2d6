"""Data files of LAMMPS: header, sections, and the columns of common atom styles."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import one_of, show
from mesokit.case.given.snapshot import Snapshot, rows_of
from mesokit.errors import CaseError

# columns before the coordinates
STYLES = {
    "atomic": ("id", "type"),
    "charge": ("id", "type", "charge"),
    "bond": ("id", "molecule", "type"),
    "angle": ("id", "molecule", "type"),
    "molecular": ("id", "molecule", "type"),
    "full": ("id", "molecule", "type", "charge"),
    "sphere": ("id", "type", "diameter", "density"),
    "bpm/sphere": ("id", "molecule", "type", "diameter", "density"),
}
# styles of LAMMPS with other columns
OTHERS = (
    *("amoeba", "body", "dielectric", "dipole", "dpd", "edpd", "electron", "ellipsoid", "hybrid"),
    *("line", "mdpd", "oxdna", "peri", "rheo", "smd", "sph", "spin", "tdpd", "template", "tri"),
    "wavepacket",
)
# by the number of columns, without images: where the third is of whole numbers, and where it is not
USUAL = {5: ("atomic", "atomic"), 6: ("molecular", "charge"), 7: ("full", "sphere")}
CORNERS = tuple(f"{axis}lo {axis}hi" for axis in "xyz")
TILTS = "xy xz yz"

Sections = dict[str, list[list[str]]]


def read(path: str) -> Snapshot:
    """The particles of a data file. Raises CaseError for one that cannot be read."""
    try:
        return _snapshot(*_parts(Path(path).read_text(encoding="utf-8")))
    except CaseError:
        raise
    except (OSError, ValueError, KeyError, IndexError) as error:
        reason = getattr(error, "strerror", None) or f"{error}"
        raise CaseError(f"cannot be read as a LAMMPS data file: {reason}") from None


def _parts(text: str) -> tuple[dict[str, str], Sections, str | None]:
    """Values of the header by keyword, words of the lines of each section, and the atom style, if
    the comment of the heading `Atoms` is one. The first line is a title."""
    header: dict[str, str] = {}
    sections: Sections = {}
    rows: list[list[str]] | None = None
    style = None
    for line in text.splitlines()[1:]:
        content, _, comment = line.partition("#")
        words = content.split()
        if not words:
            continue
        if words[0][0].isalpha():  # lines of the header and of sections begin with a number
            rows = sections.setdefault(" ".join(words), [])
            said = comment.split()[:1] if words == ["Atoms"] else []
            if said and said[0] in OTHERS:
                raise CaseError(f"atom style {show(said[0])}: expected {one_of(list(STYLES))}")
            if said and said[0] in STYLES:
                style = said[0]
        elif rows is not None:
            rows.append(words)
        else:
            values = [word for word in words if not word[0].isalpha()]
            header[" ".join(words[len(values) :])] = " ".join(values)
    return header, sections, style


def _snapshot(header: dict[str, str], sections: Sections, style: str | None) -> Snapshot:
    if not sections.get("Atoms"):
        raise CaseError("it has no section Atoms")
    atoms = _numbers(sections, "Atoms")
    width = atoms.shape[1]
    if style is None and width - 3 * (width > 7) in USUAL:
        whole = all(words[2].lstrip("+-").isdecimal() for words in sections["Atoms"])
        style = USUAL[width - 3 * (width > 7)][0 if whole else 1]
    names = STYLES.get(style or "", ())
    before = len(names)
    if not names or width not in (before + 3, before + 6):
        form = f"{one_of(list(STYLES))}, after '#' beside the heading Atoms"
        which = f"its {width} columns of Atoms are not those of style {show(style or '?')}"
        raise CaseError(f"{which}; expected {form}")
    n, numbers = len(atoms), atoms[:, 0].astype(int)
    if len(np.unique(numbers)) < n or str(n) != header.get("atoms", str(n)).strip():
        raise CaseError(f"it has {n} lines of Atoms; expected one for each of its atoms")
    if missing := [name for name in CORNERS if name not in header]:
        raise CaseError(f"its header has no line of {show(missing[0])}; expected the box")
    order = np.argsort(numbers)
    atoms, numbers = atoms[order], numbers[order]
    corners = np.array([header[name].split() for name in CORNERS], float)
    velocities, spins = _velocities(sections, numbers)
    column = {name: atoms[:, i] for i, name in enumerate(names)}
    diameters, masses = column.get("diameter"), None
    links = np.zeros((0, 2), int)
    if sections.get("Bonds"):
        links = rows_of(numbers, _numbers(sections, "Bonds")[:, 2:4].astype(int))
    if diameters is not None:
        masses = column["density"] * np.pi / 6 * diameters**3
    elif sections.get("Masses"):
        table = _numbers(sections, "Masses")
        of_kind = dict(zip(table[:, 0].tolist(), table[:, 1].tolist(), strict=True))
        masses = np.array([of_kind[kind] for kind in column["type"].tolist()])
    return Snapshot(
        positions=atoms[:, before : before + 3],
        velocities=velocities,
        images=atoms[:, before + 3 :].astype(int) if width == before + 6 else None,
        masses=masses,
        bonds=links,
        numbers=numbers,
        low=corners[:, 0],
        lengths=corners[:, 1] - corners[:, 0],
        tilts=np.array(header.get(TILTS, "0 0 0").split(), float),
        diameters=diameters,
        spins=spins,
    )


def _velocities(sections: Sections, numbers: NDArray[np.int64]) -> tuple[Any, Any]:
    """Velocities (n, 3), and angular velocities (n, 3) of spheres; None for missing ones."""
    if not sections.get("Velocities"):
        return None, None
    rows = _numbers(sections, "Velocities")
    found = np.zeros((len(numbers), rows.shape[1] - 1))
    found[rows_of(numbers, rows[:, 0].astype(int))] = rows[:, 1:]
    return found[:, :3], found[:, 3:6] if found.shape[1] >= 6 else None


def _numbers(sections: Sections, name: str) -> NDArray[np.float64]:
    """The lines of a section as a table."""
    try:
        return np.array(sections[name], float)
    except ValueError:
        why = f"its section {name} is damaged; expected as many numbers in every line"
        raise CaseError(why) from None
