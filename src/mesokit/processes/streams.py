"""Standard streams whose reader may leave, such as `| head`, without an end to the command."""

import io
import os
import sys
from typing import Any


class _Output(io.FileIO):
    """A file descriptor that leads nowhere once a write failed; errors of `lost` are not raised."""

    lost: type[OSError] = BrokenPipeError

    def write(self, data: Any) -> int:
        """Write bytes; their number."""
        try:
            return super().write(data) or 0
        except OSError as error:
            os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())
            if not isinstance(error, self.lost):
                raise
            return memoryview(data).nbytes


class _Messages(_Output):
    """Standard error: what fails there can be said nowhere."""

    lost = OSError


def outlive_readers() -> None:
    """Let commands go on and end with their own status when the reader of their output leaves."""
    for name, kind in (("stdout", _Output), ("stderr", _Messages)):
        stream = getattr(sys, name)
        buffer = getattr(stream, "buffer", None)
        own = stream is getattr(sys, f"__{name}__")  # not one that a caller has put there
        # not a terminal of Windows; PYTHONUNBUFFERED leaves the file without a buffer
        if own and isinstance(getattr(buffer, "raw", buffer), io.FileIO):
            stream.flush()
            output = io.TextIOWrapper(
                io.BufferedWriter(kind(stream.fileno(), "wb", closefd=False)),
                stream.encoding,
                stream.errors,
                line_buffering=stream.line_buffering or stream.write_through,
            )
            setattr(sys, name, output)
