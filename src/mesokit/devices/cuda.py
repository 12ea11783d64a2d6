"""A card of NVIDIA, by its driver: memory, kernels as machine code, and launches in a row."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.amounts import size_text
from mesokit.devices.compile import INSTALL
from mesokit.devices.device import BLOCK
from mesokit.errors import RunError

WORD = 8  # bytes
LEAST_CHIP = (7, 5)
MOST_BLOCKS = 2**31 - 1
OUT_OF_MEMORY = 2  # CUDA_ERROR_OUT_OF_MEMORY
NO_DEVICE = 100  # CUDA_ERROR_NO_DEVICE
WHERE = "device = 'cuda'"


class Cuda:
    """A card, counted from 0 in the driver's order.

    Raises RunError, in one line, where there is no driver, too old a one, no such card, or a card
    without what the kernels need. `driver` is the module of the driver, for tests.
    """

    def __init__(self, ordinal: int = 0, driver: Any = None) -> None:
        self._where = WHERE if ordinal == 0 else f"device = 'cuda:{ordinal}'"
        self._driver = driver or _driver(self._where)
        self._require_driver()
        count = self._ask(self._driver.cuDeviceGetCount())
        if ordinal >= count:
            cards = "no card" if count == 0 else f"{count} card{'s' * (count > 1)}"
            raise RunError(f"device = 'cuda:{ordinal}': the driver knows {cards} here")
        device = self._ask(self._driver.cuDeviceGet(ordinal))
        raw = self._ask(self._driver.cuDeviceGetName(100, device))
        self.name = raw.decode().strip("\0")
        kinds = self._driver.CUdevice_attribute
        self.chip = (
            self._attribute(kinds.CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MAJOR, device),
            self._attribute(kinds.CU_DEVICE_ATTRIBUTE_COMPUTE_CAPABILITY_MINOR, device),
        )
        if self.chip < LEAST_CHIP:
            least, has = (".".join(map(str, chip)) for chip in (LEAST_CHIP, self.chip))
            text = f"compute capability {has}; expected {least} or more"
            raise RunError(f"{self._where}: {self.name} has {text}")
        self._device = device
        self._context = self._ask(self._driver.cuDevicePrimaryCtxRetain(device))
        self._ask(self._driver.cuCtxSetCurrent(self._context))
        self._kernels: dict[Any, Any] = {}
        self._modules: list[Any] = []

    def close(self) -> None:
        """Give back what the driver holds for this process; the device is of no use then."""
        self._ask(self._driver.cuDevicePrimaryCtxRelease(self._device))

    def _require_driver(self) -> None:
        status, *_ = self._driver.cuInit(0)
        if int(status) == NO_DEVICE:
            raise RunError(f"{self._where}: the driver knows no card here; expected --device cpu")
        if int(status):
            raise RunError(f"{self._where}: the driver of the card does not start ({status})")
        found = self._ask(self._driver.cuDriverGetVersion())
        needed = _version_needed()
        if found // 1000 < needed:
            has = f"{found // 1000}.{found % 1000 // 10}"
            text = f"the driver is for CUDA {has}, what is installed for {needed}.0"
            raise RunError(f"{self._where}: {text}; expected a newer driver, or {INSTALL[9:]}")

    def _attribute(self, kind: Any, device: Any) -> int:
        return int(self._ask(self._driver.cuDeviceGetAttribute(kind, device)))

    def _ask(self, answer: tuple[Any, ...]) -> Any:
        """The answer of the driver. Raises RunError with the name of its error."""
        status, *values = answer
        if int(status):
            raise RunError(f"{self._where}: the driver says {getattr(status, 'name', status)}")
        return values[0] if len(values) == 1 else tuple(values)

    @property
    def memory(self) -> tuple[int, int]:
        """Bytes that are free, and all."""
        free, total = self._ask(self._driver.cuMemGetInfo())
        return int(free), int(total)

    def allocate(self, size: int) -> int:
        """The address of so many bytes. Raises RunError if there are not so many."""
        status, *address = self._driver.cuMemAlloc(size)
        if int(status) == OUT_OF_MEMORY:
            free, total = map(size_text, self.memory)
            text = f"{size_text(size)} more do not fit, {free} of {total} are free"
            raise RunError(f"{self._where}: out of memory on {self.name}: {text}")
        return int(self._ask((status, *address)))

    def free(self, address: int) -> None:
        """Give the bytes from this address on back."""
        self._ask(self._driver.cuMemFree(address))

    def write(self, address: int, values: NDArray[Any]) -> None:
        """Copy an array to an address."""
        given = np.ascontiguousarray(values)
        if given.nbytes:
            self._ask(self._driver.cuMemcpyHtoD(address, given.ctypes.data, given.nbytes))

    def read(self, address: int, values: NDArray[Any]) -> None:
        """Fill an array, which lies in one piece, from an address."""
        assert values.flags.c_contiguous
        if values.nbytes:
            self._ask(self._driver.cuMemcpyDtoH(values.ctypes.data, address, values.nbytes))

    def clear(self, address: int, size: int) -> None:
        """Set so many bytes to 0."""
        if size:
            self._ask(self._driver.cuMemsetD8(address, 0, size))

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The kernel of a body, for arguments of these types; loaded as machine code."""
        from numba import typeof  # tapes play where no compiler is

        from mesokit.devices.cubins import made

        kinds = tuple(map(typeof, given))
        if (body, kinds) not in self._kernels:
            self._kernels[body, kinds] = self.loaded(*made(body, kinds, self.chip)[:2])
        return self._kernels[body, kinds]

    def loaded(self, ptx: str, cubin: bytes) -> Any:
        """A kernel, by its machine code: a driver may be too old for the PTX."""
        from mesokit.devices.compile import ENTRY

        module = self._ask(self._driver.cuModuleLoadData(cubin))
        self._modules.append(module)
        return self._ask(self._driver.cuModuleGetFunction(module, ENTRY.encode()))

    def launch(self, kernel: Any, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says; the others are the arguments."""
        blocks = -(-int(words[0]) // BLOCK)
        assert 0 < blocks <= MOST_BLOCKS
        # The driver takes the addresses of the arguments, and copies these before it returns.
        places = words.ctypes.data + WORD * np.arange(len(words), dtype=np.uint64)
        grid, block = (blocks, 1, 1), (BLOCK, 1, 1)
        self._ask(self._driver.cuLaunchKernel(kernel, *grid, *block, 0, 0, places.ctypes.data, 0))

    def wait(self) -> None:
        """Return when all that was launched is done. Raises RunError if some of it failed."""
        self._ask(self._driver.cuCtxSynchronize())


def _driver(where: str) -> Any:
    """The module of the driver. Raises RunError where it is not installed."""
    try:
        from cuda.bindings import driver
    except ImportError as error:
        raise RunError(f"{where}: cuda-bindings is missing ({error}); {INSTALL}") from None
    try:
        driver.cuDriverGetVersion()
    except Exception:  # its library is not there
        raise RunError(
            f"{where}: no driver of NVIDIA on this machine; expected --device cpu"
        ) from None
    return driver


def _version_needed() -> int:
    """The version of CUDA for which the compilers here make machine code."""
    from importlib import metadata

    try:
        return int(metadata.version("nvidia-nvjitlink").split(".")[0])
    except metadata.PackageNotFoundError:
        return 12
