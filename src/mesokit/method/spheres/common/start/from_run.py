"""Spheres where an earlier run has left them."""

from pathlib import Path
from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.given.file import FileName
from mesokit.errors import CaseError, MesokitError
from mesokit.io.earlier_spheres import spheres_of
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.fitted import fitted
from mesokit.method.spheres.common.start.protocol import Placed, SphereStart


@component
class RunStart(SphereStart):
    """The last state of an earlier run, of whichever method of spheres, to the last digit."""

    rule: Literal["run"] = tag("run")
    run: FileName = param(doc="folder of the earlier run: go on from its last state")
    moving: bool = param(True, doc="with the velocities and spins of that run; if not, drawn ones")

    def place(self, case: Case, made: Made) -> Placed:
        """What the run has. Raises CaseError where there is none, or it has other spheres."""
        try:
            return fitted(case, made, spheres_of(self.run), self.moving)
        except MesokitError as error:
            raise CaseError(f"spheres.start.run = {show(self.run, 500)}: {error}") from None

    def files(self) -> dict[str, Path]:
        """The folder."""
        return {"run": Path(self.run)}
