"""Entries of the vector of a dead centre that an engine never changes, or keeps for ever."""

from __future__ import annotations

from collections.abc import Sequence

from saleg.engine import BounceChamber, Chamber, Engine, OpenEnd
from saleg.kernel import layout
from saleg.kernel.vector import (
    Z_AMPERES,
    Z_CHAMBERS,
    Z_CRANKCASE_BURNT,
    Z_CRANKCASE_MASS,
    Z_FRAME_V,
    Z_FRAME_X,
    Z_FRESH,
    Z_INTEGRAL,
    Z_LN_CLOSING_PRESSURE,
    Z_LN_CLOSING_TEMPERATURE,
    Z_LN_CRANKCASE,
    Z_LN_LIT,
    Z_LN_MOTORED,
    Z_LN_PRESSURE,
    Z_RATIO,
    Z_WALL,
)
from saleg.laws import NoHeatTransfer
from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import Alternator

#: Hot gas in motion and its charge, to which every wall that takes heat has a coefficient.
PROBE_GAS = Gas(30e5, 900.0, 1e-4, 20e5, 0.03, 0.06, 8.0, 450.0, 0.0, -5.0)
PROBE_CHARGE = Charge(1e-4, 0.0, 1e-4, 0.0, 0.0, 1e5, 300.0, 4e-4, 3e-4)
#: Entries of the vector, per side, for the states that laws ask for; masses have entries anyway.
ENTRIES_OF_STATES = {
    "contents": (Z_FRESH, Z_LN_LIT, Z_LN_CLOSING_PRESSURE, Z_LN_CLOSING_TEMPERATURE),
    "wall_temperature": (Z_WALL,),
    "crankcase": (Z_LN_CRANKCASE, Z_CRANKCASE_MASS, Z_CRANKCASE_BURNT),
}


def constant_entries(engine: Engine) -> set[int]:
    """Entries of the vector that nothing can change: a current that is not, a sealed charge."""
    kept = set()
    if type(engine.alternator).current_rate is Alternator.current_rate:
        kept.add(Z_AMPERES)
    if "frame" not in engine.frame.states:
        kept |= {Z_FRAME_X, Z_FRAME_V}
    for side, chamber in enumerate(engine.chambers):
        first = Z_CHAMBERS + layout.VECTOR_PER_SIDE * side
        if isinstance(chamber, OpenEnd):
            kept |= {first + n for n in range(layout.VECTOR_PER_SIDE)}
        elif chamber.is_sealed:
            kept |= {first + n for n in range(layout.VECTOR_PER_SIDE)}
            kept -= {first + Z_LN_PRESSURE, first + Z_LN_MOTORED, first + Z_WALL}
        elif isinstance(chamber, BounceChamber):  # gas flows, but no charge is composed
            kept |= {first + Z_INTEGRAL, first + Z_RATIO, first + Z_LN_LIT}
            kept |= {first + Z_LN_CLOSING_PRESSURE, first + Z_LN_CLOSING_TEMPERATURE}
        if not engine.needs_motored_pressure:
            kept.add(first + Z_LN_MOTORED)
    return kept | unused_entries(engine)


def unused_entries(engine: Engine) -> set[int]:
    """Entries of the vector for states of the chambers that none of their laws asks for."""
    return {
        Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n
        for side, chamber in enumerate(engine.chambers)
        for name, entries in ENTRIES_OF_STATES.items()
        if name not in chamber.states
        for n in entries
    }


def conserved_entries(engine: Engine) -> set[int]:
    """Entries of the vector that hold the entropy of sealed chambers without heat transfer."""
    return sealed_entries(engine, [is_adiabatic(chamber) for chamber in engine.chambers])


def sealed_entries(engine: Engine, wanted: Sequence[bool] = (True, True)) -> set[int]:
    """Entries of the vector for the pressures in those chambers that never open."""
    entries = [Z_LN_PRESSURE] + [Z_LN_MOTORED] * engine.needs_motored_pressure
    return {
        Z_CHAMBERS + layout.VECTOR_PER_SIDE * side + n
        for side, chamber in enumerate(engine.chambers)
        if wanted[side] and chamber.is_sealed
        for n in entries
    }


def is_adiabatic(chamber: Chamber) -> bool:
    """Whether a chamber is sealed and without heat transfer, so that it keeps its entropy."""
    if not chamber.is_sealed:
        return False
    law = chamber.heat_transfer  # type: ignore[attr-defined]
    return isinstance(law, NoHeatTransfer) or law.coefficient(PROBE_GAS, PROBE_CHARGE) == 0.0
