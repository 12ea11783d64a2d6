"""What a run or a study says when it is stopped, fails or has come to its end."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

import click

from mesokit.cli.words import reason, say
from mesokit.errors import RunError
from mesokit.io.shared_work import work_words
from mesokit.processes.signals import Stopped
from mesokit.processes.world import world


@contextlib.contextmanager
def stopping(again: str) -> Iterator[None]:
    """What was stopped can go on, by a command; a full disk is a failure of what runs."""
    try:
        yield
    except Stopped as stop:
        if not str(stop):  # stopped so hard that nothing is known
            raise
        here, text = world(), str(stop)
        command = here.again(again)
        here.leave(lambda rank: say(f"mesokit: {rank}{text}; go on with: {command}"), stop.status)
        raise SystemExit(stop.status) from None
    except OSError as error:
        raise RunError(reason(error)) from None


def show_results(output: Path) -> None:
    """What is compared in a run, and its pictures."""
    import mesokit

    done = mesokit.open(output)
    for line in work_words(done.provenance):
        click.echo(line)
    for result in done.results.values():
        for comparison in result.comparisons:
            click.echo(f"{result.name}: {comparison}")
    for picture in sorted(output.glob("*.png")):
        click.echo(f"picture: {picture}")
