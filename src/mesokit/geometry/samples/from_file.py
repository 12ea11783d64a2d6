"""Base class of shapes that are read from a file.

The file is read once for each shape, whose solid is then what the file held, whatever becomes of
it. A run keeps the distances themselves, so that it goes on with the same solid.
"""

import functools
import hashlib
import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Any

from mesokit.case.component import component, param
from mesokit.case.given.file import FileName, FromContents
from mesokit.errors import CaseError
from mesokit.geometry.region import Region, Room
from mesokit.geometry.samples.distances import Floats, Grid, fitted, slope
from mesokit.geometry.shape_protocol import Shape


@component
class FromFile(FromContents, Shape):
    """A shape given by samples of its signed distance, which are made from a file."""

    file: FileName = param(doc="file, relative to that of the case")

    @functools.cached_property
    def digest(self) -> str:
        """Digest of its contents; empty if it cannot be read, which is reported on reading."""
        try:
            return hashlib.sha256(self.contents).hexdigest()
        except CaseError:
            return ""

    @abstractmethod
    def grid(self, room: Room) -> Grid:
        """Its signed distance, positive outside."""

    def distances(self, room: Room) -> Grid:
        """`grid`, made once for the contents of the file."""
        return _found(self, self.digest, room)

    def body(self, room: Room) -> Region:
        grid = self.distances(room)
        if grid.values.ndim != room.dimension:
            raise self.wrong(f"{grid.values.ndim}D, in a {room.dimension}D box")
        size = slope(grid)
        if not 0.5 < size < 2.0:
            raise self.unfit(room, size)
        try:
            found = fitted(grid, room)
        except ValueError as error:
            raise self.wrong(str(error)) from None
        ((first, *_), *_) = found
        samples = first.samples
        if samples is None or not samples.min() < 0.0:  # what smoothing has left
            raise self.unfit(room, math.nan)
        return found

    def unfit(self, room: Room, size: float) -> CaseError:
        """The error for samples whose gradient at the surface is so large; nan: without surface."""
        if math.isnan(size):
            return self.wrong("no surface: all samples have one sign")
        return self.wrong(
            f"the gradient at the surface is {size:.3g}; expected a signed distance, for which it "
            "is 1, in cells"
        )

    @abstractmethod
    def notes(self, room: Room, samples: Floats) -> Iterator[str]:
        """Remarks for users on the solid that the samples describe, key first."""

    def kept(self) -> dict[str, Any]:
        """Parameters that it shares with the `Sampled` that a run keeps of it."""
        return {"fluid": self.fluid, "surface": self.surface, "virtual": self.virtual}


@functools.lru_cache(maxsize=8)
def _found(shape: FromFile, digest: str, room: Room) -> Grid:
    """Grid of a shape; those of one file are equal whatever it holds, so the digest is compared."""
    grid = shape.grid(room)
    grid.values.flags.writeable = False
    return grid
