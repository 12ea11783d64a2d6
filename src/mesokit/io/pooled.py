"""Texts about merged runs, from the record of their folder."""

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any


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
