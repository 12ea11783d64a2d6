"""Tapes: all that a device was asked to do, kept to be done again by another one.

A tape is made on a machine without a card and played on one that has it. There it needs mesokit,
numpy and the driver's bindings: no compiler, and no fluid. It holds hashes of what must come out.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

TAG, BLOCK_BITS = 1 << 60, 40  # an address on a tape: block of memory, and byte in it


class Recorded:
    """A device that another one stands behind, and a tape of what it was asked.

    `behind` is an emulated device: its chip is that of the kernels on the tape.
    """

    def __init__(self, behind: Any) -> None:
        self.behind, self.name, self.chip = behind, f"{behind.name}, recorded", behind.chip
        self._blocks: list[tuple[int, int]] = []  # addresses behind, and sizes
        self._there: dict[int, int] = {}  # addresses behind, by addresses on the tape
        self._events: list[dict[str, Any]] = []
        self._arrays: list[NDArray[Any]] = []
        self._kernels: list[tuple[str, bytes]] = []  # PTX and machine code
        self._known: dict[Any, tuple[int, Any]] = {}

    def _note(self, what: str, **given: Any) -> None:
        self._events.append({"do": what, **given})

    def _keep(self, values: NDArray[Any]) -> int:
        self._arrays.append(np.ascontiguousarray(values).reshape(-1).view(np.uint8).copy())
        return len(self._arrays) - 1

    def _real(self, address: int) -> int:
        """The address behind of one on the tape."""
        number, byte = (address - TAG) >> BLOCK_BITS, address & ((1 << BLOCK_BITS) - 1)
        return self._blocks[number][0] + byte

    def allocate(self, size: int) -> int:
        """The address of so many bytes."""
        self._blocks.append((self.behind.allocate(size), size))
        self._note("allocate", size=size)
        return TAG + (len(self._blocks) - 1 << BLOCK_BITS)

    def free(self, address: int) -> None:
        """Give the bytes from this address on back."""
        self.behind.free(self._real(address))
        self._note("free", address=address)

    def write(self, address: int, values: NDArray[Any]) -> None:
        """Copy an array to an address."""
        addresses = values.dtype == np.int64  # some of them may be
        self._note("write", address=address, array=self._keep(values), addresses=addresses)
        self.behind.write(self._real(address), self._moved(values))

    def _moved(self, values: NDArray[Any]) -> NDArray[Any]:
        """An array with the addresses behind: tables may hold addresses of others."""
        if values.dtype != np.int64:
            return values
        return _with_addresses(values.view(np.uint64), self._real).view(np.int64)

    def read(self, address: int, values: NDArray[Any]) -> None:
        """Fill an array from an address; the tape keeps the hash of what was read."""
        self.behind.read(self._real(address), values)
        self._note("read", address=address, size=values.nbytes, hash=_hash(values))

    def expect(self, length: int, rows: Sequence[tuple[int, str]]) -> None:
        """Keep the hash of rows of so many numbers: their addresses, and kinds as numpy names them.

        Numbers are taken in the order of those in the first row, in which none is twice: where they
        lie may depend on the order of threads.
        """
        found = _hash_in_order(self.behind, self._real, length, rows)
        self._note("expect", length=length, rows=list(rows), hash=found)

    def clear(self, address: int, size: int) -> None:
        """Set so many bytes to 0."""
        self.behind.clear(self._real(address), size)
        self._note("clear", address=address, size=size)

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The number of a kernel on the tape, and that behind."""
        from numba import typeof

        from mesokit.devices.cubins import made

        key = body, tuple(map(typeof, given))
        if key not in self._known:
            new = made(*key, self.chip)
            self._kernels.append((new.ptx, new.cubin))
            self._known[key] = len(self._kernels) - 1, self.behind.kernel(body, given)
        return self._known[key]

    def launch(self, kernel: Any, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says; the others are the arguments."""
        number, behind = kernel
        self._note("launch", kernel=number, array=self._keep(words))
        self.behind.launch(behind, _with_addresses(words, self._real))

    def wait(self) -> None:
        """Return when all that was launched is done."""
        self.behind.wait()

    def save(self, file: Path, **about: Any) -> None:
        """Write the tape, with words about it."""
        with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as parts:
            table = {"about": about, "chip": self.chip, "events": self._events}
            parts.writestr("tape.json", json.dumps(table))
            for k, (ptx, cubin) in enumerate(self._kernels):
                parts.writestr(f"kernel-{k}.ptx", ptx)
                parts.writestr(f"kernel-{k}.cubin", cubin)
            buffer = io.BytesIO()
            np.savez(buffer, *self._arrays)
            parts.writestr("arrays.npz", buffer.getvalue())


def _hash(values: NDArray[Any]) -> str:
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


def _hash_in_order(
    device: Any, real: Callable[[int], int], length: int, rows: Sequence[tuple[int, str]]
) -> str:
    found = [np.empty(length, kind) for _, kind in rows]
    for (address, _), values in zip(rows, found, strict=True):
        device.read(real(address), values)
    order = np.argsort(found[0])
    return _hash(np.concatenate([values[order].view(np.uint8) for values in found]))


def _with_addresses(words: NDArray[np.uint64], real: Callable[[int], int]) -> NDArray[np.uint64]:
    """Words with the addresses of a device in the place of those on a tape."""
    words = words.copy()
    for k in np.flatnonzero((words >> np.uint64(60)) == 1):
        words[k] = real(int(words[k]))
    return words


class Differences(NamedTuple):
    """Places on a tape where other bits came out, among reads and among what was expected.

    What is read may depend on the order of threads, such as rows of particles after a sort.
    """

    reads: list[int]
    expected: list[int]


class Tape:
    """A tape in a file; `about` is what it says of itself, `kernels` PTX and machine code of each.

    Raises ValueError for a file that is none.
    """

    def __init__(self, file: Path) -> None:
        try:
            with zipfile.ZipFile(file) as parts:
                table = json.loads(parts.read("tape.json"))
                arrays = np.load(io.BytesIO(parts.read("arrays.npz")))
                self._arrays = [arrays[f"arr_{k}"] for k in range(len(arrays.files))]
                names = {name for name in parts.namelist() if name.startswith("kernel-")}
                self.kernels = [
                    (parts.read(f"kernel-{k}.ptx").decode(), parts.read(f"kernel-{k}.cubin"))
                    for k in range(len(names) // 2)
                ]
        except (OSError, KeyError, zipfile.BadZipFile, json.JSONDecodeError) as error:
            raise ValueError(f"{file}: no tape ({error})") from None
        self.about, self.chip, self._events = table["about"], tuple(table["chip"]), table["events"]

    def play(self, device: Any) -> Differences:
        """Do all of it on a device; where it gave other bits than on the tape.

        The device loads kernels of the tape by `loaded(ptx, cubin)`.
        """
        kernels = [device.loaded(*kernel) for kernel in self.kernels]
        blocks: list[int] = []
        differ = Differences([], [])

        def real(address: int) -> int:
            number, byte = (address - TAG) >> BLOCK_BITS, address & ((1 << BLOCK_BITS) - 1)
            return blocks[number] + byte

        for place, event in enumerate(self._events):
            do = event["do"]
            if do == "allocate":
                blocks.append(device.allocate(event["size"]))
            elif do == "free":
                device.free(real(event["address"]))
            elif do == "clear":
                device.clear(real(event["address"]), event["size"])
            elif do == "write":
                values = self._arrays[event["array"]]
                if event["addresses"]:
                    values = _with_addresses(values.view(np.uint64), real)
                device.write(real(event["address"]), values)
            elif do == "launch":
                words = self._arrays[event["array"]].view(np.uint64)
                device.launch(kernels[event["kernel"]], _with_addresses(words, real))
            elif do == "expect":
                if _hash_in_order(device, real, event["length"], event["rows"]) != event["hash"]:
                    differ.expected.append(place)
            else:
                found = np.empty(event["size"], np.uint8)
                device.read(real(event["address"]), found)
                if _hash(found) != event["hash"]:
                    differ.reads.append(place)
        device.wait()
        return differ
