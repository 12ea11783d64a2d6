"""The store of compiled code on disk: one SQLite file for all processes of a user.

An entry is found by a key, and says what else must hold for it to be used (see `made_of`). Code
lies beside the entries, by its own hash: bitcode of parts, which does not depend on the processor,
and object code of kernels. What is loaded is run: so the folder must be the user's own and closed
to others, and each row must have the right digest. A store that is missing, damaged, full, locked
or read-only costs time, never a run.

Packages may bring a second file, which is only read.
"""

import contextlib
import hashlib
import itertools
import os
import sqlite3
import stat
import sys
import tempfile
import time
import zlib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from numba import config

FORMAT = 1  # of the tables
BOUND = 500_000_000  # bytes; what has not been used for longest goes first
PATIENCE = 5.0  # seconds that a process waits for one that writes
MOST_ENTRIES = 4  # of one key: states of what it needs, such as two versions of the sources
NETWORK = {
    "nfs", "nfs4", "cifs", "smb3", "smbfs", "9p", "afs", "fuse.sshfs", "lustre", "gpfs", "beegfs",
    "ceph", "glusterfs", "fuse.glusterfs",
}  # fmt: skip
TABLES = """
CREATE TABLE IF NOT EXISTS needs (id INTEGER PRIMARY KEY AUTOINCREMENT, line TEXT UNIQUE);
CREATE TABLE IF NOT EXISTS entries (id INTEGER PRIMARY KEY, key TEXT, name TEXT, needs BLOB,
    about BLOB, code TEXT, digest BLOB, used INTEGER);
CREATE INDEX IF NOT EXISTS keys ON entries (key);
CREATE TABLE IF NOT EXISTS code (hash TEXT PRIMARY KEY, name TEXT, called TEXT, body BLOB,
    used INTEGER);
"""


class Entry(NamedTuple):
    """Record of one compiled function."""

    name: str
    needs: frozenset[str]
    about: bytes  # its description for numba
    code: str  # hash of its code


class Code(NamedTuple):
    """Code of one function, and hashes of what it calls."""

    name: str
    called: tuple[str, ...]
    body: bytes

    @property
    def hash(self) -> str:
        """The name of this code."""
        text = "\0".join((self.name, *self.called)).encode()
        return hashlib.sha256(text + b"\0" + self.body).hexdigest()[:32]


def folder() -> Path:
    """The user's folder of compiled code, in NUMBA_CACHE_DIR or the user's cache."""
    named = config.CACHE_DIR or os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    place = Path(named).absolute() / "mesokit"
    if not _is_ours(place) and hasattr(os, "getuid"):  # several users share NUMBA_CACHE_DIR
        return place.with_name(f"mesokit-{os.getuid()}")
    return place


def _is_ours(place: Path) -> bool:
    """Whether a folder is not there yet, or is the user's own."""
    try:
        return not hasattr(os, "getuid") or place.stat().st_uid == os.getuid()
    except OSError:
        return True


def _private(place: Path) -> Path:
    """The folder, which only its user may open. Raises OSError."""
    place.mkdir(mode=0o700, parents=True, exist_ok=True)
    if hasattr(os, "getuid"):
        about = place.stat()
        if {about.st_uid, place.lstat().st_uid} != {os.getuid()}:  # the folder, and a link to it
            raise PermissionError(f"{place} belongs to another user")
        if stat.S_IMODE(about.st_mode) != 0o700:
            place.chmod(0o700)
        for file in place.glob("compiled-*"):
            if about.st_mode & 0o022 or file.lstat().st_uid != os.getuid():
                file.unlink()  # others could have written it
    return place


def on_network(place: Path, mounts: Path = Path("/proc/mounts")) -> bool:
    """Whether a folder is on a file system of the network, whose locks are not to be relied on."""
    try:
        text = mounts.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return False
    rows = map(str.split, text.splitlines())
    within = [row for row in rows if Path(os.path.abspath(place)).is_relative_to(row[1])]
    return bool(within) and max(within, key=lambda row: len(row[1]))[2] in NETWORK


class Store:
    """A file of compiled code.

    Parameters
    ----------
    file : Path
        Where it lies; made if it is not there.
    writes : bool
        Whether entries may be added.
    level : int
        How much code is compressed, 0 to 9.
    """

    def __init__(self, file: Path, writes: bool = True, level: int = 6) -> None:
        self.file, self.writes, self.level = file, writes, level
        self._lines: dict[int, str] = {}
        self._used: dict[str, set[Any]] = {"entries": set(), "code": set()}
        try:
            if writes:
                self._disk = sqlite3.connect(self.file, PATIENCE, check_same_thread=False)
                self._disk.isolation_level = None
                self._disk.execute("PRAGMA journal_mode = WAL")
                self._disk.execute("PRAGMA synchronous = NORMAL")
                self._disk.executescript(TABLES)
        except sqlite3.OperationalError as error:  # read-only or full: what is there can be read
            self.writes = False
            if "locked" in str(error):
                raise
        if not self.writes:  # SQLite has no place for its locks there, nor need of any
            uri = f"{self.file.as_uri()}?mode=ro&immutable=1"
            self._disk = sqlite3.connect(uri, uri=True, check_same_thread=False)

    def find(self, key: str) -> Iterator[Entry]:
        """Entries of a key, the newest first. Raises sqlite3.Error."""
        rows = self._disk.execute(
            "SELECT id, name, needs, about, code, digest FROM entries WHERE key = ?"
            " ORDER BY id DESC",
            (key,),
        ).fetchall()
        for number, name, needs, about, code, digest in rows:
            if hashlib.sha256(f"{key} {name} {code}".encode() + needs + about).digest() != digest:
                raise sqlite3.DatabaseError("an entry is damaged")
            self._used["entries"].add(number)
            yield Entry(name, self._read_needs(needs), about, code)

    def _read_needs(self, numbers: bytes) -> frozenset[str]:
        wanted = memoryview(numbers).cast("I")
        unknown = [number for number in wanted if number not in self._lines]
        for start in range(0, len(unknown), 500):
            some = unknown[start : start + 500]
            rows = f"SELECT id, line FROM needs WHERE id IN ({','.join('?' * len(some))})"
            self._lines.update(self._disk.execute(rows, some).fetchall())
        return frozenset(self._lines.get(number, "function lost:lost lost") for number in wanted)

    def code(self, hash: str) -> Code | None:
        """The code of this hash; None if it is not here. Raises sqlite3.Error."""
        question = "SELECT name, called, body FROM code WHERE hash = ?"
        row = self._disk.execute(question, (hash,)).fetchone()
        if row is None:
            return None
        try:
            found = Code(row[0], tuple(row[1].split()), zlib.decompress(row[2]))
        except zlib.error:
            raise sqlite3.DatabaseError("code is damaged") from None
        if found.hash != hash:
            raise sqlite3.DatabaseError("code is damaged")
        self._used["code"].add(hash)
        return found

    def has_code(self, hash: str) -> bool:
        """Whether code of this hash is here. Raises sqlite3.Error."""
        found = self._disk.execute("SELECT 1 FROM code WHERE hash = ?", (hash,))
        return found.fetchone() is not None

    def has_name(self, name: str) -> bool:
        """Whether there is any entry of this name. Raises sqlite3.Error."""
        found = self._disk.execute("SELECT 1 FROM entries WHERE name = ? LIMIT 1", (name,))
        return found.fetchone() is not None

    def parts(self) -> Iterator[tuple[str, Entry]]:
        """Keys and entries of all parts, by name. Raises sqlite3.Error."""
        keys = self._disk.execute(
            "SELECT key FROM entries WHERE name NOT LIKE 'kernel %' AND name NOT LIKE 'kind %'"
            " GROUP BY key ORDER BY name, key"
        ).fetchall()
        for (key,) in keys:
            yield from ((key, entry) for entry in self.find(key))

    def keep(self, key: str, entry: Entry, codes: Sequence[Code]) -> None:
        """Add an entry and the code that it needs, or nothing. Raises sqlite3.Error."""
        now = _hour()
        with self._written():
            for code in codes:
                body = zlib.compress(code.body, self.level)
                self._disk.execute(
                    "INSERT OR REPLACE INTO code VALUES (?, ?, ?, ?, ?)",
                    (code.hash, code.name, " ".join(code.called), body, now),
                )
            needs = self._write_needs(entry.needs)
            text = f"{key} {entry.name} {entry.code}".encode()
            digest = hashlib.sha256(text + needs + entry.about).digest()
            row = key, entry.name, needs, entry.about, entry.code, digest, now
            self._disk.execute("DELETE FROM entries WHERE key = ? AND needs = ?", (key, needs))
            columns = "key, name, needs, about, code, digest, used"
            self._disk.execute(f"INSERT INTO entries ({columns}) VALUES (?, ?, ?, ?, ?, ?, ?)", row)
            self._disk.execute(
                "DELETE FROM entries WHERE key = ? AND id NOT IN"
                " (SELECT id FROM entries WHERE key = ? ORDER BY id DESC LIMIT ?)",
                (key, key, MOST_ENTRIES),
            )

    def _write_needs(self, needs: frozenset[str]) -> bytes:
        lines = [(line,) for line in sorted(needs)]
        self._disk.executemany("INSERT OR IGNORE INTO needs (line) VALUES (?)", lines)
        numbers = [
            self._disk.execute("SELECT id FROM needs WHERE line = ?", line).fetchone()[0]
            for line in lines
        ]
        return b"".join(number.to_bytes(4, sys.byteorder) for number in sorted(numbers))

    @contextlib.contextmanager
    def _written(self) -> Iterator[None]:
        """A change that other processes see as a whole, or not at all."""
        self._disk.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            with contextlib.suppress(sqlite3.Error):
                self._disk.execute("ROLLBACK")
            raise
        self._disk.execute("COMMIT")

    def note_used(self) -> None:
        """Write down what was used since this was opened, by the hour, and keep to the bound.

        Raises sqlite3.Error.
        """
        if not self.writes:
            return
        now = _hour()
        with self._written():
            for table, name in (("entries", "id"), ("code", "hash")):
                rows = [(now, one, now) for one in self._used[table]]
                change = f"UPDATE {table} SET used = ? WHERE {name} = ? AND used < ?"
                self._disk.executemany(change, rows)
                self._used[table].clear()
        if self.size > BOUND:
            self.shrink(BOUND * 3 // 4)

    def shrink(self, most: int) -> None:
        """Leave out what was not used for longest, until the rest has so many bytes.

        Raises sqlite3.Error.
        """
        rows = self._disk.execute(
            "SELECT hash, used, length(body) + 200 + coalesce(bytes, 0) FROM code LEFT JOIN"
            " (SELECT code AS hash, SUM(length(about) + length(needs) + 200) AS bytes"
            " FROM entries GROUP BY code) USING (hash) ORDER BY used DESC, code.rowid DESC"
        ).fetchall()
        sizes = itertools.accumulate(size for _, _, size in rows)
        left = sum(size <= most for size in sizes)
        if left < len(rows):
            oldest = rows[left - 1][1] if left else _hour() + 1
            with self._written():
                gone = [(hash,) for hash, _, _ in rows[left:]]
                self._disk.executemany("DELETE FROM code WHERE hash = ?", gone)
                self._disk.execute(
                    "DELETE FROM entries WHERE CASE code WHEN '' THEN used < ?"
                    " ELSE code NOT IN (SELECT hash FROM code) END",
                    (oldest,),
                )
                self._forget_needs()
        self._disk.execute("VACUUM")
        self._disk.execute("PRAGMA wal_checkpoint(TRUNCATE)")

    def _forget_needs(self) -> None:
        """Leave out lines that no entry has; their numbers are not given again, since other
        processes remember them."""
        left: set[int] = set()
        for (blob,) in self._disk.execute("SELECT needs FROM entries").fetchall():
            left.update(memoryview(blob).cast("I"))
        known = [number for (number,) in self._disk.execute("SELECT id FROM needs").fetchall()]
        gone = [(number,) for number in known if number not in left]
        self._disk.executemany("DELETE FROM needs WHERE id = ?", gone)

    @property
    def size(self) -> int:
        """Bytes on disk."""
        files = [self.file.with_name(self.file.name + end) for end in ("", "-wal", "-shm")]
        return sum(file.stat().st_size for file in files if file.exists())

    def counts(self) -> dict[str, int]:
        """Number of entries of parts, kernels, stages and kinds of case. Raises sqlite3.Error."""
        rows = self._disk.execute(
            "SELECT CASE WHEN name LIKE 'kernel stage %' THEN 'stages' WHEN name LIKE 'kernel %'"
            " THEN 'kernels' WHEN name LIKE 'kind %' THEN 'kinds' ELSE 'parts' END, COUNT(*)"
            " FROM entries GROUP BY 1"
        )
        return {"parts": 0, "kernels": 0, "stages": 0, "kinds": 0} | dict(rows.fetchall())

    def finish(self) -> None:
        """Bring all into the one file, which then is only read. Raises sqlite3.Error."""
        self._disk.execute("PRAGMA journal_mode = DELETE")
        self._disk.execute("PRAGMA page_size = 1024")  # parts are small
        self._disk.execute("VACUUM")
        self._disk.close()


def _hour() -> int:
    return int(time.time() // 3600)


def clear() -> None:
    """Delete the user's store. Raises OSError."""
    file = store_file()
    for one in file.parent.glob(f"{file.name}*"):
        one.unlink(missing_ok=True)


def store_file() -> Path:
    """The user's file, made ready for use. Raises OSError.

    On a file system of the network it lies in the machine's own folder of temporary files, unless
    NUMBA_CACHE_DIR says where it is to be.
    """
    place = folder()
    if not config.CACHE_DIR and on_network(place):
        user = os.getuid() if hasattr(os, "getuid") else "user"
        place = Path(tempfile.gettempdir()) / f"mesokit-{user}"
    file = _private(place) / f"compiled-{FORMAT}.sqlite"
    if file.is_dir():
        raise IsADirectoryError(f"{file} is a folder; expected a file, or nothing")
    return file
