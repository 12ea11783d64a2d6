"""Numbers, memory and time in words for people."""


def size_text(count: float) -> str:
    """Bytes for people.

    >>> size_text(270_000_000)
    '270 MB'
    """
    for unit in ("bytes", "kB", "MB", "GB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} TB"


def count_text(count: int) -> str:
    """How many, without more digits than one reads.

    >>> count_text(2147483648), count_text(10**300)
    ('2147483648', '1e+300')
    """
    return str(count) if count < 10**15 else f"{count:.3g}"


def duration_text(seconds: float) -> str:
    """Time for people, to two units.

    >>> duration_text(0.2), duration_text(61), duration_text(7300)
    ('0.2 s', '1 min 1 s', '2 h 1 min')
    """
    if seconds < 10:
        return f"{seconds:.1f} s"
    seconds = round(seconds)
    for big, first, small, second in ((86400, "d", 3600, "h"), (3600, "h", 60, "min")):
        if seconds >= big:
            return f"{seconds // big} {first} {seconds % big // small} {second}"
    return f"{seconds // 60} min {seconds % 60} s" if seconds >= 60 else f"{seconds} s"


def number(value: float | None, unit: str = "") -> str:
    """A number with its unit, or that there is none."""
    return "no formula" if value is None else f"{value:.4g} {unit}".rstrip()
