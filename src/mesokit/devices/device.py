"""What a device does for an engine, and the words that its kernels take."""

import struct
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

BLOCK = 256  # threads of a block


class Device(Protocol):
    """Memory of its own, and launches of kernels, one after another.

    A kernel is made of a body: a scalar function `body(i, *given)` that does the work of thread i.
    """

    name: str

    @property
    def chip(self) -> tuple[int, int] | None:
        """Compute capability of a card, or of one that is emulated."""

    def allocate(self, size: int) -> int:
        """The address of so many bytes. Raises RunError if there are not so many."""

    def free(self, address: int) -> None:
        """Give the bytes from this address on back."""

    def write(self, address: int, values: NDArray[Any]) -> None:
        """Copy an array to an address."""

    def read(self, address: int, values: NDArray[Any]) -> None:
        """Fill an array, which lies in one piece, from an address."""

    def clear(self, address: int, size: int) -> None:
        """Set so many bytes to 0."""

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The kernel of a body, for arguments of these types; made once."""

    def launch(self, kernel: Any, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says; the others are the arguments."""

    def wait(self) -> None:
        """Return when all that was launched is done."""


def words_of(threads: int, *given: Any) -> NDArray[np.uint64]:
    """The number of threads, and every number of the arguments, each in a word of 8 bytes."""
    numbers: list[Any] = [threads]
    formats = ["Q"]
    _flatten(given, numbers, formats)
    return np.frombuffer(bytearray(struct.pack("=" + "".join(formats), *numbers)), np.uint64)


def _flatten(value: Any, numbers: list[Any], formats: list[str]) -> None:
    if isinstance(value, tuple):
        for part in value:
            _flatten(part, numbers, formats)
    elif isinstance(value, (float, np.floating)):
        numbers.append(float(value))
        formats.append("d")
    else:
        numbers.append(int(value) & (2**64 - 1))
        formats.append("Q")
