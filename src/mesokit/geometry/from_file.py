"""What shapes that are read from a file share.

The file is read once for each shape, whose solid is then what the file held, whatever becomes of
it. A run keeps the distances themselves, so that it goes on with the same solid.
"""

from __future__ import annotations

import functools
import hashlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.component import FileName, component, param, show
from mesokit.errors import CaseError
from mesokit.geometry.grid import Grid, fitted
from mesokit.geometry.region import Region
from mesokit.geometry.shape import Shape

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


@component
class FromFile(Shape):
    """A shape given by samples of its signed distance, which are made from a file."""

    file: FileName = param(doc="file, relative to that of the case")

    @functools.cached_property
    def contents(self) -> bytes:
        """What the file held when it was first needed. Raises CaseError."""
        try:
            return Path(self.file).read_bytes()
        except FileNotFoundError:
            raise self.wrong("no such file") from None
        except OSError as error:
            raise self.wrong(f"cannot be read: {(error.strerror or str(error)).lower()}") from None

    @functools.cached_property
    def digest(self) -> str:
        """Of its contents; empty where there are none, which whoever reads them will say."""
        try:
            return hashlib.sha256(self.contents).hexdigest()
        except CaseError:
            return ""

    def wrong(self, reason: str) -> CaseError:
        """The error that says what is wrong with the file."""
        return CaseError(f"file = {show(self.file, 500)}: {reason}")

    def grid(self, room: Room) -> Grid:
        """Its signed distance, positive outside."""
        raise NotImplementedError

    def body(self, room: Room) -> Region:
        """What lies within the surface."""
        grid = self.grid(room)
        if grid.values.ndim != room.dimension:
            raise self.wrong(f"{grid.values.ndim}D, in a {room.dimension}D box")
        try:
            return fitted(grid, room)
        except ValueError as error:
            raise self.wrong(str(error)) from None

    def kept(self) -> dict[str, Any]:
        """What it shares with the `Sampled` that a run keeps of it."""
        return {"fluid": self.fluid, "surface": self.surface, "virtual": self.virtual}
