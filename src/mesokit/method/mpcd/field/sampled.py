"""An acceleration given on a grid, linear between its nodes."""

from __future__ import annotations

import functools
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES, Box
from mesokit.case.component import component, param, show, tag
from mesokit.case.given.array_file import array_of_contents
from mesokit.case.given.file import FileName, FromContents
from mesokit.errors import CaseError
from mesokit.method.mpcd.field.protocol import Force, acceleration
from mesokit.scalar.intrinsics import floor, mul_add, with_item
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import address, real

Floats = NDArray[np.float64]
SAME = 1e-9  # of the largest: ends of the box that differ by no more are one place
COARSE = 0.05  # of the largest: linear between nodes, the field is off by more


@component
class SampledForce(FromContents, Force):
    """An acceleration on a grid over the box (a .npy file), linear between its nodes.

    There are nodes at both ends of the box along each axis: n of them are L/(n - 1) apart. Along an
    axis that no wall closes the last are the first again. An array (d, nx, ny[, nz]) holds the
    acceleration; with `of = "potential"` an array (nx, ny[, nz]) holds the potential energy of a
    unit of mass, of which minus the gradient, found by cubic splines, is the acceleration.

    Examples
    --------
    >>> import tempfile
    >>> file = Path(tempfile.mkdtemp()) / "trap.npy"
    >>> def trap(x, y):
    ...     return 0.1 * np.cos(np.pi * x / 10) * np.cos(np.pi * y / 10)
    >>> force = SampledForce.from_function(trap, Box([20, 20]), file, of="potential")
    >>> np.load(file).shape, round(force.largest_in((20, 20)), 4)
    ((41, 41), 0.0314)
    """

    rule: Literal["sampled"] = tag("sampled")
    file: FileName = param(doc="array of the nodes (.npy), relative to the case", unit="a/time^2")
    of: Literal["acceleration", "potential"] = param(
        "acceleration", doc="what the array holds; a potential in a^2/time^2"
    )

    @classmethod
    def from_array(
        cls,
        values: Any,
        file: str | Path,
        of: Literal["acceleration", "potential"] = "acceleration",
    ) -> SampledForce:
        """Write an array to a file, which is then that of the force.

        Parameters
        ----------
        values : array (d, nx, ny[, nz]), or (nx, ny[, nz]) of a potential
            In cells and units of time; nodes at both ends of the box.
        file : path
            Ends in .npy.
        of : str
            "acceleration" or "potential".

        Raises
        ------
        CaseError
            For another array, and a file that cannot be written.
        """
        key = f"SampledForce: file = {show(str(file), 500)}"
        if Path(file).suffix != ".npy":
            raise CaseError(f"{key}: expected a name ending in .npy")
        try:
            np.save(file, _checked(values, of))
        except ValueError as error:
            raise CaseError(f"SampledForce: {error}") from None
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise CaseError(f"{key}: cannot be written: {reason}") from None
        return cls(file=str(file), of=of)

    @classmethod
    def from_function(
        cls,
        function: Callable[..., Any],
        box: Box,
        file: str | Path,
        per_cell: int = 2,
        of: Literal["acceleration", "potential"] = "acceleration",
    ) -> SampledForce:
        """Write what a function says at the nodes to a file, which is then that of the force.

        Parameters
        ----------
        function : function of x, y (and z)
            Takes arrays of coordinates in cells; gives an acceleration for each axis, or with
            `of="potential"` the potential energy of a unit of mass.
        box : Box
            That of the case.
        file : path
            Ends in .npy.
        per_cell : int
            Nodes in a cell along each axis.
        of : str
            "acceleration" or "potential".

        Raises
        ------
        CaseError
            For what is no such function, and a file that cannot be written.
        """
        if not callable(function):
            raise CaseError(f"SampledForce: function = {show(function)}: expected a function")
        places = [np.linspace(0.0, length, length * per_cell + 1) for length in box.size]
        values, shape = function(*np.meshgrid(*places, indexing="ij")), tuple(map(len, places))
        try:
            if of == "potential":
                values = np.broadcast_to(values, shape)
            else:
                one, *others = values
                values = [np.broadcast_to(part, shape) for part in (one, *others)]
        except (TypeError, ValueError):
            wanted = f"{box.dimension} numbers, one for each axis,"
            raise CaseError(
                "SampledForce: function: expected "
                f"{'a number' if of == 'potential' else wanted} at each place of its arrays"
            ) from None
        return cls.from_array(values, file, of)

    @functools.cached_property
    def values(self) -> Floats:
        """Content of the file. Raises CaseError."""
        try:
            found = array_of_contents(self.contents)
        except (ValueError, EOFError):
            raise self.wrong("expected a .npy file of numbers") from None
        try:
            return _checked(found, self.of)
        except ValueError as error:
            raise self.wrong(str(error)) from None

    @property
    def shape(self) -> tuple[int, ...]:
        """Nodes along each axis."""
        return self.values.shape[self.of == "acceleration" :]

    @functools.cached_property
    def repeats(self) -> tuple[bool, ...]:
        """Along which axes the ends are alike."""
        scale = np.abs(self.values).max()
        first = int(self.of == "acceleration")
        ends = [np.take(self.values, [0, -1], first + k) for k in range(len(self.shape))]
        return tuple(
            bool(np.ptp(pair, axis=first + k).max() <= SAME * scale) for k, pair in enumerate(ends)
        )

    @functools.cached_property
    def _tables(self) -> dict[tuple[int, ...], Floats]:
        return {}  # for each size of the box; compiled code has their addresses

    def nodes(self, size: tuple[int, ...]) -> Floats:
        """Acceleration at the nodes (nx, ny[, nz], d) in a box of this size."""
        if size not in self._tables:
            found = self.values
            if self.of == "potential":
                from scipy.interpolate import CubicSpline

                slopes = []
                for k, length in enumerate(size):
                    values, ends = self.values, "not-a-knot"
                    if self.repeats[k]:
                        ends, values = "periodic", values.copy()
                        np.moveaxis(values, k, 0)[-1] = np.moveaxis(values, k, 0)[0]
                    places = np.linspace(0.0, length, self.shape[k])
                    slopes.append(-np.asarray(CubicSpline(places, values, k, ends)(places, 1)))
                found = np.stack(slopes)
            self._tables[size] = np.ascontiguousarray(np.moveaxis(found, 0, -1))
        return self._tables[size]

    @property
    def largest(self) -> float:
        """Largest size of the acceleration, for a potential in a box whose intervals are a cell."""
        return self.largest_in(tuple(n - 1 for n in self.shape))

    def largest_in(self, size: tuple[int, ...]) -> float:
        return float(np.linalg.norm(self.nodes(size), axis=-1).max())

    def misfits(self, size: tuple[int, ...]) -> Iterator[str]:
        """Another dimension than that of the box."""
        try:
            d, shape = len(size), self.values.shape
        except CaseError as error:
            yield str(error)
            return
        axes = ", ".join(["nx", "ny", "nz"][:d])
        wanted = f"({axes})" if self.of == "potential" else f"({d}, {axes})"
        if len(self.shape) != d or (self.of == "acceleration" and shape[0] != d):
            yield str(self.wrong(f"an array of shape {show(shape)}; expected {wanted} in {d}D"))

    def problems(self, closed: Collection[str]) -> Iterator[str]:
        """Ends of the box that are one place, and have two forces."""
        for axis, repeats in zip(AXES, self.repeats, strict=False):
            if not repeats and axis not in closed:
                reason = (
                    f"first and last nodes along {axis} differ, and no wall closes it; "
                    "expected nodes at both ends of the box, where they are the same"
                )
                yield str(self.wrong(reason))

    def notes(self, size: tuple[int, ...]) -> Iterator[str]:
        """A grid too coarse for its field."""
        nodes, off = self.nodes(size), 0.0
        for axis in range(len(size)):
            if nodes.shape[axis] > 2:
                off += float(np.abs(np.diff(nodes, 2, axis)).max()) / 8.0
        share = off / (self.largest_in(size) or 1.0)
        if share > COARSE:
            reason = f"between its nodes the force may be off by {100 * share:.2g} % of the largest"
            yield str(self.wrong(f"{reason}; take more nodes"))

    def kernel(self, size: tuple[int, ...]) -> Nodes:
        """Parameters for the scalar function below; the force keeps the table alive."""
        table = self.nodes(tuple(size))
        return Nodes(
            address(table),
            tuple(1.0 / length for length in size),
            tuple(n - 1.0 for n in table.shape[:-1]),
            tuple(float(repeats) for repeats in self.repeats),
            tuple(step // table.itemsize for step in table.strides[:-1]),
        )


def _checked(values: Any, of: str) -> Floats:
    """An array of finite real numbers. Raises ValueError."""
    array = np.asarray(values)
    first = int(of == "acceleration")
    if array.dtype.kind not in "iuf" or array.ndim - first not in (2, 3):
        raise ValueError(
            f"expected numbers at nodes, not shape {show(array.shape)} of {array.dtype}"
        )
    if min(array.shape[first:]) < 2:
        raise ValueError(f"expected 2 nodes or more along each axis, not shape {show(array.shape)}")
    if not np.isfinite(array).all():
        raise ValueError("expected finite numbers")
    return np.ascontiguousarray(array, float)


class Nodes(NamedTuple):
    """Where the table is; 1 over the lengths of the box, intervals between nodes, and 1 along axes
    on which the field repeats itself (beyond the ends of others it goes on as it is there); how far
    apart in the table neighbours along each axis are."""

    table: int
    inverse: tuple[float, ...]
    intervals: tuple[float, ...]
    repeats: tuple[float, ...]
    strides: tuple[int, ...]


@scalar
def table_interval(field, k, x):
    """Where in the table the interval along axis k begins in which x lies, and how far in it x is,
    from 0 to 1."""
    count = field.intervals[k]
    part = x * field.inverse[k]
    inside = part - floor(part) if field.repeats[k] > 0.5 else min(max(part, 0.0), 1.0)
    place = inside * count
    first = min(floor(place), count - 1.0)
    if not first >= 0.0:  # unused lanes of a strip hold NaN
        first = 0.0
    return np.int64(np.int32(first)) * field.strides[k], place - first


@scalar
def between_nodes(field, place, far, share):
    """Between the number at a place of the table and the one so far beyond it."""
    low = real(field.table, place)
    return mul_add(share, real(field.table, place + far) - low, low)


@by_type
def interpolated(field, r):
    """Linear along each axis between the nodes around r."""

    def in_square(field, r):
        x, s = table_interval(field, 0, r[0])
        y, t = table_interval(field, 1, r[1])
        right, up = field.strides
        a = r
        for j in range(2):
            low = between_nodes(field, x + y + j, up, t)
            high = between_nodes(field, x + y + right + j, up, t)
            a = with_item(a, j, mul_add(s, high - low, low))
        return a

    def in_cube(field, r):
        x, s = table_interval(field, 0, r[0])
        y, t = table_interval(field, 1, r[1])
        z, u = table_interval(field, 2, r[2])
        right, back, up = field.strides
        a = r
        for j in range(3):
            place = x + y + z + j
            near = between_nodes(field, place, up, u)
            near = mul_add(t, between_nodes(field, place + back, up, u) - near, near)
            far = between_nodes(field, place + right, up, u)
            far = mul_add(t, between_nodes(field, place + right + back, up, u) - far, far)
            a = with_item(a, j, mul_add(s, far - near, near))
        return a

    return in_square if len(r) == 2 else in_cube


acceleration.register(Nodes)(lambda field, r: interpolated(field, r))
