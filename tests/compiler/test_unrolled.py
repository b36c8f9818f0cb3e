"""The step of the adaptive pair as it is written out, run as Python where the end is known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from saleg.compiler.needs import Needs
from saleg.compiler.unrolled import adaptive_step
from saleg.kernel import adaptive, layout
from saleg.laws import CircuitAlternator, LinearLoad, PortFlow, Woschni


def growth(P, E, C, t, y, dy, motored):
    """y' = y for states, their time for quadratures."""
    dy[:] = y
    dy[layout.N_STATE :] = t


def names_of(needs):
    """What the text of a step defines."""
    names = {"compiled": lambda f: f, "inline": lambda f: f, "write_rates": growth}
    exec(adaptive_step(needs.states, needs.kept, needs.sums), names)
    return names


def step_of(needs, h):
    """End of a step from 1, 2, 3 ..., and the estimated error of position."""
    names = names_of(needs)
    y = np.arange(1.0, layout.N_ALL + 1.0)
    k, y_new = np.zeros((7, layout.N_ALL)), np.full(layout.N_ALL, math.nan)
    k[0] = y
    k[0, layout.N_STATE :] = 0.0
    E = SimpleNamespace(evaluations=0.0)
    names["take_adaptive_step"](None, E, None, 0.0, h, y, k, y_new, 0)
    assert E.evaluations == 6.0
    return y, y_new, h * names["defect"](k, layout.X)


@pytest.mark.parametrize("motored", [False, True])
@pytest.mark.parametrize("current", [False, True])
def test_a_step_is_of_fifth_order_and_leaves_alone_what_nobody_needs(motored, current):
    needs = Needs(motored_pressure=motored, current=current)
    h = 0.1
    y, y_new, error = step_of(needs, h)
    grown = y[: layout.N_STATE] * math.exp(h)
    wanted = grown.copy()
    if not motored:
        wanted[layout.MOTORED : layout.CURRENT] = y[layout.MOTORED : layout.CURRENT]
    if not current:
        wanted[layout.CURRENT] = y[layout.CURRENT]
    assert y_new[: layout.N_STATE] == pytest.approx(wanted, rel=h**6 / math.factorial(6))
    sums = slice(layout.N_STATE, layout.N_PLAIN)
    assert y_new[sums] == pytest.approx(y[sums] + h**2 / 2, rel=1e-14)
    assert np.isnan(y_new[layout.N_PLAIN :]).all()  # nobody asks for these: not even copied
    assert 0.0 < abs(error) < h**5 / math.factorial(5)
    halved = step_of(needs, h / 2)[2]
    assert error / halved == pytest.approx(32.0, rel=0.1)


def test_an_engine_needs_what_its_laws_ask_for():
    plain = Needs.of([Woschni, LinearLoad], motored_pressure=False)
    assert plain == Needs(motored_pressure=False, current=False)
    circuit = Needs.of([Woschni, CircuitAlternator], motored_pressure=True)
    assert circuit == Needs(motored_pressure=True, current=True)


def test_a_step_takes_along_the_states_that_laws_ask_for():
    needs = Needs.of([PortFlow, LinearLoad], motored_pressure=False)
    assert needs.chambers == {"contents"}
    h = 0.1
    y, y_new, _ = step_of(needs, h)
    contents, totals = slice(layout.FUEL, layout.WALL), slice(layout.SUPPLIED, layout.MOUNT_LOSS)
    # Their rate is the time here, as that of all entries beyond the first states.
    assert y_new[contents] == pytest.approx(y[contents] + h**2 / 2, rel=1e-14)
    assert y_new[totals] == pytest.approx(y[totals] + h**2 / 2, rel=1e-14)
    kept = slice(layout.WALL, layout.SUPPLIED)
    assert np.array_equal(y_new[kept], y[kept])


def test_a_second_estimate_of_the_error_is_written_out_too():
    needs = Needs.of([Woschni, LinearLoad], motored_pressure=False)
    names, n = names_of(needs), layout.IGNITION
    rng = np.random.default_rng(0)
    for _ in range(100):
        k = rng.uniform(0.0, 12.0, (7, layout.N_ALL))
        assert names["late_defect"](k, n) == pytest.approx(adaptive.late_defect(k, n), abs=1e-12)
        grows = k[6, n] > adaptive.MANIFOLD * k[0, n]
        assert names["grows_manifold"](k, n) == adaptive.grows_manifold(k, n) == grows
        k[5] = k[6]  # the last stage and the end of the step see the same
        assert names["late_defect"](k, n) == pytest.approx(names["defect"](k, n), abs=1e-12)
