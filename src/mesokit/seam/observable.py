"""Observables, and the accumulators that keep their numbers."""

from abc import ABC, abstractmethod, update_abstractmethods
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, option
from mesokit.case.registry import family
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

Array = NDArray[np.floating[Any]]
State = dict[str, NDArray[Any]]
T = TypeVar("T", bound="Callable[[Any, Case], Accumulator]")


class Accumulator(Protocol):
    """The memory of an observable during a run: bounded, and the same bits after any resume."""

    def observe(self, engine: Any) -> None:
        """Take one sample."""

    def state(self) -> State:
        """Its memory as arrays."""

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""

    def pool(self, other: Self) -> None:
        """Take in the samples of an independent run of the same case: only to read from then on."""

    def result(self) -> Result:
        """The result of the samples so far."""


@family(
    "observable",
    "quantity",
    "mesokit.observable",
    "Simulation(..., callbacks=[every(10, function)]) calls one, a class makes an observable",
)
@component
class Observable(ABC):  # noqa: B024  # `accumulator` is abstract
    """Something measured during a run."""

    methods: ClassVar[tuple[str, ...]] = ()  # it is for, beside those that offer it
    of_methods_alone: ClassVar[bool] = False  # whether it is for no others
    needs_fluid: ClassVar[bool] = True  # whether solutes alone cannot answer it
    in_open_box: ClassVar[bool] = False  # True: measured of particles far outside the box too
    # whether its theory needs the transport coefficients of the fluid as it is, molecules and all
    asks_transport: ClassVar[bool] = False
    of_built_up_flow: ClassVar[bool] = False  # whether its theory is of the steady flow
    # words of the names of numbers that do not depend on the flow, or on kT; "" is in all names
    in_any_flow: ClassVar[tuple[str, ...]] = ()
    at_any_kT: ClassVar[tuple[str, ...]] = ()
    measures: ClassVar[tuple[str, ...]] = ()  # "stress" or "walls": what the step has to sum for it
    # of its result: kind of figure, words for the values, units of these ("value") and of axes
    drawing: ClassVar[str] = "curve"
    value_label: ClassVar[str] = ""
    units: ClassVar[dict[str, str]] = {}
    every: int = option(default=10, doc="steps between two samples", ge=1, kw_only=True)
    name: str | None = option(
        default=None,
        doc="name of the results (the quantity unless said)",
        kw_only=True,
        min_length=1,
    )

    @property
    def label(self) -> str:
        """The name under which its results are kept."""
        return self.name or name_of(self)

    def check(self, case: Case) -> None:  # noqa: B027  # most can be measured anywhere
        """Raise CaseError if it cannot be measured in this case."""

    def warnings(self, case: Case) -> Iterator[str]:
        """Warnings about measuring it in this case, key first."""
        yield from ()

    def accumulator(self, case: Case) -> Accumulator:
        """An empty memory for it: a method of its own, or a class marked with `accumulator_of`."""
        raise NotImplementedError

    if not TYPE_CHECKING:  # type checkers do not see what `accumulator_of` adds
        accumulator = abstractmethod(accumulator)


def accumulator_of(observable: type[Observable]) -> Callable[[T], T]:
    """Mark the class of an observable's accumulators; each is made of the observable and a case."""

    def mark(made: T) -> T:
        def accumulator(self: Observable, case: Case) -> Accumulator:
            """An empty memory for it."""
            self.check(case)
            return made(self, case)

        observable.accumulator = accumulator  # type: ignore[method-assign]
        update_abstractmethods(observable)
        return made

    return mark


def pack(**parts: object) -> State:
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
    """An accumulator whose memory is the parts that `memory` names: blocks unless given.

    Each is a part that has a state of its own (`Blocks`, `TimeSeries`, ...), a number or an array,
    or a dictionary of such parts by name. A part that is None is left out. Parts that can pool
    those of another run do so; numbers and arrays stay those of this run, unless they are `added`.
    It is made of an observable and a case; a subclass makes its parts in `prepare`.
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks",)
    added: ClassVar[tuple[str, ...]] = ()  # numbers, arrays and lists that pooling adds up
    observable: Any
    case: Case
    name: str
    blocks: Blocks

    def __init__(self, observable: Any, case: Case) -> None:
        self.observable, self.case, self.name = observable, case, observable.label
        self.prepare()

    def prepare(self) -> None:  # noqa: B027  # a subclass may have an __init__ instead
        """Make the parts that samples are added to."""

    def report(
        self,
        x: Mapping[str, Any],
        found: Any,
        comparisons: Iterable[Comparison | None] = (),
        *,
        samples: int | None = None,
        units: Mapping[str, str] | None = None,
        **more: Any,
    ) -> Result:
        """The result; label, drawing and units are those of the observable.

        Parameters
        ----------
        x: coordinates of each axis, arrays or sequences.
        found: `Blocks`, whose mean it is; an `Estimate` or another with `value` and `error`; a list
            of those, one a column; a pair of values and errors; values alone, without (nan).
        comparisons: a list, or a generator, run only where there are samples; None is left out.
        samples: their number (that of `blocks` unless given).
        units: further units, that of "value" included.
        more: further fields of `Result`, such as `expected`, `theory`, `label`.
        """
        observable, count = self.observable, self.blocks.count if samples is None else samples
        if isinstance(found, list):
            value = np.stack([one.value for one in found], axis=1)
            error = np.stack([one.error for one in found], axis=1)
        elif isinstance(found, Blocks):
            value, error = found.mean(), found.error()
        elif hasattr(found, "value"):
            value, error = found.value, found.error
        elif isinstance(found, tuple):
            value, error = found
        else:
            value, error = found, np.full(np.shape(found), np.nan)
        given = isinstance(comparisons, list | tuple)
        known = {"label": observable.value_label, "drawing": observable.drawing}
        return Result(
            quantity=name_of(observable),
            name=observable.label,
            x={name: np.asarray(axis) for name, axis in x.items()},
            value=value,
            error=error,
            units={"value": ""} | observable.units | dict(units or {}),
            comparisons=tuple(filter(None, comparisons)) if count or given else (),
            samples=count,
            **(known | more),
        )

    def _parts(self, names: Iterable[str]) -> list[tuple[dict[str, Any], str, Any]]:
        """The dictionary that holds a part, its name there, and the part."""
        found = []
        for name in names:
            part = getattr(self, name)
            if isinstance(part, dict):
                found += [(part, key, one) for key, one in part.items()]
            elif part is not None:
                found.append((vars(self), name, part))
        return found

    def state(self) -> State:
        """Its memory as arrays."""
        return pack(**{name: part for _, name, part in self._parts(self.memory)})

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        for holder, name, part in self._parts(self.memory):
            if hasattr(part, "restore"):
                part.restore(unpack(state, name))
            elif hasattr(part, "from_state"):
                holder[name] = type(part).from_state(unpack(state, name))
            else:
                kind = type(part) if isinstance(part, int | float) else np.array
                holder[name] = kind(state[name])

    def pool(self, other: Self) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        theirs = {name: part for _, name, part in other._parts(self.memory)}
        for _, name, part in self._parts(self.memory):
            if hasattr(part, "pool"):
                part.pool(theirs[name])
        for name in self.added:
            setattr(self, name, getattr(self, name) + getattr(other, name))
