"""Files that a case names: found from its folder, and read once."""

import functools
import stat
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, ValidationInfo
from pydantic_core import PydanticCustomError

from mesokit.case.component import show
from mesokit.errors import CaseError


def _located(name: str, info: ValidationInfo) -> str:
    """The absolute path, from the folder of the case or else the working directory."""
    folder = (info.context or {}).get("folder") or Path.cwd()
    try:
        path = (folder / name).resolve()
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError, PermissionError):  # reported when it is read
        return str(path)
    except RuntimeError:  # of Python up to 3.12
        raise PydanticCustomError("file", "a loop of links; expected a file") from None
    except (OSError, ValueError) as error:
        reason = (getattr(error, "strerror", None) or str(error)).lower()
        raise PydanticCustomError("file", "{reason}; expected a file", {"reason": reason}) from None
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):  # reading a pipe would never end
        raise PydanticCustomError("file", "a pipe or device; expected a file")
    return str(path)


FileName = Annotated[str, AfterValidator(_located)]


class FromContents:
    """Base of components that are given by the contents of a `file`, a FileName.

    The file is read once: later changes of the file do not change the component.
    """

    file: str

    @functools.cached_property
    def contents(self) -> bytes:
        """The bytes of the file when they were first needed. Raises CaseError."""
        try:
            return Path(self.file).read_bytes()
        except FileNotFoundError:
            raise self.wrong("no such file") from None
        except OSError as error:
            raise self.wrong(f"cannot be read: {(error.strerror or str(error)).lower()}") from None

    def wrong(self, reason: str) -> CaseError:
        """The error that says what is wrong with the file."""
        return CaseError(f"file = {show(self.file, 500)}: {reason}")
