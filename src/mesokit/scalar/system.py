"""Functions of the operating system that compiled code calls, whichever it is.

The functions have the same names on all systems, under which LLVM receives their addresses when
this is imported; so kernels that were compiled in another process find them too.
"""

import ctypes
import sys
import time
from typing import Any

import numpy as np
from llvmlite import binding
from numba import types

from mesokit.scalar.jit import scalar


def _named(name: str, function: Any, *arguments: Any) -> Any:
    """A C function that gives an int, for compiled code."""
    binding.add_symbol(name, ctypes.cast(function, ctypes.c_void_p).value)
    return types.ExternalFunction(name, types.int32(*arguments))


if sys.platform == "win32":
    _library = ctypes.WinDLL("kernel32")
    _frequency = ctypes.c_int64()
    _library.QueryPerformanceFrequency(ctypes.byref(_frequency))
    TICK = 1.0 / _frequency.value  # seconds of one unit of `read_clock`
    yield_core = _named("mesokit_yield_core", _library.SwitchToThread)
    nap = yield_core  # the shortest sleep there lasts milliseconds
    _counter = _named("mesokit_counter", _library.QueryPerformanceCounter, types.uintp)

    @scalar
    def read_clock(room):
        """Time in ticks; the system writes its answer to an int64 array."""
        _counter(np.uint64(room.ctypes.data))
        return room[0]

    read_work_clock = read_clock  # time of a thread alone is too coarse

else:
    _library = ctypes.CDLL(None)
    TICK = 1e-9
    _MONOTONIC, _THREAD = np.int32(time.CLOCK_MONOTONIC), np.int32(time.CLOCK_THREAD_CPUTIME_ID)
    yield_core = _named("mesokit_yield_core", _library.sched_yield)
    _sleep = _named("mesokit_sleep", _library.usleep, types.uint32)
    _clock = _named("mesokit_clock", _library.clock_gettime, types.int32, types.uintp)

    @scalar
    def nap():
        """Sleep as briefly as the system can, some 50 microseconds."""
        return _sleep(np.uint32(1))

    @scalar
    def read_clock(room):
        """Time in ticks; the system writes its answer to an int64 array."""
        _clock(_MONOTONIC, np.uint64(room.ctypes.data))
        return room[0] * 1_000_000_000 + room[1]

    @scalar
    def read_work_clock(room):
        """Time that this thread has had a core, in ticks."""
        _clock(_THREAD, np.uint64(room.ctypes.data))
        return room[0] * 1_000_000_000 + room[1]
