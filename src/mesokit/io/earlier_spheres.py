"""Spheres of the last checkpoint of an earlier run."""

from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.seam.method import method_of


def spheres_of(path: str) -> Snapshot:
    """The spheres at the last checkpoint of the run in a folder, of any method.

    Raises RunError for a folder without one, CaseError for a run of other particles.
    """
    directory = RunDirectory.existing(path)
    earlier = Case.from_toml(directory.case_file)
    method, d = method_of(earlier), earlier.box.dimension
    if not earlier.particles_have("diameter"):
        raise CaseError(
            f"that is a run of method {show(earlier.run.method)}, whose particles have no size"
        )
    arrays, _ = checkpoint.read(directory.checkpoint_file)
    engine: Any = method.engine(earlier, 1, ())
    engine.restore(checkpoint.part(arrays, "engine/"))
    spins = engine.spins()
    lengths = np.ones(3)
    lengths[:d] = earlier.box.size
    return Snapshot(
        positions=np.pad(engine.positions(), ((0, 0), (0, 3 - d))),
        velocities=np.pad(engine.velocities(), ((0, 0), (0, 3 - d))),
        images=None,
        masses=np.asarray(engine.masses(), float),
        bonds=np.zeros((0, 2), np.int64),
        numbers=np.arange(engine.n),
        low=np.zeros(3),
        lengths=lengths,
        tilts=np.zeros(3),
        diameters=np.asarray(engine.diameters(), float),
        spins=np.pad(spins[:, None], ((0, 0), (2, 0))) if d == 2 else spins,
    )
