"""Pictures and films of the flow: one file for each kind, and for each place numbers come from."""

from mesokit.report.flow.film import Film, animate
from mesokit.report.flow.kinds import KINDS, NAMES, usual
from mesokit.report.flow.layout import page_width
from mesokit.report.flow.region import CHOICES
from mesokit.report.flow.state import State
from mesokit.report.flow.still import picture

__all__ = [
    "CHOICES",
    "KINDS",
    "NAMES",
    "Film",
    "State",
    "animate",
    "page_width",
    "picture",
    "usual",
]
