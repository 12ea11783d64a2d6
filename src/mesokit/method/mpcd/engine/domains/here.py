"""The particles of one rank alone, for data that stay on their rank until they are written."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.method.mpcd.engine.domains.readings import SharedReadings
from mesokit.method.mpcd.engine.domains.state import ROOT, Spread
from mesokit.method.mpcd.engine.measure.readings import Observed
from mesokit.method.mpcd.engine.pieces import pieces


class Here:
    """Readings of the particles of this rank, by id, without messages to other ranks.

    Beads of solutes, which all ranks can read, count as those of the first rank.
    """

    def __init__(self, readings: SharedReadings) -> None:
        self.readings = readings

    def ids(self, first: int, last: int) -> NDArray[np.int64]:
        """Ids of the particles of this rank from `first` to before `last`, rising."""
        readings, n = self.readings, self.readings.n
        own = readings.numbers_here(min(first, n), min(last, n))
        beads = np.arange(max(first, n), max(last, n) if readings.comm.rank == ROOT else 0)
        return np.concatenate([own, beads])

    def positions(self, ids: NDArray[np.int64]) -> NDArray[np.float64]:
        """Positions (n, d) of some of these particles, in the box."""
        return self._of("positions", ids)

    def velocities(self, ids: NDArray[np.int64]) -> NDArray[np.float64]:
        """Velocities (n, d) of some of these particles."""
        return self._of("velocities", ids)

    def images(self, ids: NDArray[np.int64]) -> NDArray[np.int32]:
        """Image counts (n, d) of some of these particles."""
        return self._of("images", ids)

    def _of(self, name: str, ids: NDArray[np.int64]) -> NDArray[Any]:
        readings, kind = self.readings, np.int32 if name == "images" else np.float64
        out = np.empty((len(ids), readings.dimension), kind)
        own = int(np.searchsorted(ids, readings.n))
        _, which = readings.own_rows(ids[:own])
        for first, last in pieces(0, own):
            places = readings.memory.places[which[first:last]]
            out[first:last] = getattr(readings.seen_at(places, False), name)
        if readings.solutes is not None:
            beads = Observed(*readings.solutes.folded())
            out[own:] = getattr(beads, name)[ids[own:] - readings.n]
        return out

    def spread(self, number: int, places: NDArray[np.int64], rows: NDArray[Any]) -> Spread:
        """An array of `number` rows, of which this rank has `rows` at these places (rising)."""

        def some(first: int, last: int) -> tuple[NDArray[np.int64], NDArray[Any]]:
            part = slice(*np.searchsorted(places, (first, last)))
            return places[part], rows[part]

        return Spread(self.readings.comm, (number, *rows.shape[1:]), rows.dtype, some)
