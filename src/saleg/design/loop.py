"""The closed loop: a moving mass and a steady state that belong together.

The components are sized for the steady state, which depends on their mass: one more unknown. The
mass is an entry of the vector whose fixed point is looked for, renewed by every map from stroke and
work, so that the loop costs hardly more than a steady state of a given mass.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import chain, repeat
from typing import Any, NamedTuple

import numpy as np

from saleg.checks import a, checked
from saleg.design.designs import Design, InvalidDesign
from saleg.design.operation import Operation
from saleg.design.parameters import Parameters
from saleg.design.results import DesignedState
from saleg.engine import Engine, Translator, warn_of_unusual
from saleg.engine.start import CompressedCharge
from saleg.kernel import layout
from saleg.kernel.vector import read_vector, write_vector
from saleg.quantities import Problem
from saleg.simulation.course import STEPS_PER_CALL
from saleg.simulation.initial_state import State, prepare
from saleg.status import Status
from saleg.steady.return_map import ReturnMap
from saleg.steady.slow_states import find_settled, finer, is_sharp
from saleg.steady.solver import (
    DEFAULT_TOLERANCE,
    MAX_MAPS,
    QUICK_MAPS,
    QUICK_STEPS,
    RESIDUAL,
    Effort,
    check_effort,
    check_tolerance,
    converged,
    not_found,
    result_of,
    starts,
    waited_for,
)
from saleg.steady.state import SteadyState
from saleg.steady.symmetry import is_symmetric, repeats_itself

#: Relative difference allowed between the mass of the orbit and that of the components, over the
#: tolerance of the integrator.
MASS_TOLERANCE = 1.0
#: Orbits tried until the mass is that of the components; one will do for Eq. 60-67.
MAX_ORBITS = 15
#: Relative step of differences of the mass, and the fields of the engine's record they go into.
STEP = 1e-3
#: How a map is told its mass, given the operation of the last orbit.
Way = Callable[[State, Design, Operation], None]
LAW = ("mass_fixed", "mass_per_stroke", "mass_per_work")
#: Simulations that try to find mass and motion together where no fixed point is found, and strokes
#: at their end over which stroke, frequency and power are averaged.
MAX_SIMULATIONS = 15
LAST_STROKES = 20
#: Continuation from the base case: first and least step as shares of the way, and most steps.
FIRST_STEP, MIN_STEP, MAX_STEPS = 0.25, 1.0 / 512.0, 60


class Spent(NamedTuple):
    """Work done on starts that led nowhere."""

    half_cycles: int = 0
    evaluations: int = 0


@checked(near=a(DesignedState).optional)
def solve(
    design: Design,
    *,
    rtol: float = DEFAULT_TOLERANCE,
    near: DesignedState | None = None,
    effort: Effort = Effort.THOROUGH,
) -> DesignedState:
    """Masses, dimensions and steady state of a design, solved together.

    Parameters
    ----------
    design : Design
    rtol : float
        Tolerance of the integrator, of the state after a return, and of the mass [-].
    near : DesignedState, optional
        A neighbour's orbit to start from, which follows its branch where there are several.
    effort : Effort
        ``Effort.QUICK`` ends with "not found" where the standard starts lead to no orbit.

    Returns
    -------
    DesignedState
        Always with a status and a message. Where the standard starts lead to no orbit it is
        followed from the base case with the same laws, all eight parameters changing together; the
        method is then "continuation". Without a steady state masses and dimensions are those for
        the mean of the last simulated strokes, and the moving mass is a guess. "unsteady" is also
        what repeats itself with another mass than that of its components.

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
    (2.38, True)
    """
    rtol = check_tolerance(rtol)
    check_effort(effort)
    check_design(design)
    design.validate()
    engine = design.engine(1.0)
    guess = _mass(design, Operation.guess(engine))
    if not repeats_itself(engine):
        why = "a law depends on time or counts charges"
        if effort is Effort.QUICK:
            return _nothing(design, guess, Spent(), why)
        return _simulated(design, guess, rtol, Spent(), why)
    mirrored = is_symmetric(engine)
    if effort is Effort.QUICK:
        return _quick(design, guess, rtol, mirrored, near)
    charts = _charts(design, guess, rtol, mirrored, near)
    one_by_one = _charts(design, guess, rtol, mirrored, None)
    ways = chain(zip(charts, repeat(_set_law)), zip(one_by_one, repeat(_set_mass)))
    found, spent = _first_orbit(design, ways, rtol, Spent())
    if found is not None:
        return _closed_message(found)
    found, spent = _continued(design, rtol, mirrored, spent)
    if found is not None:
        return _continued_message(found)
    why = "the return map did not settle, and no orbit could be followed from the base case"
    return _simulated(design, guess, rtol, spent, why)


def _quick(
    design: Design, guess: float, rtol: float, mirrored: bool, near: DesignedState | None
) -> DesignedState:
    """Orbit from the standard starts, or the word that they lead to none."""
    charts = _charts(design, guess, rtol, mirrored, near, QUICK_STEPS)
    ways = zip(charts, repeat(_set_law))
    found, spent = _first_orbit(design, ways, rtol, Spent(), quick=True)
    if found is not None:
        return _closed_message(found)
    return _nothing(design, guess, spent, "no orbit from the standard starts")


def _nothing(design: Design, mass: float, spent: Spent, why: str) -> DesignedState:
    """What a quick search has to say where it has found nothing; the mass is a guess."""
    engine = design.engine(mass)
    return DesignedState.of(not_found(engine, *spent, why), design, Operation.guess(engine))


def evaluate(
    design: Design | None = None,
    *,
    rtol: float = DEFAULT_TOLERANCE,
    effort: Effort = Effort.THOROUGH,
    **values: Any,
) -> DesignedState:
    """Evaluate a design: from the eight parameters of Table 8 to a steady state.

    Parameters
    ----------
    design : Design, optional
        Laws, mass models and parameters not given; those of Chapter 4 unless given.
    rtol : float
        Tolerance of the integrator [-].
    effort : Effort
        As for :func:`solve`.
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
    (True, 0.083)
    """
    design = Design() if design is None else design
    check_design(design)
    found = solve(design.replace(values), rtol=rtol, effort=effort)
    warn_of_unusual(found.engine)
    return found


def check_design(design: Any) -> None:
    """Refuse what is no design; raises InvalidDesign."""
    if not isinstance(design, Design):
        need = "must be a saleg.design.Design, as Design().replace(bore=0.06); names go as keywords"
        raise InvalidDesign([Problem("design", design, "-", need)])


def _mass(design: Design, operation: Operation) -> float:
    return design.masses.masses(design.parameters, operation).total


def _charts(
    design: Design,
    guess: float,
    rtol: float,
    mirrored: bool,
    near: DesignedState | None,
    most_steps: int = STEPS_PER_CALL,
) -> Iterator[ReturnMap]:
    """Return maps to try."""
    if near is not None:
        yield from _near_chart(design, rtol, mirrored, near)
    engine = design.engine(guess)
    for start in starts(engine):
        state = prepare(replace(engine, start=start))
        yield ReturnMap.of(engine, state, rtol, mirrored, most_steps)


def _first_orbit(
    design: Design,
    ways: Iterable[tuple[ReturnMap, Way]],
    rtol: float,
    spent: Spent,
    quick: bool = False,
) -> tuple[DesignedState | None, Spent]:
    """The first orbit some return maps lead to, and the work done so far."""
    for chart, way in ways:
        orbit = _closed(design, chart, rtol, way, quick)
        spent = Spent(spent.half_cycles + orbit.half_cycles, spent.evaluations + chart.evaluations)
        if not orbit.found:
            continue
        if not orbit.sharp:
            sharper = chart.finer(finer(rtol))
            again = _closed(design, sharper, finer(rtol), way, quick)
            anew = sharper.evaluations - chart.evaluations
            spent = Spent(spent.half_cycles + again.half_cycles, spent.evaluations + anew)
            if not again.found:
                continue
            chart, orbit, rtol = sharper, again, finer(rtol)
        steady = result_of(chart, *spent, orbit.residual, "fixed point", rtol)
        return DesignedState.of(steady, design, orbit.operation), spent
    return None, spent


def _continued(
    design: Design, rtol: float, mirrored: bool, spent: Spent
) -> tuple[DesignedState | None, Spent]:
    """Orbit followed from the base case with the same laws, all parameters changing together.

    A step that finds no orbit is halved. What lies beyond a fold is not found so.
    """
    origin, goal = dataclasses.replace(design, parameters=Parameters()), design.parameters
    if goal == origin.parameters:
        return None, spent
    guess = _mass(origin, Operation.guess(origin.engine(1.0)))
    ways = zip(_charts(origin, guess, rtol, mirrored, None), repeat(_set_law))
    near, spent = _first_orbit(origin, ways, rtol, spent)
    share, step = 0.0, FIRST_STEP
    for _ in range(MAX_STEPS):
        if near is None or step < MIN_STEP:
            break
        ahead = min(share + step, 1.0)
        target = design if ahead == 1.0 else _between(origin, goal, ahead)
        found, spent = _from_near(target, rtol, mirrored, near, spent)
        if found is None:
            step *= 0.5
        elif ahead == 1.0:
            return found, spent
        else:
            near, share, step = found, ahead, 1.5 * step
    return None, spent


def _between(origin: Design, goal: Parameters, share: float) -> Design:
    """Design a share of the way from one to the parameters of another."""
    ends = dataclasses.asdict(origin.parameters), dataclasses.asdict(goal)
    return origin.replace({name: a + share * (ends[1][name] - a) for name, a in ends[0].items()})


def _from_near(
    design: Design, rtol: float, mirrored: bool, near: DesignedState, spent: Spent
) -> tuple[DesignedState | None, Spent]:
    """Orbit of a design from that of its neighbour alone."""
    ways = (
        (chart, way)
        for way in (_set_law, _set_mass)
        for chart in _near_chart(design, rtol, mirrored, near)
    )
    found, spent = _first_orbit(design, ways, rtol, spent)
    return (found if found is not None and found.found else None), spent


def _near_chart(
    design: Design, rtol: float, mirrored: bool, near: DesignedState
) -> Iterator[ReturnMap]:
    """Return map that begins at a neighbour's orbit, if it can."""
    if near.replay is None:
        return
    engine = design.engine(near.moving_mass)
    state = near_state(engine, near)
    if state is not None:
        yield ReturnMap.of(engine, state, rtol, mirrored)


def near_state(engine: Engine, near: SteadyState) -> State | None:
    """State of an engine at the left dead centre of a neighbour's orbit.

    The same in the dimensionless numbers in which states are compared; None if the neighbour's
    chambers are not in the same modes there.
    """
    assert near.replay is not None
    theirs = near.replay.start
    position = float(theirs.y[layout.X]) / (0.5 * near.engine.maximum_stroke)
    burning = float(theirs.chambers[0]["mode"] == layout.BURNING)
    state = prepare(replace(engine, start=CompressedCharge(position=position, burning=burning)))
    if [*state.chambers["mode"]] != [*theirs.chambers["mode"]]:
        return None
    state.chambers["armed"] = theirs.chambers["armed"]
    z = np.empty(layout.N_VECTOR)
    write_vector(*theirs.records, theirs.y, z)
    read_vector(*state.records, state.y, z)
    return state


class _Orbit(NamedTuple):
    """What closing the loop on one return map came to."""

    found: bool
    sharp: bool
    half_cycles: int
    residual: float
    operation: Operation


def _closed(design: Design, chart: ReturnMap, rtol: float, way: Way, quick: bool) -> _Orbit:
    """Find an orbit whose mass is that of its components; the chart then holds its engine too."""
    spent, operation = 0, Operation.guess(chart.engine)
    most = QUICK_MAPS if quick else MAX_MAPS
    for _ in range(MAX_ORBITS):
        way(chart.state, design, operation)
        found, strokes = find_settled(chart, most, RESIDUAL * rtol, patient=not quick)
        spent += strokes
        if found.code != layout.END_OF_TIME:
            break
        operation = Operation.of_strokes(chart.strokes[:2])
        mass = float(chart.state.engine["mass"][0])
        if abs(_mass(design, operation) / mass - 1.0) <= MASS_TOLERANCE * rtol:
            chart.engine = dataclasses.replace(chart.engine, translator=Translator(mass))
            _give_mass(chart)
            sharp = is_sharp(chart, found, rtol)
            return _Orbit(converged(found, rtol), sharp, spent, found.missed, operation)
    return _Orbit(False, False, spent, math.nan, operation)


def _set_mass(state: State, design: Design, operation: Operation) -> None:
    """Give the map the mass for an operation: slower, but finds orbits the other way may miss."""
    state.engine["mass"] = _mass(design, operation)


def _set_law(state: State, design: Design, operation: Operation) -> None:
    """Tell the map how the mass follows from stroke and work, anew after every orbit."""
    for name, value in zip(LAW, mass_law(design, operation), strict=True):
        state.engine[name] = value


def mass_law(design: Design, operation: Operation) -> tuple[float, float, float]:
    """Numbers m_0, m_S and m_W of the mass as it follows from stroke S and work W of a stroke.

    ``m_0 + m_S S + m_W W^2 / S^3`` is what Eq. 60-67 come to; other mass models are given its
    tangent at an operation.
    """
    S, W = operation.stroke, 0.5 * operation.power / operation.frequency
    total = _mass(design, operation)
    by_work = _mass(design, operation._replace(power=(1.0 + STEP) * operation.power)) - total
    longer = operation._replace(stroke=(1.0 + STEP) * S)
    by_stroke = (_mass(design, longer) - total) / (STEP * S)
    # d(W^2/S^3) = 2 W dW / S^3 - 3 W^2 dS / S^4; differences of (1 + STEP)^2 - 1 and the like.
    load = W**2 / S**3
    per_work = by_work / (load * ((1.0 + STEP) ** 2 - 1.0)) if load > 0.0 else 0.0
    per_stroke = by_stroke - per_work * load * ((1.0 + STEP) ** -3 - 1.0) / (STEP * S)
    fixed = total - per_stroke * S - per_work * load
    return (fixed, per_stroke, per_work) if fixed > 0.0 else (total, 0.0, 0.0)


def _give_mass(chart: ReturnMap) -> None:
    """From now on the mass is given: what disturbs the orbit does not rebuild the engine."""
    for record in (chart.state.engine, chart.snapshots.engine):
        for name in LAW:
            record[name] = 0.0


def _closed_message(state: DesignedState) -> DesignedState:
    state.message += closed_message(state.mass_error)
    return state


def closed_message(mass_error: float) -> str:
    """How well the mass of the components is that of the orbit."""
    return f"; the mass of the components is that of the orbit to {mass_error:.1e}"


def _continued_message(state: DesignedState) -> DesignedState:
    state.method = "continuation"
    state.message += "; none was found from the standard starts, it was followed from the base case"
    return _closed_message(state)


def _simulated(design: Design, mass: float, rtol: float, spent: Spent, why: str) -> DesignedState:
    """Simulate and size the components for how that ends, until both agree or never will."""
    for _ in range(MAX_SIMULATIONS):
        steady = waited_for(design.engine(mass), rtol, *spent, why)
        assert steady.fallback is not None
        strokes = steady.strokes if len(steady.strokes) else steady.fallback.strokes[-LAST_STROKES:]
        if not len(strokes):
            return DesignedState.of(steady, design, Operation.guess(steady.engine))
        state = DesignedState.of(steady, design, Operation.of_strokes(strokes))
        if not steady.found or abs(state.mass_error) <= MASS_TOLERANCE * rtol:
            return state
        mass, spent = state.masses.total, Spent(steady.half_cycles, steady.evaluations)
    state.status = Status.UNSTEADY
    state.message += (
        f"; but after {MAX_SIMULATIONS} simulations the mass of the components still differs from "
        f"that of the orbit by {state.mass_error:.1e}"
    )
    return state
