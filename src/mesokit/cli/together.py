"""Commands on several ranks, and how ranks are started on this machine."""

import contextlib
import functools
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click

from mesokit.errors import CaseError, RunError
from mesokit.processes import parent
from mesokit.processes.world import is_first, may_be_several, stay_alone, world

TOGETHER = ("run", "resume", "warm")  # all others are commands of one process
ALONE = ("study",)  # commands that start runs of their own
MOST_OF_CORE = 16  # ranks: more would keep the machine busy with starting them
RANKS = click.option(
    "--ranks",
    type=click.IntRange(1),
    help="Share the work among so many ranks of MPI on this machine (elsewhere: mpiexec -n N).",
)
Command = Callable[..., Any]


def take_part(command: str | None) -> None:
    """Let all ranks of a launcher carry out commands that share work, and rank 0 all others."""
    if not may_be_several():
        return
    if command in TOGETHER:
        here = world()
        if here.root:
            parent.take_terminal()
        else:
            sys.stdout = sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
        return
    if not is_first():
        raise SystemExit(0)
    stay_alone()
    if command in ALONE:
        raise CaseError(f"{command}: starts runs of its own; expected one process, no mpiexec")


def on_ranks(folder: Callable[[dict[str, Any]], Path]) -> Callable[[Command], Command]:
    """Give a command `--ranks N`: ranks of this machine then carry it out.

    `folder` gives the folder of the run from the options.
    """

    def decorated(command: Command) -> Command:
        @RANKS
        @functools.wraps(command)
        def carried(ranks: int | None, **given: Any) -> Any:
            if ranks is None or ranks == 1:
                return command(**given)
            arguments = click.get_current_context().obj
            raise SystemExit(_carried_by(ranks, arguments, folder(given)))

        return carried

    return decorated


def _carried_by(ranks: int, arguments: Sequence[str], output: Path) -> int:
    """Carry out a command on so many ranks of this machine; the status that they end with."""
    from mesokit.cli.words import say
    from mesokit.processes.cores import usable_cores
    from mesokit.processes.mpiexec import find, start

    if may_be_several():
        raise CaseError("--ranks: this is one of the ranks of an mpiexec; leave it out")
    find()
    cores = usable_cores()
    have = f"{cores} core{'s' * (cores > 1)}"
    if ranks > MOST_OF_CORE * cores:
        most = f"expected at most {MOST_OF_CORE * cores}: {MOST_OF_CORE} for each core"
        raise CaseError(f"--ranks = {ranks}: this machine has {have}; {most}")
    if ranks > cores and "--quiet" not in arguments:
        say(f"warning: {ranks} ranks share {have}: they are slower than {cores} would be")
    end = start(ranks, without(arguments, "--ranks"))
    if end.why:
        say(f"mesokit: {end.why}{_go_on(output, ranks)}")
    return end.status


def without(arguments: Sequence[str], option: str) -> list[str]:
    """Arguments without an option and its value.

    >>> without(["run", "a.toml", "--ranks", "4", "--quiet"], "--ranks")
    ['run', 'a.toml', '--quiet']
    >>> without(["run", "--ranks=4", "a.toml"], "--ranks")
    ['run', 'a.toml']
    """
    left, found = iter(arguments), []
    for word in left:
        if word == option:
            next(left, None)
        elif not word.startswith(f"{option}="):
            found.append(word)
    return found


def _go_on(output: Path, ranks: int) -> str:
    """The last checkpoint of a run, and the command that goes on; "" if it had not begun."""
    from mesokit.io.checkpoint import read_meta
    from mesokit.io.run_directory import RunDirectory

    run = RunDirectory(output)
    if not run.case_file.exists():
        return ""
    last = "there is no checkpoint yet"
    with contextlib.suppress(RunError):
        last = f"the last checkpoint is of step {read_meta(run.checkpoint_file)['step']}"
    return f"; {last}: mesokit resume {output} --ranks {ranks}"
