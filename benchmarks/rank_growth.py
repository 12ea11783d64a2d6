"""How what is sent grows with the number of ranks, beside a model on paper, and where that leads.

    python -m benchmarks.rank_growth

Messages and bytes are exact on any machine, however many ranks share its cores; times are not, and
are those of one core (`CORE`) and of a network (`NETWORK`) in the predictions.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

from benchmarks import ranks
from mesokit.method.mpcd.engine.domains.blocks.tree import divided

SIDE, DENSITY, STEPS = 64, 10, 40
COUNTS = (2, 4, 8, 16)
WORD = 8  # bytes
ROW, ANSWER, MOVED = 5, 6, 16  # words of sums, of an answer, of a particle that moves: 3D SRD
EVERY = 4  # steps from one move to the next, for a timestep of 0.1
CORE, CELL = 15e-9, 20e-9  # seconds of a particle-step, and of a cell beyond the block
FIRST, LAST = 64, 4096  # ranks of the predictions


class Network(NamedTuple):
    """Seconds of a message, bytes per second of a node, ranks of a node."""

    latency: float
    bandwidth: float
    ranks: int


NETWORK = Network(latency=1.5e-6, bandwidth=25e9, ranks=32)  # InfiniBand HDR, 200 Gbit/s


class Sent(NamedTuple):
    """Of a rank in a step: bytes and messages; layers of cells that its faces have in all."""

    bytes: float
    messages: float
    faces: float


def face(lengths: tuple[int, ...], size: tuple[int, ...]) -> float:
    """Cells of all faces of a block that are borders."""
    volume = math.prod(lengths)
    return sum(2 * volume / n for n, whole in zip(lengths, size, strict=True) if n < whole)


def model(lengths: tuple[int, ...], size: tuple[int, ...], rows: float, moved: float) -> Sent:
    """Rows of sums and their answers, and particles that move, in proportion to the faces."""
    cut = sum(n < whole for n, whole in zip(lengths, size, strict=True))
    two = sum(n == whole // 2 for n, whole in zip(lengths, size, strict=True))
    partners = 3 ** (cut - two) * 2**two - 1
    area = face(lengths, size)
    words = rows * area * (ROW + ANSWER) + moved * area * MOVED
    return Sent(WORD * words, partners * (2 + 1 / EVERY), area)


def seconds(lengths: tuple[int, ...], size: tuple[int, ...], rows: float, moved: float) -> float:
    """Of a step: particles, cells around the block, what is sent."""
    sent = model(lengths, size, rows, moved)
    around = math.prod(min(n + 4, whole) for n, whole in zip(lengths, size, strict=True))
    work = CORE * DENSITY * math.prod(lengths) + CELL * (around - math.prod(lengths))
    wire = sent.bytes * NETWORK.ranks / NETWORK.bandwidth + sent.messages * NETWORK.latency
    return work + wire


def cubes(side: int, number: int) -> tuple[int, ...]:
    """A block of a cube of so many cells along each axis, shared by so many ranks."""
    return divided((side,) * 3, number, (1.0,) * 3).blocks[0].lengths


def lines() -> Iterator[str]:
    """Measured beside the model, then predictions."""
    size = (SIDE,) * 3
    yield f"{SIDE}^3 cells, {DENSITY} particles each; of a rank in a step, mean of all ranks."
    yield ""
    yield (
        "| ranks | block | rows of sums per cell of face | moves per cell of face | kB | model | "
        "messages | model |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    rows = moved = 0.0
    for number in COUNTS:
        found = ranks.run("W2", number, 1, STEPS)
        messages, sums, answers, moves = (
            sum(meter[k] for meter in found["meters"]) / number / STEPS for k in range(4)
        )
        lengths = cubes(SIDE, number)
        area = face(lengths, size)
        if not rows:
            rows, moved = sums / ROW / area, moves / MOVED / area
        paper = model(lengths, size, rows, moved)
        yield (
            f"| {number} | {' x '.join(map(str, lengths))} | {sums / ROW / area:.3f} | "
            f"{moves / MOVED / area:.3f} | {WORD * (sums + answers + moves) / 1e3:.0f} | "
            f"{paper.bytes / 1e3:.0f} | {messages:.2f} | {paper.messages:.2f} |"
        )
    yield ""
    yield "Predicted efficiency: time of a step of one rank alone over that of so many."
    yield ""
    yield "| ranks | weak, 64^3 cells each | strong, 512^3 in all | block then |"
    yield "|---|---|---|---|"
    doubled = itertools.takewhile(lambda n: n <= LAST, (FIRST * 4**k for k in itertools.count()))
    for number in doubled:
        large = (10**6,) * 3
        weak = CORE * DENSITY * SIDE**3 / seconds(size, large, rows, moved)
        block = cubes(512, number)
        alone = CORE * DENSITY * math.prod(block)
        strong = alone / seconds(block, (512,) * 3, rows, moved)
        yield f"| {number} | {weak:.0%} | {strong:.0%} | {' x '.join(map(str, block))} |"


if __name__ == "__main__":
    for line in lines():
        print(line, flush=True)
