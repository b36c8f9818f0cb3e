"""Completion of command lines by a shell, where argcomplete is installed.

``pip install "saleg[completion]"``, then ``eval "$(register-python-argcomplete saleg)"``.
"""

from __future__ import annotations

import argparse
import contextlib
import os
from collections.abc import Iterable
from typing import Any


def complete(parser: argparse.ArgumentParser) -> None:
    """Answer a shell that asks how a line may go on; it ends the process then."""
    if "_ARGCOMPLETE" not in os.environ:
        return
    with contextlib.suppress(ImportError):
        import argcomplete

        for action in _actions(parser):
            if action.dest in WORDS:
                action.completer = WORDS[action.dest]  # type: ignore[attr-defined]
        argcomplete.autocomplete(parser)


def _actions(parser: argparse.ArgumentParser) -> Iterable[argparse.Action]:
    """All arguments and options of a parser and its sub-commands."""
    for action in parser._actions:
        yield action
        if isinstance(action, argparse._SubParsersAction):
            for part in action.choices.values():
                yield from _actions(part)


def _machines(prefix: str, **_: Any) -> list[str]:
    from argcomplete.completers import FilesCompleter

    from saleg.machines import catalogue

    return [*catalogue(), *FilesCompleter(("toml", "npz"))(prefix)]


def _changes(parsed_args: argparse.Namespace, **_: Any) -> list[str]:
    """Paths of the engine named on the line so far, each with its equals sign."""
    from saleg.cli.parameters import parameters_of
    from saleg.cli.run import load
    from saleg.errors import SalegError

    named = getattr(parsed_args, "machine", None) or getattr(parsed_args, "subject", None)
    try:
        engine = load(named or "thesis-base")
    except SalegError:
        return []
    return [f"{parameter.path}=" for parameter in parameters_of(engine)]


def _figures(**_: Any) -> list[str]:
    from saleg.cli.pictures import names

    return names()


def _studies(**_: Any) -> list[str]:
    from saleg.cli.studies import catalogue

    return list(catalogue())


def _experiments(**_: Any) -> list[str]:
    from saleg.thesis.chapter_5 import EXPERIMENTS

    return list(EXPERIMENTS)


#: How each argument or option may go on.
WORDS = {
    "machine": _machines,
    "subject": _machines,
    "changes": _changes,
    "plot": _figures,
    "study": _studies,
    "experiment": _experiments,
}
