"""Each rank carries out commands and scripts, one after another, and notes how each ends.

mpiexec -n 3 python -m mpi4py refused.py '{"words": {"no case": ["run", "no.toml"]}, "scripts": {}}'
"""

import contextlib
import io
import json
import sys

from mesokit import cli
from mesokit.errors import MesokitError
from mesokit.processes import end, world

# a rank goes on to the next command, where it would end
end.leave_orderly = lambda status: None


def status_of(words):
    try:
        cli.main(words)
    except SystemExit as status:
        return status.code


def error_of(script):
    try:
        exec(script, {"rank": world.known().rank})
    except MesokitError as error:
        return f"{type(error).__name__}: {error}"


def main(words, scripts):
    """Status and standard error of each command, and the error of each script, of every rank."""
    here, found = world.world(), {}
    for name, given in words.items():
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            status = status_of([word.format(rank=here.rank) for word in given])
        world._known = here  # a command of one process has left the others
        found[name] = here.gathered((status, said.getvalue()))
    for name, script in scripts.items():
        found[name] = here.gathered(error_of(script))
    if here.root:
        print(json.dumps(found))


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
