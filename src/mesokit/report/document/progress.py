"""Progress of a run as a bar in a notebook, and who tells it where nobody was named."""

from __future__ import annotations

import sys
from typing import Any

from mesokit.report.document.template import render
from mesokit.report.progress import Reporter


def reporter_for(progress: Reporter | bool | None) -> Reporter:
    """Who tells how a run goes.

    Parameters
    ----------
    progress: True for a bar in a notebook or a terminal and lines elsewhere, False for nothing,
        None for a bar in a notebook and nothing elsewhere, or a reporter of one's own.

    >>> reporter_for(None).quiet, reporter_for(True).quiet, reporter_for(False).quiet
    (True, False, True)
    """
    if isinstance(progress, Reporter):
        return progress
    if progress is not False and in_notebook():
        return NotebookReporter()
    return Reporter(quiet=not progress)


def in_notebook() -> bool:
    """Whether a notebook shows what is displayed: IPython runs, with a kernel."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return getattr(shell, "kernel", None) is not None


class NotebookReporter(Reporter):
    """Tell how a run goes by a bar below the cell of a notebook."""

    def has_bar(self) -> bool:
        """Wherever the stream leads."""
        return True

    def _open_bar(self) -> None:
        self.bar = NotebookBar()
        self.task = self.bar.add_task(self.phase, total=self.total, completed=self.first, words="")


class NotebookBar:
    """What a reporter asks of a bar, shown by the notebook that displays it."""

    def __init__(self) -> None:
        self.state: dict[str, Any] = {}
        self.shown: Any = None

    def add_task(self, description: str, **state: Any) -> int:
        """The one task of this bar: `total`, `completed` and `words`."""
        from IPython.display import display

        self.state = {"description": description} | state
        self.shown = display(self, display_id=True)
        return 0

    def update(self, task: int, **state: Any) -> None:
        """Change some of it."""
        self.state |= state
        self.shown.update(self)

    def stop(self) -> None:
        """It stays as it is."""

    @property
    def console(self) -> NotebookBar:
        """What prints lines that stay."""
        return self

    def print(self, line: str, **look: Any) -> None:
        """A line below the cell."""
        print(line)

    def _repr_html_(self) -> str:
        """What a notebook asks for."""
        return render("progress.html", percent=self._percent(), **self.state)

    def __repr__(self) -> str:
        return f"{self.state['description']}: {self._percent()} % {self.state['words']}"

    def _percent(self) -> int:
        return round(100 * self.state["completed"] / max(self.state["total"], 1))
