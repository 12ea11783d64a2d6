"""Contacts of a frame as records: a row each, in segments, data files and tables.

Fields are `pair` (particle numbers; of a wall -1 less the number of its surface), `normal` from the
second to the first, `force` on the first, `place`, and `gap`, negative where the two overlap.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Records = NDArray[Any]
FIELD = "contact"
VECTORS = ("normal", "force", "place")


def kind_of(dimension: int, real: Any) -> np.dtype[Any]:
    """The type of a record, with numbers of the type `real`."""
    vectors = [(name, real, (dimension,)) for name in VECTORS]
    return np.dtype([("pair", np.int64, (2,)), *vectors, ("gap", real)])


def records_of(contacts: Any, first: int, number: int, real: Any) -> Records:
    """Records of the contacts of `number` particles from `first` on with one another and with
    walls. `contacts` are those of an engine (`mesokit.seam.engine.ContactsNow`)."""
    inside = (contacts.pairs >= first) & (contacts.pairs < first + number)
    kept = inside[:, 0] & (inside[:, 1] | contacts.at_walls)
    found = np.zeros(int(kept.sum()), kind_of(contacts.normals.shape[1], real))
    found["pair"] = contacts.pairs[kept]
    found["normal"], found["force"] = contacts.normals[kept], contacts.forces[kept]
    found["place"], found["gap"] = contacts.places[kept], contacts.gaps[kept]
    return found
