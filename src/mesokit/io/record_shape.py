"""Keys and types of the record of a run, and a check of a record that was read."""

from collections.abc import Iterator
from typing import Any

# a type, or some of them; a list of others; a dict of which each value is one; keys with their own
NUMBER = (int, float)
RECORD: dict[str, Any] = {
    "case": str,
    "case_digest": str,
    "units": (dict, None),
    "seed": int,
    "sources": {"*": (str, bool, None)},
    "starts_from": dict,
    "parts": [{"family": str, "name": str, "class": str}],
    "versions": {"*": str},
    "host": str,
    "system": str,
    "processor": str,
    "cores": (int, None),
    "threads": int,
    "ranks": int,
    "device": str,
    "command": [str],
    "started": str,
    "resumed": [str],
    "lengthened": [{"at": str, "step": int, "steps": int}],
    "ended": (str, None),
    "failed": (str, None),
    "absorbed": (*NUMBER, None),
    "timings": {"*": NUMBER},
    "shared_work": dict,
    "merged": [{"run": str, "seed": int}],
}
SHARED_WORK = {
    "stages": {"*": {"least": NUMBER, "median": NUMBER, "most": NUMBER}},
    "imbalance": NUMBER,
    "balance": {"*": (int, float, str)},
}


def misshapen(record: Any) -> str | None:
    """The first error of a record in words, None without one. Keys may be missing.

    >>> misshapen({"seed": 4, "resumed": ["2026-01-01"]})
    >>> misshapen({"resumed": 5}), misshapen({"parts": [{"name": "a"}]})
    ("'resumed' is no list", "'parts[0].family' is missing")
    """
    if not isinstance(record, dict):
        return "it is no table"
    wanted = {key: shape for key, shape in RECORD.items() if key in record}
    if record.get("shared_work"):
        wanted["shared_work"] = SHARED_WORK
    return next(_wrong(record, wanted, ""), None)


def _wrong(value: Any, shape: Any, key: str) -> Iterator[str]:
    if isinstance(shape, dict):
        if not isinstance(value, dict):
            yield f"{key!r} is no table"
            return
        for name, one in (dict.fromkeys(value, shape["*"]) if "*" in shape else shape).items():
            below = f"{key}.{name}".lstrip(".")
            if name not in value:
                yield f"{below!r} is missing"
            else:
                yield from _wrong(value[name], one, below)
    elif isinstance(shape, list):
        if not isinstance(value, list):
            yield f"{key!r} is no list"
            return
        for i, one in enumerate(value):
            yield from _wrong(one, shape[0], f"{key}[{i}]")
    else:
        kinds = shape if isinstance(shape, tuple) else (shape,)
        known = tuple(kind for kind in kinds if kind is not None)
        if not (isinstance(value, known) or (value is None and None in kinds)):
            yield f"{key!r} is no {' or '.join(NAMES[kind] for kind in known)}"


NAMES: dict[Any, str] = {
    str: "text", int: "whole number", float: "number", bool: "yes or no", dict: "table",
}  # fmt: skip
