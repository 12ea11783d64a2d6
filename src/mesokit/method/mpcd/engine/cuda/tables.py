"""Tables of the physics in the memory of a device.

Parameters have addresses of tables (see `scalar.pointer`), and some tables have addresses of
others. Each is copied once, and its address replaced wherever it stands.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.device import Device
from mesokit.scalar.pointer import table_at


def copied(device: Device, room: Callable[[int], int], table: Any, whole: Any) -> int:
    """The address of a copy of a table on a device: float64 numbers, or whole ones of this kind.

    `room` gives addresses of so many bytes.
    """
    table = np.asarray(table)
    values = np.ascontiguousarray(table, np.float64 if table.dtype.kind == "f" else whole)
    address = room(values.nbytes)
    if values.size:
        device.write(address, values)
    return address


class Tables:
    """Copies of tables on a device, by their addresses here; `held` has those of all copies."""

    def __init__(self, device: Device, held: set[int]) -> None:
        self._device, self._addresses = device, held
        self._there: dict[int, int] = {}
        self._held: list[NDArray[Any]] = []  # no other table can come to their addresses
        self.bytes_held = 0

    def there(self, value: Any) -> Any:
        """Parameters with the addresses of copies on the device."""
        if isinstance(value, tuple):
            parts = [self.there(part) for part in value]
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        if not isinstance(value, (int, np.integer)) or (table := table_at(int(value))) is None:
            return value
        if int(value) not in self._there:
            self._there[int(value)] = self._copied(table)
        return self._there[int(value)]

    def _copied(self, table: NDArray[Any]) -> int:
        self._held.append(table)
        if table.dtype == np.int64:  # these may be addresses
            places = [self.there(place) for place in table.ravel().tolist()]
            table = np.array(places, np.int64)
        address = self._device.allocate(table.nbytes)
        self._addresses.add(address)
        self._device.write(address, table)
        self.bytes_held += table.nbytes
        return address
