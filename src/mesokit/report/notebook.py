"""Figures that a notebook shows. Import it where a figure is made: it loads Matplotlib."""

import io
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A figure made without pyplot, which a notebook shows as a picture.

    `origin` says where it comes from (`mesokit.report.finish.origin`), None if unknown.
    """

    origin: Any = None

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        FigureCanvasAgg(self)

    def _repr_png_(self) -> bytes:
        """The picture, for notebooks."""
        data = io.BytesIO()
        self.savefig(data, format="png", dpi=120)
        return data.getvalue()
