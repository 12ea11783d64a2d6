"""An emulated card that looks at every access to memory: for tests of kernels.

All arrays lie in one stretch of memory, at addresses that this process does not have: one of the
host in a kernel is an error too. Every 4 bytes have a record of which threads read, wrote and added
there in a launch. Two threads of which one writes are a race, in whatever order they ran here.
"""

import ctypes
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.devices.emulated import CHIP, Chip, Emulated
from mesokit.errors import RunError

TAG = 1 << 60  # no address of a process
GRAIN = 4  # bytes that have one record
GAP = 64  # bytes that belong to no array
SIZE = 1 << 25
FAULTS = (
    "outside of all arrays",
    "read before written",
    "written by two threads",
    "read by one thread and written by another",
    "added to by one thread and written by another",
    "added to by one thread and read by another",
)
ALLOCATED, SET = 1, 2
MEMORY = """
static char *arena; static uint64_t arena_size; static uint8_t *state;
static int64_t *writer, *reader, *adder, launch_number, me, faults[8];
void memory_is(char *a, uint64_t n, uint8_t *s, int64_t *w, int64_t *r, int64_t *x) {
  arena = a; arena_size = n; state = s; writer = w; reader = r; adder = x; }
void launch_is(int64_t n) { launch_number = n; }
int64_t *faults_are(void) { return faults; }
#define MANY (1ll << 32) /* in the place of a thread's number: several of this launch */
static int others(int64_t thread) {
  return thread >> 33 == launch_number && thread != (launch_number << 33 | me); }
static void note(int64_t *thread) {
  *thread = others(*thread) ? launch_number << 33 | MANY : launch_number << 33 | me; }
static char none[64];
static char *seen(uint64_t address, int size, int what) {
  uint64_t at = address - %TAG%ull;
  if (at >= arena_size || at + size > arena_size) { faults[0]++; return none; }
  for (uint64_t g = at / 4; g < (at + size + 3) / 4; g++) {
    if (!(state[g] & 1)) { faults[0]++; return none; }
    if (what != 1 && !(state[g] & 2)) faults[1]++;
    if (what == 0) {
      if (others(writer[g])) faults[3]++;
      if (others(adder[g])) faults[5]++;
      note(&reader[g]); }
    if (what == 1) {
      if (others(writer[g])) faults[2]++;
      if (others(reader[g])) faults[3]++;
      if (others(adder[g])) faults[4]++;
      note(&writer[g]); state[g] |= 2; }
    if (what == 2) {
      if (others(writer[g])) faults[4]++;
      if (others(reader[g])) faults[5]++;
      note(&adder[g]); } }
  return arena + at; }
static char *seen_or_own(uint64_t address, int size, int what) {
  return address < %TAG%ull ? (char *)address : seen(address, size, what); }
""".replace("%TAG%", str(TAG))


class Checked(Emulated):
    """An emulated card that counts `faults`, by the name of the kernel and what it did."""

    name = "checked"
    memory_code, before_thread = MEMORY, "me = order[j];"

    def __init__(self, chip: Chip = CHIP, seed: int = 1, size: int = SIZE) -> None:
        super().__init__(chip, seed)
        self._arena = np.zeros(size, np.uint8)
        grains = size // GRAIN
        self._state = np.zeros(grains, np.uint8)
        self._noted = [np.full(grains, -1, np.int64) for _ in range(3)]
        self._sizes: dict[int, int] = {}
        self._free: dict[int, list[int]] = {}
        self._used, self._launches = 0, 0
        self._names: dict[int, str] = {}
        self.faults: Counter[tuple[str, str]] = Counter()

    def allocate(self, size: int) -> int:
        """The address of so many bytes, not set."""
        length = -(-size // 8) * 8
        if self._free.get(length):
            start = self._free[length].pop()
        else:
            start = self._used
            self._used += -(-(length + GAP) // GAP) * GAP
            if self._used > len(self._arena):
                raise RunError(f"device = 'checked': {self._used} bytes do not fit")
        self._sizes[start] = length
        self._mark(start, length, ALLOCATED)
        return TAG + start

    def free(self, address: int) -> None:
        """Give the bytes from this address on back."""
        start = address - TAG
        length = self._sizes.pop(start)
        self._mark(start, length, 0)
        self._free.setdefault(length, []).append(start)

    def _mark(self, start: int, size: int, state: int) -> None:
        self._state[start // GRAIN : -(-(start + size) // GRAIN)] = state

    def _part(self, address: int, size: int) -> NDArray[np.uint8]:
        start = address - TAG
        if not 0 <= start <= len(self._arena) - size:
            raise ValueError(f"{address:#x} is not an address of this device")
        inside = self._state[start // GRAIN : -(-(start + size) // GRAIN)]
        if not (inside & ALLOCATED).all():
            raise ValueError(f"{size} bytes from {address:#x} are not in one array")
        return self._arena[start : start + size]

    def write(self, address: int, values: NDArray[Any]) -> None:
        """Copy an array to an address."""
        given = np.ascontiguousarray(values).reshape(-1).view(np.uint8)
        self._part(address, given.size)[:] = given
        self._mark(address - TAG, given.size, ALLOCATED | SET)

    def read(self, address: int, values: NDArray[Any]) -> None:
        """Fill an array, which lies in one piece, from an address."""
        values.reshape(-1).view(np.uint8)[:] = self._part(address, values.nbytes)

    def clear(self, address: int, size: int) -> None:
        """Set so many bytes to 0."""
        self._part(address, size)[:] = 0
        self._mark(address - TAG, size, ALLOCATED | SET)

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The machine code of a body, for arguments of these types."""
        library = super().kernel(body, given)
        if id(library) not in self._names:
            library.faults_are.restype = ctypes.POINTER(ctypes.c_int64)
            source = getattr(body, "__wrapped__", body)
            self._names[id(library)] = f"{source.__name__} {len(self._names)}"
        return library

    def launch(self, kernel: Any, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says, and note what they must not do."""
        self._launches += 1
        # Each time: another device of this process may have the same machine code.
        arrays: tuple[Any, ...] = self._arena, self._state, *self._noted
        arena, state, *noted = (ctypes.c_void_p(array.ctypes.data) for array in arrays)
        kernel.memory_is(arena, ctypes.c_uint64(self._arena.size), state, *noted)
        kernel.launch_is(ctypes.c_int64(self._launches))
        super().launch(kernel, words)
        found = kernel.faults_are()
        for place, fault in enumerate(FAULTS):
            if found[place]:
                self.faults[self._names[id(kernel)], fault] += found[place]
                found[place] = 0
