"""Progress bars on a terminal."""

from __future__ import annotations

import sys
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
    if not _on_terminal():
        return nullcontext()
    from tqdm import tqdm

    return tqdm(total=total, delay=1, leave=False, **form)


def _on_terminal() -> bool:
    """Whether errors go to a terminal; they go nowhere where there is no console."""
    try:
        return bool(sys.stderr.isatty())
    except (AttributeError, ValueError):  # none, one that is no file, or a closed one
        return False
