"""One workload on a device: particle-steps in a second, and the time of each kernel.

    python -m benchmarks.on_device W1 --device cuda --seconds 3

prints one JSON line. A copy of as many bytes as positions and velocities take is timed in the same
run: a card that is busy, or slower than another of its name, shows there.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np

from benchmarks.workloads import case
from mesokit.devices.device import words_of
from mesokit.devices.named import opened
from mesokit.errors import RunError
from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.cuda.cost import CARDS, REAL, WHOLE, seconds_of_step
from mesokit.method.mpcd.engine.cuda.engine import CUDA
from mesokit.method.mpcd.engine.cuda.refused import refused
from mesokit.method.mpcd.start.fluid import start
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import put_real, real

WARM = 101  # steps: the first sorts are out of the time
ROUNDS, COPIES = 5, 15


class Timed:
    """A device whose launches are waited for and timed while `watching`."""

    def __init__(self, behind: Any) -> None:
        self.behind, self.watching = behind, False
        self.seconds: dict[str, list[float]] = {}
        self.threads: dict[str, int] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self.behind, name)

    def kernel(self, body: Callable, given: tuple[Any, ...]) -> Any:
        """The name of a body, and its kernel."""
        return body.__name__, self.behind.kernel(body, given)

    def launch(self, kernel: Any, words: Any) -> None:
        """Run the threads."""
        name, there = kernel
        if not self.watching:
            self.behind.launch(there, words)
            return
        self.behind.wait()
        began = time.perf_counter()
        self.behind.launch(there, words)
        self.behind.wait()
        self.seconds.setdefault(name, []).append(time.perf_counter() - began)
        self.threads[name] = int(words[0])


@scalar
def copy_real(i, source, to):  # type: ignore[no-untyped-def]
    """Thread i copies number i."""
    put_real(to, i, real(source, i))


@scalar
def idle(i, to):  # type: ignore[no-untyped-def]
    """No thread does anything: what a launch takes by itself."""
    if i < 0:
        put_real(to, i, 0.0)


def copied(device: Timed, numbers: int) -> tuple[float, float]:
    """Bytes read and written in a second by a copy, and seconds of a launch without work."""
    size = numbers * REAL
    source, to = device.allocate(size), device.allocate(size)
    device.clear(source, size)
    copy, nothing = device.kernel(copy_real, (source, to)), device.kernel(idle, (to,))
    device.watching = True
    for _ in range(COPIES):
        device.launch(copy, words_of(numbers, source, to))
        device.launch(nothing, words_of(1, to))
    device.watching = False
    device.free(source)
    device.free(to)
    taken = {body: median(device.seconds.pop(body)) for body in ("copy_real", "idle")}
    return 2 * size / taken["copy_real"], taken["idle"]


def least_bytes(numbers: Numbers) -> dict[str, int]:
    """Bytes that a thread of a kernel must read and write, by its name."""
    d = numbers.dimension
    sums = sums_length(len(numbers.scales)) * REAL
    return {
        "sweep": 4 * d * REAL,
        "collide_cell": 2 * sums + record_length(numbers.coefficient_count) * REAL,
        "wrap_particle": 2 * d * (REAL + WHOLE),
        "count_in_cell": d * REAL + WHOLE,
        "place_in_order": d * REAL + 2 * WHOLE,
        "gather_reals": 2 * REAL + WHOLE,
        "gather_wholes": 3 * WHOLE,
    }


def predicted(numbers: Numbers, name: str) -> float | None:
    """Particle-steps in a second on the card of a name, without walls and sorts; None for others.

    Molecules have no prediction.
    """
    single = numbers.case.fluid.molecule is None
    for card in CARDS:
        if single and card.name.removesuffix(" 80 GB") in name:
            return numbers.n / seconds_of_step(numbers, card)
    return None


def measure(workload: str, name: str, seconds: float) -> dict[str, Any]:
    """Run for about so many seconds in all; then some steps with each launch timed."""
    given = case(workload)
    if (reason := next(refused(given), None)) is not None:
        return {"workload": workload, "refused": reason}
    behind = opened(name)
    assert behind is not None  # the processor is no device
    device = Timed(behind)
    fluid = CUDA(given, device, ())
    numbers, rates = fluid.numbers, []
    start(fluid)
    fluid.advance(WARM)
    chunk = 2 * numbers.sort_every
    for _ in range(ROUNDS):
        began, first = time.perf_counter(), fluid.step
        while fluid.step == first or time.perf_counter() - began < seconds / ROUNDS:
            fluid.advance(chunk)
        rates.append((fluid.step - first) * fluid.n / (time.perf_counter() - began))
    device.watching = True
    fluid.advance(chunk)
    device.watching = False
    taken, threads = dict(device.seconds), dict(device.threads)
    least = least_bytes(numbers)
    speed, launch = copied(device, 2 * numbers.dimension * fluid.n)
    kernels = {
        body: {
            "threads": threads[body],
            "launches": len(every) / chunk,
            "seconds": float(np.median(every)),
            "bytes": least.get(body),
        }
        for body, every in taken.items()
    }
    return {
        "workload": workload,
        "device": behind.name,
        "particles": fluid.n,
        "rates": rates,
        "predicted": predicted(numbers, behind.name),
        "bytes": fluid.memory.bytes_held,
        "copy": speed,
        "launch": launch,
        "kernels": kernels,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("workload")
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--seconds", type=float, default=3.0)
    given = parser.parse_args()
    try:
        found = measure(given.workload, given.device, given.seconds)
    except RunError as error:  # such as too little memory
        found = {"workload": given.workload, "refused": str(error)}
    print(json.dumps(found))


if __name__ == "__main__":
    main()
