"""What an observable is, what it may ask of the running fluid, and how it keeps its numbers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.component import component, param
from mesokit.observe.result import Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case import Case

Array = NDArray[np.floating[Any]]
State = dict[str, NDArray[Any]]


class RunningFluid(Protocol):
    """What an observer may ask of the running fluid; d is the dimension, order is by particle id.

    `totals` gives number, momentum (d,) and kinetic energy of all particles. `moments` gives
    number, mass (*bins), momentum (d, *bins) and sum of m v^2 (*bins) in equal bins over the
    whole box along `axes`. `modes` gives sum m e^(-i k r) (K,) and sum m v e^(-i k r) (K, d).
    `bond_vectors` (bonds, d) lead from the first to the second particle of each bond.
    `whole_positions` are those of whole molecules, each bead next to its first, whatever images
    they lie in: under shear `unwrapped` positions do not know how far images have slid.
    `stress` holds "kinetic", "collisional" and, of molecules, "bond" (d, d) of the last step if an
    observer due at it declares `measures = ("stress",)`. `wall_impulse` (surfaces, d + 1 or d + 3)
    is the momentum and angular momentum given to the lower and the upper plate of a slit, or to
    each body, during the last `wall_steps` steps, for `measures = ("walls",)`.
    """

    n: int
    dimension: int
    box: Array
    step: int

    @property
    def time(self) -> float: ...
    def totals(self) -> tuple[int, Array, float]: ...
    def moments(
        self, axes: tuple[int, ...], bins: tuple[int, ...]
    ) -> tuple[Array, Array, Array, Array]: ...
    def modes(
        self, wavevectors: Array
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]: ...
    def positions(self, ids: NDArray[np.int64] | None = None, unwrapped: bool = False) -> Array: ...
    def velocities(self, ids: NDArray[np.int64] | None = None) -> Array: ...
    def images(self, ids: NDArray[np.int64] | None = None) -> NDArray[np.int32]: ...
    def masses(self, ids: NDArray[np.int64] | None = None) -> Array: ...
    def bond_vectors(self) -> Array: ...
    def whole_positions(self, ids: NDArray[np.int64] | None = None) -> Array: ...
    def potential_energy(self) -> float: ...
    @property
    def stress(self) -> Mapping[str, Array]: ...
    @property
    def wall_impulse(self) -> Array: ...
    @property
    def wall_steps(self) -> int: ...


class Accumulator(Protocol):
    """The memory of an observable during a run: bounded, and the same bits after any resume."""

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""

    def state(self) -> State:
        """All it has to remember, as arrays."""

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""

    def result(self) -> Result:
        """What the samples so far say."""


@component
class Observable(ABC):
    """Something measured while the fluid runs."""

    measures: ClassVar[tuple[str, ...]] = ()  # "stress" or "walls": what the step has to sum for it
    every: int = param(10, doc="steps between two samples", ge=1, kw_only=True)
    name: str | None = param(
        None, doc="name of the results (the quantity unless said)", kw_only=True, min_length=1
    )

    @property
    def label(self) -> str:
        """The name under which its results are kept."""
        return self.name or str(self.quantity)  # type: ignore[attr-defined]

    def check(self, case: Case) -> None:  # noqa: B027  # most can be measured anywhere
        """Raise CaseError if it cannot be measured in this case."""

    @abstractmethod
    def accumulator(self, case: Case) -> Accumulator:
        """An empty memory for it."""


def pack(**parts: Any) -> State:
    """The states of several parts (Blocks, MultipleTau, arrays) as one.

    >>> pack(rows=np.zeros(2))
    {'rows': array([0., 0.])}
    """
    state: State = {}
    for name, part in parts.items():
        if hasattr(part, "state"):
            state |= {f"{name}/{key}": array for key, array in part.state().items()}
        else:
            state[name] = np.array(part)
    return state


def unpack(state: Mapping[str, NDArray[Any]], name: str) -> State:
    """The state of one part.

    >>> unpack({"a/sums": np.ones(1), "b": np.zeros(1)}, "a")
    {'sums': array([1.])}
    """
    start = name + "/"
    return {key[len(start) :]: value for key, value in state.items() if key.startswith(start)}


class BlockAccumulator(ABC):
    """An accumulator that remembers block averages and nothing else."""

    blocks: Blocks

    def state(self) -> State:
        """All it has to remember."""
        return pack(blocks=self.blocks)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.blocks = Blocks.from_state(unpack(state, "blocks"))
