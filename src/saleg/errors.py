"""Errors a user can cause, each with a message that says what to change."""

from __future__ import annotations

import difflib
import reprlib
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

__all__ = [
    "AxesError",
    "ControllerError",
    "EngineFileError",
    "InvalidController",
    "InvalidEngine",
    "LawError",
    "OutsideModel",
    "PathsClash",
    "Problem",
    "RunFileError",
    "SalegError",
    "SalegWarning",
    "StartError",
    "SweepError",
    "UnknownPath",
    "WrongFields",
    "WrongQuantity",
]


def shown(value: Any) -> str:
    """A value as one line of text, cut where it is long, whatever its own text does.

    Examples
    --------
    >>> shown(10**5000), shown([1, 2])
    ('<int>', '[1, 2]')
    """
    try:
        return " ".join(reprlib.repr(value).split())
    except Exception:  # more digits than Python shows, or a class that fails to describe itself
        return f"<{type(value).__name__}>"


class Problem(NamedTuple):
    """One field that is wrong, or unusual: where, what stands there, and what may.

    Attributes
    ----------
    path : str
        Dotted path of the field.
    value : object
        What stands there.
    unit : str
        Its SI unit; "-" for a pure number.
    allowed : str
        What may stand there, in words.
    """

    path: str
    value: Any
    unit: str
    allowed: str

    def __str__(self) -> str:
        unit = "" if self.unit in ("", "-") else f" [{self.unit}]"
        return f"{self.path} = {shown(self.value)}{unit}: {self.allowed}"


class SalegWarning(UserWarning):
    """What is allowed, but is hardly what a user wants."""


class SalegError(Exception):
    """Base of all errors that are the user's to mend."""


class WrongFields(SalegError, ValueError):
    """Fields out of range; `problems` lists them all.

    Attributes
    ----------
    problems : list of Problem
        Path, value, unit and allowed range of every wrong field.
    """

    #: What the fields belong to.
    whole = "input"

    def __init__(self, problems: Iterable[Problem]):
        self.problems = list(problems)
        count = len(self.problems)
        lines = "\n".join(f"  {problem}" for problem in self.problems)
        plural = "s" if count > 1 else ""
        super().__init__(f"{count} wrong field{plural} in the {self.whole}:\n{lines}")

    def __reduce__(self) -> tuple[type[WrongFields], tuple[Any, ...]]:
        """Pickle by the problems, not by their text."""
        return type(self), (self.problems,)


class InvalidEngine(WrongFields):
    """An engine with fields out of range; `problems` lists them all."""

    whole = "engine"


class InvalidController(WrongFields):
    """A controller with fields out of range; `problems` lists them all."""

    whole = "controller"


class WrongArguments(WrongFields):
    """A call with wrong arguments; `problems` lists them all.

    Parameters
    ----------
    problems : iterable of Problem
    whole : str
        Whose arguments they are.
    """

    def __init__(self, problems: Iterable[Problem], whole: str = "arguments"):
        self.whole = whole
        super().__init__(problems)

    def __reduce__(self) -> tuple[type[WrongFields], tuple[Any, ...]]:
        """Pickle by the problems and whose they are."""
        return type(self), (self.problems, self.whole)


class WrongQuantity(SalegError, ValueError):
    """A field of a dataclass declared with a unit or a range that makes no sense."""


class OutsideModel(WrongFields):
    """Quantities for which the fundamental model of Chapter 2 says nothing."""

    whole = "fundamental model"


class UnknownPath(SalegError, KeyError):
    """A dotted path that leads nowhere in an engine."""

    def __str__(self) -> str:
        return str(self.args[0])


class PathsClash(SalegError, ValueError):
    """Two names for one number of an engine, both given in one call."""


class EngineFileError(SalegError, ValueError):
    """An engine file that cannot be read; names file and key."""


class RunFileError(SalegError, OSError):
    """A file or folder of a run that cannot be written or read; says which and why."""


class SweepError(SalegError, ValueError):
    """A sweep that makes no sense, or does not belong to its folder."""


class LawError(SalegError, TypeError):
    """A law that cannot be compiled; names law, method and the offending name."""


class ControllerError(SalegError, ValueError):
    """A command an engine cannot be given."""


class AxesError(SalegError, ValueError):
    """Axes a figure cannot be drawn on: too few, too many, or none at all."""


class StartError(SalegError, ArithmeticError):
    """An engine whose laws cannot be evaluated where it starts."""


def nearest(name: object, known: Iterable[str]) -> str:
    """Text that suggests the known names most like a wrong one; empty if there is none."""
    text = name if isinstance(name, str) else shown(name)
    close = difflib.get_close_matches(text, list(dict.fromkeys(known)), n=3, cutoff=0.5)
    return f"; did you mean {' or '.join(map(repr, close))}?" if close else ""


def raise_together(kind: type[SalegError], checks: Iterable[Callable[[], Any]]) -> None:
    """Do some checks, and raise what they raise: several errors as one that names all.

    Parameters
    ----------
    kind : type of error
        Of that one, unless all are of one type.
    checks : iterable of callable
    """
    errors: list[SalegError] = []
    for check in checks:
        try:
            check()
        except SalegError as error:
            errors.append(error)
    if len(errors) == 1:
        raise errors[0]
    if errors:
        kinds = {type(error) for error in errors}
        lines = "\n".join(f"  {error}" for error in errors)
        raise (kinds.pop() if len(kinds) == 1 else kind)(f"{len(errors)} are wrong:\n{lines}")
