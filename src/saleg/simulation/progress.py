"""Progress bars on a terminal and in a notebook."""

from __future__ import annotations

import sys
import threading
import warnings
from contextlib import AbstractContextManager, nullcontext
from typing import Any


def progress_bar(total: float | None, **form: Any) -> AbstractContextManager[Any]:
    """Progress bar after a second of waiting; None where nobody looks on.

    Parameters
    ----------
    total : float or None
        What there is to do, if it is known.
    **form
        Keywords of :class:`tqdm.tqdm`.
    """
    if not (_in_notebook() or _on_terminal()):
        return nullcontext()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # text where there are no widgets is as good
        from tqdm.auto import tqdm

    bar: AbstractContextManager[Any] = tqdm(total=total, delay=1, leave=False, **form)
    return bar


def _in_notebook() -> bool:
    """Whether a cell of a notebook waits for this thread.

    Widgets are the kernel's: its worker threads and the processes it forks leave them alone.
    """
    if "ipykernel.zmqshell" not in sys.modules:
        return False
    processes = sys.modules.get("multiprocessing.process")
    forked = processes is not None and processes.parent_process() is not None
    return not forked and threading.current_thread() is threading.main_thread()


def _on_terminal() -> bool:
    """Whether errors go to a terminal; they go nowhere where there is no console."""
    try:
        return bool(sys.stderr.isatty())
    except (AttributeError, ValueError):  # none, one that is no file, or a closed one
        return False
