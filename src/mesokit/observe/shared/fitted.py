"""A fitted number beside theory, or why the fit has found none."""

import math

from mesokit.seam.estimate import SURE
from mesokit.seam.result import Comparison, joined, with_error


def fitted_number(
    what: str, value: float, error: float, expected: float, unit: str, note: str = ""
) -> Comparison:
    """A comparison of a positive number that a fit has found.

    Within two standard errors of zero it has no value: a coefficient or a time that may be zero, or
    twice as large, is no measurement of it.

    Parameters: those of `Comparison`.

    >>> print(fitted_number("stress time", 11.9, 1.2, 12.61, "tau"))
    stress time: 11.9(12) tau, expected 12.61: -0.6 standard errors, -5.6 %
    >>> print(fitted_number("stress time", 28.0, 16.0, 12.61, "tau"))
    stress time: undetermined, expected 12.61 (the fit finds 28(16): within two errors of zero)
    """
    if error >= abs(value) / SURE:
        why = f"the fit finds {with_error(value, error)}: within two errors of zero"
        return Comparison(what, math.nan, math.nan, expected, unit, joined(why, note))
    return Comparison(what, value, error, expected, unit, note)
