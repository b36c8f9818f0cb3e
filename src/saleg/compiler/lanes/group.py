"""Room for engines side by side, and what steps them."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.compiler.kernel import Kernel
from saleg.kernel import layout
from saleg.kernel.lanes.group import STEP_RECORD, Flat, Group, Rows
from saleg.kernel.tuples import Integration, Scratch, Snapshots, Tables, Words


def group_of(run: Integration, address: int, width: int) -> Group:
    """Room for engines side by side, as many as the width.

    Parameters
    ----------
    run : Integration
        Arguments of the integrator for one engine: their options are those of all.
    address : int
        Address of the integrator.
    width : int

    Returns
    -------
    Group
        With that engine at rest in every lane: a lane without one would compute what is no number,
        which takes long.
    """
    runs = _runs(run, width)
    step = np.zeros((width, 1), STEP_RECORD)
    flat = Flat(*(_as_numbers(part) for part in (runs.laws, runs.engine, runs.chambers, step)))
    rates = np.zeros((len(run.tableau.b) + 1) * layout.N_ALL)
    numbers = [*(part[0] for part in flat[:3]), run.y, run.y, rates, flat.step[0]]
    rows = Rows(*(np.repeat(part, width) for part in numbers))
    fresh, codes = np.zeros(width, np.int64), np.full(width, layout.NOT_FOUND)
    return Group(address, run.laws, runs, flat, rows, step, fresh, codes)


def address_of_steps(kernel: Kernel, group: Group, laws: np.ndarray) -> int:
    """Address of what steps a group, compiled if need be.

    Parameters
    ----------
    kernel : Kernel
        For engines side by side.
    group : Group
    laws : ndarray of one record
        Numbers of the laws of one engine, as their record.
    """
    return kernel.address("advance", (group._replace(law=laws),))


def _runs(run: Integration, width: int) -> Integration:
    """Arguments of the integrator for each lane."""

    def for_each(part: np.ndarray) -> Any:
        return np.repeat(part[np.newaxis], width, axis=0)

    def words_of(records: np.ndarray, *shape: int) -> Any:
        return records.view(np.int64).reshape(width, *shape, -1)

    engine, chambers = for_each(run.engine), for_each(run.chambers)
    begun = Snapshots(*map(for_each, run.snapshots))
    tables, spare = run.tables, run.scratch.spare
    return Integration(
        laws=for_each(run.laws),
        engine=engine,
        chambers=chambers,
        y=for_each(run.y),
        peaks=for_each(run.peaks),
        tableau=run.tableau,
        order=run.order,
        options=for_each(run.options),
        tables=Tables(
            strokes=for_each(tables.strokes),
            events=tables.events,
            history=tables.history,
            filled=for_each(tables.filled),
        ),
        snapshots=begun,
        words=Words(
            engine=words_of(engine, 1),
            chambers=words_of(chambers, 2),
            kept_engine=words_of(begun.engine, 2),
            kept_chambers=words_of(begun.chambers, 2, 2),
        ),
        scratch=Scratch(
            rates=for_each(run.scratch.rates),
            y_new=for_each(run.scratch.y_new),
            spare=spare._replace(trail=for_each(spare.trail), slopes=for_each(spare.slopes)),
        ),
        control=run.control,
    )


def _as_numbers(records: np.ndarray) -> np.ndarray:
    """Records as numbers in the same memory, a row per lane."""
    return records.view(np.float64).reshape(len(records), -1)
