"""MPI in compiled code: the functions that a step needs of the library that mpi4py has loaded.

A step of a small fluid takes less time than Python needs to pass its arrays, so the kernel itself
sends messages. Handles are whole numbers of 32 or 64 bits, as in the library.
"""

import ctypes
import platform
from typing import Any, NamedTuple

import numpy as np
from llvmlite import binding
from numba import types

from mesokit.processes.cores import usable_cores, which_cores
from mesokit.scalar.jit import scalar
from mesokit.scalar.system import nap, read_work_clock, yield_core

SPINS = 1_000  # polls for messages before a rank yields its core
FAILED = 1  # bit of `Post.flag[1]`: a call of the library failed

_WORD, _INT = types.int64, types.int32
_send = types.ExternalFunction(
    "mesokit_mpi_isend", _INT(_WORD, _INT, _WORD, _INT, _INT, _WORD, _WORD)
)
_receive = types.ExternalFunction(
    "mesokit_mpi_irecv", _INT(_WORD, _INT, _WORD, _INT, _INT, _WORD, _WORD)
)
_test = types.ExternalFunction("mesokit_mpi_testall", _INT(_INT, _WORD, _WORD, _WORD))


class Post(NamedTuple):
    """A communicator, and the memory of open messages.

    comm, words: handles of the communicator and of the type of 64-bit numbers; requests, statuses:
    memory of the library, `size` bytes for each request; flag (2,) int32: result of a test, and
    faults; waited (3,): memory of the clock, and ticks spent in waiting; crowded: whether ranks
    share cores and so sleep while they wait: a core that is yielded often comes back at once.
    """

    comm: int
    words: int
    size: int
    requests: Any
    statuses: Any
    flag: Any
    waited: Any
    crowded: bool


def crowded(comm: Any, threads: int) -> bool:
    """Whether ranks on the cores of this one have more threads than there are cores.

    All ranks of the communicator call this, each with its threads.
    """
    own = platform.node(), which_cores()
    every = comm.allgather((own, threads))
    return sum(n for theirs, n in every if theirs == own) > usable_cores()


def post(comm: Any, messages: int, crowded: bool) -> Post:
    """A `Post` for so many open messages of a communicator; `crowded` if its ranks share cores."""
    from mpi4py import MPI

    library = ctypes.CDLL(MPI.__file__)
    for name in ("isend", "irecv", "testall"):
        function = getattr(library, f"MPI_{name.capitalize()}")
        binding.add_symbol(f"mesokit_mpi_{name}", ctypes.cast(function, ctypes.c_void_p).value)
    size = MPI._sizeof(MPI.Request)
    return Post(
        comm=MPI._handleof(comm),
        words=MPI._handleof(MPI.INT64_T),
        size=size,
        requests=np.zeros(size * messages + 8, np.uint8),
        statuses=np.zeros(MPI._sizeof(MPI.Status) * messages + 8, np.uint8),
        flag=np.zeros(2, np.int32),
        waited=np.zeros(3, np.int64),
        crowded=crowded,
    )


@scalar
def request_of(post, n):
    """Address of the request of the nth open message."""
    return np.int64(post.requests.ctypes.data) + n * post.size


@scalar
def send(post, n, address, words, rank, tag):
    """Begin to send `words` 64-bit numbers to a rank as the nth open message; returns n + 1."""
    number, to, mark = np.int32(words), np.int32(rank), np.int32(tag)
    failed = _send(np.int64(address), number, post.words, to, mark, post.comm, request_of(post, n))
    post.flag[1] |= failed != 0
    return n + 1


@scalar
def receive(post, n, address, words, rank, tag):
    """Begin to receive at most `words` 64-bit numbers from a rank; returns n + 1."""
    number, by, mark = np.int32(words), np.int32(rank), np.int32(tag)
    failed = _receive(
        np.int64(address), number, post.words, by, mark, post.comm, request_of(post, n)
    )
    post.flag[1] |= failed != 0
    return n + 1


@scalar
def finish(post, n):
    """Wait until all n open messages are sent and received."""
    requests, statuses = post.requests.ctypes.data, post.statuses.ctypes.data
    post.flag[0], spins, began = 0, 0, read_work_clock(post.waited)
    # The wait of most MPI libraries holds the core all the time. Polling lets another rank or
    # thread on this core go on: after SPINS polls the core is yielded, and crowded ranks sleep
    # after each poll.
    while post.flag[0] == 0:
        failed = _test(
            np.int32(n), np.int64(requests), np.int64(post.flag.ctypes.data), np.int64(statuses)
        )
        if failed != 0:
            post.flag[1] |= FAILED
            break
        spins += 1
        if post.crowded:
            nap()
        elif spins > SPINS:
            yield_core()
    post.waited[2] += read_work_clock(post.waited) - began
