"""Where a figure comes from, written into its file: below it, and in its metadata."""

from typing import NamedTuple

from mesokit import __version__
from mesokit.case.case import Case
from mesokit.io.checkpoint import digest


class Origin(NamedTuple):
    """The title and digest of a case, its seed, and the name of the folder of the run, if any.

    Figures of theory alone, and of studies, have a title only.
    """

    title: str
    run: str = ""
    seed: int | None = None
    digest: str = ""

    def line(self) -> str:
        """The line below a figure.

        >>> Origin("Channel", "run-3", 7, "0a" * 32).line().startswith("Channel, run run-3, seed 7")
        True
        """
        seed = "" if self.seed is None else f"seed {self.seed}"
        words = [self.title, f"run {self.run}" * bool(self.run), seed]
        return ", ".join([*filter(None, words), f"mesokit {__version__}"])

    def metadata(self, kind: str) -> dict[str, str]:
        """Entries of a PNG, PDF, SVG, MP4 or GIF file, none for other kinds."""
        program, title = f"mesokit {__version__}", self.title or self.run
        about = self.line() + f"; case sha256 {self.digest}" * bool(self.digest)
        known = {
            "png": {"Title": title, "Software": program, "Description": about},
            "pdf": {"Title": title, "Creator": program, "Subject": about},
            "svg": {"Title": title, "Creator": program, "Description": about},
            "mp4": {"title": title, "comment": about},
            "gif": {"comment": about},
        }
        return {key: text for key, text in known.get(kind, {}).items() if text}


def as_text(name: str) -> str:
    """A text that any file can hold: bytes of names of files that are no text are question marks.

    >>> as_text("run" + chr(0xdcff))
    'run?'
    """
    return name.encode("utf-8", "replace").decode("utf-8")


def origin_of(case: Case, run: str = "") -> Origin:
    """Where figures of a case come from, and of which run."""
    return Origin(case.title, as_text(run), case.run.seed, digest(case.to_toml()))
