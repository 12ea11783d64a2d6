"""Solids that were read from files, kept in the folder of a run."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from mesokit.geometry.from_file import FromFile
from mesokit.geometry.sampled import Sampled
from mesokit.io.atomic import replacing
from mesokit.solids import solids_of

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.io.run_directory import RunDirectory


def keep_solids(case: Case, directory: RunDirectory) -> Case:
    """The case with the distances that its files gave, which are written into the folder now.

    So a run goes on with the same solids, and can be moved, whatever becomes of the files. Raises
    RunError.
    """
    walls = list(case.walls)
    for i, wall in enumerate(case.walls):
        if not isinstance(wall, FromFile):
            continue
        solids, file = solids_of(case), directory.wall_file(i + 1)
        grid = wall.grid(solids.room)
        with replacing(file) as temporary, temporary.open("wb") as stream:
            np.save(stream, grid.values)
        walls[i] = Sampled(
            file=str(file),
            spacing=grid.spacing,
            origin=grid.origin,
            centre=wall.pivot(solids.room),
            name=solids.bodies[solids.walls.index(i)].name,
            **wall.kept(),
        )
    return dataclasses.replace(case, walls=tuple(walls))
