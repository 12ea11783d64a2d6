"""Running averages, correlations and fits, each with an honest error bar, in bounded memory."""

from mesokit.statistics.blocking import (
    FEWEST_BLOCKS,
    FEWEST_PIECES,
    blocking_error,
    correlated,
    correlated_error,
    falling_error,
    independent_error,
    student,
)
from mesokit.statistics.blocks import Blocks
from mesokit.statistics.fit import (
    ChiSquare,
    Fit,
    chi_square,
    deviation,
    weighted_line,
    weighted_polynomial,
)
from mesokit.statistics.multiple_tau import Correlation, MultipleTau
from mesokit.statistics.ratio import ratio
from mesokit.statistics.sample import spread_ids
from mesokit.statistics.spectrum import (
    Frequency,
    Spectrum,
    dominant_frequency,
    mean_frequency,
    mean_spectrum,
    spectrum,
)
from mesokit.statistics.tally import Tally
from mesokit.statistics.time_series import TimeSeries

__all__ = [
    "FEWEST_BLOCKS", "FEWEST_PIECES", "Blocks", "ChiSquare", "Correlation", "Fit", "Frequency",
    "MultipleTau", "Spectrum", "Tally", "TimeSeries", "blocking_error", "chi_square",
    "correlated", "correlated_error", "deviation", "dominant_frequency", "falling_error",
    "independent_error", "mean_frequency", "mean_spectrum", "ratio", "spectrum", "spread_ids",
    "student", "weighted_line", "weighted_polynomial",
]  # fmt: skip
