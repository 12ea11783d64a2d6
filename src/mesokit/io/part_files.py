"""Files from which parts were made, such as a force, kept in the folder of a run."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from mesokit.io.atomic import replacing
from mesokit.io.run_directory import RunDirectory


def kept_part(part: Any, name: str, folder: Path) -> Any:
    """A part with the contents of its file, which are written into the folder under this name now.

    So a run goes on with the same part, and can be moved, whatever becomes of the file. Raises
    RunError.
    """
    file = RunDirectory(folder).part_file(f"{name}{Path(part.file).suffix}")
    with replacing(file) as temporary:
        temporary.write_bytes(part.contents)
    return dataclasses.replace(part, file=str(file))
