"""Spheres as an earlier run has left them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError
from mesokit.io import checkpoint
from mesokit.io.run_directory import RunDirectory
from mesokit.seam.method import method_of


def spheres_of(path: str) -> Snapshot:
    """The spheres at the last checkpoint of the run in a folder, whichever method it is of.

    Raises RunError for a folder without one, CaseError for a run of other particles.
    """
    from mesokit.case.case import Case

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
        positions=_deep(engine.positions()),
        velocities=_deep(engine.velocities()),
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


def _deep(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """With a third column."""
    return np.pad(values, ((0, 0), (0, 3 - values.shape[1])))
