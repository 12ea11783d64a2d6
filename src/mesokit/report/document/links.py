"""Links from a page to what lies on the same disk."""

import os
from pathlib import Path
from urllib.parse import quote


def link_to(path: Path, page: Path) -> str:
    """A link from a page to a file or folder, relative so that both can be moved together.

    >>> link_to(Path("study/runs/a=1,b=2/seed 3"), Path("study/report.html"))
    'runs/a=1,b=2/seed%203'
    """
    try:
        relative = os.path.relpath(path, page.parent)
    except ValueError:  # another drive of Windows: no relative path leads there
        return path.resolve().as_uri()
    return quote(Path(relative).as_posix(), safe="/=,+")
