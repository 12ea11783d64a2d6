"""A solid drawn in a picture, in 2D."""

import functools
import io
import math
import warnings
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator
from scipy import ndimage
from scipy.spatial import KDTree

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.geometry.region import Room
from mesokit.geometry.samples.distances import Grid, spans
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.shape_protocol import positive

Floats = NDArray[np.float64]
REACH = 4.0  # cells from the outline in which distances are kept
BLUR = 1.0  # pixels by which edges are smoothed
MARGIN = 2.0  # cells of fluid around a picture that does not span the box
NEAR = 0.8  # pixels from the outline: those that it passes through
FINE = 8  # points of the outline per pixel
LEAF = 200  # points of the outline that are compared one by one: they lie close together
LARGEST = 2**24  # pixels: some 40 bytes each while it is read
# no others: Pillow starts a program for some
FORMATS = ("PNG", "JPEG", "TIFF", "BMP", "GIF", "PPM", "WEBP")
ENOUGH = 8  # pixels a cell
PLAIN, FEW = 0.1, 0.02  # off black or white that no one sees, share of pixels that are not


@component
class Picture(FromFile):
    """A black-and-white PNG (2D): black is solid, white is fluid, the top row is the top.

    Grey and transparent pixels count as partly white, and the surface is where it is half. It is
    smoothed by about a pixel: draw with 8 pixels a cell or more.
    """

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    per_axis = ("origin", "size")
    shape: Literal["picture"] = tag("picture")
    origin: Either[None, float] = param(
        None, doc="place of its lower left corner (that of the box unless said)", unit="a"
    )
    size: Either[None, float] = param(
        None, doc="its width and height (those of the box unless said)", unit="a"
    )

    _positive = field_validator("size")(positive)

    def frame(self, room: Room) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Its lower left corner, and its width and height."""
        lengths = tuple(float(length) for length in room.size)
        return self.origin or (0.0,) * len(lengths), self.size or lengths

    def grid(self, room: Room) -> Grid:
        white = self._white()
        corner, size = self.frame(room)
        wide, high = (length / n for length, n in zip(size, white.shape, strict=True))
        if not math.isclose(wide, high, rel_tol=1e-9):
            raise self.wrong(
                f"{white.shape[0]} x {white.shape[1]} pixels do not have the proportions of "
                f"{size[0]:g} x {size[1]:g} cells"
            )
        again = [
            not shut and spans(n, length / n, whole)
            for n, length, whole, shut in zip(
                white.shape, size, room.size, room.closed, strict=True
            )
        ]
        around = math.ceil(MARGIN / wide) + 4  # and what the blur reaches
        ends = [
            0 if wraps or (shut and length >= whole) else around
            for wraps, shut, length, whole in zip(again, room.closed, size, room.size, strict=True)
        ]
        white = np.pad(white, [(n, n) for n in ends], constant_values=1.0)
        distance = outline_distance(white, again, REACH / wide)
        if distance is None:
            raise self.wrong("no surface: nothing in it is both black and white")
        origin = tuple(x + (0.5 - n) * wide for x, n in zip(corner, ends, strict=True))
        return Grid(wide * distance, origin, wide)

    def notes(self, room: Room, samples: Floats) -> Iterator[str]:
        """Remarks for users: few pixels, shades of grey, a picture larger than the box."""
        name = show(self.file, 500)
        white, (_, size) = self._white(), self.frame(room)
        per_cell = white.shape[0] / size[0]
        if per_cell < ENOUGH:
            yield (
                f"file = {name}: {per_cell:.3g} pixel{'s' * (per_cell != 1)} a cell; the surface "
                f"is smoothed by a pixel: draw with {ENOUGH} or more"
            )
        solid, grey = white < 1.0 - PLAIN, (white > PLAIN) & (white < 1.0 - PLAIN)
        inner = ndimage.binary_erosion(grey, np.ones((3, 3)), border_value=1)
        share = inner.sum() / max(solid.sum(), 1)
        if share > FEW:
            yield (
                f"file = {name}: {100 * share:.0f} % of what is drawn is neither black nor white, "
                "beyond the width of an edge; the surface is where it is half white"
            )
        if self._format == "JPEG":
            yield f"file = {name}: a JPEG, which blurs edges; expected a PNG"
        for axis, (length, whole) in enumerate(zip(size, room.size, strict=True)):
            if length > whole * (1.0 + 1e-9):
                yield (
                    f"size = {show(size)}: the picture reaches over the box by "
                    f"{length - whole:.4g} cells along {'xyz'[axis]}"
                )

    @functools.cached_property
    def _format(self) -> str | None:
        from PIL import Image

        with Image.open(io.BytesIO(self.contents), formats=FORMATS) as image:
            return image.format

    def _white(self) -> Floats:
        """How white each pixel is, from 0 to 1, x first and y upwards."""
        from PIL import Image, UnidentifiedImageError

        ignoring_size = warnings.catch_warnings(
            action="ignore", category=Image.DecompressionBombWarning
        )
        try:
            with ignoring_size, Image.open(io.BytesIO(self.contents), formats=FORMATS) as image:
                if image.width * image.height > LARGEST:
                    raise self.wrong(
                        f"{image.width} x {image.height} pixels: expected at most {LARGEST}"
                    )
                if image.mode.startswith("I"):  # 16 bits of grey
                    grey, alpha = np.asarray(image, float) / 65535.0, np.ones(1)
                else:
                    levels = np.asarray(image.convert("RGBA"), float) / 255.0
                    grey = levels[..., :3] @ np.array([0.299, 0.587, 0.114])
                    alpha = levels[..., 3]
        except Image.DecompressionBombError:
            raise self.wrong(f"too many pixels: expected at most {LARGEST}") from None
        except (UnidentifiedImageError, OSError, ValueError, SyntaxError):
            raise self.wrong("expected a picture, such as PNG") from None
        return np.ascontiguousarray((1.0 - alpha * (1.0 - grey))[::-1].T)

    def pivot(self, room: Room) -> tuple[float, ...]:
        corner, size = self.frame(room)
        return tuple(x + 0.5 * length for x, length in zip(corner, size, strict=True))


def outline_distance(white: Floats, repeats: list[bool], reach: float) -> Floats | None:
    """Signed distance in pixels, at most `reach`, from where a picture is half white.

    None if it nowhere is. The outline is that of the blurred picture: points near it are brought
    onto it by Newton's method, and the distance is that from the nearest of them.
    """
    modes = ["grid-wrap" if again else "nearest" for again in repeats]
    level = ndimage.gaussian_filter(white, BLUR, mode=modes) - 0.5
    slopes = [
        ndimage.gaussian_filter(white, BLUR, order=order, mode=modes) for order in ((1, 0), (0, 1))
    ]
    fields = [level, *slopes]
    for axis, again in enumerate(repeats):  # one more pixel at each end
        widths = [(1, 1) if k == axis else (0, 0) for k in range(2)]
        fields = [np.pad(field, widths, mode="wrap" if again else "edge") for field in fields]
    steep = np.hypot(*slopes)
    near = np.argwhere((np.abs(level) < NEAR * steep) & (steep > 1e-3))
    steps = (np.arange(FINE) + 0.5) / FINE - 0.5
    around = np.stack(np.meshgrid(steps, steps, indexing="ij"), -1).reshape(-1, 2)
    points = (near[:, None] + around).reshape(-1, 2)
    off = np.zeros(len(points))
    # Newton's method along the gradient of the blurred picture, in pixels, for all points at once.
    # A step is at most one pixel, so a point does not jump to another outline.
    for _ in range(8):
        f, gx, gy = (ndimage.map_coordinates(field, points.T + 1.0, order=1) for field in fields)
        square = np.maximum(gx**2 + gy**2, 1e-6)
        step = (f / square)[:, None] * np.stack([gx, gy], -1)
        off = np.hypot(*step.T)
        points = points - step / np.maximum(1.0, off)[:, None]
        for axis, again in enumerate(repeats):
            n = white.shape[axis]
            points[:, axis] = points[:, axis] % n if again else points[:, axis].clip(0.0, n - 1.0)
    points = points[off < 1e-2]
    if len(points) == 0:
        return None
    sides = [float(n) if again else 0.0 for n, again in zip(white.shape, repeats, strict=True)]
    pixels = np.indices(white.shape).reshape(2, -1).T
    tree = KDTree(points, boxsize=sides, leafsize=LEAF)
    distance, _ = tree.query(pixels, distance_upper_bound=reach)
    return np.where(level < 0.0, -1.0, 1.0) * np.minimum(distance, reach).reshape(white.shape)
