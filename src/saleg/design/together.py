"""Many designs at once: what the loop does with one, done with columns of numbers."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from saleg.batch.many import columns_of, cycle_figures_of, stability_columns
from saleg.batch.points import Values
from saleg.batch.table import Columns
from saleg.columns import by_branch, column
from saleg.design.designs import Design
from saleg.design.loop import LAW, MASS_TOLERANCE, closed_message, mass_law
from saleg.design.operation import Operation
from saleg.design.results import component_figures
from saleg.design.score import Score
from saleg.engine import Translator
from saleg.engine.columns import Rows, are_in_range
from saleg.errors import SalegError
from saleg.simulation.course import STEPS_PER_CALL
from saleg.simulation.initial_rows import States
from saleg.status import Status
from saleg.steady.many import Limits, Orbits, lots_to_search, searched, verdicts
from saleg.steady.solver import MAX_MAPS, MAX_MISSED, QUICK_MAPS, QUICK_STEPS, Effort


class Designs(NamedTuple):
    """Designs that are one with some numbers replaced.

    Attributes
    ----------
    design : Design
    values : mapping of str to ndarray, shape (n,)
        Numbers of each by name.
    """

    design: Design
    values: Mapping[str, np.ndarray]

    def some(self, chosen: np.ndarray) -> Design:
        """Some of them, as a design whose numbers are columns."""
        return self.design.replace({n: column(v[chosen]) for n, v in self.values.items()})

    def one(self, n: int) -> Design:
        """One of them."""
        return self.design.replace({name: float(v[n]) for name, v in self.values.items()})


def solved_together(
    design: Design,
    points: Sequence[Values],
    rtol: float,
    effort: Effort,
    total: int,
    multipliers: bool = False,
) -> list[tuple[np.ndarray, Columns]]:
    """Columns of those designs whose loop closes where the first start leads, and their places.

    Parameters
    ----------
    design : Design
    points : sequence of mappings
        Numbers of each design to replace, by name.
    rtol : float
        Tolerance of the integrator, and of the mass.
    effort : Effort
    total : int
        Number of designs in the batch they are a piece of.
    multipliers : bool
        Whether to differentiate each steady state.
    """
    designs = Designs(design, {name: np.array([p[name] for p in points]) for name in points[0]})
    if not all(_is_ours(getattr(design.masses, f.name)) for f in dataclasses.fields(design.masses)):
        return []
    lots = []
    for lot, mirrored in _lots(designs, len(points)):
        orbits = _closed(designs, lot, mirrored, rtol, effort, total)
        if orbits is not None:
            lots += _columns(designs, orbits, rtol, multipliers)
    return lots


def _is_ours(model: Any) -> bool:
    """Whether a model of a mass is the library's: it calculates with columns."""
    return type(model).__module__.startswith("saleg.")


def _lots(designs: Designs, count: int) -> list[tuple[Rows, bool]]:
    """Engines of the valid designs, and whether they are searched for in the mirror."""
    try:
        many = designs.some(np.arange(count))
        sound = are_in_range(many.parameters, count) & are_in_range(many.masses, count)
        places = np.flatnonzero(sound)
        if not len(places):
            return []
        designs.one(int(places[0])).validate()
        return lots_to_search(Rows(designs.some(places).engine(1.0), places))
    except (SalegError, AttributeError, TypeError):  # whoever solves them one by one will say
        return []


def _closed(
    designs: Designs, lot: Rows, mirrored: bool, rtol: float, effort: Effort, total: int
) -> Orbits | None:
    """Orbits whose mass is that of their components, the mass renewed by every map."""
    numbers = np.full((1 + len(LAW), lot.count), math.nan)
    for chosen, found in by_branch(
        lambda rows: _first_masses(designs.some(lot.places[rows])), np.arange(lot.count)
    ):
        for row, values in zip(numbers, found or (), strict=bool(found)):
            row[chosen] = values
    known = np.isfinite(numbers).all(axis=0)
    if not known.any():
        return None
    lot, (guess, *law) = lot.some(known), numbers[:, known]

    def tell(states: States, ready: np.ndarray) -> None:
        for name, values in zip(LAW, law, strict=True):
            states.engine[name] = values[ready]

    taken = (QUICK_MAPS, QUICK_STEPS) if effort is Effort.QUICK else (MAX_MAPS, STEPS_PER_CALL)
    limits = Limits(*taken, MAX_MISSED)
    numbers = np.array([values[lot.places] for values in designs.values.values()]).T
    orbits = searched(_of_mass(lot, guess), mirrored, rtol, limits, total, tell, numbers)
    return None if orbits is None else orbits._replace(rows=_of_mass(orbits.rows, orbits.mass))


def _first_masses(design: Design) -> tuple[Any, ...]:
    """Guess of the mass, and the numbers by which it follows from stroke and work."""
    operation = Operation.guess(design.engine(1.0))
    guess = design.masses.masses(design.parameters, operation).total
    return guess, *mass_law(design, operation)


def _of_mass(rows: Rows, mass: np.ndarray) -> Rows:
    """Engines with a moving mass [kg] of their own."""
    return Rows(dataclasses.replace(rows.engine, translator=Translator(column(mass))), rows.places)


def _columns(
    designs: Designs, orbits: Orbits, rtol: float, multipliers: bool
) -> list[tuple[np.ndarray, Columns]]:
    """Columns of orbits, as :func:`saleg.design.many.design_row` has the row of one."""
    lots = []
    for chosen, components in by_branch(
        lambda rows: _components(designs, orbits.some(rows)), np.arange(len(orbits.mass))
    ):
        if components is None:
            continue
        found = orbits.some(chosen)
        error = np.broadcast_to(components["mass_error"], len(chosen))
        status, message = verdicts(found, rtol)
        message += np.array([closed_message(one) for one in error.tolist()], dtype=object)
        columns = columns_of(found, cycle_figures_of(found), status, message)
        columns |= {
            name: np.broadcast_to(np.asarray(value, dtype=float), len(chosen)).copy()
            for name, value in components.items()
        }
        steady = np.isin(status, [str(Status.STEADY), str(Status.IDLING)])
        for name in ("moving_mass", "power_density", "frequency_ratio"):
            columns[name] = np.where(steady, columns[name], math.nan)
        if multipliers:
            columns |= stability_columns(found, status)
        columns["score"] = scores(columns)
        agrees = np.abs(error) <= MASS_TOLERANCE * rtol
        if agrees.any():
            kept = {name: values[agrees] for name, values in columns.items()}
            lots.append((found.rows.places[agrees], kept))
    return lots


def scores(columns: Columns) -> np.ndarray:
    """Scores of rows; numpy's functions of arrays differ from those of numbers in the last bit."""
    return np.asarray(Score()(columns), dtype=float)


def _components(designs: Designs, found: Orbits) -> dict[str, Any]:
    """Figures of the components."""
    design = designs.some(found.rows.places)
    operation = Operation.of_strokes(found.strokes)
    masses = design.masses.masses(design.parameters, operation)
    figures = SimpleNamespace(**cycle_figures_of(found))
    return component_figures(design, found.rows.engine, operation, masses, figures)
