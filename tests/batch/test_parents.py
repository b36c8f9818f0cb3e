"""Processes of a pool end with the process that made it, however that ends."""

import os
import signal
import subprocess
import sys
import time

import pytest

POOL = """
import os, sys, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from saleg.batch.workers import completed

def work(piece):
    os.write(1, f"{os.getpid()}\\n".encode())  # at once: two may write
    time.sleep(piece)

if __name__ == "__main__":
    pool = ProcessPoolExecutor(2, mp_context=get_context(sys.argv[1]))
    list(completed(work, enumerate([0.2, 0.2, 600.0]), pool, 2))
"""


def is_there(process):
    """Whether a process runs; one that has ended may wait to be asked how."""
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
@pytest.mark.parametrize("kind", ["spawn", "fork"])
def test_workers_end_with_a_killed_parent(tmp_path, kind, end):
    """One is at work and one waits for it; before, both stayed."""
    (tmp_path / "pool.py").write_text(POOL)
    command = [sys.executable, "pool.py", kind]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as parent:
        workers = {int(parent.stdout.readline()) for _ in range(3)}
        assert all(map(is_there, workers))
        os.kill(parent.pid, end)
    patience = time.monotonic() + 20.0
    while any(map(is_there, workers)) and time.monotonic() < patience:
        time.sleep(0.05)
    left = list(filter(is_there, workers))
    for worker in left:
        os.kill(worker, signal.SIGKILL)
    assert not left
