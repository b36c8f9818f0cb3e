"""Every point of a sweep is a row."""

import subprocess
import sys

import numpy as np
import pytest

import saleg
from helpers import falls, single_piston
from saleg import sweep
from saleg.steady import lanes


def test_every_point_is_a_row():
    bores = [0.064, -1.0, 0.03, 0.064]
    temperatures = [325.0, 325.0, 325.0, 600.0]
    table = sweep.run(sweep.listed({"bore": bores, "intake_temperature": temperatures}))
    assert list(table.status) == ["steady", "invalid", "steady", "idling"]
    assert list(table.stable)[:3] == [True, False, False]
    assert table.kind[2] == "quasi-periodic"
    assert "bore = -1" in table.message[1]
    assert np.isnan(table.power[1])
    assert set(table.attrs["units"]) == set(table.columns)
    alone = saleg.design.evaluate(bore=0.064, intake_temperature=325.0)
    assert table.power[0] == alone.quick_performance.power
    assert table.moving_mass[0] == alone.moving_mass


def test_an_engine_with_fixed_mass_is_swept_by_its_paths(base):
    table = sweep.run(sweep.grid({"moving_mass": [2.0, 2.39, 3.0]}), base)
    assert falls(table.frequency)
    assert table.attrs["units"]["moving_mass"] == "kg"
    assert table.power[1] == saleg.steady_state(base).quick_performance.power


def test_warm_starts_find_the_same_along_a_line():
    points = sweep.grid({"bore": np.linspace(0.055, 0.075, 21)})
    cold = sweep.run(points, multipliers=False)
    warm = sweep.run(points, multipliers=False, warm=True)
    np.testing.assert_allclose(warm.power, cold.power, rtol=2e-5)


def test_nothing_heavy_is_imported_with_saleg():
    code = "import sys, saleg; print([m for m in ('pandas', 'scipy', 'dask') if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_a_sweep_of_a_single_piston_engine_has_the_figures_of_its_steady_states(base):
    engine = single_piston(base, length=0.1, pressure=2.5e5)
    values = {"right.pressure": [2.3e5, 2.7e5], "alternator.load_constant": [28.0, 32.0]}
    table = sweep.run(sweep.grid(values), engine)
    assert (table.status == "steady").all()
    for _, row in table.iterrows():
        alone = saleg.steady_state(engine.replace(**{name: row[name] for name in values}))
        assert row.power == pytest.approx(alone.performance.power, rel=1e-5)
        assert row.compression_ratio == pytest.approx(alone.performance.compression_ratio, rel=1e-5)
        assert row.largest_multiplier == pytest.approx(abs(alone.multipliers[0]), abs=1e-4)


def test_all_wrong_arguments_are_named_at_once(base):
    """Of batches and sweeps: arguments, inputs and ranges; what is no list of engines is no row."""
    nothing = {"rtol": 2, "chunk": 0, "workers": -1, "effort": None}
    points = sweep.grid({"bor": [0.06], "strok": [1.0], "bore": [0.06]})
    calls = {
        lambda: saleg.steady_states([base], multipliers="yes", **nothing): [*nothing, "mult"],
        lambda: saleg.design.evaluate_many(points, **nothing): nothing,
        lambda: sweep.run(points, base, warm="x", **nothing): [*nothing, "warm"],
        lambda: sweep.run(points, base): ("'bor'", "'strok'"),
        lambda: sweep.latin_hypercube({"bore": (2, 1), "egr": (0, np.inf)}, -1, "x"): (
            *("bore", "egr", "count"),
            "seed",
        ),
    }
    for call, names in calls.items():
        with pytest.raises(saleg.SalegError) as error:
            call()
        assert all(name in str(error.value) for name in names), error.value
    for engines in ("thesis-base", {"a": base}, base):
        with pytest.raises(saleg.SalegError, match="must be a list of engines"):
            saleg.steady_states(engines)


def test_a_sweep_in_a_folder_does_not_ask_what_has_been_compiled(base, tmp_path, monkeypatch):
    monkeypatch.setattr(lanes, "MANY", 2)
    monkeypatch.setattr(lanes, "kernel_of_lanes", None)  # not to be called
    points = sweep.sobol({"bore": (0.06, 0.07), "egr": (0.1, 0.2)}, 8)
    table = sweep.run(points, base, folder=tmp_path / "kept", multipliers=False)
    assert (table.status == "steady").all()
