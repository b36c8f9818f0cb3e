"""What is measured at a dead centre."""

from __future__ import annotations

import numpy as np

from saleg.kernel import layout
from saleg.kernel.control import write_signals
from saleg.laws.arguments import Signals
from saleg.simulation.initial_state import State


def measured(state: State) -> Signals:
    """Signals at a state."""
    values = np.zeros(1, layout.SIGNALS_RECORD).view(np.recarray)
    write_signals(*state.records, state.y, values[0])
    return Signals(*values[0].tolist())
