"""How several ranks have shared the work of a run, in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


def work_words(provenance: Mapping[str, Any]) -> Iterator[str]:
    """Lines of what a run keeps as `shared_work`, none of a run on one rank.

    >>> stages = {"sweep": {"least": 1.0, "median": 1.5, "most": 2.0}}
    >>> shared = {"stages": stages, "imbalance": 1.25, "balance": {"cuts moved": 3}}
    >>> for line in work_words({"ranks": 4, "shared_work": shared}):
    ...     print(line)
    4 ranks: one had 1.25 times the work of the mean; cuts moved 3
    seconds of a rank (least, median, most): sweep 1, 1.5, 2
    """
    shared = provenance.get("shared_work")
    if not shared:
        return
    more = [f"{what} {_number(value)}" for what, value in shared["balance"].items()]
    most = f"one had {shared['imbalance']:.3g} times the work of the mean"
    yield f"{provenance['ranks']} ranks: {'; '.join([most, *more])}"
    stages = [
        f"{stage} {spread['least']:.3g}, {spread['median']:.3g}, {spread['most']:.3g}"
        for stage, spread in shared["stages"].items()
    ]
    yield f"seconds of a rank (least, median, most): {'; '.join(stages)}"


def _number(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
