"""What only Linux or only POSIX has is taken away: runs start, stop, go on and end without it."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

import mesokit
from mesokit.io import atomic
from mesokit.method.mpcd.derived import summary
from mesokit.processes.cores import usable_cores

ON_POSIX = pytest.mark.skipif(sys.platform == "win32", reason="what it stands for is real there")
SOURCE = str(Path(mesokit.__file__).parent.parent)

# What Windows has not, or does otherwise: a folder cannot be opened, a file that was opened for
# reading cannot be brought to the disk.
WITHOUT_POSIX = """
import os, shutil, signal, subprocess, sys, time
import h5py, numba, numpy, pydantic, rich
for name in ("sched_getaffinity", "sched_setaffinity", "getuid", "geteuid", "process_cpu_count"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("SIGHUP", "SIGUSR1", "SIGUSR2", "SIGKILL", "SIGALRM", "setitimer"):
    if hasattr(signal, name):
        delattr(signal, name)
for name in ("fcntl", "resource", "pwd", "grp"):
    sys.modules[name] = None
real_open, real_fsync = os.open, os.fsync
def open_file(path, flags, *mode, **more):
    if os.path.isdir(path):
        raise PermissionError(13, "Permission denied")
    return real_open(path, flags, *mode, **more)
def fsync(handle):
    os.write(handle, b"")  # EBADF, if it may only be read
    real_fsync(handle)
os.open, os.fsync, shutil._use_fd_functions = open_file, fsync, False
"""

RUN = """
from mesokit import Box, Case, Conservation, Fluid, Run, Simulation, Trajectory
from mesokit.report.progress import Reporter

case = Case(
    run=Run(steps=60, seed=2), box=Box([8, 8]), fluid=Fluid(),
    observe=[Conservation(every=10)], trajectory=Trajectory(every=10),
)

class Press(Reporter):
    def update(self, step):
        if step > 20:
            signal.raise_signal(signal.SIGTERM)

assert Simulation(case).threads == os.cpu_count()
try:
    Simulation(case, output="run", threads=2).run(progress=Press(quiet=True))
except KeyboardInterrupt as stop:
    assert stop.status == 143
again = Simulation.resume("run", threads=1)
assert 20 < again.step < 60
again.run()
whole = Simulation(case, threads=1)
whole.run()
assert (again.engine.positions() == whole.engine.positions()).all()
assert again.results == whole.results
print(*sorted(os.listdir("run")))
"""


def ends(program: str, folder: Path) -> str:
    """What a Python process prints that ends well."""
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, env=os.environ | {"PYTHONPATH": SOURCE},
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_run_without_what_only_posix_has(tmp_path: Path) -> None:
    files = "case.toml checkpoint.npz conservation.png provenance.json run.h5\n"
    assert ends(WITHOUT_POSIX + RUN, tmp_path) == files


# The functions of Windows' kernel32 that threads and clocks need, in Python: each notes its call.
WINDOWS = """
import ctypes, sys, threading, time
import numba, numpy as np
from llvmlite import binding

calls = {"yield": 0, "clock": 0}
@ctypes.CFUNCTYPE(ctypes.c_int)
def switch():
    calls["yield"] += 1
    time.sleep(0)
    return 1
@ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_int64))
def counter(answer):
    calls["clock"] += 1
    answer[0] = 10_000_000 * calls["clock"]  # a second later at each call
    return 1
@ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_int64))
def frequency(answer):
    answer[0] = 10_000_000
    return 1
class Kernel32:
    SwitchToThread, QueryPerformanceCounter = switch, counter
    QueryPerformanceFrequency = staticmethod(lambda where: frequency(where))
ctypes.WinDLL, ctypes.CDLL, sys.platform = {"kernel32": Kernel32}.get, None, "win32"
del time.CLOCK_MONOTONIC

from mesokit.loops.clock import CELLS, FIRST, START, lap
from mesokit.scalar.system import TICK
from mesokit.loops.threads import Threads, barrier

@numba.njit(nogil=True)
def work(worker, most, sums):
    lap(worker, START)
    for turn in range(100):
        if worker.thread == turn % worker.threads:  # the others wait for it
            for k in range(most):
                sums[0] += sums[0] % 7 + 1
        barrier(worker)
    lap(worker, CELLS)

threads, sums = Threads(2), np.zeros(1, np.int64)
threads.run(work, 0, sums)
before = threads.clock[FIRST + CELLS]
threads.run(work, 100_000, sums)
told = TICK * (threads.clock[FIRST + CELLS] - before)
assert sums[0] >= 10_000_000, sums
assert calls["clock"] == 4 and calls["yield"] > 0, calls
assert told == 1.0, told
"""


@ON_POSIX
def test_compiled_code_calls_what_windows_has(tmp_path: Path) -> None:
    ends(WINDOWS, tmp_path)


def test_cores_are_those_that_may_be_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(os, "process_cpu_count", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: {0, 3, 5}, raising=False)
    assert usable_cores() == 3
    case = mesokit.Case(run=mesokit.Run(steps=5), box=mesokit.Box([8, 8]), fluid=mesokit.Fluid())
    assert mesokit.Simulation(case).threads == 3
    told = dict(row[:1] + row[2:] for row in summary(case).rows)
    assert "3 threads" in told["run time"]
    monkeypatch.delattr(os, "sched_getaffinity")
    assert usable_cores() == 64
    monkeypatch.setattr(os, "cpu_count", lambda: None)  # where it is not known
    assert usable_cores() == 1
    monkeypatch.setattr(os, "process_cpu_count", lambda: 7, raising=False)
    assert usable_cores() == 7


@ON_POSIX
def test_a_folder_that_cannot_be_brought_to_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on some disks in a network; a full disk there is told as ever."""
    real, number = os.fsync, errno.EINVAL

    def fsync(handle: int) -> None:
        if stat.S_ISDIR(os.fstat(handle).st_mode):
            raise OSError(number, "refused")
        real(handle)

    monkeypatch.setattr(atomic.os, "fsync", fsync)
    atomic.write_text(tmp_path / "a.txt", "whole")
    assert (tmp_path / "a.txt").read_text() == "whole"
    number = errno.EIO
    with pytest.raises(mesokit.RunError, match=r"cannot write .*a\.txt: refused"):
        atomic.write_text(tmp_path / "a.txt", "other")


def test_a_file_that_is_read_just_now(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows refuses to replace it: that is tried again, and told in the end."""
    real, refusals, pauses = os.replace, [True, True], []

    def replace(old: Path, new: Path) -> None:
        if refusals and refusals.pop():
            raise PermissionError(errno.EACCES, "The process cannot access the file")
        real(old, new)

    monkeypatch.setattr(atomic.os, "replace", replace)
    monkeypatch.setattr(atomic.time, "sleep", pauses.append)
    monkeypatch.setattr(sys, "platform", "win32")
    atomic.write_text(tmp_path / "a.txt", "whole")
    assert (tmp_path / "a.txt").read_text() == "whole" and len(pauses) == 2
    refusals += [True] * 99
    with pytest.raises(mesokit.RunError, match="the process cannot access the file"):
        atomic.write_text(tmp_path / "a.txt", "other")
    assert (tmp_path / "a.txt").read_text() == "whole"
