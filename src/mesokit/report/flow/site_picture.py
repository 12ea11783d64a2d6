"""A picture of the sites of a lattice: a figure of its own, which may be drawn anew in a film."""

from typing import Any, ClassVar

from mesokit.case.trajectory import Group
from mesokit.report.flow.layout import width_of_page
from mesokit.report.flow.site_frames import SiteFrames
from mesokit.report.notebook import ShownFigure
from mesokit.report.style import STYLE, fonts


def look() -> Any:
    """Settings of Matplotlib: smaller letters in a narrow figure."""
    return STYLE | {"axes.titlesize": 10} | fonts(width_of_page())


class SitePicture:
    """A figure of frames of sites.

    OF: dimensions of the lattices that it shows. HEIGHTS: whether it shows heights (True), states
    (False) or both (None). MOVES: whether a film has a picture of each frame; else all frames are
    in one. TALL: height of the figure over its width.
    """

    OF: ClassVar[tuple[int, ...]]
    HEIGHTS: ClassVar[bool | None]

    MOVES: ClassVar[bool] = True
    TALL: ClassVar[float] = 0.75

    def __init__(self, frames: SiteFrames) -> None:
        self.frames, width = frames, width_of_page()
        self.figure: Any = ShownFigure(figsize=(width, self.TALL * width), layout="constrained")

    @classmethod
    def fits(cls, group: Group) -> bool:
        """True if it shows sites of a group."""
        assert group.lattice is not None
        known = cls.HEIGHTS is None or bool(group.states) != cls.HEIGHTS
        return group.lattice.dimension in cls.OF and known

    def still(self) -> None:
        """Draw the last frame, or what a picture shows of all."""
        self.show(len(self.frames) - 1)

    def show(self, index: int) -> None:
        """Draw one of the frames in place of the one before."""
