"""The cores that this process may use, on every system."""

import os


def usable_cores() -> int:
    """How many cores this process may use: fewer than there are where a queue or `taskset` says so.

    Where the system does not say, as on macOS and, before Python 3.13, on Windows, all that it has.

    >>> 1 <= usable_cores() <= os.cpu_count()
    True
    """
    allowed = getattr(os, "process_cpu_count", None)  # Python 3.13
    if allowed is not None:
        return allowed() or 1
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def which_cores() -> tuple[int, ...]:
    """Their numbers, nothing where the system does not say."""
    return tuple(sorted(os.sched_getaffinity(0))) if hasattr(os, "sched_getaffinity") else ()
