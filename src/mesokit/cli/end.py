"""End of every command: at most one line on standard error, and a status."""

import contextlib
import sys
import traceback
from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from mesokit.cli.commands import cli
from mesokit.cli.words import frames_of_parts, reason, say, warnings_said
from mesokit.errors import MesokitError, RunError
from mesokit.io.record_words import work_words
from mesokit.processes.signals import Stopped
from mesokit.processes.world import known, world


def status_of(arguments: Sequence[str] | None) -> int:
    """Run a command and print what went wrong; the exit status."""
    try:
        status = _carried_out(sys.argv[1:] if arguments is None else list(arguments))
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 0
    known().ended(status)
    return status


def _carried_out(arguments: list[str]) -> int:
    try:
        with warnings_said():
            status = cli.main(arguments, prog_name="mesokit", standalone_mode=False, obj=arguments)
        return status if isinstance(status, int) else 0
    except click.exceptions.Abort as abort:
        stop = abort.__cause__
        return _interrupted(stop if isinstance(stop, KeyboardInterrupt) else KeyboardInterrupt())
    except KeyboardInterrupt as stop:
        return _interrupted(stop)
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message())
        return 2
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "mesokit"
        return _failed(f"{error.format_message()} (try {command} --help)", 2)
    except click.ClickException as error:
        return _failed(error.format_message(), 2)
    except RunError as error:
        return _failed(str(error), 1)
    except MesokitError as error:
        return _failed(str(error), 2)
    except OSError as error:
        return _failed(reason(error), 2)
    except UnicodeEncodeError as error:
        near = error.object[max(error.start - 60, 0) : error.end]
        return _failed(f"...{near!r}: a name that is not {error.encoding} text", 2)
    except MemoryError:
        return _failed("not enough memory for this case (mesokit check says what it needs)", 1)
    except Exception as error:
        frames = frames_of_parts(error)
        if not frames:  # an error of mesokit itself: the whole traceback is shown
            raise
        last = frames[-1]
        why = f"{type(error).__name__}: {error}"
        status = _failed(f"line {last.lineno} of {last.filename}: {why}", 1)
        say("".join(traceback.format_list(frames)).rstrip())
        return status


def _failed(message: str, status: int) -> int:
    text = " ".join(message.split())
    world().leave(lambda rank: say(f"mesokit: error: {rank}{text}"), status)
    return status


def _interrupted(stop: KeyboardInterrupt) -> int:
    status: int = getattr(stop, "status", 130)
    world().leave(lambda rank: say(f"mesokit: {rank}interrupted"), status)
    return status


@contextlib.contextmanager
def stopping(again: str) -> Iterator[None]:
    """Print the command by which stopped work goes on; a full disk is an error of the run."""
    try:
        yield
    except Stopped as stop:
        if not str(stop):  # stopped at once by a second signal
            raise
        here, text = world(), str(stop)
        command = here.again(again)
        here.leave(lambda rank: say(f"mesokit: {rank}{text}; go on with: {command}"), stop.status)
        raise SystemExit(stop.status) from None
    except OSError as error:
        raise RunError(reason(error)) from None


def show_results(output: Path) -> None:
    """Print the comparisons of a run, and the names of its pictures."""
    import mesokit

    done = mesokit.open(output)
    for line in work_words(done.provenance):
        click.echo(line)
    for result in done.results.values():
        for comparison in result.comparisons:
            click.echo(f"{result.name}: {comparison}")
    for picture in sorted(output.glob("*.png")):
        click.echo(f"picture: {picture}")
