"""Who works, as ``saleg sweep`` and ``saleg optimize`` are told."""

from __future__ import annotations

import argparse
from contextlib import nullcontext
from typing import Any

from saleg.batch.workers import WorkersError, end_with_parent


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add the options to a command."""
    add = parser.add_argument
    add("--workers", type=int, metavar="N", help="how many work at once (all processors)")
    add("--processes", action="store_true", help="work in processes, not threads")


def executor_of(options: argparse.Namespace) -> Any:
    """Processes if asked for, as a context; threads of this process are the batch's own affair.

    Raises
    ------
    WorkersError
        If nobody is to work.
    """
    if options.workers is not None and options.workers < 1:
        raise WorkersError(f"--workers {options.workers}: must be at least 1")
    if not options.processes:
        return nullcontext()
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    return ProcessPoolExecutor(options.workers, get_context("spawn"), end_with_parent)
