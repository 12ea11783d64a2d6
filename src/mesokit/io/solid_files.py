"""Solids that were read from files, kept in the folder of a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.shape.sampled import Sampled
from mesokit.io.atomic import replacing
from mesokit.io.run_directory import RunDirectory

if TYPE_CHECKING:
    from mesokit.geometry.solids.solids import Solids


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
