"""Command line: ``saleg run``, ``steady``, ``report``, ``list``, ``sweep`` and others."""

from __future__ import annotations

import argparse
import contextlib
import logging
import os
import sys
import warnings
from collections.abc import Iterator, Sequence

from saleg.cli import (
    control,
    design,
    fundamental,
    listing,
    optimize,
    report,
    run,
    sensitivity,
    steady,
    studies,
    sweep,
)
from saleg.cli.completion import complete
from saleg.errors import SalegError
from saleg.files.signals import ending_in_order
from saleg.version import __version__

#: Exit codes: all well; the run ended badly; the user's mistake; stopped from the keyboard.
WELL, BADLY, MISTAKE, INTERRUPTED = 0, 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Words after ``saleg``; those of the process unless given.

    Returns
    -------
    int
        Exit code: 0 for a run that ended well, 1 for one that ended badly, 2 for a mistake of the
        user's, 130 after Ctrl-C.
    """
    parser = _parser()
    complete(parser)
    options = parser.parse_args(arguments)
    try:
        with _short_warnings(), _told_of_compilation(), ending_in_order():
            well = options.command(options)
            if sys.stdout is not None:
                sys.stdout.flush()
    except SalegError as error:
        _complain(str(error))
        return MISTAKE
    except (OSError, UnicodeError) as error:
        if isinstance(error, BrokenPipeError):  # the reader, such as `head`, has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return WELL
        _complain(ascii(str(error))[1:-1])
        return MISTAKE
    except KeyboardInterrupt:
        _complain("interrupted")
        return INTERRUPTED
    return WELL if well else BADLY


def _complain(text: str) -> None:
    """Say something beside the results; nothing where there is no console."""
    if sys.stderr is not None:
        print(f"saleg: {text}", file=sys.stderr, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="saleg", description="Simulator of free-piston linear engine generators."
    )
    parser.add_argument("--version", action="version", version=f"saleg {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    parts = (run, steady, report, listing, design, sensitivity, studies)
    for part in (*parts, fundamental, sweep, optimize, control):
        part.add_to(commands)
    return parser


class _OncePerText(logging.Handler):
    """Says each text once."""

    def __init__(self) -> None:
        super().__init__(logging.INFO)
        self.said: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Say a text that has not been said."""
        text = record.getMessage()
        if text not in self.said:
            self.said.add(text)
            _complain(text)


@contextlib.contextmanager
def _told_of_compilation() -> Iterator[None]:
    """Say that something is compiled, where it is, and about how long that takes."""
    log, handler = logging.getLogger("saleg.compiler"), _OncePerText()
    level = log.level
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.setLevel(level)


@contextlib.contextmanager
def _short_warnings() -> Iterator[None]:
    """Show warnings as one line of text, without a place in the source."""
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_: _complain(f"warning: {message}")
        yield
