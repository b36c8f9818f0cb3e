"""Sobol' indices: known ones, and those that would hide something."""

import math

import numpy as np
import pytest

from saleg import sweep


def test_indices_of_a_function_with_known_ones():
    """Ishigami's function with a = 7 and b = 0.1; its indices follow by hand."""
    names = ["x", "y", "z"]
    points = sweep.saltelli_points({name: (-math.pi, math.pi) for name in names}, 4096)
    x, y, z = points.to_numpy().T
    points["value"] = np.sin(x) + 7.0 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)
    found = sweep.indices(points, "value", names)
    np.testing.assert_allclose(found.table["first"], [0.3139, 0.4424, 0.0], atol=0.02)
    np.testing.assert_allclose(found.table["total"], [0.5576, 0.4424, 0.2437], atol=0.02)
    assert (found.table.first_low <= found.table.first_high).all()
    ax = found.plot()
    assert [text.get_text() for text in ax.get_yticklabels()] == ["z", "y", "x"]


def test_indices_refuse_to_hide_failed_designs():
    points = sweep.saltelli_points({"egr": (0.1, 0.2), "intake_temperature": (320.0, 640.0)}, 4)
    table = sweep.run(points, multipliers=False)
    assert (table.status == "idling").any()
    with pytest.raises(sweep.NoIndices, match=r"of 16 designs have no steady efficiency .*idling"):
        sweep.indices(table, "efficiency")
    good = sweep.run(sweep.saltelli_points({"egr": (0.1, 0.2), "bore": (0.06, 0.07)}, 4))
    assert sweep.indices(good, "power").table.total.idxmax() == "bore"
    with pytest.raises(sweep.NoIndices, match="none of saltelli_points"):
        sweep.indices(good.sample(frac=1.0, random_state=0), "power", ["egr", "bore"])
    with pytest.raises(sweep.NoIndices, match="same at all points"):
        sweep.indices(good.assign(power=1.0), "power", ["egr", "bore"])
    with pytest.raises(sweep.NoIndices, match="no column"):
        sweep.indices(good, "colour", ["egr", "bore"])


def test_indices_refuse_unstable_orbits_unless_asked():
    points = sweep.saltelli_points({"egr": (0.1, 0.2), "bore": (0.040, 0.060)}, 4)
    table = sweep.run(points)
    assert (table.status == "steady").all()
    assert not table.stable.all()
    with pytest.raises(sweep.NoIndices, match=r"[0-9]+ unstable.*unstable=True"):
        sweep.indices(table, "power")
    assert sweep.indices(table, "power", unstable=True).table.total.idxmax() == "bore"


def test_what_indices_cannot_be_of():
    points = sweep.saltelli_points({"egr": (0.1, 0.2), "bore": (0.05, 0.06)}, 8)
    table = points.assign(message="x", status="steady", y=points.egr**2 + points.bore)
    names = ["egr", "bore"]
    assert sweep.indices(table, "y", names).table.total.idxmax() == "egr"
    with pytest.raises(sweep.NoIndices, match="egr is the only input"):
        sweep.indices(table, "y", ["egr"])
    with pytest.raises(sweep.NoIndices, match="message holds no numbers"):
        sweep.indices(table, "message", names)
    with pytest.raises(sweep.NoIndices, match="1 without y"):
        sweep.indices(table.drop(columns="status").assign(y=[np.nan] + 31 * [1.0]), "y", names)
    with pytest.raises(sweep.NoIndices, match="no column 'erg'"):
        sweep.indices(table, "y", ["erg", "bore"])
