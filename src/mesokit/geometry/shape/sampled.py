"""A solid given by its signed distance on a grid."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.case.given.array_file import array_of_contents
from mesokit.errors import CaseError
from mesokit.geometry.region import Room
from mesokit.geometry.samples.distances import Floats, Grid, checked, extent
from mesokit.geometry.samples.from_file import FromFile


@component
class Sampled(FromFile):
    """A signed distance on a grid (a .npy file), positive outside of the solid, linear between.

    The grid repeats along axes on which it exactly spans the box; elsewhere there is fluid beyond
    it. Features of the solid that are smaller than the spacing are smoothed.

    Examples
    --------
    >>> import tempfile
    >>> x, y = np.meshgrid(np.arange(-3, 3.1, 0.25), np.arange(-3, 3.1, 0.25), indexing="ij")
    >>> file = Path(tempfile.mkdtemp()) / "post.npy"
    >>> post = Sampled.from_array(np.hypot(x, y) - 2, file, spacing=0.25, origin=(7, 2))
    """

    per_axis = ("origin", "centre")
    shape: Literal["sampled"] = tag("sampled")
    spacing: float = param(doc="distance between samples", unit="a", gt=0)
    origin: Either[None, float] = param(
        None, doc="place of the first sample (the corner of the box unless said)", unit="a"
    )
    centre: Either[None, float] = param(
        None, doc="place about which torques are taken (the middle unless said)", unit="a"
    )

    @classmethod
    def from_array(cls, values: Any, file: str | Path, spacing: float, **others: Any) -> "Sampled":
        """Write an array to a file, which is then the shape's. Raises CaseError.

        Parameters
        ----------
        values : array, 2D or 3D
            Signed distance, in cells, x first.
        file : path
            Ends in .npy.
        spacing, others
            The other parameters of the shape.
        """
        key = f"Sampled.from_array: file = {str(file)!r}"
        if Path(file).suffix != ".npy":
            raise CaseError(f"{key}: expected a name ending in .npy")
        try:
            np.save(file, checked(values, "values"))
        except ValueError as error:
            raise CaseError(f"Sampled.from_array: {error}") from None
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise CaseError(f"{key}: cannot be written: {reason}") from None
        return cls(file=str(file), spacing=spacing, **others)

    def grid(self, room: Room) -> Grid:
        try:
            values = array_of_contents(self.contents)
        except (ValueError, EOFError):
            raise self.wrong("expected a .npy file of numbers") from None
        origin = self.origin or (0.0,) * values.ndim
        try:
            return Grid(checked(values, "array"), origin, self.spacing)
        except ValueError as error:
            raise self.wrong(str(error)) from None

    def notes(self, room: Room, samples: Floats) -> Iterator[str]:
        """Remarks for users: a solid that reaches over the box."""
        values = self.distances(room).values
        origin = self.origin or (0.0,) * values.ndim
        for axis, (n, length) in enumerate(zip(values.shape, room.size, strict=True)):
            beyond = (n - 1) * self.spacing - length
            first, last = (origin[axis] + self.spacing * i for i in extent(values, axis))
            if beyond > 0.5 * self.spacing and not 0.0 <= first <= last <= length:
                yield (
                    f"file = {show(self.file, 500)}: the samples reach over the box by "
                    f"{beyond:.4g} cells along {'xyz'[axis]}, and so does the solid; the first "
                    "axis of the array is x"
                )

    def pivot(self, room: Room) -> tuple[float, ...]:
        if self.centre is not None:
            return self.centre
        grid = self.distances(room)
        return tuple(
            x + 0.5 * (n - 1) * grid.spacing
            for x, n in zip(grid.origin, grid.values.shape, strict=True)
        )
