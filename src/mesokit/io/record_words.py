"""The work of ranks of a run, and texts about shared work and merged runs from records."""

import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import median
from typing import Any

WAITING = "wait"  # the stage of a step in which a rank does nothing


def shared_work(ranks: Any, engine: Any) -> dict[str, Any]:
    """Seconds of each stage, least, median and most over ranks, and the imbalance; {} on one rank.

    `imbalance` is the largest work of a rank, without waiting, over the mean.
    """
    if ranks.size == 1:
        return {}
    every = ranks.gathered(engine.seconds)
    work = [sum(s for stage, s in one.items() if stage != WAITING) for one in every]
    mean = sum(work) / len(work)
    return {
        "stages": {
            stage: {"least": min(spent), "median": median(spent), "most": max(spent)}
            for stage, spent in ((stage, [one[stage] for one in every]) for stage in every[0])
        },
        "imbalance": max(work) / mean if mean else 1.0,
        "balance": engine.balance(),
    }


def work_words(provenance: Mapping[str, Any]) -> Iterator[str]:
    """Lines about a record's device, if it has one, and its `shared_work`, if it has several ranks.

    >>> stages = {"sweep": {"least": 1.0, "median": 1.5, "most": 2.0}}
    >>> shared = {"stages": stages, "imbalance": 1.25, "balance": {"cuts moved": 3}}
    >>> for line in work_words({"ranks": 4, "shared_work": shared}):
    ...     print(line)
    4 ranks: one had 1.25 times the work of the mean; cuts moved 3
    seconds of a rank (least, median, most): sweep 1, 1.5, 2
    >>> list(work_words({"ranks": 1, "device": "NVIDIA H200"}))
    ['on the device NVIDIA H200']
    """
    if (device := provenance.get("device", "cpu")) != "cpu":
        yield f"on the device {device}"
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


def pooled_words(record: Mapping[str, Any]) -> str:
    """The number of merged runs and their seeds, "" for the record of any other run.

    >>> pooled_words({"merged": [{"run": "a", "seed": 1}, {"run": "b", "seed": 4}]})
    'pooled from 2 runs, seeds 1 and 4'
    >>> pooled_words({"seed": 1})
    ''
    """
    seeds = [str(run["seed"]) for run in record.get("merged") or ()]
    if not seeds:
        return ""
    return f"pooled from {len(seeds)} runs, seeds {', '.join(seeds[:-1])} and {seeds[-1]}"


def merge_again(record: Mapping[str, Any], output: Path) -> str:
    """The command that merges the same runs into another folder."""
    runs = [str(run["run"]) for run in record["merged"]]
    return shlex.join(["mesokit", "merge", *runs, "--output", f"{output}-again"])
