"""Change detectors: our own figures where the dissertation prints none.

They are no evidence that anything is right. One that fails says that results have moved: look why,
and if the change is meant, put in what comes now.
"""

import numpy as np
import pytest

from helpers import border, swept_line


def test_where_ports_let_too_little_be_compressed():
    table = swept_line("port_location", 0.50, 0.60, 11)
    assert border(table, "port_location") == pytest.approx(0.572, abs=0.01)


def test_the_smallest_stroke_that_opens_the_ports():
    near = swept_line("port_location", 0.041, 0.045, 9)
    assert near.port_location[near.status == "steady"].min() == pytest.approx(0.0425, abs=1e-4)


def test_the_hottest_intake():
    table = swept_line("intake_temperature", 540.0, 620.0, 17)
    assert table.intake_temperature[table.status == "steady"].max() == pytest.approx(
        578.0, abs=10.0
    )


def test_beyond_where_the_dissertation_ends():
    wide = swept_line("bore", 0.090, 0.100, 6)
    assert wide.compression_ratio.between(38.0, 66.0).all()
    boosted = swept_line("intake_pressure", 2.0e5, 3.0e5, 5)
    assert boosted.compression_ratio.between(36.0, 80.0).all()
    assert boosted.peak_pressure.max() > 800e5
    assert np.isfinite(boosted.peak_pressure).all()
