"""Runs on the cores of this machine: in processes of their own, or in this one."""

import os
import queue
import signal
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from mesokit.devices.names import CPU
from mesokit.io.run_directory import RunDirectory
from mesokit.run.folder import note_failed
from mesokit.study.work import carry

LOST = "its process ended"  # killed, or out of memory


class Processes:
    """Several workers at once.

    Each is a program of its own and not a copy of this one, so scripts and notebooks need no guard.
    Ctrl-C goes to the study alone; `stop` sends signals to its workers.
    """

    def __init__(
        self, jobs: int, threads: int = 1, modules: Sequence[str] = (), device: str = CPU
    ) -> None:
        self.jobs, self.arguments = jobs, [str(threads), device, *modules]
        self.pool = ThreadPoolExecutor(jobs)
        self.idle: queue.SimpleQueue[subprocess.Popen[str]] = queue.SimpleQueue()
        self.busy: set[subprocess.Popen[str]] = set()
        self.stopping = False

    def submit(self, path: Path) -> Future[str]:
        return self.pool.submit(self._carry, path)

    def _carry(self, path: Path) -> str:
        if self.stopping:
            return "stopped before the start"
        worker = self._worker()
        self.busy.add(worker)
        if self.stopping:  # meanwhile: `stop` may have missed the new worker
            self.busy.discard(worker)
            self.idle.put(worker)
            return "stopped before the start"
        try:
            assert worker.stdin is not None and worker.stdout is not None
            worker.stdin.write(f"{path}\n")
            worker.stdin.flush()
            answer = worker.stdout.readline()
        except OSError:
            answer = ""
        finally:
            self.busy.discard(worker)
        if not answer.endswith("\n"):
            status = worker.wait()
            by = f" by {signal.Signals(-status).name}" if status < 0 else f" with {status}"
            why = f"{LOST}{by}; perhaps there was too little memory"
            note_failed(RunDirectory(path), why)  # the process could not
            return why
        self.idle.put(worker)
        return answer.rstrip("\n")

    def _worker(self) -> subprocess.Popen[str]:
        """An idle worker, or a new one."""
        while not self.idle.empty():
            worker = self.idle.get()
            if worker.poll() is None:
                return worker
        apart: Any = {"start_new_session": True}
        if sys.platform == "win32":
            apart = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
        return subprocess.Popen(
            [sys.executable, "-m", "mesokit.study.work", *self.arguments],
            env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            encoding="utf-8",
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            **apart,
        )

    @property
    def places(self) -> int:
        return self.jobs

    def stop(self) -> None:
        self.stopping = True
        for worker in list(self.busy):
            if sys.platform == "win32":
                worker.send_signal(signal.CTRL_BREAK_EVENT)
            else:
                worker.terminate()

    def close(self) -> None:
        self.pool.shutdown()
        while not self.idle.empty():
            worker = self.idle.get()
            assert worker.stdin is not None and worker.stdout is not None
            worker.stdin.close()
            worker.wait()
            worker.stdout.close()


class Here:
    """This process, one run after another, for parts that only a script defines.

    A signal ends the present run and the study.
    """

    places = 1

    def __init__(self, threads: int = 1, device: str = CPU) -> None:
        self.threads, self.device = threads, device

    def submit(self, path: Path) -> Future[str]:
        done: Future[str] = Future()
        done.set_result(carry(str(path), self.threads, device=self.device))
        return done

    def stop(self) -> None:
        """There is no run that could go on."""

    def close(self) -> None:
        """There is nothing to end."""
