"""Figures with the theory in them, and tables of measured against expected."""

from mesokit.report.figures import plot, save, save_all
from mesokit.report.finish.saving import save_figure
from mesokit.report.table import comparison_table, print_comparisons

__all__ = ["comparison_table", "plot", "print_comparisons", "save", "save_all", "save_figure"]
