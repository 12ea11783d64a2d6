"""Numbers of which two digits are enough."""


def two_digits(value: float, sign: str = "") -> str:
    """Rounded to two digits, and written out where a power of ten would be harder to read.

    >>> two_digits(187.0), two_digits(0.0123), two_digits(2.0, sign="+")
    ('190', '0.012', '+2')
    """
    return f"{float(f'{value:.2g}'):{sign}g}"


def above(value: float, limit: float, digits: int = 2) -> bool:
    """Whether a value is above a limit even as it is shown, to so many digits."""
    return float(f"{value:.{digits}g}") > float(f"{limit:.{digits}g}")
