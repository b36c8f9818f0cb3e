"""Figures of a cycle against what the table of cycles says."""

import numpy as np
import pytest

import saleg
from saleg.engine.start import CompressedCharge


@pytest.mark.parametrize("duration", [0.09, 0.4])
def test_change_of_the_compression_ratio_is_that_of_the_table(base, duration):
    run = saleg.simulate(base.replace(start=CompressedCharge(position=0.8, burning=0.0)), duration)
    ratios = run.cycles["compression_ratio"]
    changes = ratios.diff().abs().dropna()
    assert run.performance.cr_change == pytest.approx(changes.tail(10).mean(), rel=1e-9)
    assert run.performance.compression_ratio == pytest.approx(ratios.iloc[-1], rel=1e-12)


def test_a_single_cycle_has_no_change(base):
    run = saleg.simulate(base, 0.025)
    assert len(run.cycles) == 1
    assert np.isnan(run.performance.cr_change)
