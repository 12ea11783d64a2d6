"""A solid given by a closed surface of triangles."""

import functools
import importlib
import io
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.region import Room
from mesokit.geometry.samples.distances import Grid, volume
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.samples.simplices import signed_distance

Floats = NDArray[np.float64]
REACH = 2.0  # cells around the surface in which distances are kept
FORMATS = ("stl", "obj", "ply")
ABOVE = 1e-6  # of the height of a mesh: its cross-section is taken so far above flat faces
MOST_SAMPLES = 2**27
OFF = 0.05  # part of the volume that samples may miss


class Closed(NamedTuple):
    """A closed surface or outline: the corners (n, d, d) of its triangles or straight pieces,
    whether it is that of a hollow, and its volume or area."""

    corners: Floats
    hollow: bool
    size: float


@component
class Mesh(FromFile):
    """The inside of a triangle mesh (STL, OBJ or PLY): in 2D a cross-section of it.

    It has to be watertight. What is inside of any of its closed surfaces is solid; one that is
    turned inside out and lies in another is a hollow. Features smaller than the spacing are
    smoothed. Reading meshes takes the package trimesh: pip install 'mesokit[mesh]'.
    """

    per_axis = ("position",)
    shape: Literal["mesh"] = tag("mesh")
    position: Either[None, float] = param(
        None,
        doc="where the origin of the mesh is put (the corner of the box unless said)",
        unit="a",
    )
    scale: float = param(1.0, doc="cells per unit of length of the mesh", unit="a", gt=0)
    height: float | None = param(
        None, doc="where a 2D box cuts the mesh, along its z, scaled (at 0 unless said)", unit="a"
    )
    spacing: float = param(0.25, doc="distance between samples of the distance", unit="a", gt=0)

    @functools.cached_property
    def closed(self) -> list[Closed]:
        """The closed surfaces it consists of, scaled, the largest first. Raises CaseError."""
        try:
            trimesh = importlib.import_module("trimesh")
        except ImportError:
            raise self.wrong(
                "meshes need the package trimesh: pip install 'mesokit[mesh]'"
            ) from None
        kind = Path(self.file).suffix.lower().lstrip(".")
        if kind not in FORMATS:
            raise self.wrong("expected a name ending in .stl, .obj or .ply")
        contents = self.contents
        try:
            mesh = trimesh.load(io.BytesIO(contents), file_type=kind, force="mesh")
            number = len(mesh.faces)
        except Exception:  # each format has its own words for a damaged file
            number = 0
        if number == 0:
            raise self.wrong(f"expected a triangle mesh in {kind.upper()} format")
        if not mesh.is_watertight:
            raise self.wrong(
                "the mesh is not watertight: it has holes or loose triangles; close it first"
            )
        triangles = _one_winding(np.asarray(mesh.faces))
        return _bodies(self.scale * np.asarray(mesh.vertices, float)[triangles], triangles)

    def grid(self, room: Room) -> Grid:
        if room.dimension == 3 and self.height is not None:
            raise CaseError(f"height = {self.height:g}: only in 2D; leave it out")
        place = np.array(self.pivot(room))
        parts = [Closed(part.corners + place, part.hollow, part.size) for part in self._parts(room)]
        low, high = _ends(parts)
        low, high = low - REACH, high + REACH
        counts = tuple(math.ceil(span / self.spacing) + 1 for span in high - low)
        if math.prod(counts) > MOST_SAMPLES:
            raise CaseError(
                f"spacing = {self.spacing:g}: {math.prod(counts)} samples of the distance; "
                f"expected at most {MOST_SAMPLES}"
            )
        values = np.full(counts, REACH)
        for part in parts:
            self._add(values, low, part)
        return Grid(values, tuple(float(x) for x in low), self.spacing)

    def _add(self, values: Floats, low: Floats, part: Closed) -> None:
        """Fill in a body, or cut out a hollow, as far as its distances reach."""
        ends = part.corners.min(axis=(0, 1)), part.corners.max(axis=(0, 1))
        first = np.floor((ends[0] - REACH - low) / self.spacing).astype(int).clip(0)
        last = np.ceil((ends[1] + REACH - low) / self.spacing).astype(int)
        window = tuple(slice(a, b + 1) for a, b in zip(first, last, strict=True))
        here = values[window]
        origin = tuple(float(x) for x in low + self.spacing * first)
        own = signed_distance(part.corners, origin, here.shape, self.spacing, REACH)
        values[window] = np.maximum(here, -own) if part.hollow else np.minimum(here, own)

    def _parts(self, room: Room) -> list[Closed]:
        """Its closed surfaces, or in 2D outlines of its section, each before those that lie in it.

        The section is that of a plane across z.
        """
        if room.dimension == 3:
            return self.closed
        low, high = _ends(self.closed)
        bottom, top = float(low[2]), float(high[2])
        level = (self.height or 0.0) + ABOVE * (top - bottom)
        found = []
        for part in self.closed:
            outline = _cut(part.corners, level)
            if len(outline):
                area = 0.5 * float(np.linalg.det(outline - outline[0, 0]).sum())
                found.append(Closed(outline, part.hollow, abs(area)))
        if not found:
            raise CaseError(
                f"height = {self.height or 0.0:g}: the mesh lies between {bottom:g} and {top:g}"
            )
        return found

    def unfit(self, room: Room, size: float) -> CaseError:
        """The error for samples that miss the mesh."""
        low, high = _ends(self._parts(room))
        return CaseError(
            f"spacing = {self.spacing:g}: too coarse for file {show(self.file, 500)}, which is "
            f"{' x '.join(f'{x:.3g}' for x in high - low)} cells; expected a smaller spacing, or "
            "a larger scale"
        )

    def notes(self, room: Room, samples: Floats) -> Iterator[str]:
        """Remarks for users: volume that the samples miss, a mesh larger than the box."""
        parts = self._parts(room)
        exact, found = _size(parts), volume(samples, self.spacing)
        if exact is not None and abs(found - exact) > OFF * exact:
            yield (
                f"spacing = {self.spacing:g}: the sampled solid has {found:.4g} cells, the mesh "
                f"{exact:.4g}; expected a smaller spacing"
            )
        low, high = _ends(parts)
        for axis, (length, shut) in enumerate(zip(room.size, room.closed, strict=True)):
            beyond = high[axis] - low[axis] - length
            if beyond > 0.5 * self.spacing and not shut:
                yield (
                    f"file = {show(self.file, 500)}: the mesh reaches over the box by "
                    f"{beyond:.4g} cells along {'xyz'[axis]}, and overlaps its own images"
                )

    def pivot(self, room: Room) -> tuple[float, ...]:
        return self.position or (0.0,) * room.dimension


def _one_winding(faces: NDArray[np.intp]) -> NDArray[np.intp]:
    """The triangles of closed surfaces, by the numbers of their corners, each the way round that
    most triangles of its surface have."""
    n = len(faces)
    edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    # of two triangles at an edge both go along it one way only where one of them is turned
    ends = np.sort(edges, axis=1)
    one, two = np.lexsort(ends.T).reshape(-1, 2).T
    turned = edges[one, 0] == edges[two, 0]
    if not turned.any():
        return faces
    pairs = np.sort(np.stack([one // 3, two // 3], axis=1), axis=1)
    pairs, first = np.unique(pairs, axis=0, return_index=True)
    relation = np.where(turned[first], -1, 1)
    # the number of the surface of each triangle, which neighbours share
    graph = sparse.coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n))
    which = np.asarray(sparse.csgraph.connected_components(graph, directed=False)[1])
    roots = np.unique(which, return_index=True)[1]
    # a triangle more, beside one of each surface: all are reached from it
    pairs = np.concatenate([pairs, np.stack([roots, np.full(len(roots), n)], axis=1)])
    relation = np.concatenate([relation, np.ones(len(roots), int)])
    graph = sparse.coo_matrix((relation, pairs.T), shape=(n + 1, n + 1)).tocsr()
    graph = graph + graph.T
    order, before = sparse.csgraph.breadth_first_order(graph, n, directed=False)
    steps = np.asarray(graph[before[order[1:]], order[1:]]).ravel()
    sign = np.ones(n + 1, int)
    for face, last, step in zip(order[1:], before[order[1:]], steps, strict=True):
        sign[face] = sign[last] * step
    sign = sign[:n] * np.where(np.bincount(which, sign[:n]) < 0, -1, 1)[which]
    return np.where(sign[:, None] < 0, faces[:, ::-1], faces)


def _bodies(corners: Floats, faces: NDArray[np.intp]) -> list[Closed]:
    """The closed surfaces that triangles make, by the numbers of their corners."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    count = int(faces.max()) + 1
    graph = sparse.coo_matrix((np.ones(len(ends)), ends.T), shape=(count, count))
    which = sparse.csgraph.connected_components(graph, directed=False)[1][faces[:, 0]]
    order = np.argsort(which, kind="stable")
    parts = np.split(corners[order], np.flatnonzero(np.diff(which[order])) + 1)
    sizes = [float(np.linalg.det(part - part[0, 0]).sum()) / 6.0 for part in parts]
    outward = math.copysign(1.0, sum(sizes))
    found: list[Closed] = []
    for i in sorted(range(len(parts)), key=lambda i: -abs(sizes[i])):
        inverted = outward * sizes[i] < 0.0
        hollow = inverted and any(_surrounds(part.corners, parts[i][0, 0]) for part in found)
        found.append(Closed(parts[i], hollow, abs(sizes[i])))
    return found


def _surrounds(corners: Floats, place: Floats) -> bool:
    """Whether a place is inside of a closed surface: the solid angles of its triangles add up."""
    if (place < corners.min(axis=(0, 1))).any() or (place > corners.max(axis=(0, 1))).any():
        return False
    a, b, c = np.moveaxis(corners - place, 1, 0)
    x, y, z = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a)))
    angles = np.arctan2(np.linalg.det(corners - place), x * y * z + ab * z + bc * x + ca * y)
    return bool(abs(angles.sum()) > math.pi)  # halves of solid angles


def _cut(corners: Floats, level: float) -> Floats:
    """The outline (n, 2, 2) in which a plane across z cuts a closed surface, one way round."""
    above = corners[..., 2] > level
    cut = above.any(axis=1) & ~above.all(axis=1)
    outline = []
    for places, over in zip(corners[cut], above[cut], strict=True):
        lonely = int(np.flatnonzero(over == (over.sum() == 1))[0])
        ends = []
        for other in ((lonely + 1) % 3, (lonely + 2) % 3):
            a, b = places[lonely], places[other]
            ends.append(a[:2] + (level - a[2]) / (b[2] - a[2]) * (b[:2] - a[:2]))
        outline.append(ends if over[lonely] else ends[::-1])
    return np.array(outline)


def _ends(parts: Sequence[Closed]) -> tuple[Floats, Floats]:
    low = np.min([part.corners.min(axis=(0, 1)) for part in parts], axis=0)
    return low, np.max([part.corners.max(axis=(0, 1)) for part in parts], axis=0)


def _size(parts: Sequence[Closed]) -> float | None:
    """Volume or area of them all; None if bodies may overlap."""
    total = 0.0
    seen: list[tuple[Floats, Floats]] = []
    for part in parts:
        total += -part.size if part.hollow else part.size
        if not part.hollow:
            low, high = _ends([part])
            if any((low < other[1]).all() and (high > other[0]).all() for other in seen):
                return None
            seen.append((low, high))
    return total
