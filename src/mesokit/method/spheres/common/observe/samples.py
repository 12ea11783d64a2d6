"""What observables remember that keep each sample: a series in time."""

from typing import ClassVar

from mesokit.seam.observable import BlockAccumulator
from mesokit.statistics import TimeSeries


class Samples(BlockAccumulator):
    """Rows of so many numbers in time, and how many samples were taken."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)

    def __init__(self, width: int) -> None:
        self.series, self.samples = TimeSeries(width), 0
