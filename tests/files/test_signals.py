"""What SIGTERM and Ctrl-C leave of files that are being written: nothing."""

import os
import signal
import subprocess
import sys
import time

import pytest

from saleg.compiler import machine_code
from saleg.compiler.kernel import Kernel
from saleg.files.atomic import new_file, new_folder
from saleg.files.signals import ending_in_order, held_off

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


def terminated_while_writing(place, target):
    with place(target) as temporary:
        file = temporary / "part" if temporary.is_dir() else temporary
        file.write_text("half")
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(5.0)


@pytest.mark.parametrize("place", [new_file, new_folder])
def test_what_is_half_written_is_removed_on_sigterm(tmp_path, place):
    with pytest.raises(SystemExit) as ended:
        terminated_while_writing(place, tmp_path / "above" / "run")
    assert ended.value.code == 128 + signal.SIGTERM
    assert list(tmp_path.iterdir()) == []
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def test_a_handler_of_the_users_own_is_left_alone():
    came = []
    before = signal.signal(signal.SIGTERM, lambda number, _: came.append(number))
    try:
        with ending_in_order():
            os.kill(os.getpid(), signal.SIGTERM)
        assert came == [signal.SIGTERM]
    finally:
        signal.signal(signal.SIGTERM, before)


@pytest.mark.parametrize(
    ("number", "end"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)]
)
def test_signals_come_after_the_moment_they_are_held_off(number, end):
    done = []
    # A shell has the jobs behind it ignore Ctrl-C, and so has whoever they start.
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)

    def work():
        with ending_in_order(), held_off():
            os.kill(os.getpid(), number)
            done.append(True)

    try:
        with pytest.raises(end):
            work()
    finally:
        signal.signal(signal.SIGINT, usual)
    assert done


def test_a_terminated_command_leaves_nothing(tmp_path):
    command = ["run", "thesis-base", "--duration", "1e6", "--out", str(tmp_path / "out")]
    process = subprocess.Popen([sys.executable, "-m", "saleg", *command])
    patience = time.monotonic() + 60.0
    while not list(tmp_path.iterdir()) and time.monotonic() < patience:
        time.sleep(0.05)
    assert list(tmp_path.iterdir())
    time.sleep(0.5)
    process.terminate()
    assert process.wait(60.0) == 128 + signal.SIGTERM
    assert list(tmp_path.iterdir()) == []


def test_a_kernel_is_compiled_to_its_end_before_sigterm_ends_the_process(monkeypatch):
    """Within the compiler's callbacks the exit would be swallowed, and the command run on."""
    done = []

    def compile_for(function, kinds):
        signal.raise_signal(signal.SIGTERM)
        done.append(True)

    kernel = object.__new__(Kernel)
    kernel._kept, kernel._laws = None, []
    monkeypatch.setattr(Kernel, "function", lambda *_: None)
    monkeypatch.setattr(machine_code, "types_of", lambda _: ())
    monkeypatch.setattr(machine_code, "is_compiled", lambda *_: False)
    monkeypatch.setattr(machine_code, "compile_for", compile_for)
    with pytest.raises(SystemExit) as left, ending_in_order():
        kernel._compiled("run_on", ())
    assert left.value.code == 128 + signal.SIGTERM
    assert done == [True]
