"""Pages in HTML: the report of a run, the cards and the bar that notebooks show.

Markup is in the templates beside the code: `base.html` of all pages, `page.html` of reports,
`parts.html` their tables.
"""

from mesokit.report.document.card import card
from mesokit.report.document.run import write_report

__all__ = ["card", "write_report"]
