"""What is asked of a case before several ranks run it, and how they have shared the work."""

from __future__ import annotations

from collections.abc import Sequence
from statistics import median
from typing import TYPE_CHECKING, Any

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.seam.method import method_of

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.processes.world import World

WAITING = "wait"  # the stage of a step in which a rank does nothing


def require_ranks(case: Case, ranks: int) -> None:
    """Raise CaseError for a case that so many ranks cannot run."""
    if ranks == 1:
        return
    if case.run.replicas > 1:
        raise CaseError(f"run.replicas = {case.run.replicas}: not on {ranks} ranks; expected 1")
    check = method_of(case).check_ranks
    if check is None:
        raise CaseError(f"run.method = {show(case.run.method)}: not on {ranks} ranks; expected one")
    check(case, ranks)


def shared_work(here: World, engine: Any) -> dict[str, Any]:
    """How long each stage took, least, median and most over ranks, and how even the work was.

    `imbalance` is the most work of a rank, which is all but waiting, over the mean. Nothing where
    there is one rank.
    """
    if here.size == 1:
        return {}
    every = here.gathered(engine.seconds)
    work = [sum(s for stage, s in one.items() if stage != WAITING) for one in every]
    mean = sum(work) / len(work)
    return {
        "stages": {stage: _spread([one[stage] for one in every]) for stage in every[0]},
        "imbalance": max(work) / mean if mean else 1.0,
        "balance": engine.balance(),
    }


def _spread(seconds: Sequence[float]) -> dict[str, float]:
    return {"least": min(seconds), "median": median(seconds), "most": max(seconds)}
