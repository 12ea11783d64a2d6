"""Colours of the states of sites."""

from typing import Any


def colours(number: int) -> Any:
    """A map of so many colours, from light to dark: they differ in grey too."""
    from matplotlib import colormaps

    return colormaps["cividis_r"].resampled(number)
