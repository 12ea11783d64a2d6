"""A notebook, as far as a bar of progress sees it."""

from __future__ import annotations

import sys
import types

from tests.helpers.html_page import Page


class Display:
    """What a notebook shows, as IPython's display does."""

    def __init__(self):
        self.pages = []

    def __call__(self, shown, display_id):
        assert display_id
        self.update(shown)
        return self

    def update(self, shown):
        self.pages.append(Page(shown._repr_html_()))


def in_a_notebook(monkeypatch) -> Display:
    """From now on, until the end of the test."""
    display, shell = Display(), types.SimpleNamespace(kernel=object())
    ipython = types.ModuleType("IPython")
    ipython.get_ipython = lambda: shell
    shown = types.ModuleType("IPython.display")
    shown.display = display
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", shown)
    return display
