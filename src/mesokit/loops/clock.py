"""Time of the stages, taken inside compiled code by the first thread."""

from mesokit.scalar.jit import scalar
from mesokit.scalar.system import read_clock

# The clock is an int64 array: two places for the system's answer, the time of the last lap, then
# ticks of the system's clock for each stage.
STAGES = 8
# stages whose time is kept
START, SWEEP, CELLS, FINISH, SHARE, WAIT, MOVE, BEADS, SORT = -1, 0, 1, 2, 3, 4, 5, 6, 7
FIRST = 3  # where their times begin in the clock
CLOCK_SIZE = FIRST + STAGES


@scalar
def lap(team, stage):
    """Add the time since the last lap to a stage; START only starts the clock."""
    if team.thread == 0:
        clock = team.clock
        now = read_clock(clock)
        if stage >= 0:
            clock[FIRST + stage] += now - clock[2]
        clock[2] = now
