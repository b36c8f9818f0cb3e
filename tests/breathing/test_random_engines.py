"""Random engines that breathe: what is solved for is where waiting leads."""

import importlib.util

import pytest

from helpers import ROOT

spec = importlib.util.spec_from_file_location("breathing", ROOT / "benchmarks" / "breathing.py")
breathing = importlib.util.module_from_spec(spec)
spec.loader.exec_module(breathing)

#: Those without walls and crankcase in a double, and all laws in a single-piston engine.
MAKES = breathing.MAKES[0], breathing.MAKES[2]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::saleg.errors.SalegWarning")
def test_fixed_points_of_random_engines_are_where_waiting_leads():
    """``benchmarks/breathing.py`` does this for 500."""
    engines = [breathing.random_engine(number, MAKES) for number in (*range(0, 18, 2), 9)]
    found = [breathing.compared(engine) for engine in engines if not engine.problems()]
    apart = [outcome for outcome in found if outcome.kind == "apart"]
    assert not apart
    assert sum(outcome.kind == "agrees" for outcome in found) >= 5
