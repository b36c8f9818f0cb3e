"""The closed loop: a moving mass and a steady state that belong together.

The components are sized for the steady state, which depends on their mass: one more unknown. What
the mass sizes is stroke, frequency and power, and these hardly feel it (a mass 10 % off gives one
that is about 0.2 % off), so a few secant steps suffice, each from the orbit of the last.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from saleg.design.designs import Design
from saleg.design.operation import Operation
from saleg.design.results import DesignedState
from saleg.engine import Engine, Translator
from saleg.kernel import layout
from saleg.kernel.orbit import read_vector, write_vector
from saleg.prepare import State, prepare
from saleg.return_map import Fields, ReturnMap, is_symmetric, repeats_itself
from saleg.start import CompressedCharge, Start
from saleg.steady import (
    DEFAULT_TOLERANCE,
    MOST_MAPS,
    RESIDUAL,
    SteadyState,
    check_tolerance,
    converged,
    result_of,
    starts,
    waited_for,
)

#: Relative difference allowed between the mass of the orbit and that of the components, over the
#: tolerance of the integrator.
MASS_TOLERANCE = 1.0
#: Maps after which the first guess of the mass is improved.
FIRST_MAPS = 7
#: Orbits tried; dependence of the mass wanted on the mass given before it is known, its greatest
#: magnitude, and the change below which the noise of the orbits hides it.
MOST_ORBITS = 15
TYPICAL_SLOPE, MOST_SLOPE = -0.02, 0.5
LEAST_CHANGE = 1e-4
#: Fields of the engine's record that count, and whole numbers at the head of a chamber's.
COUNTS = ["strokes", "steps", "steps_at_dead_centre", "rejected", "evaluations"]
N_MODES = [layout.CHAMBER_RECORD[name] for name in layout.CHAMBER_RECORD.names or ()].count(
    np.dtype(np.int64)
)
#: Where no strokes were completed.
NOWHERE = Operation(0.0, 0.0, 0.0)
#: Simulations that try to find mass and motion together where no fixed point is found, and strokes
#: at their end over which stroke, frequency and power are averaged.
MOST_SIMULATIONS = 3
LAST_STROKES = 20


class Spent(NamedTuple):
    """Work done on starts that led nowhere."""

    half_cycles: int = 0
    evaluations: int = 0


def solve(
    design: Design,
    *,
    rtol: float = DEFAULT_TOLERANCE,
    near: DesignedState | None = None,
) -> DesignedState:
    """Masses, dimensions and steady state of a design, solved together.

    Parameters
    ----------
    design : Design
    rtol : float
        Tolerance of the integrator, of the state after a return, and of the mass.
    near : DesignedState, optional
        A neighbour's orbit to start from: faster, and follows its branch where there are several.

    Returns
    -------
    DesignedState
        Always with a status and a message. Without a steady state masses and dimensions are those
        for the mean of the last simulated strokes.

    Raises
    ------
    InvalidDesign, InvalidEngine
        Naming every wrong field.
    SettingsError
        If the tolerance makes no sense.

    Examples
    --------
    >>> found = solve(Design())
    >>> round(found.moving_mass, 2), abs(found.mass_error) < 1e-6
    (2.33, True)
    """
    check_tolerance(rtol)
    design.validate()
    engine = design.engine(1.0)
    guess = _mass(design, Operation.guess(engine))
    if not repeats_itself(engine):
        why = "a law depends on time or counts charges"
        return _simulated(design, guess, rtol, Spent(), why)
    mirrored = is_symmetric(engine)
    spent = Spent()
    for chart, maps in _charts(design, guess, rtol, mirrored, near):
        orbit = _closed(design, chart, rtol, maps)
        spent = Spent(spent.half_cycles + orbit.half_cycles, spent.evaluations + chart.evaluations)
        if orbit.found:
            steady = result_of(chart, *spent, orbit.residual, "fixed point", rtol)
            return _closed_message(DesignedState.of(steady, design, orbit.operation))
    return _simulated(design, guess, rtol, spent, "the return map did not settle")


def evaluate(
    design: Design | None = None,
    *,
    rtol: float = DEFAULT_TOLERANCE,
    **values: Any,
) -> DesignedState:
    """Evaluate a design: from the eight parameters of Table 8 to a steady state.

    Parameters
    ----------
    design : Design, optional
        Laws, mass models and parameters not given; those of Chapter 4 unless given.
    rtol : float
        Tolerance.
    **values
        The eight parameters (SI): bore, half_stroke, port_location, spring_stiffness,
        intake_pressure, intake_temperature, equivalence_ratio, egr. Further paths of the engine or
        of the mass models as for :meth:`Design.replace`.

    Returns
    -------
    DesignedState
        With ``moving_mass``, ``masses`` and ``geometry``.

    Examples
    --------
    >>> import saleg
    >>> found = saleg.design.evaluate(bore=0.06)
    >>> found.stable, round(found.geometry.mover_outer_diameter, 3)
    (True, 0.084)
    """
    return solve((design or Design()).replace(values), rtol=rtol)


def _mass(design: Design, operation: Operation) -> float:
    return float(design.masses.masses(design.parameters, operation).total)


def _charts(
    design: Design, guess: float, rtol: float, mirrored: bool, near: DesignedState | None
) -> Iterator[tuple[ReturnMap, int]]:
    """Return maps to try, with the maps before the mass is improved first."""
    if near is not None and near.replay is not None:
        engine = design.engine(near.moving_mass)
        state = near_state(engine, near)
        if state is not None:
            yield ReturnMap.of(engine, state, rtol, mirrored), 0
    engine = design.engine(guess)
    for start in starts(engine):
        yield _chart(engine, start, rtol, mirrored), FIRST_MAPS


def _chart(engine: Engine, start: Start, rtol: float, mirrored: bool) -> ReturnMap:
    return ReturnMap.of(engine, prepare(replace(engine, start=start)), rtol, mirrored)


def near_state(engine: Engine, near: SteadyState) -> State | None:
    """State of an engine at the left dead centre of a neighbour's orbit.

    The same in the dimensionless numbers in which states are compared; None if the neighbour's
    chambers are not in the same modes there.
    """
    assert near.replay is not None
    E, C, y = (part[1] for part in near.replay.snapshot)
    position = float(y[layout.X]) / (0.5 * near.engine.maximum_stroke)
    burning = float(C[0]["mode"] == layout.BURNING)
    state = prepare(replace(engine, start=CompressedCharge(position=position, burning=burning)))
    if [*state.chambers["mode"]] != [*C["mode"]]:
        return None
    z = np.empty(layout.N_VECTOR)
    write_vector(Fields(E), [Fields(c) for c in C], y, z)
    # Attributes of a record array's elements write through to the record.
    chambers = state.chambers.view(np.recarray)
    read_vector(state.engine.view(np.recarray)[0], [chambers[0], chambers[1]], state.y, z)
    return state


class _Orbit(NamedTuple):
    """What closing the loop on one return map came to."""

    found: bool
    half_cycles: int
    residual: float
    operation: Operation


def _closed(design: Design, chart: ReturnMap, rtol: float, maps: int) -> _Orbit:
    """Iterate orbit and mass until they agree; the chart then holds the orbit with its engine."""
    mass = float(chart.engine.translator.mass)
    slope, spent = TYPICAL_SLOPE, 0
    if maps:
        code, found = chart.find(maps, 0.0)
        spent += int(found[0] * chart.strokes_per_map)
        if code != layout.NOT_FOUND:
            return _Orbit(False, spent, math.nan, NOWHERE)
        wanted = _mass(design, Operation.of_strokes(chart.strokes[: int(chart.strokes_per_map)]))
        mass += (wanted - mass) / (1.0 - slope)
    before: _Tried | None = None
    for _ in range(MOST_ORBITS):
        chart.state.engine["mass"] = mass
        code, found = chart.find(MOST_MAPS, RESIDUAL * rtol)
        spent += int(found[0] * chart.strokes_per_map)
        if code != layout.END_OF_TIME:
            break
        spent += 2
        operation = Operation.of_strokes(chart.strokes[:2])
        now = _Tried(mass, _mass(design, operation), chart.state.copy())
        if abs(now.wanted / mass - 1.0) <= MASS_TOLERANCE * rtol:
            chart.engine = dataclasses.replace(chart.engine, translator=Translator(mass))
            return _Orbit(converged(code, found, rtol), spent, float(found[2]), operation)
        slope = _slope(before, now, slope)
        mass += (now.wanted - mass) / (1.0 - slope)
        if before is not None:
            _extrapolate(chart.state, before, now, mass)
        before = now
    return _Orbit(False, spent, math.nan, NOWHERE)


class _Tried(NamedTuple):
    """A mass given, the mass wanted on its orbit, and the state there."""

    given: float
    wanted: float
    state: State


def _extrapolate(state: State, before: _Tried, now: _Tried, mass: float) -> None:
    """Move a state to where the orbits of the last two masses point; counts stay as they are."""
    if abs(now.given - before.given) < LEAST_CHANGE * now.given:
        return
    if [*before.state.chambers["mode"]] != [*now.state.chambers["mode"]]:
        return
    share = (mass - now.given) / (now.given - before.given)
    if abs(share) > 1.0:
        return
    for held, new, old in zip(
        _floats(state), _floats(now.state), _floats(before.state), strict=True
    ):
        held += share * (new - old)
    state.engine[COUNTS] = now.state.engine[COUNTS]


def _floats(state: State) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All numbers of a state but the modes of its chambers, in place."""
    chambers = state.chambers.view(np.float64).reshape(2, -1)
    return state.engine.view(np.float64), chambers[:, N_MODES:], state.y


def _slope(before: _Tried | None, now: _Tried, known: float) -> float:
    """Dependence of the mass wanted on the mass given, from the last two orbits."""
    if before is None or abs(now.given - before.given) < LEAST_CHANGE * now.given:
        return known
    slope = (now.wanted - before.wanted) / (now.given - before.given)
    return min(max(slope, -MOST_SLOPE), MOST_SLOPE)


def _closed_message(state: DesignedState) -> DesignedState:
    state.message += f"; the mass of the components is that of the orbit to {state.mass_error:.1e}"
    return state


def _simulated(design: Design, mass: float, rtol: float, spent: Spent, why: str) -> DesignedState:
    """Simulate and size the components for how that ends, until both agree or never will."""
    for _ in range(MOST_SIMULATIONS):
        steady = waited_for(design.engine(mass), rtol, *spent, why)
        assert steady.fallback is not None
        strokes = steady.strokes if len(steady.strokes) else steady.fallback.strokes[-LAST_STROKES:]
        if not len(strokes):
            return DesignedState.of(steady, design, Operation.guess(steady.engine))
        state = DesignedState.of(steady, design, Operation.of_strokes(strokes))
        if not steady.found or abs(state.mass_error) <= MASS_TOLERANCE * rtol:
            break
        mass, spent = state.masses.total, Spent(steady.half_cycles, steady.evaluations)
    return state
