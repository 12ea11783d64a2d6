"""The table `start` of a case: where positions and velocities come from."""

from mesokit.case.component import component, param, show
from mesokit.case.given.file import FileName


@component
class Start:
    """Where positions and velocities come from; without files they are drawn from the seed.

    Drawn positions are uniform; drawn velocities are Maxwellian with zero total momentum.
    """

    positions: FileName | None = param(None, doc="file .npy or .npz with an (n, d) array", unit="a")
    velocities: FileName | None = param(
        None, doc="file .npy or .npz with an (n, d) array", unit="a/time"
    )
    run: FileName | None = param(None, doc="folder of an earlier run: go on from its last state")
    file: FileName | None = param(
        None, doc="GSD file (its last frame) or LAMMPS data file, with the bonds of the molecules"
    )
    scale: float | None = param(
        None,
        doc="cells per length of these files, of places and velocities (1 unless said)",
        gt=0,
        le=1e12,
    )

    def __post_init__(self) -> None:
        if self.scale is not None and not (self.file or self.positions or self.velocities):
            raise ValueError(f"scale = {show(self.scale)}: only with file, positions or velocities")
