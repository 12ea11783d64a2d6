"""A process that runs a case alone: what all ranks are asked, and how one answers."""

import contextlib
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from mesokit.processes.order import Coming, Order

T = TypeVar("T")


class Alone:
    """One process, which decides and writes.

    >>> Alone().on_root(lambda: 5), Alone().gathered(5)
    (5, [5])
    """

    rank, size, root = 0, 1, True
    comm: Any = None  # of the ranks' engines

    def on_root(self, function: Callable[[], T]) -> T:
        """What a function says that rank 0 alone calls. Raises its MesokitError on all ranks."""
        return function()

    def by_root(self, function: Callable[[], T]) -> T:
        """What a function says that all ranks call: the answer of rank 0, or its MesokitError."""
        return function()

    def each(self, function: Callable[[], T]) -> T:
        """What a function says that all ranks call, each for its part.

        Raises the MesokitError of one of them, the first that has any, on all ranks.
        """
        return function()

    def answers(self, function: Callable[[], T]) -> list[T]:
        """What a function of the user says that all ranks call: the answers of all.

        Where it fails, or ends the program, on some ranks, RunError on all names the first of them;
        its own error where it does on all.
        """
        return [function()]

    def gathered(self, value: T) -> list[T]:
        """What each rank has, on all ranks."""
        return [value]

    def require_same(self, facts: Callable[[], Mapping[str, str]]) -> None:
        """Raise RunError, which names a rank and what differs, if these are not the same on all."""

    def quietly(self) -> contextlib.AbstractContextManager[Any]:
        """Warnings meanwhile are those of rank 0."""
        return contextlib.nullcontext()

    def again(self, command: str) -> str:
        """The command for as many ranks as there are now."""
        return command

    # --- how far to go --------------------------------------------------------------------------

    def begin(self) -> None:
        """A run begins: signals told before do not matter any more."""

    def heard(self, signal: int) -> int:
        """The number of the signal that has come to this rank, or on rank 0 to any; 0 if none."""
        return signal

    def ahead(self, decide: Callable[[int], Order], signal: Callable[[], int]) -> Coming:
        """What to do after the steps in hand: decided by rank 0, before them if others must know.

        `decide` is given the number of a signal that has come to any rank, `signal` says which has
        come to this one. What is returned must be called, even if it is not needed any more.
        """
        return lambda: decide(signal())

    # --- the end --------------------------------------------------------------------------------

    def failed(self, note: Callable[[str], Any]) -> None:
        """A run fails here: note it on record, once for all ranks.

        `note` is given what comes before the reason: the name of the rank, where not all fail.
        """
        note("")

    def leave(self, say: Callable[[str], Any], status: int) -> None:
        """Say why this process ends with a status, once for all ranks that end so.

        `say` is given the name of the rank, nothing where all are meant. Where others do not end
        as well, they are made to.
        """
        say("")

    def ended(self, status: int) -> None:
        """This process has nothing more to do, and ends in order."""
