"""Sites of a lattice as files for other programs: extended XYZ, and VTK ImageData."""

import base64
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import nearest, one_of, show
from mesokit.case.sites import SiteLattice
from mesokit.case.trajectory import Group
from mesokit.errors import CaseError
from mesokit.io.atomic import replacing, write_text
from mesokit.io.text_frames import extended_frame

RADIUS = 0.5  # of a site, so that neighbours touch


class Sites(NamedTuple):
    """Sites of a lattice: where they are, the names of their states (none of heights), and the
    numbers of the states that are written, or None for all."""

    lattice: SiteLattice
    names: tuple[str, ...]
    written: tuple[int, ...] | None = None

    @property
    def quantity(self) -> str:
        """What the number of a site is."""
        return "state" if self.names else "height"


class SiteFrame(NamedTuple):
    """Numbers (n,) of the states, or heights, of all sites at one time."""

    step: int
    time: float
    states: NDArray[np.integer[Any]]


Frames = Callable[[], Iterator[SiteFrame]]
SiteWriter = Callable[[Path, Sites, Frames], Path]


def sites_of(group: Group, states: Sequence[str] | None = None) -> Sites:
    """The sites of a group; of these states alone. Raises CaseError for a state that they lack.

    >>> gas = Group("sites", (), lattice=SiteLattice((4,)), states=("empty", "A"))
    >>> sites_of(gas, ["A"]).written
    (1,)
    """
    assert group.lattice is not None
    if states is None:
        return Sites(group.lattice, group.states)
    for name in states:
        if name not in group.states:
            known = one_of(group.states) if group.states else "none: sites have heights"
            raise CaseError(
                f"states = {show(list(states))}: expected {known}{nearest(name, group.states)}"
            )
    return Sites(group.lattice, group.states, tuple(map(group.states.index, states)))


def numbered(path: Path, index: int) -> Path:
    """The file of one frame of a series.

    >>> numbered(Path("run.vti"), 12).name
    'run-00012.vti'
    """
    return path.with_name(f"{path.stem}-{index:05d}{path.suffix}")


def xyz(path: Path, sites: Sites, frames: Frames) -> Path:
    """Extended XYZ: a row for each site that is written, with the name of its state.

    Heights are also the coordinate along the axis after those of the lattice.
    """
    lattice, names = sites.lattice, np.array([name.replace(" ", "_") for name in sites.names])
    d, number = lattice.dimension, np.arange(lattice.number)
    size, closed = np.ones(3), np.ones(3, bool)
    size[:d], closed[:d] = lattice.edges, lattice.ends
    places = np.pad(lattice.places(), ((0, 0), (0, 3 - d)))
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        for now in frames():
            states = now.states.astype(np.int64)
            rows = number if sites.written is None else _rows(states, sites.written)
            place, state = places[rows], states[rows]
            if not len(names) and d < 3:
                place[:, d] = state
            kinds = names[state] if len(names) else np.full(len(rows), "site")
            columns = [
                ("species:S:1", "%s", kinds), ("pos:R:3", "%.9g", place),
                ("id:I:1", "%d", rows + 1), (f"{sites.quantity}:I:1", "%d", state),
                ("radius:R:1", "%.9g", np.full(len(rows), RADIUS)),
            ]  # fmt: skip
            extended_frame(file, np.diag(size), closed.tolist(), (now.time, now.step), columns)
    return path


def _rows(states: NDArray[np.int64], written: Sequence[int]) -> NDArray[np.int64]:
    return np.flatnonzero(np.isin(states, written))


def vti(path: Path, sites: Sites, frames: Frames) -> Path:
    """A file of VTK ImageData for each frame, and one that lists them with their times (.pvd).

    A site is a cell, with its place in the middle. Raises CaseError for rows that are shifted.
    """
    lattice = sites.lattice
    _all_of_them(path, sites)
    if lattice.shifted:
        raise CaseError(
            f"{path}: rows of this lattice are shifted by half a site, cells of an image are not; "
            "expected '.xyz'"
        )
    listed = []
    for index, now in enumerate(frames()):
        file = numbered(path, index)
        write_text(file, _image(sites, now))
        entry = f'<DataSet timestep="{now.time:.17g}" file={quoteattr(file.name)}/>'
        listed.append(entry)
    series = path.with_suffix(".pvd")
    write_text(series, _vtk("Collection", f"<Collection>{''.join(listed)}</Collection>"))
    return series


def _all_of_them(path: Path, sites: Sites) -> None:
    if sites.written is not None:
        raise CaseError(f"{path}: states: images have all sites; leave states out, or write '.xyz'")


def _image(sites: Sites, now: SiteFrame) -> str:
    lattice, rest = sites.lattice, 3 - sites.lattice.dimension
    counts, steps = [*lattice.size, *[0] * rest], [*lattice.steps.tolist(), *[1.0] * rest]
    extent = " ".join(f"0 {count}" for count in counts)
    origin = " ".join(
        f"{-0.5 * step if count else 0:.17g}" for count, step in zip(counts, steps, strict=True)
    )
    spacing = " ".join(f"{step:.17g}" for step in steps)
    cells = np.ascontiguousarray(now.states, "<i4").reshape(lattice.size).ravel(order="F")
    time = _array("TimeValue", "Float64", np.array([now.time], "<f8"), ' NumberOfTuples="1"')
    name = sites.quantity
    data = f'<CellData Scalars="{name}">{_array(name, "Int32", cells)}</CellData>'
    return _vtk(
        "ImageData",
        f'<ImageData WholeExtent="{extent}" Origin="{origin}" Spacing="{spacing}">'
        f"<FieldData>{time}</FieldData>"
        f'<Piece Extent="{extent}">{data}</Piece></ImageData>',
    )


def _vtk(kind: str, content: str) -> str:
    how = 'version="1.0" byte_order="LittleEndian" header_type="UInt64"'
    return f'<?xml version="1.0"?>\n<VTKFile type="{kind}" {how}>{content}</VTKFile>\n'


def _array(name: str, kind: str, values: NDArray[Any], more: str = "") -> str:
    """Binary numbers in base64, after how many bytes they are."""
    raw = np.array([values.nbytes], "<u8").tobytes() + values.tobytes()
    text = base64.b64encode(raw).decode()
    return f'<DataArray type="{kind}" Name="{name}" format="binary"{more}>{text}</DataArray>'


def one_each(path: Path, sites: Sites, frames: Iterable[Any], write: Callable[..., None]) -> Path:
    """Write a file for each frame by `write(file, frame)`; returns the first."""
    _all_of_them(path, sites)
    for index, frame in enumerate(frames):
        with replacing(numbered(path, index)) as temporary:
            write(temporary, frame)
    return numbered(path, 0)
