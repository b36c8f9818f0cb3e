"""Optimisations as TOML files.

::

    [optimize]                     # all of it optional
    target_power = 4e3             # W; without it, none
    compression_ratio = [5.0, 25.0]
    preset = "thesis_text"         # or "thesis_script": box, score, settings of the GA
    method = "cma"                 # or "ga", "de", "nsga2", "archive", "compass"
    evaluations = 2000
    seed = 0
    maximise = ["efficiency", "power_density"]   # in place of the score; also minimise
    machine = "thesis-base"        # an engine with a fixed mass; without it, component design
    rtol = 1e-6

    [bounds]                       # beside or in place of those of the preset (SI)
    intake_temperature = [300.0, 1000.0]

    [fixed]                        # values by name (SI); these are no parameters
    egr = 0.1

    [limits]                       # least and greatest value of figures (SI)
    power = [3.5e3, inf]

    [settings]                     # of the method
    size = 48

    [improve]                      # a second stage: one figure, within the limits of the score
    maximise = "efficiency"
    evaluations = 1000
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from saleg.design.terms import Limit
from saleg.design.toml_tables import (
    WrongTable,
    base_of,
    fixed_of,
    refuse_dotted,
    refuse_unknown,
    table_of,
    with_fixed,
)
from saleg.engine.toml import parsed
from saleg.errors import nearest
from saleg.optimize.log import OptimisationError
from saleg.optimize.methods import METHODS, Method
from saleg.optimize.presets import Preset, thesis_script, thesis_text
from saleg.optimize.problem import Objective, Problem
from saleg.quantities import is_number, is_whole

#: Presets by name.
PRESETS = {"thesis_text": thesis_text, "thesis_script": thesis_script}
#: Tables of a file, and keys of two of them.
TABLES = ("optimize", "bounds", "fixed", "limits", "settings", "improve")
KEYS = (
    "target_power",
    "compression_ratio",
    "preset",
    "method",
    "evaluations",
    "seed",
    "maximise",
    "minimise",
    "machine",
    "rtol",
)
IMPROVE_KEYS = ("maximise", "evaluations")
#: Designs of a first and a second stage unless a file says otherwise.
EVALUATIONS, IMPROVE_EVALUATIONS = 2000, 1000


class SecondStage(NamedTuple):
    """What is made as great as possible from the winners on, and in how many designs."""

    figure: str
    evaluations: int


class OptimisationFile(NamedTuple):
    """An optimisation as a file has it.

    Attributes
    ----------
    problem : Problem
    method : Method or None
        The default of :func:`saleg.optimize.optimize` if the file names none.
    evaluations, seed : int
    improve : SecondStage or None
    """

    problem: Problem
    method: Method | None
    evaluations: int
    seed: int
    improve: SecondStage | None


def read(path: str | Path) -> OptimisationFile:
    """Read an optimisation file.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    OptimisationFile

    Raises
    ------
    EngineFileError
        If it is no TOML file.
    OptimisationError
        Naming the file and what is wrong in it.
    InvalidProblem
        Naming all of the problem that makes no sense.
    """
    tables = parsed(path)
    try:
        refuse_unknown(tables, TABLES)
        given = table_of(tables, "optimize")
        refuse_unknown(given, KEYS, "optimize.")
        preset = PRESETS[_one_of(given, "preset", PRESETS, "thesis_text")]
        return OptimisationFile(
            _problem(tables, given, preset),
            _method(table_of(tables, "settings"), given, preset),
            _whole(given, "optimize.", "evaluations", EVALUATIONS, 1),
            _whole(given, "optimize.", "seed", 0, 0),
            _improve(table_of(tables, "improve")) if "improve" in tables else None,
        )
    except WrongTable as error:
        raise OptimisationError(f"{path}: {error}") from None


def _problem(tables: Mapping[str, Any], given: Mapping[str, Any], preset: Preset) -> Problem:
    """Problem of a file."""
    fixed, machine = fixed_of(tables), "machine" in given
    bounds = {} if machine else {k: v for k, v in preset.box.items() if k not in fixed}
    own = _pairs(tables, "bounds")
    both = [name for name in own if name in fixed]
    if both:
        raise WrongTable(f"{both[0]} stands in [fixed] and in [bounds]: remove one")
    fields: dict[str, Any] = {"rtol": given["rtol"]} if "rtol" in given else {}
    goals = [
        Objective(name, word == "maximise")
        for word in ("maximise", "minimise")
        for name in _texts(given, word)
    ]
    if goals:
        fields["objectives"] = tuple(goals)
    limits = tuple(Limit(name, *ends) for name, ends in _pairs(tables, "limits").items())
    ratios = _pair("optimize.compression_ratio", given.get("compression_ratio", [5.0, 35.0]))
    score = preset.score(given.get("target_power"), ratios)
    swept = with_fixed(base_of(given), fixed)
    return Problem({**bounds, **own}, score, constraints=limits, swept=swept, **fields)


def _method(settings: Mapping[str, Any], given: Mapping[str, Any], preset: Preset) -> Method | None:
    """Method of a file with its settings; that of the preset for the genetic algorithm."""
    if "method" not in given:
        if settings:
            raise WrongTable("[settings] without optimize.method: say of which method they are")
        return None
    name = _one_of(given, "method", METHODS, "")
    method: Any = preset.method if name == "ga" else METHODS[name]
    known = [item.name for item in dataclasses.fields(method) if item.name != "axes"]
    refuse_unknown(settings, known, "settings.")
    changed: Method = dataclasses.replace(method, **settings)
    return changed


def _improve(given: Mapping[str, Any]) -> SecondStage:
    refuse_unknown(given, IMPROVE_KEYS, "improve.")
    figure = given.get("maximise", "efficiency")
    if not isinstance(figure, str):
        raise WrongTable(f"improve.maximise = {figure!r}: must be the name of a figure")
    count = _whole(given, "improve.", "evaluations", IMPROVE_EVALUATIONS, 1)
    return SecondStage(figure, count)


def _pairs(tables: Mapping[str, Any], name: str) -> dict[str, tuple[float, float]]:
    """Two numbers by name."""
    held = table_of(tables, name)
    refuse_dotted(held)
    return {key: _pair(f"{name}.{key}", value) for key, value in held.items()}


def _pair(where: str, value: Any) -> tuple[float, float]:
    if not (isinstance(value, list) and len(value) == 2 and all(map(is_number, value))):
        raise WrongTable(f"{where} = {value!r}: must be [lowest, highest]")
    return float(value[0]), float(value[1])


def _texts(given: Mapping[str, Any], name: str) -> list[str]:
    value = given.get(name, [])
    names = [value] if isinstance(value, str) else value
    if not (isinstance(names, list) and all(isinstance(item, str) for item in names)):
        raise WrongTable(f"optimize.{name} = {value!r}: must be the names of figures")
    return names


def _whole(given: Mapping[str, Any], where: str, name: str, usual: int, least: int) -> int:
    value = given.get(name, usual)
    if not is_whole(value, least):
        raise WrongTable(f"{where}{name} = {value!r}: must be a whole number >= {least}")
    return int(value)


def _one_of(given: Mapping[str, Any], name: str, known: Mapping[str, Any], usual: str) -> str:
    value = given.get(name, usual)
    if not isinstance(value, str) or value not in known:
        hint = nearest(value, known) or f"; there are {', '.join(known)}"
        raise WrongTable(f"optimize.{name} = {value!r}: unknown{hint}")
    return value
