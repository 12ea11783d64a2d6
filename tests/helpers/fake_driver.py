"""A driver that is called as that of NVIDIA, and has no card."""

from __future__ import annotations

import ctypes
import re
from types import SimpleNamespace

import numpy as np

from mesokit.devices.compile import ENTRY
from mesokit.devices.emulated import Emulated


class FakeDriver:
    """The driver's functions, as they are called; kernels are run from their PTX.

    It is no card: kernels come as machine code, and `known` has the PTX of each.
    """

    CUdevice_attribute = SimpleNamespace(
        CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR="major",
        CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR="minor",
    )

    def __init__(
        self, chip=(9, 0), version=13010, cards=1, size=1 << 20, init=0, known=None
    ) -> None:
        self.known = known or {}
        self.chip, self.version, self.cards, self.size, self.init = chip, version, cards, size, init
        self.memory: dict[int, np.ndarray] = {}
        self.behind, self.released = Emulated(chip), False

    def cuInit(self, flags):
        return (self.init,)

    def cuDriverGetVersion(self):
        return 0, self.version

    def cuDeviceGetCount(self):
        return 0, self.cards

    def cuDeviceGet(self, ordinal):
        return 0, ordinal

    def cuDeviceGetName(self, length, device):
        return 0, b"A card\0\0"

    def cuDeviceGetAttribute(self, kind, device):
        return 0, self.chip[kind == "minor"]

    def cuDevicePrimaryCtxRetain(self, device):
        return 0, "context"

    def cuDevicePrimaryCtxRelease(self, device):
        self.released = True
        return (0,)

    def cuCtxSetCurrent(self, context):
        return (0,)

    def cuMemGetInfo(self):
        return 0, self.size - sum(block.size for block in self.memory.values()), self.size

    def cuMemAlloc(self, size):
        if size > self.cuMemGetInfo()[1]:
            return 2, None
        block = np.full(size, 0xAB, np.uint8)  # not 0, as that of a card
        self.memory[block.ctypes.data] = block
        return 0, block.ctypes.data

    def _require_own(self, address, size) -> None:
        """Bytes of one block, and none beyond."""
        ends = [(start, start + block.size) for start, block in self.memory.items()]
        assert any(start <= address and address + size <= end for start, end in ends)

    def cuMemFree(self, address):
        del self.memory[address]
        return (0,)

    def cuMemcpyHtoD(self, to, source, size):
        self._require_own(to, size)
        ctypes.memmove(to, source, size)
        return (0,)

    def cuMemcpyDtoH(self, to, source, size):
        self._require_own(source, size)
        ctypes.memmove(to, source, size)
        return (0,)

    def cuMemsetD8(self, to, value, size):
        self._require_own(to, size)
        ctypes.memset(to, value, size)
        return (0,)

    def cuModuleLoadData(self, cubin):
        assert isinstance(cubin, bytes)
        assert cubin[:4] == b"\x7fELF"
        return 0, cubin

    def cuModuleGetFunction(self, module, name):
        assert name.decode() == ENTRY
        ptx = self.known[module]
        head = re.search(rf"\.entry {ENTRY}\(([^)]*)\)", ptx)
        assert head is not None
        return 0, (self.behind.loaded(ptx, module), head[1].count(".param"))

    def cuLaunchKernel(self, kernel, gx, gy, gz, bx, by, bz, shared, stream, parameters, extra):
        assert (gy, gz, by, bz, shared, stream, extra) == (1, 1, 1, 1, 0, 0, 0)
        there, count = kernel
        places = np.ctypeslib.as_array((ctypes.c_uint64 * count).from_address(parameters))
        words = np.array([ctypes.c_uint64.from_address(int(at)).value for at in places], np.uint64)
        assert gx == -(-int(words[0]) // bx)
        self.behind.launch(there, words)
        return (0,)

    def cuCtxSynchronize(self):
        return (0,)
