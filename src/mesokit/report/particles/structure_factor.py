"""S(q): of what is far above 1 at long waves on logarithmic axes, else on plain ones."""

from typing import Any

import numpy as np

from mesokit.report import curve
from mesokit.report.style import sparse_logarithm
from mesokit.seam.result import Result

SPAN = 5.0  # largest over smallest value from which axes are logarithmic


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Data with error bars, and theory where there is one."""
    ax = figure.subplots() if ax is None else ax
    curve.draw(result, figure, ax)
    value = result.value[np.isfinite(result.value)]
    if len(value) and value.min() > 0 and value.max() > SPAN * value.min():
        ax.set_xscale("log")
        ax.set_yscale("log")
        sparse_logarithm(ax.xaxis, *ax.get_xlim())
        sparse_logarithm(ax.yaxis, *ax.get_ylim())
    else:
        ax.set_ylim(bottom=0)
