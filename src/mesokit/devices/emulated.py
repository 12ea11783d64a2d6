"""A card that is not there: kernels as NVIDIA's compiler makes them, run on the processor.

The text of a kernel (PTX) becomes C (see `devices.translate`), and that machine code. Threads run
one after another in shuffled order, in whole blocks, so that the last block has threads to spare.
"""

import ctypes
import hashlib
import os
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numba import typeof
from numpy.typing import NDArray

from mesokit.devices.compile import Chip
from mesokit.devices.cubins import made
from mesokit.devices.device import BLOCK
from mesokit.devices.host import BYTES, Host
from mesokit.devices.translate import PLAIN_MEMORY, Translation
from mesokit.errors import RunError
from mesokit.kernels.store import folder

# Roundings as the source has them; a number may be read by its bits.
OPTIONS = ["-O2", "-ffp-contract=off", "-fno-strict-aliasing", "-fwrapv", "-shared", "-fPIC", "-w"]
CHIP = (9, 0)


class Emulated(Host):
    """Kernels for a chip, on the processor; `seed` is that of the order of threads."""

    name = "emulated"
    memory_code, before_thread = PLAIN_MEMORY, ""

    def __init__(self, chip: Chip = CHIP, seed: int = 1) -> None:
        super().__init__(seed)
        self.chip = chip

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The machine code of a body, for arguments of these types."""
        kinds = tuple(map(typeof, given))
        if (body, kinds) not in self._kernels:
            self._kernels[body, kinds] = self.loaded(*made(body, kinds, self.chip)[:2])
        return self._kernels[body, kinds]

    def loaded(self, ptx: str, cubin: bytes) -> Any:
        """A kernel, by its PTX: the machine code of a card is of no use here."""
        source = Translation(ptx, self.memory_code, self.before_thread).source
        return ctypes.CDLL(str(machine_code_of(source)))

    def launch(self, kernel: Any, words: NDArray[np.uint64]) -> None:
        """Run as many threads as the first word says, and those that fill the last block."""
        threads = -(-int(words[0]) // BLOCK) * BLOCK
        assert self._random is not None
        order = self._random.permutation(threads)
        numbers = ctypes.c_int64(threads), ctypes.c_int64(BLOCK)
        places = ctypes.c_void_p(order.ctypes.data), ctypes.c_void_p(words.ctypes.data)
        assert words.itemsize == BYTES
        kernel.launch(places[0], *numbers, places[1])


def machine_code_of(source: str) -> Path:
    """The library of a C source, kept beside compiled kernels. Raises RunError without cc."""
    name = hashlib.sha256(f"{OPTIONS} {source}".encode()).hexdigest()[:32]
    made = folder() / "emulated" / f"{name}.so"
    if made.exists():
        return made
    made.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=made.parent) as here:
        code, library = Path(here) / "kernel.c", Path(here) / "kernel.so"
        code.write_text(source, encoding="utf-8")
        try:
            subprocess.run(
                ["cc", *OPTIONS, str(code), "-o", str(library), "-lm"],
                check=True,
                capture_output=True,
                text=True,
            )
        except FileNotFoundError:
            raise RunError("device = 'emulated': no C compiler; expected cc, such as gcc") from None
        except subprocess.CalledProcessError as error:
            raise RunError(f"device = 'emulated': cc failed: {error.stderr[:300]}") from None
        os.replace(library, made)
    return made
