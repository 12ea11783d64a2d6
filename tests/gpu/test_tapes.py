"""Tapes of fluids: played in another order of threads, particles have the same bits."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks import tapes
from mesokit.devices.cuda import Cuda
from mesokit.devices.emulated import Emulated
from mesokit.devices.recorded import Tape
from tests.helpers.fake_driver import FakeDriver
from tests.helpers.on_devices import kinds_of_bulk, record

CHIP = (9, 0)
ROOT = Path(__file__).resolve().parents[2]
KIND = kinds_of_bulk()["2D AT"]


class OneBitLess(Emulated):
    """A device that once writes a number wrong."""

    wrong = 0

    def write(self, address, values) -> None:
        values = np.array(values)
        if self.wrong == 3:
            values.view(np.uint8)[0] ^= 1
        self.wrong += 1
        super().write(address, values)


def test_a_fluid_on_a_tape_has_the_same_bits_in_any_order_of_threads(tmp_path) -> None:
    record(tmp_path / "fluid.tape", CHIP, **KIND)
    tape = Tape(tmp_path / "fluid.tape")
    assert tape.play(Emulated(CHIP, seed=1)) == ([], [])
    other_order = tape.play(Emulated(CHIP, seed=9))
    assert other_order.expected == []
    assert other_order.reads != []  # rows lie in another order, which a hash of them would blame
    assert len(tape.play(OneBitLess(CHIP, seed=1)).expected) == 1


def test_a_fluid_on_a_tape_is_played_by_calls_of_the_driver(tmp_path) -> None:
    record(tmp_path / "fluid.tape", CHIP, **KIND)
    tape = Tape(tmp_path / "fluid.tape")
    driver = FakeDriver(CHIP, known={cubin: ptx for ptx, cubin in tape.kernels})
    assert tape.play(Cuda(driver=driver)).expected == []
    assert len(driver.memory) > 10  # of the fluid


def test_tapes_are_played_where_no_compiler_is(tmp_path) -> None:
    """Only the driver is missing here: neither numba nor a compiler of cards is asked for."""
    hidden = "numba", "llvmlite", "numba_cuda", "scipy", "matplotlib"
    code = (
        f"import runpy, sys; sys.modules |= dict.fromkeys({hidden}); "
        f"sys.argv = ['tapes', 'play', {str(tmp_path)!r}]; "
        "runpy.run_module('benchmarks.tapes', run_name='__main__')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT)
    assert done.returncode != 0
    assert done.stderr.startswith("device = 'cuda': ")
    assert done.stderr.count("\n") == 1


@pytest.mark.long
@pytest.mark.further
def test_tapes_of_all_kinds_of_fluid_have_the_same_bits(tmp_path, capsys) -> None:
    tapes.record(tmp_path, CHIP)
    assert tapes.play(tmp_path, Emulated(CHIP, seed=4)) == 0
    said = capsys.readouterr().out
    assert said.count("same bits") == len(tapes.fluids()) == 8
