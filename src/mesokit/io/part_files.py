"""Files from which parts were made, such as a force, kept in the folder of a run."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

from mesokit.case.component import FromContents
from mesokit.io.atomic import replacing
from mesokit.io.run_directory import RunDirectory


def kept_part(whole: Any, key: str, folder: Path) -> Any:
    """A case, or a component, whose part of that key holds the contents of its file, if it has one:
    they are written into the folder, under the last name of the key, now.

    So a run goes on with the same part, and can be moved, whatever becomes of the file. Raises
    RunError.
    """
    name, _, rest = key.partition(".")
    part: Any = getattr(whole, name)
    if rest:
        kept = kept_part(part, rest, folder) if part is not None else None
    elif isinstance(part, FromContents):
        file = RunDirectory(folder).part_file(f"{name}{Path(part.file).suffix}")
        with replacing(file) as temporary:
            temporary.write_bytes(part.contents)
        kept = dataclasses.replace(part, file=str(file))  # type: ignore[type-var]
    else:
        return whole
    return whole if kept is part else dataclasses.replace(whole, **{name: kept})
