"""A solid given by a closed surface of triangles."""

from __future__ import annotations

import functools
import importlib
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.geometry.from_file import FromFile
from mesokit.geometry.grid import Grid
from mesokit.geometry.simplices import signed_distance

if TYPE_CHECKING:
    from mesokit.geometry.region import Room

Floats = NDArray[np.float64]
REACH = 2.0  # cells around the surface in which distances are kept
FORMATS = ("stl", "obj", "ply")
ABOVE = 1e-6  # of the height of a mesh: its cross-section is taken so far above flat faces
MOST_SAMPLES = 2**27


@component
class Mesh(FromFile):
    """The inside of a triangle mesh (STL, OBJ or PLY): in 2D a cross-section of it.

    It has to be watertight. Features smaller than the spacing are smoothed. Reading meshes takes
    the package trimesh: pip install 'mesokit[mesh]'.
    """

    shape: Literal["mesh"] = tag("mesh")
    position: tuple[float, ...] | None = param(
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
    def triangles(self) -> Floats:
        """Corners (n, 3, 3) of its triangles, scaled. Raises CaseError."""
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
            faces = len(mesh.faces)
        except Exception:  # each format has its own words for a damaged file
            faces = 0
        if faces == 0:
            raise self.wrong(f"expected a triangle mesh in {kind.upper()} format")
        if not mesh.is_watertight:
            raise self.wrong(
                "the mesh is not watertight: it has holes or loose triangles; close it first"
            )
        return self.scale * np.asarray(mesh.triangles, float)

    def grid(self, room: Room) -> Grid:
        """Its signed distance, positive outside."""
        simplices = self.triangles if room.dimension == 3 else self._section()
        simplices = simplices + np.array(self.pivot(room))
        low, high = simplices.min(axis=(0, 1)) - REACH, simplices.max(axis=(0, 1)) + REACH
        counts = tuple(math.ceil(span / self.spacing) + 1 for span in high - low)
        if math.prod(counts) > MOST_SAMPLES:
            raise CaseError(
                f"spacing = {self.spacing:g}: {math.prod(counts)} samples of the distance; "
                f"expected at most {MOST_SAMPLES}"
            )
        origin = tuple(float(x) for x in low)
        values = signed_distance(simplices, origin, counts, self.spacing, REACH)
        return Grid(values, origin, self.spacing)

    def _section(self) -> Floats:
        """The outline (n, 2, 2) in which a plane across z cuts it."""
        z = self.triangles[..., 2]
        bottom, top = float(z.min()), float(z.max())
        level = (self.height or 0.0) + ABOVE * (top - bottom)
        if not bottom < level < top:
            raise CaseError(
                f"height = {self.height or 0.0:g}: the mesh lies between {bottom:g} and {top:g}"
            )
        above = z > level
        cut = above.any(axis=1) & ~above.all(axis=1)
        outline = []
        for corners, over in zip(self.triangles[cut], above[cut], strict=True):
            lonely = int(np.flatnonzero(over == (over.sum() == 1))[0])
            ends = []
            for other in ((lonely + 1) % 3, (lonely + 2) % 3):
                a, b = corners[lonely], corners[other]
                ends.append(a[:2] + (level - a[2]) / (b[2] - a[2]) * (b[:2] - a[:2]))
            outline.append(ends)
        return np.array(outline)

    def pivot(self, room: Room) -> tuple[float, ...]:
        """The place about which it turns and torques are taken."""
        return self.position or (0.0,) * room.dimension

    def vectors(self) -> dict[str, Any]:
        """Its parameters that have one number for each axis, by key."""
        return {} if self.position is None else {"position": self.position}
