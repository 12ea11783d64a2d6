"""Signals that end a run at a checkpoint, and the exit status of each."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator

# Ctrl-C; the end of a job; a terminal that is closed; what queues send some time before the end
# (Slurm's --signal). Not every system has the last three.
NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGBREAK")


class Stopped(KeyboardInterrupt):
    """A run was stopped by a signal, and can go on; `status` is what a process then ends with.

    >>> Stopped(signal.SIGTERM, "stopped at step 20 by SIGTERM").status
    143
    """

    def __init__(self, by: signal.Signals, text: str = "") -> None:
        super().__init__(*([text] if text else []))
        self.status = 128 + by


_caught: list[int] = []  # signals since `catching` began


def heard() -> bool:
    """True if a signal has requested the end of this thread, which can only be the main thread."""
    return bool(_caught) and threading.current_thread() is threading.main_thread()


@contextlib.contextmanager
def catching(stop: Callable[[signal.Signals], None]) -> Iterator[None]:
    """Call `stop` at a signal that ends the run; earlier handlers are set again afterwards.

    Only the main thread can do so. A closed terminal is no reason under `nohup`, which ignores it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def catch(number: int, frame: object) -> None:
        _caught.append(number)
        stop(signal.Signals(number))

    known = [getattr(signal, name) for name in NAMES if hasattr(signal, name)]
    _caught.clear()
    before = {
        number: signal.signal(number, catch)
        for number in known
        if not (number.name == "SIGHUP" and signal.getsignal(number) is signal.SIG_IGN)
    }
    try:
        yield
    finally:
        _caught.clear()
        for number, handler in before.items():
            signal.signal(number, handler)
