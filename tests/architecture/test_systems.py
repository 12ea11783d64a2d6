"""What not every system has is used in few files, which have something else for the others."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

CHILD = {"signal.SIGALRM", "signal.SIGKILL", "signal.alarm"}  # by which a process ends its child
# The files that may use some of it: what they use
HOMES = {
    "processes/cores.py": {"os.sched_getaffinity"},
    "case/warnings.py": {"os.sysconf", "resource"},
    "kernels/ahead.py": {"os.fork", "os.sched_getaffinity"} | CHILD,
    "kernels/made_of.py": {"ExternalFunction"},
    "kernels/store.py": {"/proc", "os.getuid"},
    "scalar/system.py": {"time.CLOCK_MONOTONIC", "ctypes", "ExternalFunction"},
    "devices/checked.py": {"ctypes"},
    "devices/emulated.py": {"ctypes"},
    "devices/host.py": {"ctypes"},
    "method/mpcd/engine/domains/messages/mpi.py": {"ctypes", "ExternalFunction"},
    "io/provenance.py": {"/proc"},
}
MODULES = {"fcntl", "resource", "pwd", "grp", "termios", "tty", "pty", "posix", "syslog", "ctypes"}
OF_OS = {
    "sched_getaffinity", "sched_setaffinity", "sched_yield", "fork", "forkpty", "killpg", "nice",
    "getuid", "geteuid", "getgid", "getegid", "getpgid", "getloadavg", "setsid", "uname", "mkfifo",
    "chown", "lchown", "fchmod", "fchown", "statvfs", "fstatvfs", "sync", "fdatasync", "sysconf",
    "symlink", "posix_fallocate", "sendfile", "pread", "pwrite", "O_DIRECTORY", "O_NOFOLLOW",
}  # fmt: skip
OF_SIGNAL = {
    "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGKILL", "SIGQUIT", "SIGPIPE", "SIGCHLD",
    "SIGCONT", "SIGSTOP", "SIGTSTP", "SIGXCPU", "alarm", "setitimer", "pause", "pthread_kill",
    "siginterrupt",
}  # fmt: skip
OF_TIME = {"clock_gettime", "clock_gettime_ns", "tzset", "CLOCK_MONOTONIC", "CLOCK_REALTIME"}
NAMES = {"os": OF_OS, "signal": OF_SIGNAL, "time": OF_TIME}


def special(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """What a source uses that not every system has."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from {alias.name for alias in node.names} & MODULES
        elif isinstance(node, ast.ImportFrom):
            yield from {node.module} & MODULES
            known = NAMES.get(node.module or "", set())
            yield from (f"{node.module}.{a.name}" for a in node.names if a.name in known)
        elif isinstance(node, ast.Attribute):
            if isinstance(node.value, ast.Name) and node.attr in NAMES.get(node.value.id, ()):
                yield f"{node.value.id}.{node.attr}"
            if node.attr in ("ExternalFunction", "add_symbol"):
                yield "ExternalFunction"
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from (start for start in ("/proc", "/dev/") if node.value.startswith(start))


def test_only_what_every_system_has(nodes: dict[str, list[ast.AST]]) -> None:
    found = {name: set(special(of_file)) for name, of_file in nodes.items()}
    assert {name: used for name, used in found.items() if used} == HOMES


def texts_without_encoding(nodes: Iterable[ast.AST]) -> Iterator[int]:
    """Lines that open a text in whatever the system thinks texts are written in."""
    for node in nodes:
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            given = {word.arg for word in node.keywords}
            modes = [a.value for a in node.args if isinstance(a, ast.Constant)]
            if name in ("read_text", "write_text") and isinstance(node.func, ast.Attribute):
                bad = "encoding" not in given and len(node.args) < (2 if name[0] == "w" else 1)
            else:  # files whose mode is a text; other things open without a mode
                text_modes = [m for m in modes if m in ("r", "w", "x", "a", "r+", "w+")]
                bad = name == "open" and bool(text_modes) and "encoding" not in given
            if bad:
                yield node.lineno


def test_texts_have_an_encoding(nodes: dict[str, list[ast.AST]]) -> None:
    found = {name: list(texts_without_encoding(of_file)) for name, of_file in nodes.items()}
    assert not {name: lines for name, lines in found.items() if lines}


def test_the_rules_see_what_they_should() -> None:
    used = parsed("import os, fcntl\nfrom signal import SIGHUP\nos.fork()\nopen('/proc/cpuinfo')")
    assert set(special(used)) == {"fcntl", "signal.SIGHUP", "os.fork", "/proc"}
    bad = parsed("path.read_text()\npath.open('w')\nopen(p, 'x')")
    assert list(texts_without_encoding(bad)) == [1, 2, 3]
    good = parsed("p.read_text('utf-8')\np.open('wb')\nmesokit.open(p)")
    assert not list(texts_without_encoding(good))


def parsed(text: str) -> list[ast.AST]:
    return list(ast.walk(ast.parse(text)))
