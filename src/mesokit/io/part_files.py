"""Files from which parts and solids were made, kept in the folder of a run."""

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.case.given.file import FromContents
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.shape.sampled import Sampled
from mesokit.geometry.solids.solids import Solids
from mesokit.io.atomic import replacing
from mesokit.io.run_directory import RunDirectory


def kept_row(parts: tuple[Any, ...], key: str, name: str, folder: Path) -> tuple[Any, ...]:
    """Components of which each holds the contents of the file of its part of that key, as
    `kept_part` has it; files are named by `name`, the number of the component, and the key."""
    found = tuple(
        _kept(part, key, f"{name}-{n}-{key}", folder) for n, part in enumerate(parts, start=1)
    )
    return parts if all(a is b for a, b in zip(found, parts, strict=True)) else found


def kept_part(whole: Any, key: str, folder: Path) -> Any:
    """A case, or a component, whose part of that key holds the contents of its file, if it has one:
    they are written into the folder, under the last name of the key, now.

    So a run goes on with the same part, and can be moved, whatever becomes of the file. Raises
    RunError.
    """
    name, _, rest = key.partition(".")
    part: Any = getattr(whole, name)
    if rest:
        kept = kept_part(part, rest, folder) if part is not None else None
    else:
        return _kept(whole, name, name, folder)
    return whole if kept is part else dataclasses.replace(whole, **{name: kept})


def _kept(whole: Any, key: str, name: str, folder: Path) -> Any:
    """The component whose part of that key is read from a file of that name in the folder."""
    part = getattr(whole, key)
    if not isinstance(part, FromContents):
        return whole
    file = RunDirectory(folder).part_file(f"{name}{Path(part.file).suffix}")
    with replacing(file) as temporary:
        temporary.write_bytes(part.contents)
    part = dataclasses.replace(part, file=str(file))  # type: ignore[type-var]
    return dataclasses.replace(whole, **{key: part})


def kept(walls: Sequence[Any], solids: Solids, folder: Path) -> tuple[Any, ...]:
    """The walls with the distances that their files gave, which are written into the folder now.

    So a run goes on with the same solids, and can be moved, whatever becomes of the files. Raises
    RunError.
    """
    found = list(walls)
    for i, wall in enumerate(walls):
        if not isinstance(wall, FromFile):
            continue
        file = RunDirectory(folder).wall_file(i + 1)
        grid = wall.distances(solids.room)
        with replacing(file) as temporary, temporary.open("wb") as stream:
            np.save(stream, grid.values)
        found[i] = Sampled(
            file=str(file),
            spacing=grid.spacing,
            origin=grid.origin,
            centre=wall.pivot(solids.room),
            name=solids.bodies[solids.walls.index(i)].name,
            **wall.kept(),
        )
    return tuple(found)
