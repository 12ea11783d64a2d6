"""Reference of the commands, from click."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import click
from mkdocs.structure.files import File, Files

from mesokit.cli.commands import cli

HEAD = """# Commands

`mesokit COMMAND --help` shows the same. Exit status: 0 done, 1 the run failed, 2 the case or the
command is wrong, 128 + the number of the signal that ended it.
"""


def on_files(files: Files, config: Any) -> Files:
    """Add the page."""
    root = click.Context(cli, info_name="mesokit")
    text = "\n".join([HEAD, *_commands(root)])
    files.append(File.generated(config, "reference/commands.md", content=text))
    return files


def _commands(context: click.Context) -> Iterator[str]:
    group = context.command
    assert isinstance(group, click.Group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        inner = click.Context(command, info_name=name, parent=context)
        usage = " ".join(command.collect_usage_pieces(inner))
        yield f"## {name}\n\n```\n{inner.command_path} {usage}\n```\n"
        yield f"{_plain(command.help or '')}\n"
        rows = [r for p in command.get_params(inner) if (r := p.get_help_record(inner))]
        if rows:
            yield "| option | |\n|---|---|"
            yield from (f"| `{o.replace('|', chr(92) + '|')}` | {_plain(w)} |" for o, w in rows)
            yield ""


def _plain(text: str) -> str:
    """Words of click as Markdown: what begins with # is no heading."""
    lines = [line.strip() for line in text.replace("\b", "").splitlines()]
    return "\n".join(f"`{line}`" if line.startswith("#") else line for line in lines)
