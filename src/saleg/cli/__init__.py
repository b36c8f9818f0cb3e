"""Command line: ``saleg run``, ``steady``, ``report``, ``list``, ``sweep`` and others."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
import warnings
from collections.abc import Iterator, Sequence

from saleg.cli import control, fundamental, listing, optimize, report, run, steady, sweep
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
    options = _parser().parse_args(arguments)
    try:
        with _short_warnings(), ending_in_order():
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
        print(f"saleg: {text}", file=sys.stderr)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="saleg", description="Simulator of free-piston linear engine generators."
    )
    parser.add_argument("--version", action="version", version=f"saleg {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    run.add_to(commands)
    steady.add_to(commands)
    report.add_to(commands)
    listing.add_to(commands)
    fundamental.add_to(commands)
    sweep.add_to(commands)
    optimize.add_to(commands)
    control.add_to(commands)
    return parser


@contextlib.contextmanager
def _short_warnings() -> Iterator[None]:
    """Show warnings as one line of text, without a place in the source."""
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_: _complain(f"warning: {message}")
        yield
