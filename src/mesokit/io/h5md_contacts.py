"""Contacts of each frame in a data file, by the elements of H5MD.

/connectivity/contacts  step, time and value (frames, most, 2): the two particles of each contact by
             their numbers; of a wall -1 less the number of its surface
/contacts    normal, force, place (frames, most, 3) and gap (frames, most) of these, and number
             (frames,): how many there are

Frames differ in their number of contacts: the rest of a row has the fill value of its dataset. In
2D the third component is 0.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mesokit.io.contact_records import VECTORS, Records, kind_of

PAIRS, REST = "connectivity/contacts", "contacts"
FILL = np.iinfo(np.int64).min
UNITS = {"force": "m a/tau^2", "place": "a", "gap": "a"}
CHUNK = 16384  # contacts


class ContactSets:
    """The datasets of contacts in a data file, to which frames are added one by one.

    Parameters
    ----------
    file: open for writing.
    group: of the particles, with `step` and `time` of all frames.
    packed: compression of datasets.
    real: type of their numbers.
    units: of `UNITS`, as they are called in the file.
    """

    def __init__(
        self, file: Any, group: Any, packed: Mapping[str, Any], real: Any, units: Mapping[str, str]
    ) -> None:
        frames = len(group["step"])
        rows = max(1, min(2 * len(group["id"]), CHUNK))
        self.number = file.create_dataset(f"{REST}/number", (frames,), np.int64)

        def made(path: str, deep: tuple[int, ...], dtype: Any, fill: Any) -> Any:
            element = file.require_group(path)
            element["step"], element["time"] = group["step"], group["time"]
            shape, most = (frames, 0, *deep), (frames, None, *deep)
            how = {"maxshape": most, "chunks": (1, rows, *deep), "fillvalue": fill, **packed}
            return element.create_dataset("value", shape, dtype, **how)

        self.sets = {"pair": made(PAIRS, (2,), np.int64, FILL)}
        file[PAIRS].attrs["particles_group"] = group.ref
        for name in (*VECTORS, "gap"):
            deep = (3,) if name in VECTORS else ()
            self.sets[name] = made(f"{REST}/{name}", deep, real, np.nan)
            if name in UNITS:
                self.sets[name].attrs["reduced_unit"] = units[name]

    def add(self, index: int, records: Records) -> None:
        """Write the contacts of a frame."""
        self.number[index] = m = len(records)
        for name, data in self.sets.items():
            if data.shape[1] < m:
                data.resize(m, axis=1)
            part = records[name]
            if name in VECTORS:
                part = np.pad(part, ((0, 0), (0, 3 - part.shape[1])))
            if m:
                data[index, :m] = part


def has_contacts(file: Any) -> bool:
    """Whether a data file has the contacts of its frames."""
    return PAIRS in file


def contacts_of(file: Any, index: int, dimension: int) -> Records:
    """The contacts of a frame, as they were recorded."""
    m, rest = int(file[f"{REST}/number"][index]), file[REST]
    found = np.zeros(m, kind_of(dimension, rest["gap/value"].dtype))
    if m:
        found["pair"] = file[PAIRS]["value"][index, :m]
        for name in VECTORS:
            found[name] = rest[name]["value"][index, :m, :dimension]
        found["gap"] = rest["gap/value"][index, :m]
    return found
