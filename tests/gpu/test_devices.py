"""Devices of kernels: memory, launches, what the checker sees, and the driver's calls."""

from __future__ import annotations

import re
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from mesokit.devices.checked import Checked
from mesokit.devices.compile import ENTRY, machine_of
from mesokit.devices.cubins import made
from mesokit.devices.cuda import Cuda
from mesokit.devices.device import words_of
from mesokit.devices.emulated import Emulated
from mesokit.devices.host import Host
from mesokit.devices.named import opened
from mesokit.devices.recorded import Recorded, Tape
from mesokit.devices.translate import Translation, UnknownInstructionError
from mesokit.errors import CaseError, RunError
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import (
    add_word,
    put_real,
    put_word,
    raise_to,
    real,
    take_number,
    word,
)
from tests.helpers.fake_driver import FakeDriver

CHIP = (9, 0)
CHIPS = ((8, 0), (9, 0), (12, 0))
THREADS = 300  # more than a block, and a block that is not full


@scalar
def work(i, scale, place):  # type: ignore[no-untyped-def]
    """A sum, a largest number, a count and a number of each thread."""
    add_word(place[0], 0, i)
    raise_to(place[0], 1, i)
    take_number(place[0], 4, 2)
    put_real(place[1], i, scale * real(place[1], i) + 1.0 / (i + 3.0))


@scalar
def lost_sum(i, place):  # type: ignore[no-untyped-def]
    put_word(place, 0, word(place, 0) + i)


@scalar
def beyond_the_end(i, place):  # type: ignore[no-untyped-def]
    put_word(place, i + 295, 1)


@scalar
def unset(i, place):  # type: ignore[no-untyped-def]
    put_real(place, i, real(place, i) + 1.0)


@scalar
def same_place(i, place):  # type: ignore[no-untyped-def]
    put_word(place, 0, i)


@scalar
def neighbour(i, place):  # type: ignore[no-untyped-def]
    put_word(place, i, word(place, (i + 1) % 300))


@scalar
def added_and_read(i, place):  # type: ignore[no-untyped-def]
    add_word(place, 0, 1)
    put_word(place, i + 1, word(place, 0))


@scalar
def added_and_written(i, place):  # type: ignore[no-untyped-def]
    if i == 7:
        put_word(place, 0, 1)
    add_word(place, 0, 1)


def run_work(device: Any, repeat: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """The numbers that `work` leaves."""
    sums, values = np.zeros(3, np.int64), np.linspace(-1.0, 1.0, THREADS)
    place = device.allocate(sums.nbytes), device.allocate(values.nbytes)
    device.clear(place[0], sums.nbytes)
    device.write(place[1], values)
    kernel = device.kernel(work, (0.7, place))
    for _ in range(repeat):
        device.launch(kernel, words_of(THREADS, 0.7, place))
    device.wait()
    device.read(place[0], sums)
    device.read(place[1], values)
    for address in place:
        device.free(address)
    return sums, values


def expected_work(repeat: int = 2) -> tuple[np.ndarray, np.ndarray]:
    values = np.linspace(-1.0, 1.0, THREADS)
    for _ in range(repeat):
        values = 0.7 * values + 1.0 / (np.arange(THREADS) + 3.0)
    total = THREADS * (THREADS - 1) // 2
    return np.array([repeat * total, THREADS - 1, 2 * repeat * THREADS]), values


@pytest.mark.parametrize(
    "make", [Host, lambda: Host(3), *[lambda c=c: Emulated(c) for c in CHIPS], Checked]
)
def test_a_device_does_what_it_is_asked(make) -> None:
    device = make()
    for found, expected in zip(run_work(device), expected_work(), strict=True):
        np.testing.assert_array_equal(found, expected)
    assert getattr(device, "faults", {}) == {}


def test_two_devices_of_one_process_have_memory_of_their_own() -> None:
    one, other = Checked(), Checked()
    first, second = ((device, device.allocate(8 * THREADS)) for device in (one, other))
    for device, place in (first, second):
        device.clear(place, 8 * THREADS)
    kernels = [device.kernel(same_place, (place,)) for device, place in (first, second)]
    one.launch(kernels[0], words_of(8, first[1]))
    found = np.zeros(THREADS, np.int64)
    other.read(second[1], found)
    assert not found.any()
    one.read(first[1], found)
    assert 0 < found[0] < 8


# --- the checker ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "faults"),
    [
        (lost_sum, {"read by one thread and written by another", "written by two threads"}),
        (beyond_the_end, {"outside of all arrays"}),
        (unset, {"read before written"}),
        (same_place, {"written by two threads"}),
        (neighbour, {"read by one thread and written by another"}),
        (added_and_read, {"added to by one thread and read by another"}),
        (added_and_written, {"added to by one thread and written by another"}),
    ],
)
def test_a_careless_kernel_is_caught(body, faults) -> None:
    device = Checked()
    place = device.allocate(8 * (THREADS + 1))
    if body is not unset:
        device.clear(place, 8 * (THREADS + 1))
    device.launch(device.kernel(body, (place,)), words_of(THREADS, place))
    assert {fault for _, fault in device.faults} == faults


def test_an_address_of_the_host_is_caught() -> None:
    device, here = Checked(), np.zeros(THREADS, np.int64)
    device.launch(device.kernel(same_place, (1,)), words_of(1, here.ctypes.data))
    assert {fault for _, fault in device.faults} == {"outside of all arrays"}
    with pytest.raises(ValueError, match="not an address of this device"):
        device.read(here.ctypes.data, here)


def test_memory_that_was_given_back_is_caught() -> None:
    device = Checked()
    place = device.allocate(64)
    device.clear(place, 64)
    device.free(place)
    device.launch(device.kernel(same_place, (place,)), words_of(1, place))
    assert {fault for _, fault in device.faults} == {"outside of all arrays"}


# --- the text of a kernel ------------------------------------------------------------------------


def kernel_with(line: str) -> str:
    """PTX of a kernel of one instruction."""
    return (
        f".visible .entry {ENTRY}(.param .u64 p_0)\n{{\n.reg .f64 %fd<4>;\n.reg .b64 %rd<4>;\n"
        f"{line}\nret;\n}}\n"
    )


@pytest.mark.parametrize(
    "line",
    [
        "add.f64 %fd1, %fd2, %fd3;",
        "mul.f64 %fd1, %fd2, %fd3;",
        "fma.rz.f64 %fd1, %fd2, %fd3, %fd1;",
        "sqrt.approx.f64 %fd1, %fd2;",
        "bar.sync 0;",
        "atom.global.add.f64 %fd1, [%rd1], %fd2;",
        "shfl.sync.idx.b32 %rd1, %rd2, %rd3, 31, -1;",
    ],
)
def test_what_could_have_other_bits_is_refused(line) -> None:
    with pytest.raises(UnknownInstructionError, match=re.escape(line.rstrip(";"))):
        Translation(kernel_with(line))


@scalar
def product_and_sum(i, place):  # type: ignore[no-untyped-def]
    put_real(place, i, real(place, i) * real(place, i + 1) + real(place, i + 2))


@pytest.mark.parametrize("chip", CHIPS)
def test_a_card_gets_machine_code_without_contraction(chip) -> None:
    from numba import types

    new = made(product_and_sum, (types.int64,), chip)
    assert re.findall(r"(add|mul|fma)\.rn\.f64", new.ptx) == ["mul", "add"]
    assert new.cubin[:4] == b"\x7fELF"
    assert ENTRY.encode() in new.cubin
    assert int(re.findall(r"Used (\d+) registers", new.said)[0]) < 32


def test_a_kernel_is_found_again_by_another_process() -> None:
    """The second one loads no compiler of cards."""
    code = (
        "import sys, numba; from numba import types\n"
        "from mesokit.devices.cubins import made\n"
        "from mesokit.method.mpcd.engine.cuda.kernels.sort import lift_by_chunk\n"
        "new = made(lift_by_chunk, (types.int64,) * 2, (9, 0))\n"
        "print('numba.cuda.compiler' in sys.modules, hash(new.cubin) and len(new.cubin))\n"
    )
    first, second = (
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout.split()
        for _ in range(2)
    )
    assert second == ["False", first[1]]


# --- tapes ---------------------------------------------------------------------------------------


def test_a_tape_replays_to_the_same_bits(tmp_path) -> None:
    recorded = Recorded(Emulated())
    found, _ = run_work(recorded)
    recorded.save(tmp_path / "work.tape", what="work")
    tape = Tape(tmp_path / "work.tape")
    assert tape.about == {"what": "work"}
    assert tape.chip == (9, 0)
    assert tape.play(Emulated(seed=9)).reads == []
    assert tape.play(Cuda(driver=driver_that_knows_work())).reads == []
    np.testing.assert_array_equal(found, expected_work()[0])


def test_other_bits_are_seen_by_a_tape(tmp_path) -> None:
    class Careless(Emulated):
        def clear(self, address: int, size: int) -> None:
            self.write(address, np.ones(size, np.uint8))

    recorded = Recorded(Emulated())
    run_work(recorded)
    recorded.save(tmp_path / "work.tape")
    assert len(Tape(tmp_path / "work.tape").play(Careless()).reads) == 1
    (tmp_path / "none.tape").write_text("no tape")
    with pytest.raises(ValueError, match=r"none\.tape: no tape"):
        Tape(tmp_path / "none.tape")


# --- the driver ----------------------------------------------------------------------------------


def driver_that_knows_work() -> FakeDriver:
    """The fake driver, with the PTX of the kernel of `run_work`."""
    from numba import types

    new = made(work, (types.float64, types.UniTuple(types.int64, 2)), CHIP)
    return FakeDriver(CHIP, known={new.cubin: new.ptx})


def test_the_driver_is_called_as_it_wants() -> None:
    driver = driver_that_knows_work()
    device = Cuda(driver=driver)
    for found, expected in zip(run_work(device), expected_work(), strict=True):
        np.testing.assert_array_equal(found, expected)
    assert (device.name, device.chip, driver.memory) == ("A card", (9, 0), {})
    assert device.memory == (1 << 20, 1 << 20)


@pytest.mark.parametrize(
    ("driver", "error"),
    [
        (FakeDriver(version=11080), r"the driver is for CUDA 11\.8, what is installed for 1\d\.0"),
        (FakeDriver(cards=0), "'cuda:0': the driver knows no card here"),
        (FakeDriver(init=100), "the driver knows no card here; expected --device cpu"),
        (FakeDriver(init=999), "does not start"),
        (FakeDriver(chip=(7, 0)), r"A card has compute capability 7\.0; expected 7\.5 or more"),
    ],
)
def test_a_card_that_cannot_do_it_is_an_error_of_one_line(driver, error) -> None:
    with pytest.raises(RunError, match=error) as raised:
        Cuda(driver=driver)
    assert "\n" not in str(raised.value)


def test_too_little_memory_is_an_error_of_one_line() -> None:
    device = Cuda(driver=FakeDriver(size=1 << 20))
    device.allocate(1 << 19)
    with pytest.raises(
        RunError, match=r"out of memory on A card: 1\.05 MB more do not fit, 524 kB"
    ):
        device.allocate(1 << 20)


def test_a_second_card_that_is_not_there_is_an_error() -> None:
    with pytest.raises(RunError, match="'cuda:1': the driver knows 1 card here"):
        Cuda(1, FakeDriver())


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("gpu", "'cpu', 'cuda', 'emulated' or 'host'; did you mean 'cuda'?"),
        ("cud", "'cpu', 'cuda', 'emulated' or 'host'; did you mean 'cuda'?"),
        *((name, "'cpu', 'cuda', 'emulated' or 'host'") for name in ("host:1", "cpu:0", "", 3)),
        *((name, "'cuda', or such as 'cuda:1'") for name in ("cuda:x", "cuda:", "cuda:-1")),
        ("emulated:9", "'emulated', or such as 'emulated:9.0'"),
    ],
)
def test_a_device_of_another_name_is_an_error(name, expected) -> None:
    with pytest.raises(CaseError, match=re.escape(f"{name!r}: expected {expected}")):
        opened(name)


def test_what_the_driver_holds_is_given_back() -> None:
    driver = FakeDriver()
    Cuda(driver=driver).close()
    assert driver.released


def test_a_kernel_that_the_assembler_refuses_is_an_error() -> None:
    with pytest.raises(Exception, match=r"nvJitLink|PTX|ERROR"):
        machine_of("no ptx", (9, 0))
