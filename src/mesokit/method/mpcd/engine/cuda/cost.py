"""What a fluid takes on common cards: memory, and a prediction of the time of its steps.

A particle-step takes the longer of two: its double precision arithmetic, or its traffic. That is a
copy of positions and velocities, the additions to the sums of its cell, and its share of the work
on cells. Times of all three were measured with prototypes of the kernels on an H100 and an H200
(docs/inside/gpu.md); those of other cards follow from their bandwidths, and were not measured.
"""

from typing import NamedTuple

from mesokit.case.amounts import duration_text, size_text
from mesokit.case.case import Case
from mesokit.devices.records import AtOnce, adding
from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.cpu.numbers import Numbers
from mesokit.method.mpcd.engine.embedded.allocate import most_near_beads
from mesokit.method.mpcd.engine.embedded.state import PARTNERS
from mesokit.seam.method import Row


class Card(NamedTuple):
    """A card: compute capability, bytes of memory, bytes copied in a second, double precision
    operations in a second, seconds for a word that is added to sums, for four words added at once,
    and of the work on a cell; and whether the last three were measured."""

    name: str
    chip: tuple[int, int]
    memory: float
    bandwidth: float
    arithmetic: float
    word: float
    four_words: float
    cell: float
    measured: bool


CARDS = (
    Card("A100 80 GB", (8, 0), 85e9, 1.7e12, 4.8e12, 16e-12, 0.0, 150e-12, False),
    Card("H100 80 GB", (9, 0), 85e9, 2.9e12, 1.6e13, 12.4e-12, 16e-12, 110e-12, True),
    Card("H200", (9, 0), 150e9, 4.0e12, 1.6e13, 11e-12, 14e-12, 100e-12, True),
    Card("RTX 4090", (8, 9), 25.7e9, 0.9e12, 6.4e11, 14e-12, 0.0, 200e-12, False),
    Card("RTX 5090", (12, 0), 34e9, 1.6e12, 8.2e11, 12e-12, 16e-12, 150e-12, False),
)
IN_2D = 0.6  # times as many operations as in 3D
LAUNCH = 10e-6  # seconds from one launch of a kernel to the next, at least
REAL, WHOLE = 8, 4  # bytes of a number
WITHOUT = "no walls, bonds, samples or files"
TABLES = "estimate, without tables of walls and rows of beads"


def memory_of(numbers: Numbers) -> int:
    """Bytes of a device for the particles and cells of a case.

    Left out are tables of walls, which a run makes, and rows of beads, which are small.
    """
    d, among_solids = numbers.dimension, numbers.solids is not None
    row = 2 * d * REAL + d * WHOLE + WHOLE  # positions, velocities, images, number
    spare = REAL + 2 * WHOLE + WHOLE * among_solids  # of sorts, and the list of flights
    cell = sums_length(len(numbers.scales)) * REAL
    cell += record_length(numbers.coefficient_count) * REAL + 2 * WHOLE
    solutes, near = numbers.case.solutes, 0
    if solutes is not None:
        cell += 2 * WHOLE  # beads by cell
        pair = solutes.solvent_pair
        if pair is not None:
            cell, spare = cell + REAL, spare + WHOLE  # cells and particles near beads
            of_one = (2 + PARTNERS) * WHOLE + (1 + d) * REAL
            near = most_near_beads(solutes, pair, numbers) * of_one
    return numbers.n * (row + spare) + numbers.number_of_cells * cell + near


def launches_of(numbers: Numbers) -> int:
    """Launches of a step with a thermostat, as `step.py` lists them; clearing a counter is one."""
    solutes, launches = numbers.case.solutes, 4  # sweep, collisions, those that draw with care
    if numbers.solids is not None:
        launches += 2  # flights that may meet them
    launches += {"none": 0, "extrapolate": 2}.get(numbers.virtual, 1)
    if solutes is not None:
        lists, embedded = bool(solutes.different_pairs), solutes.solvent_pair is not None
        first, each = 1 + 3 * lists + 2 * embedded, 2 + 2 * lists + 3 * embedded
        launches += first + solutes.substeps * each + (5 if embedded else 7)
    return launches


def seconds_of_step(numbers: Numbers, card: Card) -> float:
    """Seconds of a step on a card, as predicted."""
    d, length = numbers.dimension, sums_length(len(numbers.scales))
    additions = (len(numbers.scales) + 1) * card.word
    if isinstance(adding(card.chip, length), AtOnce):
        additions = length // 4 * card.four_words
    copies = 4 * d * REAL / card.bandwidth
    traffic = copies + additions + card.cell * numbers.number_of_cells / max(numbers.n, 1)
    operations = numbers.case.fluid.collision.operations
    arithmetic = operations * (IN_2D if d == 2 else 1.0) / card.arithmetic
    return max(numbers.n * max(traffic, arithmetic), launches_of(numbers) * LAUNCH)


def basis_of(numbers: Numbers, card: Card) -> str:
    """What the time of a step on a card was predicted from."""
    launches = launches_of(numbers)
    if seconds_of_step(numbers, card) <= launches * LAUNCH:
        return f"{launches} launches of {1e6 * LAUNCH:.0f} us each"
    return "prototypes measured" if card.measured else "bandwidths, not measured"


def rows(case: Case) -> list[Row]:
    """Memory on a device, and the time of the run on common cards, for `mesokit check`."""
    numbers = Numbers(case)
    needed, steps = memory_of(numbers), case.run.warmup + case.run.steps
    found: list[Row] = [("device memory", size_text(needed), TABLES)]
    for card in CARDS:
        name, step = f"on one {card.name}", seconds_of_step(numbers, card)
        rate = f"{numbers.n / step:.2g} particle-steps/s"
        note = f"{rate}, predicted from {basis_of(numbers, card)}; {WITHOUT}"
        if needed > card.memory:
            found.append((name, "too large", f"it has {size_text(card.memory)}"))
        else:
            found.append((name, duration_text(step * steps), note))
    return found
