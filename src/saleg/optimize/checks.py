"""What makes no sense in a problem, or in designs for it."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from typing import Any

import numpy as np

from saleg.batch.table import TEXT
from saleg.design.designs import Design
from saleg.design.subjects import Subject, subject_of
from saleg.design.terms import Limit, Own
from saleg.engine import Engine
from saleg.errors import Problem as Wrong
from saleg.errors import SalegError, WrongFields, nearest
from saleg.optimize.objectives import Objective
from saleg.optimize.scatter import FIGURES as SCATTER_FIGURES
from saleg.optimize.scatter import Scatter
from saleg.quantities import as_float
from saleg.steady.solver import check_effort, check_tolerance


def wrong_fields(problem: Any) -> Iterator[Wrong]:
    """All that is wrong with a problem."""
    try:
        subject = subject_of(problem.swept)
    except SalegError as error:
        yield Wrong("swept", problem.swept, "-", str(error))
        return
    yield from _wrong_bounds(problem, subject)
    bounds = problem.bounds if isinstance(problem.bounds, Mapping) else {}
    figures = {*map(str, bounds), *map(str, subject.units), "score"}
    if isinstance(problem.scatter, Scatter):
        yield from problem.scatter.wrong(subject)
        figures |= set(SCATTER_FIGURES)
    elif problem.scatter is not None:
        yield Wrong("scatter", problem.scatter, "-", "must be a Scatter, or None")
    if not callable(problem.score) or isinstance(problem.score, type):
        yield Wrong("score", problem.score, "-", "must be a score: an object (not a class) to call")
    for weight, term in getattr(problem.score, "terms", ()):
        if weight and not isinstance(term, Own) and term.figure not in figures:
            yield _unknown("score", term.figure, figures)
    yield from _wrong_tuple("objectives", problem.objectives, Objective, figures)
    yield from _wrong_tuple("constraints", problem.constraints, Limit, figures)
    if isinstance(problem.objectives, (tuple, list)) and not problem.objectives:
        yield Wrong("objectives", problem.objectives, "-", "must be at least one Objective")
    for name, check in (("effort", check_effort), ("rtol", check_tolerance)):
        try:
            check(getattr(problem, name))
        except SalegError as error:
            yield Wrong(name, getattr(problem, name), "-", str(error))


def _unknown(where: str, figure: Any, figures: set[str]) -> Wrong:
    return Wrong(where, figure, "-", f"no row has it{nearest(figure, sorted(figures))}")


def _wrong_tuple(name: str, given: Any, kind: Any, figures: set[str]) -> Iterator[Wrong]:
    """Objectives or constraints that are none, or of what no row has as a number."""
    # An Objective or a Limit is a tuple itself.
    if not isinstance(given, (tuple, list)) or isinstance(given, kind):
        yield Wrong(name, given, "-", f"must be a tuple, of {kind.__name__}")
        return
    for number, item in enumerate(given):
        where = f"{name}[{number}]"
        if not isinstance(item, kind):
            yield Wrong(where, item, "-", f"must be {kind.__name__}(figure, ...)")
        elif not isinstance(item.figure, str) or item.figure not in figures:
            yield _unknown(where, item.figure, figures)
        elif item.figure in TEXT:
            yield Wrong(where, item.figure, "-", "is text; must be the name of a number")
        elif isinstance(item, Limit) and not _is_range(item.low, item.high):
            yield Wrong(where, item, "-", "must have low <= high, both numbers")


def _is_range(low: Any, high: Any) -> bool:
    ends = as_float(low), as_float(high)
    return None not in ends and ends[0] <= ends[1]  # type: ignore[operator]


def wrong_designs(where: str, given: Any, names: Collection[str]) -> Iterator[Wrong]:
    """What is wrong with a table of designs."""
    lacking = [name for name in names if name not in getattr(given, "columns", ())]
    if lacking:
        yield Wrong(where, lacking, "-", "must have a column of these, or be a row of all of them")
        return
    for name in names:
        wrong = [value for value in given[name] if not _is_finite(value)]
        if wrong:
            yield Wrong(where, wrong[0], "-", f"every {name} must be a finite number")


def _is_finite(value: Any) -> bool:
    number = as_float(value)
    return number is not None and math.isfinite(number)


def _wrong_bounds(problem: Any, subject: Subject) -> Iterator[Wrong]:
    if not isinstance(problem.bounds, Mapping) or not problem.bounds:
        need = "must be ranges by name, as {'bore': (0.05, 0.07)}"
        yield Wrong("bounds", problem.bounds, "-", need)
        return
    known = []
    for name, ends in problem.bounds.items():
        try:
            unit = subject.unit(str(name))
            known.append(str(name))
        except SalegError as error:
            yield Wrong(f"bounds[{name!r}]", ends, "-", str(error))
            continue
        numbers = [as_float(end) for end in ends] if np.iterable(ends) else []
        if len(numbers) != 2 or any(end is None or not math.isfinite(end) for end in numbers):
            yield Wrong(
                f"bounds[{name!r}]", ends, unit, "must be a lower and a higher finite value"
            )
        elif not numbers[0] < numbers[1]:  # type: ignore[operator]
            yield Wrong(f"bounds[{name!r}]", ends, unit, "the lower bound must be below the higher")
        else:
            yield from _beyond(problem.swept, str(name), numbers)
    try:
        subject.refuse_clash(known)
    except SalegError as error:
        yield Wrong("bounds", known, "-", str(error))


def _beyond(swept: Any, name: str, ends: list[Any]) -> Iterator[Wrong]:
    """Bounds no design or engine can have."""
    if not isinstance(swept, (Design, Engine)):
        return
    for end in ends:
        try:
            swept.replace(**{name: end}).validate()
        except WrongFields as error:
            fields = [item for item in error.problems if item.value == end]
            yield from (item._replace(path=f"bounds[{name!r}]") for item in fields[:1])
