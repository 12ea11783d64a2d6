"""Make the films of README from examples: short runs, and small GIFs with few colours.

python docs/generate/films.py [NAME ...]
"""

from __future__ import annotations

import dataclasses
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from PIL import Image

from mesokit import Case, FlowFrames, Simulation, open
from mesokit.report.flow import page_width

ROOT = Path(__file__).resolve().parents[2]
COLOURS, LARGEST = 64, 1_500_000  # of a film; bytes


class Film(NamedTuple):
    """An example, what is set in it, what is observed instead, and how the film is drawn."""

    example: str
    settings: dict[str, str]
    observe: tuple[Any, ...] = ()
    width: float = 4.4  # inches
    drawn: Mapping[str, Any] = MappingProxyType({})


FILMS = {
    "polymers": Film(
        "polymers_among_posts",
        {
            "run.steps": "9000",
            "trajectory.every": "100",
            "solutes.polymers": "[{ number = 4, length = 20 }]",
        },
        (FlowFrames(window=100, every=5, particles=0),),
        drawn={"kind": "speed", "fps": 12},
    ),
    "bands": Film(
        "bands",
        {"run.steps": "240", "run.warmup": "3000", "trajectory.every": "4"},
        width=5.0,
        drawn={"kind": "density", "fps": 12},
    ),
}


def make(name: str) -> Path:
    """Run the example, draw the film, and take colours away; returns the file."""
    film = FILMS[name]
    case = Case.from_toml(ROOT / "examples" / f"{film.example}.toml", film.settings)
    path = ROOT / "docs" / "images" / f"film-{name}.gif"
    with tempfile.TemporaryDirectory() as folder, page_width(film.width):
        run = Path(folder) / film.example
        Simulation(dataclasses.replace(case, observe=film.observe), output=run).run()
        open(run).animate(path, **film.drawn)
    fewer_colours(path)
    print(f"{path}: {path.stat().st_size / 1e6:.2f} MB")
    if path.stat().st_size > LARGEST:
        raise SystemExit(f"{path}: larger than {LARGEST / 1e6} MB")
    return path


def fewer_colours(path: Path) -> None:
    """Write a GIF anew with one palette for all frames, and no dots to mix colours."""
    with Image.open(path) as film:
        duration = film.info["duration"]
        frames = []
        for number in range(film.n_frames):
            film.seek(number)
            frames.append(film.convert("RGB"))
    palette = frames[len(frames) // 2].quantize(COLOURS, Image.Quantize.MAXCOVERAGE)
    few = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    few[0].save(path, save_all=True, append_images=few[1:], duration=duration, loop=0)


if __name__ == "__main__":
    for name in sys.argv[1:] or FILMS:
        make(name)
