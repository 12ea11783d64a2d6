"""Spheres from a file of another program, from an export or from an earlier run."""

from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.given.file import FileName
from mesokit.case.given.snapshot import Snapshot
from mesokit.errors import CaseError, MesokitError
from mesokit.io.earlier_spheres import spheres_of
from mesokit.io.snapshot_file import read_snapshot
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.protocol import Array, Placed, SphereStart

ROUNDING = 1e-5  # relative, of numbers in single precision and in texts
SHRINK = "part by which diameters are smaller than there, so that spheres at rest come apart"


@component
class FileStart(SphereStart):
    """The last frame of a GSD file, or a LAMMPS data file: places, and all else in it.

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
    shrink: float = param(
        0.0,
        doc=SHRINK,
        ge=0,
        lt=0.5,
    )

    def place(self, case: Case, made: Made) -> Placed:
        try:
            return fitted(
                case, made, read_snapshot(self.file, self.scale), self.moving, self.shrink
            )
        except CaseError as error:
            raise CaseError(f"spheres.start.file = {show(self.file, 500)}: {error}") from None

    def files(self) -> dict[str, Path]:
        return {"file": Path(self.file)}


@component
class RunStart(SphereStart):
    """The last state of an earlier run, of whichever method of spheres, to the last digit."""

    rule: Literal["run"] = tag("run")
    run: FileName = param(doc="folder of the earlier run: go on from its last state")
    moving: bool = param(True, doc="with the velocities and spins of that run; if not, drawn ones")
    shrink: float = param(
        0.0,
        doc=SHRINK,
        ge=0,
        lt=0.5,
    )

    def place(self, case: Case, made: Made) -> Placed:
        try:
            return fitted(case, made, spheres_of(self.run), self.moving, self.shrink)
        except MesokitError as error:
            raise CaseError(f"spheres.start.run = {show(self.run, 500)}: {error}") from None

    def files(self) -> dict[str, Path]:
        return {"run": Path(self.run)}


def fitted(case: Case, made: Made, there: Snapshot, moving: bool, shrink: float) -> Placed:
    """The spheres of a file by the numbers of the case, from the corner of its box.

    `moving`: whether they keep their velocities and spins. Diameters are those of the file where
    kinds have a spread, less a part `shrink` of them, and masses go with them.

    Raises CaseError unless box, number, diameters and masses are those of the case.
    """
    d, n = case.box.dimension, len(there.positions)
    _require_box(case, there)
    if n != len(made.diameters):
        raise CaseError(f"it has {n} particles, this case {len(made.diameters)}")
    if len(there.bonds):
        raise CaseError(f"it has {len(there.bonds)} bonds; spheres have none")
    order, diameters = _by_diameter(case, made, there)
    if there.masses is not None:
        wanted = made.masses * (diameters / made.diameters) ** d
        off = ~np.isclose(there.masses[order], wanted, rtol=10 * ROUNDING, atol=0)
        if off.any():
            one = int(np.argmax(off))
            raise CaseError(
                f"particle {there.numbers[order[one]]} has mass {there.masses[order[one]]:.6g}; "
                f"expected {wanted[one]:.6g} (spheres.kinds[#{made.kinds[one] + 1}])"
            )
    velocities = spins = None
    if moving and there.velocities is not None:
        velocities = there.velocities[order, :d]
    if moving and there.spins is not None:
        spins = there.spins[order, 2] if d == 2 else there.spins[order]
    near = shrink == 0 and np.allclose(diameters, made.diameters, rtol=ROUNDING, atol=0)
    places = (there.positions - there.low)[order, :d]
    return Placed(places, velocities, spins, None if near else diameters * (1 - shrink))


def _require_box(case: Case, there: Snapshot) -> None:
    """Raise CaseError for other lengths, for a tilted box, and in 2D for different z."""
    d, size = case.box.dimension, np.array(case.box.size, float)
    if np.abs(there.tilts).max() > ROUNDING * min(1.0, *there.lengths):
        raise CaseError(f"its box leans by {show(there.tilts.tolist())}; expected right angles")
    if not np.allclose(there.lengths[:d], size, rtol=ROUNDING, atol=0):
        found, wanted = show(there.lengths[:d].tolist()), show(list(case.box.size))
        ratio = float(size[0] / there.lengths[0]) if there.lengths[0] > 0 else 0.0
        alike = np.allclose(there.lengths[:d] * ratio, size, rtol=ROUNDING, atol=0)
        hint = f"; scale = {ratio:.6g} would make it so" if alike else ""
        raise CaseError(f"it has a box of {found}, this case {wanted} (box.size){hint}")
    if d == 2 and np.ptp(there.positions[:, 2]) > ROUNDING * max(size):
        raise CaseError("its particles differ in z; expected a 2D box as in this case")


def _by_diameter(case: Case, made: Made, there: Snapshot) -> tuple[NDArray[np.int64], Array]:
    """The particle of the file for each number of the case, and its diameter.

    Numbers are those of the file where their diameters are of the right kinds, else by size.
    """
    order = np.arange(len(made.diameters))
    if there.diameters is None:
        return order, made.diameters
    scale = case.spheres.scale(case.box)
    middle = np.array([kind.diameter for kind in case.spheres.kinds])[made.kinds] * scale
    spread = np.array([kind.spread for kind in case.spheres.kinds])[made.kinds]
    low, high = middle * (1 - spread - ROUNDING), middle * (1 + spread + ROUNDING)

    def off(diameters: Array) -> NDArray[np.bool_]:
        return (diameters < low) | (diameters > high)

    if off(there.diameters).any():
        order[np.argsort(made.diameters, kind="stable")] = np.argsort(
            there.diameters, kind="stable"
        )
    found = there.diameters[order]
    if off(found).any():
        one = int(np.argmax(off(found)))
        ends = sorted({float(f"{middle[one] * (1 + s * spread[one]):.6g}") for s in (-1, 1)})
        wanted = " to ".join(f"{end:g}" for end in ends)
        raise CaseError(
            f"particle {there.numbers[order[one]]} has diameter {found[one]:.6g}; expected "
            f"{wanted} (spheres.kinds[#{made.kinds[one] + 1}])"
        )
    return order, found
