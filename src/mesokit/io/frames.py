"""Check that all frames of a run up to a step are there."""

from collections.abc import Mapping
from typing import Any

from mesokit.case.case import Case
from mesokit.case.trajectory import written
from mesokit.errors import RunError
from mesokit.io import h5md
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter

NONE_YET = -1  # the step of a run without samples of its first state


def seen_until(meta: Mapping[str, Any]) -> int:
    """The step up to which a run has taken samples, from the meta of its checkpoint."""
    return int(meta["step"]) if meta.get("looked") else NONE_YET


def require_frames(directory: RunDirectory, case: Case, step: int) -> None:
    """Raise RunError unless all frames up to a step are in segments or the data file.

    The error says what to do.
    """
    if case.trajectory is None:
        return
    place, warmup = directory.trajectory_folder, case.run.warmup
    particles = written(case.trajectory, case.groups)
    there = TrajectoryWriter(case.trajectory, place, *particles).steps()
    if not len(there) and directory.data_file.exists():
        place = directory.data_file
        try:
            there = h5md.frame_steps(place)
        except RunError:
            why = "damaged, and only it held the frames of the trajectory; put a copy in its place"
            raise RunError(f"{place}: {why}, or run anew: {directory.again}") from None
    last = min(step, warmup + case.run.steps)
    wanted = [warmup + passed for passed in case.trajectory.frames(last - warmup)]
    if lost := sorted(set(wanted) - set(there.tolist())):
        why = f"{len(lost)} of {len(wanted)} frames are missing, the first that of step {lost[0]}"
        raise RunError(f"{place}: {why}; put the files back, or run anew: {directory.again}")
