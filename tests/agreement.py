"""How far a run may be from the same run by the reference, and its balances from zero."""

import math

import numpy as np

AGREEMENT = 1e-6

#: Peaks the integrator locates between steps only where the last cycle is run again.
ORBIT_ONLY = ("peak_acceleration", "peak_pressure_rise")


#: Needs the history of the last cycle, which the reference does not keep.
HISTORY_ONLY = "adverse_work"
#: Measures of drift, themselves near zero: compared absolutely.
DRIFT = ("stability", "cr_change")


def deviations(run, check):
    """Relative deviation of every entry of Performance; zero where both are NaN or zero."""
    found = {}
    wanted = check.performance.to_dict()
    for name, value in run.performance.to_dict().items():
        if name == HISTORY_ONLY:
            continue
        if name in DRIFT and not math.isnan(value):
            # A high compression ratio magnifies a deviation of the dead centres that many times.
            found[name] = abs(value - wanted[name]) / wanted["compression_ratio"]
            continue
        both_nan = math.isnan(value) and math.isnan(wanted[name])
        alike = both_nan or value == wanted[name]
        found[name] = 0.0 if alike else abs(value / wanted[name] - 1.0)
    return found


def assert_rows_agree(rows, wanted, tolerance, but=()):
    """Every column agrees, relative to its greatest magnitude."""
    for name in set(rows.dtype.names) - set(but):
        scale = np.abs(wanted[name]).max()
        assert np.abs(rows[name] - wanted[name]).max() <= tolerance * max(scale, 1e-9), name


def assert_same_events(run, check, within):
    """The same events in the same order, at the same times [s]."""
    for column in ("kind", "side"):
        np.testing.assert_array_equal(run.event_rows[column], check.event_rows[column])
    np.testing.assert_allclose(run.event_rows["t"], check.event_rows["t"], rtol=0, atol=within)


def assert_agree(run, check, tolerance=AGREEMENT):
    assert run.status == check.status
    assert_same_events(run, check, within=0.1 * tolerance)
    for name, deviation in deviations(run, check).items():
        assert deviation < tolerance, f"{name} deviates by {deviation:.1e}"


def assert_balanced(run, tolerance=1e-8):
    energy = run.energy
    turned_over = energy.released + abs(energy.stored) + abs(energy.alternator)
    assert abs(energy.residual) < tolerance * turned_over
