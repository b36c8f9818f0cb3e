"""Signals that end a process, while files are written."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def ending_in_order() -> Iterator[None]:
    """Let SIGTERM end the process as Ctrl-C does, so that what is half written is removed."""
    ours = _in_main_thread() and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    if ours:
        signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)


@contextmanager
def held_off(*numbers: signal.Signals) -> Iterator[None]:
    """Hold off signals for a moment, Ctrl-C and SIGTERM unless named; they come afterwards."""
    came: list[int] = []
    wanted = (numbers or (signal.SIGINT, signal.SIGTERM)) if _in_main_thread() else ()
    before = {held: signal.signal(held, lambda number, _: came.append(number)) for held in wanted}
    try:
        yield
    finally:
        for held, handler in before.items():
            signal.signal(held, handler)
        for number in came:
            signal.raise_signal(number)


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()
