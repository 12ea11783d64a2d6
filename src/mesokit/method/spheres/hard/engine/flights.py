"""Free flights of spheres from one collision to the next, if an observable reads them.

Else `Tally.flights` is `()`, and nothing of this is compiled.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.scalar.jit import by_type

TIMES, SQUARES, SUMS = 0, 1, 2  # places in `Flights.sums`


class Flights(NamedTuple):
    """per_time: bins in a unit of time; counts (bins + 1,) of flights, of which the last holds all
    longer ones; sums (2,) of their times and of the squares."""

    per_time: float
    counts: Any
    sums: Any


def no_flights(bin_width: float, bins: int) -> Flights:
    """None yet."""
    return Flights(1 / bin_width, np.zeros(bins + 1, np.int64), np.zeros(SUMS))


@by_type
def note_flight(flights, lasted):
    """Count a flight that has ended; the first one of a sphere had no beginning: infinite."""
    if len(flights) == 0:
        return lambda flights, lasted: None

    def note(flights, lasted):
        if lasted < np.inf:
            bins = len(flights.counts) - 1
            place = min(lasted * flights.per_time, float(bins))
            flights.counts[int(max(place, 0.0))] += 1
            flights.sums[TIMES] += lasted
            flights.sums[SQUARES] += lasted * lasted

    return note
