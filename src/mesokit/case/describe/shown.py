"""Small tables by which notebooks show objects."""

import importlib
from typing import Any

PAGES = "mesokit.report.document"  # loaded by name, as `case` does not import `report`


class Shown:
    """Something that a notebook shows as the table that `_card` describes."""

    def _card(self) -> dict[str, Any]:
        """The arguments of `mesokit.report.document.card`."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        html: str = importlib.import_module(PAGES).card(**self._card())
        return html
