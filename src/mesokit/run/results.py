"""What a run writes as it ends: results, figures, its record."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mesokit.errors import MesokitError
from mesokit.io import h5md
from mesokit.io.run_directory import RunDirectory, now
from mesokit.seam.method import summary_of

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.io.trajectory import TrajectoryWriter
    from mesokit.seam.result import Result


def write_results(
    directory: RunDirectory,
    case: Case,
    results: Mapping[str, Result],
    spent: Mapping[str, Any],
    writer: TrajectoryWriter | None,
) -> None:
    """Write all that a run says at its end; `spent` says where the time went. Raises RunError."""
    kept = directory.read_provenance() | {"ended": now(), **spent}
    with contextlib.suppress(MesokitError):  # a file that the start was made from may be gone
        kept["warnings"] = list(summary_of(case).warnings)
    h5md.write(directory.data_file, case, kept, results.values(), writer)
    directory.write_provenance(kept)
    from mesokit.report import save_all

    save_all(results.values(), directory.path, case)
    if writer is not None:
        writer.remove()
