"""Terms of a score: how well one figure of a design meets what is asked of it, from 0 to 1.

A term is a curve over one figure, so that it can be drawn, and takes whole columns. A figure that
is not known (NaN) earns nothing. The dissertation prints the formulas of :class:`Reached` and
:class:`Below` (Appendix B VIII) and the names of the others (docs/optimisation.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from saleg.errors import SalegError, WrongFields, nearest
from saleg.quantities import Problem, Quantities, problems, quantity

if TYPE_CHECKING:
    import pandas as pd

    #: Figures by name: one row, or the columns of a table.
    Row: TypeAlias = Mapping[str, Any] | pd.DataFrame

#: A bell asks as a hard limit for what differs from its target by this share at most.
LIMIT_OF_BELL = 0.05


class InvalidScore(WrongFields):
    """A score with fields out of range; `problems` lists them all."""

    whole = "score"


class UnknownFigure(SalegError, KeyError):
    """A figure no row has."""

    def __str__(self) -> str:
        return str(self.args[0])


class Limit(NamedTuple):
    """A range a figure has to lie in.

    Parameters
    ----------
    figure : str
        Column of the table.
    low, high : float
        Ends of the range, in the SI unit of the figure.

    Examples
    --------
    >>> float(Limit("compression_ratio", 5.0, 25.0).violation({"compression_ratio": 30.0}))
    0.2
    """

    figure: str
    low: float = -math.inf
    high: float = math.inf

    def violation(self, row: Row) -> Any:
        """By how much the figure misses the range, over the end it misses; NaN if not known."""
        values = column(row, self.figure)
        below = 0.0 if math.isinf(self.low) else np.maximum(self.low - values, 0.0) / size(self.low)
        above = (
            0.0 if math.isinf(self.high) else np.maximum(values - self.high, 0.0) / size(self.high)
        )
        return np.where(np.isnan(values), np.nan, below + above)[()]


def size(end: float) -> float:
    """What misses of a limit are measured in: the limit itself, or 1 where it is 0."""
    return abs(end) or 1.0


class Term(Protocol):
    """One figure of a design and the curve of what it earns.

    Attributes
    ----------
    figure : str
        Column the term reads, which may be an axis of its drawing.
    limits : tuple of Limit
        What the term asks for, as hard limits.
    """

    @property
    def figure(self) -> str:
        """Column the term reads."""

    @property
    def limits(self) -> tuple[Limit, ...]:
        """What the term asks for, as hard limits."""

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""

    def miss(self, values: Any) -> Any:
        """How far values are beyond where the curve is flat at nothing, 0 to 1."""

    def __call__(self, row: Row) -> Any:
        """What a row, or every row of a table, earns."""


class _Curve(Quantities):
    """Base of terms that are no more than a curve over their figure."""

    figure: str

    def __post_init__(self) -> None:
        super().__post_init__()
        found = problems(self)
        low, high = getattr(self, "low", 0.0), getattr(self, "high", 1.0)
        if not isinstance(self.figure, str) or not self.figure:
            found.append(Problem("figure", self.figure, "-", "must be the name of a column"))
        if not found and high < low:
            found.append(Problem("high", high, "-", f"must be >= {low:g}"))
        if found:
            raise InvalidScore(found)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """What the term asks for, as hard limits."""
        return ()

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        raise NotImplementedError

    def miss(self, values: Any) -> Any:
        """How far values are beyond where the curve is flat at nothing, 0 to 1."""
        return 0.0 * np.asarray(values)

    def __call__(self, row: Row) -> Any:
        """What a row, or every row of a table, earns."""
        return self.curve(column(row, self.figure))


@dataclass(frozen=True)
class Reached(_Curve):
    """The more the better: ``1 - exp(-2 ((x - target + tolerance)/tolerance)^6)``.

    Nothing below ``target - tolerance``, 0.865 at the target, all beyond (Appendix B VIII).

    Parameters
    ----------
    figure : str
    target, tolerance : float
        In the unit of the figure.
    """

    figure: str
    target: float = quantity("-")
    tolerance: float = quantity("-", low=0, open_low=True)

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        share = np.maximum((np.asarray(values) - self.target) / self.tolerance + 1.0, 0.0)
        return 1.0 - np.exp(-2.0 * share**6)

    def miss(self, values: Any) -> Any:
        """How far values are below where the curve begins, 0 to 1."""
        return _beyond((self.target - np.asarray(values)) / self.tolerance - 1.0)


@dataclass(frozen=True)
class Below(_Curve):
    """A limit from above: ``1 - exp(-((limit + tolerance - x)/tolerance)^6)``.

    Nearly all well below the limit, 0.632 at it, nothing beyond ``limit + tolerance``
    (Appendix B VIII).

    Parameters
    ----------
    figure : str
    limit, tolerance : float
        In the unit of the figure.
    """

    figure: str
    limit: float = quantity("-")
    tolerance: float = quantity("-", low=0, open_low=True)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """At most the limit."""
        return (Limit(self.figure, high=self.limit),)

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        left = np.maximum((self.limit - np.asarray(values)) / self.tolerance + 1.0, 0.0)
        return 1.0 - np.exp(-(left**6))

    def miss(self, values: Any) -> Any:
        """How far values are above where the curve ends, 0 to 1."""
        return _beyond((np.asarray(values) - self.limit) / self.tolerance - 1.0)


@dataclass(frozen=True)
class Bell(_Curve):
    """A target: ``exp(-((x - target)/width)^2)``.

    Parameters
    ----------
    figure : str
    target, width : float
        In the unit of the figure.
    """

    figure: str
    target: float = quantity("-")
    width: float = quantity("-", low=0, open_low=True)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Within 5 % of the target."""
        off = LIMIT_OF_BELL * size(self.target)
        return (Limit(self.figure, self.target - off, self.target + off),)

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        return np.exp(-(((np.asarray(values) - self.target) / self.width) ** 2))

    def miss(self, values: Any) -> Any:
        """How far values are off the bell, beyond two widths, 0 to 1."""
        return _beyond(np.abs(np.asarray(values) - self.target) / self.width - 2.0)


@dataclass(frozen=True)
class Range(_Curve):
    """A range with flanks that fall off over a tenth of its ends.

    Parameters
    ----------
    figure : str
    low, high : float
        In the unit of the figure, > 0.
    """

    figure: str
    low: float = quantity("-", low=0, open_low=True)
    high: float = quantity("-", low=0, open_low=True)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Within the range."""
        return (Limit(self.figure, self.low, self.high),)

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        return np.exp(-2.0 * self._off(values) ** 2)

    def miss(self, values: Any) -> Any:
        """How far values are off the flanks, 0 to 1."""
        return _beyond(self._off(values) - 1.5)

    def _off(self, values: Any) -> Any:
        """Distance from the range in widths of its flanks."""
        values = np.asarray(values)
        below, above = (
            (self.low - values) / (0.1 * self.low),
            (values - self.high) / (0.1 * self.high),
        )
        return np.maximum(np.maximum(below, above), 0.0)


@dataclass(frozen=True)
class Repeats(_Curve):
    """Stability: the change of the left dead centre in half strokes (Eq. 68), 0 at best.

    ``exp(-2 (x/tolerance)^2)``, and nothing for an orbit with a multiplier beyond one.
    ``largest_multiplier`` is used where it is known; NaN in it stands for not known. A row without
    the column ``stability``, as a printed one, is that of a steady state.

    Parameters
    ----------
    tolerance : float
        Change at which most is lost [-].
    figure : str
        Name it is shown by.
    """

    tolerance: float = quantity("-", default=0.1, low=0, open_low=True)
    figure: str = "stability"

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        return np.exp(-2.0 * (np.asarray(values) / self.tolerance) ** 2)

    def __call__(self, row: Row) -> Any:
        """What a row, or every row of a table, earns."""
        met = self.curve(row.get("stability", 0.0))
        if "largest_multiplier" in row:
            met = np.where(np.greater(row["largest_multiplier"], 1.0), 0.0, met)
        return met


@dataclass(frozen=True)
class Within(_Curve):
    """Another term, with nothing outside a range: the end of a map of the script.

    Parameters
    ----------
    term : Term
    low, high : float
        In the unit of the term's figure.
    """

    term: Term
    low: float = quantity("-")
    high: float = quantity("-")

    def __post_init__(self) -> None:
        """Refuse what is no term, before it is asked for its figure."""
        if isinstance(self.term, type) or not callable(getattr(self.term, "curve", None)):
            raise InvalidScore([Problem("term", self.term, "-", "must be a term")])
        super().__post_init__()

    @property
    def figure(self) -> str:  # type: ignore[override]
        """Column of the term."""
        return self.term.figure

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Those of the term."""
        return self.term.limits

    def curve(self, values: Any) -> Any:
        """What values of the figure earn, 0 to 1."""
        values = np.asarray(values)
        inside = (values >= self.low) & (values <= self.high)
        return np.where(inside, self.term.curve(values), np.where(np.isnan(values), np.nan, 0.0))

    def miss(self, values: Any) -> Any:
        """As for the term."""
        return self.term.miss(values)


@dataclass(frozen=True)
class Own:
    """An own function of the rows of a table.

    Parameters
    ----------
    function : callable
        Given a table, or a row, of figures: what each row earns, 0 to 1. Figures of designs
        without a steady state are NaN, and may give NaN; others may not.
    figure : str
        What it is called.
    limits : tuple of Limit
        Ranges of figures outside which it earns nothing.

    Examples
    --------
    >>> light = Own(lambda row: 1.0 / (1.0 + row["moving_mass"]), "lightness")
    >>> light({"moving_mass": 3.0})
    array(0.25)
    """

    function: Callable[[Any], Any]
    figure: str = "own function"
    limits: tuple[Limit, ...] = ()

    def curve(self, values: Any) -> Any:
        """What it gives is what it earns."""
        return np.asarray(values)

    def miss(self, values: Any) -> Any:
        """Nothing is known of an own function where it is flat."""
        return 0.0 * np.asarray(values)

    def __call__(self, row: Row) -> Any:
        """What a row, or every row of a table, earns.

        Raises
        ------
        InvalidScore
            If that is no number from 0 to 1 where the figures are known.
        """
        try:
            met = np.asarray(self.function(row), dtype=float)
        except (KeyError, TypeError, ValueError) as error:
            why = f"gave no numbers ({type(error).__name__}: {error})"
            raise InvalidScore([Problem(self.figure, self.function, "-", why)]) from None
        known = is_known(row)
        wrong = known & ~((met >= 0.0) & (met <= 1.0))
        if np.any(wrong):
            first = float(np.broadcast_to(met, np.shape(wrong))[wrong][0])
            need = "must give numbers from 0 to 1 for every row with a steady state"
            raise InvalidScore([Problem(self.figure, first, "-", need)])
        return np.where(known, met, np.nan)


def _beyond(distance: Any) -> Any:
    """A distance as a number from 0 to 1; 0 where it is negative."""
    distance = np.maximum(distance, 0.0)
    return distance / (1.0 + distance)


#: Words of a status behind which figures of a steady state stand.
STEADY = ("steady", "idling")


def is_known(row: Row) -> Any:
    """Whether the figures of a row, or of every row, are those of a steady state."""
    if "status" not in row:
        return np.asarray(True)
    return np.isin(np.asarray(row["status"], dtype=object).astype(str), STEADY)


def column(row: Row, name: str) -> np.ndarray:
    """A figure of a row, or of every row.

    Raises
    ------
    UnknownFigure
        If no row has it.
    """
    if name not in row:
        raise UnknownFigure(f"no figure '{name}' in the rows{nearest(name, map(str, row))}")
    return np.asarray(row[name], dtype=float)
