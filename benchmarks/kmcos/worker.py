"""Events of kmcos, timed on demand: PYTHON worker.py FOLDER SIDE, in FOLDER/out of `model.py`.

At each line that it reads it prints nanoseconds of CPU time for an event.
"""

import contextlib
import io
import os
import sys
import time

EVENTS = 300_000


def main() -> None:
    folder, side = sys.argv[1:]
    os.chdir(os.path.join(folder, "out"))
    sys.path.insert(0, ".")
    with contextlib.redirect_stdout(io.StringIO()):
        from kmcos.run import KMC_Model

        model = KMC_Model(banner=False, print_rates=False, size=[int(side)] * 2)
        model.do_steps(200_000)
    print("ready", flush=True)
    for _ in sys.stdin:
        began = time.process_time()
        model.do_steps(EVENTS)
        print(1e9 * (time.process_time() - began) / EVENTS, flush=True)


if __name__ == "__main__":
    main()
