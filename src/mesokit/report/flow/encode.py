"""Pictures into one file: MP4 by the ffmpeg that a Python package brings, GIF by Pillow."""

from collections.abc import Callable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import RunError

Pixels = NDArray[np.uint8]
About = Mapping[str, str]  # names of metadata and their texts
QUALITY = 7  # of 10: letters stay sharp


def mp4(path: Path, pictures: Iterator[Pixels], fps: float, about: About) -> None:
    """Write pictures (height, width, 3) as a film that every player reads (H.264, yuv420p).

    Such films have even sizes: an odd last row or column is left out. `about` are entries of the
    file's metadata. Raises RunError if the film
    is not whole.
    """
    from imageio_ffmpeg import count_frames_and_secs, write_frames

    first = next(pictures)
    pictures = chain([first], pictures)
    height, width = (2 * (side // 2) for side in first.shape[:2])
    entries = [word for item in about.items() for word in ("-metadata", "=".join(item))]
    how: dict[str, Any] = {"codec": "libx264", "quality": QUALITY, "macro_block_size": 1}
    how["output_params"] = ["-f", "mp4", "-movflags", "+faststart", *entries]
    writer = write_frames(path, (width, height), fps=fps, ffmpeg_log_level="quiet", **how)
    count = 0
    try:
        writer.send(None)
        for pixels in pictures:
            writer.send(np.ascontiguousarray(pixels[:height, :width]))
            count += 1
        writer.close()
        whole = count_frames_and_secs(path)[0] == count
    except (OSError, RuntimeError):  # a pipe that broke, a file that cannot be read
        whole = False
    finally:
        writer.close()
    if not whole:
        raise RunError("ffmpeg could not write the film; is the disk full?")


def gif(path: Path, pictures: Iterator[Pixels], fps: float, about: About) -> None:
    """Write pictures (height, width, 3) as a GIF that starts again at its end."""
    from PIL import Image

    images = map(Image.fromarray, pictures)
    shown = max(2, round(100 / fps)) * 10  # ms; a GIF counts in hundredths of a second
    look: dict[str, Any] = {"duration": shown, "loop": 0, **about}
    next(images).save(path, format="GIF", save_all=True, append_images=images, **look)


ENCODERS: dict[str, Callable[[Path, Iterator[Pixels], float, About], None]] = {
    ".mp4": mp4,
    ".gif": gif,
}
