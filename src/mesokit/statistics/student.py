"""Error bars of few values."""

import math

ONE_SIGMA = 0.5 * (1 + math.erf(math.sqrt(0.5)))  # of a Gaussian, below one standard deviation


def student(values: int) -> float:
    """Factor by which the error of a mean of few values is larger than their scatter tells.

    The scatter of few values is itself uncertain. With this factor the error bar holds the truth as
    often as one standard error of many values does, 68 times of 100, whatever their number.

    Parameters: `values`, independent Gaussian numbers. Returns nan for fewer than two.
    Source: Student (W. S. Gosset), Biometrika 6, 1 (1908).

    >>> [round(student(n), 2) for n in (1, 2, 3, 4, 32)]
    [nan, 1.84, 1.32, 1.2, 1.02]
    """
    from scipy.special import stdtrit

    return float(stdtrit(values - 1, ONE_SIGMA)) if values > 1 else math.nan
