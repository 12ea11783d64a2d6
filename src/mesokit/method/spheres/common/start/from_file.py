"""Spheres where a file of another program, or an export, has them."""

from pathlib import Path
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.given.file import FileName
from mesokit.errors import CaseError
from mesokit.io.snapshot_file import read_snapshot
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.fitted import fitted
from mesokit.method.spheres.common.start.protocol import Placed, SphereStart


@component
class FileStart(SphereStart):
    """The last frame of a GSD file, or a LAMMPS data file: places, and what else it tells.

    Velocities and spins that it has not are drawn.
    """

    rule: Literal["file"] = tag("file")
    file: FileName = param(doc="GSD file (.gsd) or LAMMPS data file (.data, .lmp)")
    scale: float | None = param(
        None,
        doc="lengths of the case per length of the file: of places, box, diameters and velocities "
        "(1 unless said)",
        gt=0,
        le=1e12,
    )
    moving: bool = param(True, doc="with the velocities and spins of the file; if not, drawn ones")

    def place(self, case: Case, made: Made) -> Placed:
        """What the file has. Raises CaseError where it cannot be read or has other spheres."""
        try:
            return fitted(case, made, read_snapshot(self.file, self.scale), self.moving)
        except CaseError as error:
            raise CaseError(f"spheres.start.file = {show(self.file, 500)}: {error}") from None

    def files(self) -> dict[str, Path]:
        """The file."""
        return {"file": Path(self.file)}
