"""Processes that compile one kernel take turns by a lock, which threads of a process share."""

from pathlib import Path

from mesokit.kernels.kernel import _MachineCode


class Turn:
    """A lock at whose release another thread of this process ends the turn as well."""

    def __init__(self, code, folder):
        self.code, self.released = code, 0
        self.lock_file = str(folder / "kernel.lock")
        Path(self.lock_file).touch()

    def release(self):
        self.released += 1
        self.code.end_turn()


def test_two_threads_may_end_one_turn(tmp_path):
    code = _MachineCode(test_two_threads_may_end_one_turn)
    turn = code._turn = Turn(code, tmp_path)
    code.end_turn()
    assert turn.released == 1 and not Path(turn.lock_file).exists()
    code.end_turn()  # nothing is left to end
    assert turn.released == 1
