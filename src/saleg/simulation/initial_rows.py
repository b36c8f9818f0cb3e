"""From many engines to the numbers their runs begin with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from saleg.columns import by_branch
from saleg.compiler import plain
from saleg.engine import Engine
from saleg.engine.columns import Rows
from saleg.kernel import layout
from saleg.simulation.initial_state import State, initial_numbers, prepare

#: Rows from which it pays to prepare them together.
WORTH_IT = 6


class States(NamedTuple):
    """Everything that changes during runs, a row per engine.

    Attributes
    ----------
    engine : ndarray of ENGINE_RECORD, shape (n,)
    chambers : ndarray of CHAMBER_RECORD, shape (n, 2)
    y : ndarray, shape (n, N_ALL)
    """

    engine: np.ndarray
    chambers: np.ndarray
    y: np.ndarray

    @classmethod
    def of(cls, state: State) -> States:
        """The state of one engine as a row."""
        return cls(state.engine, state.chambers.reshape(1, 2), state.y.reshape(1, -1))

    def some(self, chosen: np.ndarray) -> States:
        """Copies of the states of some rows; these themselves if they are all of them."""
        if chosen.dtype == bool and chosen.all():
            return self
        return States(self.engine[chosen], self.chambers[chosen], self.y[chosen])

    def copy(self) -> States:
        """Copies of all states."""
        return States(self.engine.copy(), self.chambers.copy(), self.y.copy())

    def row(self, n: int) -> State:
        """Copy of the state of a row."""
        parts = self.engine[n : n + 1].copy(), self.chambers[n].copy(), self.y[n].copy()
        return State(*parts, np.zeros(layout.N_PEAKS))


def prepare_rows(rows: Rows, begun: Callable[[Engine], Engine]) -> tuple[States, np.ndarray]:
    """States of engines at the beginning of their runs, equal to :func:`.initial_state.prepare`.

    Parameters
    ----------
    rows : Rows
        Valid engines, whose laws have been checked.
    begun : callable
        Gives an engine, one or many, the start to begin with.

    Returns
    -------
    states : States
    ready : ndarray of bool
        Whether there is a state of a row; for what there is none of, `prepare` says why.
    """
    n = rows.count
    states = States(
        np.zeros(n, layout.ENGINE_RECORD),
        np.zeros((n, 2), layout.CHAMBER_RECORD),
        np.zeros((n, layout.N_ALL)),
    )
    ready = np.full(n, True)
    one_by_one = [np.arange(n)]
    if n >= WORTH_IT and _is_ours(rows.engine):
        kernel = plain.on_columns()
        lots = by_branch(
            lambda lot: initial_numbers(begun(rows.some(lot).engine), kernel),
            np.arange(n),
            WORTH_IT,
        )
        for lot, numbers in lots:
            if numbers is not None:
                _write(states, lot, *numbers)
        one_by_one = [lot for lot, numbers in lots if numbers is None]
    for k in (k for lot in one_by_one for k in lot.tolist()):
        try:
            state = prepare(begun(rows.row(k)))
        except Exception:  # whoever prepares it by itself will say
            ready[k] = False
            continue
        states.engine[k], states.chambers[k], states.y[k] = state.engine[0], state.chambers, state.y
    return states, ready


def _write(states: States, lot: np.ndarray, E: Any, C: list[Any], y: list[Any]) -> None:
    """Write columns of numbers into the rows of a lot."""
    where = slice(None) if len(lot) == len(states.y) else lot
    for name, values in vars(E).items():
        states.engine[name][where] = values
    for side, chamber in enumerate(C):
        for name, values in vars(chamber).items():
            states.chambers[name][where, side] = values
    for n, values in enumerate(y):
        states.y[where, n] = values


def _is_ours(engine: Engine) -> bool:
    """Whether all parts of an engine are the library's: they calculate with columns."""
    parts = [*engine.laws.values(), *engine.chambers, engine.translator, engine.start]
    return all(type(part).__module__.startswith("saleg.") for part in parts)
