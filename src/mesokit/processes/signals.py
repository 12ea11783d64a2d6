"""Signals that end a run at a checkpoint, and the exit status of each."""

import contextlib
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from types import FrameType

# Ctrl-C; the end of a job; a terminal that is closed; what queues send some time before the end
# (Slurm's --signal). Not every system has the last three.
NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGBREAK")
# Code that no exception may leave halfway. A module that llvmlite has handed on would be freed by
# both owners; threads of a kernel would wait for the one that has left.
WHOLE = ("llvmlite.", "mesokit.loops.threads.Threads._call_all")


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
    What `stop` raises comes after the present call of code that must not be left halfway.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def catch(number: int, frame: FrameType | None) -> None:
        _caught.append(number)
        try:
            stop(signal.Signals(number))
        except Stopped as error:
            if (caller := _caller_of_whole(frame)) is None:
                raise
            _raise_in(caller, error)

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


def _caller_of_whole(frame: FrameType | None) -> FrameType | None:
    """The frame that has called code that must not be left halfway, if there is one."""
    caller = None
    while frame is not None:
        name = f"{frame.f_globals.get('__name__')}.{frame.f_code.co_qualname}"
        frame = frame.f_back
        if name.startswith(WHOLE):
            caller = frame
    return caller


def _raise_in(frame: FrameType, error: BaseException) -> None:
    """Raise an error at the next line of a function that waits for a call, or as it returns.

    A trace does so, which displaces that of a debugger.
    """

    def trace(*event: object) -> None:
        sys.settrace(None)
        frame.f_trace = None
        raise error

    frame.f_trace = trace
    sys.settrace(lambda *event: None)
