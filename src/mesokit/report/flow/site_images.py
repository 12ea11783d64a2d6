"""Images of the sites of a lattice: a block of pixels for each site, and nothing else."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.io.site_files import Frames, SiteFrame, Sites, one_each
from mesokit.report.flow.palette import colours

MOST_PIXELS = 64
SHADES = 256


def write(path: Path, sites: Sites, frames: Frames, pixels: int = 1) -> Path:
    """A PNG file of each frame, x to the right and y upwards, in the colours of pictures.

    Its pixels are numbers of states, with a colour of each. Heights have colours from the lowest to
    the highest of all frames. Raises CaseError for a lattice of other axes, or of shifted rows.
    """
    from PIL import Image

    lattice = sites.lattice
    if lattice.dimension != 2:
        raise CaseError(
            f"{path}: images have two axes, this lattice has {lattice.dimension}; expected "
            "'.xyz', '.vti' or a picture (mesokit plot)"
        )
    if lattice.shifted:
        raise CaseError(
            f"{path}: rows of this lattice are shifted by half a site, pixels are not; expected "
            "'.xyz' or a picture of kind 'sites' (mesokit plot)"
        )
    low, number = 0, max(len(sites.names), 1)
    if not sites.names:
        ends = [(now.states.min(), now.states.max()) for now in frames()]
        low, high = (
            int(f(end)) for f, end in zip((min, max), zip(*ends, strict=True), strict=True)
        )
        number = high - low + 1
    shades = min(number, SHADES)
    palette = (255 * colours(shades)(np.arange(shades))[:, :3] + 0.5).astype(np.uint8)

    def draw(file: Path, now: SiteFrame) -> None:
        image = Image.fromarray(_raster(now.states, lattice.size, low, number, pixels))
        image.putpalette(palette.tobytes())
        image.save(file, format="PNG", optimize=False)

    return one_each(path, sites, frames(), draw)


def _raster(
    states: NDArray[np.integer], size: tuple[int, ...], low: int, number: int, pixels: int
) -> NDArray[np.uint8]:
    """Numbers of colours, rows from above."""
    above = states.astype(np.int64).reshape(size) - low
    if number > SHADES:
        above = above * SHADES // number
    rows = above.astype(np.uint8).T[::-1]
    return rows.repeat(pixels, axis=0).repeat(pixels, axis=1)
