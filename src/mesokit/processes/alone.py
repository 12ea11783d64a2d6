"""One process that runs a case, and the interface that several ranks have as well."""

import contextlib
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

T = TypeVar("T")


class Order(NamedTuple):
    """Decision of rank 0 for all ranks: go on to step `target`, with a checkpoint there if `save`,
    or stop here by the signal of number `stop` if that is not 0."""

    target: int
    save: bool
    stop: int


Coming = Callable[[], Order]  # waits for an order


class Alone:
    """One process without others.

    >>> Alone().on_root(lambda: 5), Alone().gathered(5)
    (5, [5])
    """

    rank, size, root = 0, 1, True
    comm: Any = None  # of the ranks' engines

    def on_root(self, function: Callable[[], T]) -> T:
        """The result of a function that rank 0 alone calls. All ranks raise its MesokitError."""
        return function()

    def by_root(self, function: Callable[[], T]) -> T:
        """The result of rank 0, or its MesokitError, of a function that all ranks call."""
        return function()

    def each(self, function: Callable[[], T]) -> T:
        """The result of a function that all ranks call, each for its part.

        If it raises MesokitErrors, the first one is raised on all ranks.
        """
        return function()

    def answers(self, function: Callable[[], T]) -> list[T]:
        """The results of a function of the user that all ranks call.

        If it fails or ends the program on some ranks, RunError on all ranks names the first of
        them. If it does on all ranks, each raises its own error.
        """
        return [function()]

    def gathered(self, value: T) -> list[T]:
        """The values of all ranks, on all ranks."""
        return [value]

    def require_same(self, facts: Callable[[], Mapping[str, str]]) -> None:
        """Raise RunError, which names a rank and the difference, if facts differ between ranks."""

    def quietly(self) -> contextlib.AbstractContextManager[Any]:
        """Suppress warnings meanwhile on all ranks but rank 0."""
        return contextlib.nullcontext()

    def again(self, command: str) -> str:
        """The command for the present number of ranks."""
        return command

    # --- how far to go --------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin a run: earlier signals do not matter any more."""

    def heard(self, signal: int) -> int:
        """The number of the signal that has come to this rank, or on rank 0 to any; 0 if none."""
        return signal

    def ahead(self, decide: Callable[[int], Order], signal: Callable[[], int]) -> Coming:
        """Return a function that gives the order of rank 0 for the time after the steps in hand.

        Several ranks decide before these steps. `decide` takes the number of a signal that has come
        to any rank, `signal` returns that of this rank. Each returned function must be called.
        """
        return lambda: decide(signal())

    # --- the end --------------------------------------------------------------------------------

    def failed(self, note: Callable[[str], Any]) -> None:
        """Record once for all ranks that the run fails here.

        `note` takes the text before the reason: the name of the rank if not all ranks fail.
        """
        note("")

    def leave(self, say: Callable[[str], Any], status: int) -> None:
        """Print why this process ends with a status, once for all ranks that end so.

        `say` takes the name of the rank, or "" if all ranks end. Ranks that do not are ended.
        """
        say("")

    def ended(self, status: int) -> None:
        """End this process in order."""
