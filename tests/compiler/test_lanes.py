"""The right-hand side for several engines side by side, against that of one as plain Python."""

import numpy as np

from breathing_engines import PORTS, single_piston
from saleg.compiler.compiled_engine import _laws_in_order
from saleg.compiler.module import load
from saleg.compiler.plain import _with_fields, plain_laws
from saleg.compiler.records import parameters
from saleg.compiler.text import compose
from saleg.kernel import layout
from saleg.kernel.rhs import refresh, rhs
from saleg.simulation.initial_state import prepare

WIDTH = 4
RATES = f"""
@cached
def constants(P, E, C, y):
    refresh(P[0], E[0], C, y)
    return 0


@cached
def rates(laws, law, engine, E1, chambers, C, t, y, dy):
    P, E = records_of(laws, law, {WIDTH}), records_of(engine, E1, {WIDTH})
    times = numbers_of(t, 1, {WIDTH})
    write_rates(
        P, E, rows_of(chambers, C, 2, {WIDTH}), times[0],
        numbers_of(y, N_ALL, {WIDTH}), numbers_of(dy, N_WANTED, {WIDTH}), 0,
    )
    return 0
"""
#: Of what stands in an exponential, whose rounding it magnifies.
LARGEST_LOGARITHM = 20.0
#: What none of the engines has: a motored pressure, a current, a frame, a crankcase on the right.
NOT_STEPPED = np.r_[
    layout.MOTORED : layout.N_STATE,
    layout.CRANKCASE_THETA + 1 : layout.FRAME_X : 2,
    layout.FRAME_X : layout.SUPPLIED,
    layout.CRANKCASE_WORK + 1,
    layout.MOUNT_LOSS,
]
MODES = (
    (layout.BURNING, layout.OPEN),
    (layout.CLOSED, layout.CLOSED),
    (layout.OPEN, layout.CLOSED),
    (layout.OPEN, layout.OPEN),
)


def instants(like):
    """An engine and its state per lane, each with other numbers and in other modes."""
    for lane, modes in enumerate(MODES):
        changes = {"left.bore": 0.06 + 0.002 * lane, "left.equivalence_ratio": 0.5 + 0.1 * lane}
        engine = like.replace(**changes)
        state = prepare(engine)
        state.y[layout.X] = 0.03 * (lane - 1)
        state.y[layout.FRESH] = 0.3 * state.y[layout.AIR]
        state.y[layout.V] = 5.0 + lane
        state.y[layout.THETA : layout.IGNITION] = 12.0 + 0.3 * lane, 12.5
        state.chambers["mode"] = modes
        state.chambers["armed"] = np.where(
            state.chambers["fuel"] > 0.0, layout.ARMED, layout.DISARMED
        )
        state.chambers["t_ignition"], state.chambers["duration"] = -1e-3, 5e-3
        state.chambers["fuel_to_burn"] = 1e-5
        yield engine, state


def in_rows(parts):
    """Numbers of all lanes in rows."""
    return np.array([part.view(np.float64).ravel() for part in parts]).T.ravel().copy()


def compiled_rates(engine):
    laws = _laws_in_order(engine, None)
    text = compose(tuple(map(type, laws)), width=WIDTH) + RATES
    return load(text, "test").module


def test_every_lane_has_the_rates_of_its_engine(base):
    assert largest_deviation(base, 15, layout.N_PLAIN) < 1e-14 * LARGEST_LOGARITHM


def test_every_lane_breathes_as_its_engine(base):
    # Of some flows only the difference counts.
    engine = single_piston(base, PORTS)
    assert largest_deviation(engine, 30, layout.N_ALL) < 1e-12 * LARGEST_LOGARITHM


def largest_deviation(like, least, length):
    """Largest relative deviation from the rates of plain Python; so many are not zero at least."""
    compiled = compiled_rates(like)
    laws, states, times = [], [], np.linspace(0.0, 1e-3, WIDTH)
    wanted = np.zeros((WIDTH, layout.N_ALL))
    for lane, (engine, state) in enumerate(instants(like)):
        P = plain_laws(_laws_in_order(engine, None))[0]
        E, C = _with_fields(state.engine)[0], _with_fields(state.chambers)
        refresh(P, E, C, state.y)
        rhs(P, E, C, times[lane], state.y, wanted[lane], 0)
        laws.append(parameters(_laws_in_order(engine, None)))
        compiled.constants(laws[-1], state.engine, state.chambers, state.y)
        states.append(state)
    found = np.full(length * WIDTH, 7.0)
    engine, chambers, y = (in_rows([s[n] for s in map(tuple_of, states)]) for n in range(3))
    like = states[0].engine, states[0].chambers
    compiled.rates(in_rows(laws), laws[0], engine, like[0], chambers, like[1], times, y, found)
    by_lane = found.reshape(length, WIDTH).T
    stepped = np.setdiff1d(np.arange(length), NOT_STEPPED)
    assert (np.abs(wanted[:, stepped]).max(axis=0) > 0.0).sum() > least
    off = np.abs(by_lane[:, stepped] - wanted[:, stepped]) / np.abs(wanted[:, stepped]).clip(1e-300)
    return off.max()


def tuple_of(state):
    """Records and vector of a state."""
    return state.engine, state.chambers, state.y
