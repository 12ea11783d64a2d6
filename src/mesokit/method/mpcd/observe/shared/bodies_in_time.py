"""What observables of bodies at two times share: the axes that count, and many origins."""

from typing import Any, ClassVar

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.bodies import followed
from mesokit.method.mpcd.expected.setting import quiet_axes
from mesokit.observe.shared.origins import Origins
from mesokit.seam.observable import BlockAccumulator


def free_axes(case: Case, observable: Any, turns: bool) -> tuple[int, ...]:
    """Axes along which bodies of a kind move freely, or about which they turn.

    Axes along which the fluid flows or that a wall closes are left out. Raises CaseError without
    any, or without such bodies.
    """
    kind = followed(case, observable.quantity, observable.kind)
    found = kind.turning
    if not turns:
        found = tuple(axis for axis in quiet_axes(case) if axis in kind.moving)
    if not found:
        moves = "turns about" if turns else "moves along"
        raise CaseError(f"of = {observable.of!r}: {kind.name} {moves} no axis freely")
    return found


class BodiesInTime(BlockAccumulator):
    """Numbers of each body of a kind, along the axes of the observable, at many origins."""

    memory: ClassVar[tuple[str, ...]] = ("origins",)

    def prepare(self) -> None:
        observable = self.observable
        self.of = followed(self.case, observable.quantity, observable.kind)
        self.axes = list(observable.axes(self.case))
        max_lag = max(1, observable.max_lag // observable.every)
        self.origins = Origins(self.of.number, len(self.axes), max_lag)
