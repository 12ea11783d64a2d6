"""Kernels as loops over threads, compiled for the processor: for laws at real sizes, not for speed.

Threads run one after another, in order or shuffled. No kernel may depend on the order.
"""

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit, typeof
from numpy.typing import NDArray

from mesokit.kernels.group import value_at, words_in
from mesokit.kernels.later import Later

BYTES = 8  # of a word


class Host:
    """The memory of this process, and a loop over threads.

    With a `seed` the threads of each launch run in an order drawn from it.

    Examples
    --------
    >>> from mesokit.devices.device import words_of
    >>> from mesokit.scalar.jit import scalar
    >>> from mesokit.scalar.pointer import put_real
    >>> @scalar
    ... def squares(i, start):
    ...     put_real(start, i, 1.0 * i * i)
    >>> host, found = Host(), np.zeros(3)
    >>> place = host.allocate(found.nbytes)
    >>> host.launch(host.kernel(squares, (place,)), words_of(3, place))
    >>> host.read(place, found)
    >>> found.tolist()
    [0.0, 1.0, 4.0]
    """

    name = "host"
    chip: Any = None  # none that kernels could be made for

    def __init__(self, seed: int | None = None) -> None:
        self._random = None if seed is None else np.random.default_rng(seed)
        self._held: dict[int, NDArray[np.uint64]] = {}
        self._kernels: dict[Any, Callable] = {}

    def allocate(self, size: int) -> int:
        """The address of so many bytes."""
        block = np.empty(max(-(-size // BYTES), 1), np.uint64)
        self._held[block.ctypes.data] = block
        return int(block.ctypes.data)

    def free(self, address: int) -> None:
        """Give the bytes from this address on back."""
        del self._held[address]

    def write(self, address: int, values: NDArray[Any]) -> None:
        """Copy an array to an address."""
        given = np.ascontiguousarray(values)
        ctypes.memmove(address, given.ctypes.data, given.nbytes)

    def read(self, address: int, values: NDArray[Any]) -> None:
        """Fill an array, which lies in one piece, from an address."""
        assert values.flags.c_contiguous
        ctypes.memmove(values.ctypes.data, address, values.nbytes)

    def clear(self, address: int, size: int) -> None:
        """Set so many bytes to 0."""
        ctypes.memset(address, 0, size)

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Callable:
        """The loop over threads of a body, for arguments of these types."""
        kinds = tuple(map(typeof, given))
        if (body, kinds) not in self._kernels:
            self._kernels[body, kinds] = _loop(body, kinds)
        return self._kernels[body, kinds]

    def launch(self, kernel: Callable, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says; the others are the arguments."""
        number = int(words[0])
        order = np.arange(number) if self._random is None else self._random.permutation(number)
        kernel(order, words.ctypes.data + BYTES)

    def wait(self) -> None:
        """Nothing is left to be done after a launch."""


def _loop(body: Callable, kinds: tuple[Any, ...]) -> Callable:
    space: dict[str, Any] = {"body": body.made if isinstance(body, Later) else body}
    lines, at = [], 0
    for k, kind in enumerate(kinds):
        space[f"load{k}"] = value_at(kind)
        lines.append(f"    a{k} = load{k}(place + {BYTES * at})\n")
        at += words_in(kind)
    names = ", ".join(f"a{k}" for k in range(len(kinds)))
    code = f"def loop(order, place):\n{''.join(lines)}    for j in range(len(order)):\n"
    exec(f"{code}        body(order[j], {names})\n", space)
    return njit(nogil=True, error_model="numpy")(space["loop"])
