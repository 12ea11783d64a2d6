"""Progress of a run as a bar in a notebook, and the reporter that is used unless one is given."""

import sys
from typing import Any

from mesokit.report.document.template import render
from mesokit.report.progress import Reporter


def reporter_for(progress: Reporter | bool | None) -> Reporter:
    """The reporter of a run.

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
    """Progress of a run as a bar below the cell of a notebook."""

    shown: Any = None

    def has_bar(self) -> bool:
        """False: the bar is not in a stream."""
        return False

    def _open(self) -> None:
        from IPython.display import display

        super()._open()
        self.shown = display(self, display_id=True)

    def _show(self, words: str, line: str) -> None:
        assert self.task is not None
        self.task.fields["words"] = words
        self.shown.update(self)

    def _say(self, text: str) -> None:
        print(text)

    def _repr_html_(self) -> str:
        """The bar in HTML, for notebooks."""
        return render("progress.html", task=self.task)

    def __repr__(self) -> str:
        assert self.task is not None
        return f"{self.phase}: {self.task.percentage:.0f} % {self.task.fields['words']}"
