"""Signals, and code that no exception may leave halfway."""

import signal
import sys

import llvmlite.binding as llvm
import pytest
from llvmlite.binding import ffi

from mesokit.loops.threads import Threads
from mesokit.processes.signals import Stopped, catching

FUNCTION = 'define i32 @"{}"() {{ ret i32 1 }}'


def stop(by):
    raise Stopped(by, "stopped")


def test_the_compiler_hands_a_module_on_before_a_signal_ends_it(monkeypatch):
    """Both owners would free it otherwise, and the process would end by a fault of memory."""
    link = ffi.lib.LLVMPY_LinkModules

    def link_and_stop(*arguments):
        failed = link(*arguments)
        signal.raise_signal(signal.SIGTERM)
        return failed

    monkeypatch.setitem(ffi.lib._fntab, "LLVMPY_LinkModules", link_and_stop)
    first, second = (llvm.parse_assembly(FUNCTION.format(name)) for name in ("one", "two"))
    went_on = False
    with catching(stop):
        with pytest.raises(Stopped, match="stopped"):
            first.link_in(second)
            went_on = True
        assert sys.gettrace() is None
    assert second.closed and not went_on
    assert {function.name for function in first.functions} == {"one", "two"}


def test_a_signal_ends_a_call_of_threads_when_all_are_done():
    """Else those that are not would spin at a barrier, and answer the next call."""
    threads, done = Threads(2), []

    def kernel(worker):
        if worker.thread == 0:
            while threads._done.empty():
                pass
            signal.raise_signal(signal.SIGTERM)
        done.append(worker.thread)

    with catching(stop), pytest.raises(Stopped):
        threads.run(kernel)
    assert sorted(done) == [0, 1]
    assert threads._done.empty()


def test_a_signal_elsewhere_is_raised_where_it_comes():
    reached = []
    with catching(stop), pytest.raises(Stopped):
        reached.append("before")
        signal.raise_signal(signal.SIGTERM)
        reached.append("after")
    assert reached == ["before"]
