"""Time of the stages, taken inside compiled code by the first thread."""

import time

import numpy as np
from numba import types

from mesokit.scalar.jit import scalar

_clock_gettime = types.ExternalFunction("clock_gettime", types.int32(types.int32, types.uintp))
_MONOTONIC = np.int32(time.CLOCK_MONOTONIC)

# The clock is an int64 array: two places for the system's answer, the time of the last lap, then
# nanoseconds for each stage.
STAGES = 3
START, SWEEP, CELLS, FINISH = -1, 0, 1, 2  # stages whose time is kept
CLOCK_SIZE = STAGES + 3


@scalar
def lap(team, stage):
    """Add the time since the last lap to a stage; START only starts the clock."""
    if team.thread == 0:
        clock = team.clock
        _clock_gettime(_MONOTONIC, np.uint64(clock.ctypes.data))
        now = clock[0] * 1_000_000_000 + clock[1]
        if stage >= 0:
            clock[STAGES + stage] += now - clock[2]
        clock[2] = now
