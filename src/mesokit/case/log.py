"""Which numbers a run tells in time."""

from mesokit.case.component import component, param


@component
class Log:
    """Numbers in time: a line on the screen and in the file `log.csv` of the run's folder.

    Beside what the method knows, such as `temperature` and `velocity x`, a column may be what an
    observable has found so far, as `velocity-profile.viscosity`; its error is a column of its own.
    """

    every: int = param(doc="steps between two lines, from step 0 of the warm-up on", ge=1)
    columns: tuple[str, ...] = param(
        (), doc="what is written with step and time (the usual columns of the method unless said)"
    )
