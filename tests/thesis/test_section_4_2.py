"""What section 4.2 says of its eight sweeps."""

import numpy as np
import pytest

import saleg
from helpers import border, falls, rises, swept_line
from saleg import sweep
from saleg.design import Design, MassModel


def test_bore():
    """Stable from about 50 mm up, performance rising; runaway from 80 mm has no orbit of ours."""
    table = swept_line("bore", 0.030, 0.100, 36)
    assert border(table, "bore") == pytest.approx(0.050, rel=0.08)
    unstable = table[~table.stable]
    assert (unstable.kind == "quasi-periodic").all()
    for name in ("compression_ratio", "stroke", "frequency", "power_density", "peak_pressure"):
        assert rises(table[name]), name
    assert rises(table.efficiency[table.bore < 0.085])
    # "Greater than 250 bar" goes with the runaway of the thesis; converged, the orbit stays.
    beyond = table[table.bore > 0.0899]
    assert beyond.stable.all()
    assert (beyond.peak_pressure > 0.9 * 250e5).all()
    # "Decline in efficiency" with the walls, at the upper end.
    assert falls(table.efficiency[table.bore > 0.0899])


def test_half_stroke():
    """CR, stroke, frequency and efficiency fall with L; a beat sets in "around 250 mm"."""
    table = swept_line("half_stroke", 0.040, 0.300, 40)
    assert (table.status == "steady").all()
    for name in ("compression_ratio", "relative_stroke", "frequency", "efficiency"):
        assert falls(table[name]), name
    assert border(table, "half_stroke") == pytest.approx(0.250, rel=0.13)
    assert (table.kind[~table.stable] == "quasi-periodic").all()
    at_border = table[~table.stable].iloc[0]
    assert 10.0 < at_border.compression_ratio < 14.0  # "as the compression ratio falls near ten"
    assert table.efficiency[table.half_stroke < 0.055].min() > 0.40
    assert table.efficiency.iloc[-1] < 0.20
    # The thesis' power density is greatest at 135 mm, ours farther out, on a flat top.
    best = table.half_stroke[table.power_density.idxmax()]
    assert 0.135 < best < 1.3 * 0.135
    at_135 = np.interp(0.135, table.half_stroke, table.power_density)
    assert at_135 > 0.97 * table.power_density.max()
    # The thesis falters below 50 mm; our orbit at 40 mm is stable.
    assert table.stable.iloc[0]


def test_a_limited_load_runs_away_where_the_thesis_does():
    """The text limits the load without saying how far; 1.5 puts the turn at its 80 mm."""
    limited = Design().replace({"alternator.maximum_weight": 1.5})
    bores = sweep.grid({"bore": [0.070, 0.075, 0.080, 0.085, 0.090]})
    free, held = sweep.run(bores), sweep.run(bores, limited)
    excess = (held.compression_ratio / free.compression_ratio).to_numpy()
    assert (excess[:2] < 1.001).all()
    assert excess[2] < 1.1
    assert excess[3] > 1.3
    assert excess[4] > 1.7
    assert held.efficiency[4] < held.efficiency[2]


def test_borders_with_eq_63_as_printed():
    """A shorter rod moves them: bore nearer to the text's 50 mm, phi farther from its 0.2."""
    printed = Design(masses=MassModel.as_printed())
    for name, low, high, at, off in (
        ("bore", 0.04, 0.06, 0.050, 0.06),
        ("half_stroke", 0.2, 0.32, 0.250, 0.13),
        ("equivalence_ratio", 0.15, 0.3, 0.2, 0.14),
    ):
        table = sweep.run(sweep.grid({name: np.linspace(low, high, 9)}), printed)
        assert border(table, name) == pytest.approx(at, rel=off), name


def test_port_location():
    """Bounded on both sides, below by the stroke; towards the head efficiency hardly moves."""
    table = swept_line("port_location", 0.06, 0.60, 37)
    assert border(table, "port_location") > Design().parameters.port_location
    for name in ("frequency", "compression_ratio", "power_density", "peak_pressure"):
        assert falls(table[name]), name
    inner = table[table.port_location.between(0.1, 0.5)]
    assert np.ptp(inner.efficiency) < 0.02
    # Below it the piston turns before the port opens.
    near = swept_line("port_location", 0.041, 0.045, 9)
    runs = near.status == "steady"
    assert near.stable[runs].all()
    assert 0 < runs.sum() < len(near)
    reached = 0.5 * (1.0 - near.relative_stroke[runs])
    assert (reached < near.port_location[runs]).all()
    assert near.port_location[runs].min() - reached.max() < 1e-3


def test_intake_pressure():
    """All performance rises within the stable region; the limit at 2 bar is not ours."""
    table = swept_line("intake_pressure", 0.8e5, 3.0e5)
    assert (table.status == "steady").all()
    assert table.stable.all()
    for name in ("compression_ratio", "stroke", "frequency", "power_density", "peak_pressure"):
        assert rises(table[name]), name
    assert rises(table.efficiency[table.intake_pressure < 1.8e5])


def test_intake_temperature():
    """Everything falls but the frequency; there is an upper bound, where nothing is delivered."""
    table = swept_line("intake_temperature", 250.0, 650.0, 41)
    ran = table[table.status == "steady"]
    for name in ("compression_ratio", "stroke", "efficiency", "power_density", "peak_pressure"):
        assert falls(ran[name]), name
    assert rises(ran.frequency[ran.intake_temperature < 500.0])
    assert ran.stable.all()
    hot = table[table.intake_temperature > ran.intake_temperature.max()]
    assert len(hot)
    assert (hot.status == "idling").all()
    assert (hot.power == 0.0).all()


def test_spring_stiffness():
    """All falls with stiffness, power density most; the thesis' bound at 50 kN/m is not ours."""
    table = swept_line("spring_stiffness", 5e3, 200e3)
    for name in ("frequency", "compression_ratio", "efficiency", "power_density", "peak_pressure"):
        assert falls(table[name]), name
    last, first = table.iloc[-1], table.iloc[0]
    losses = {name: 1.0 - last[name] / first[name] for name in ("power_density", "frequency")}
    assert losses["power_density"] > 0.6
    assert losses["frequency"] < 0.1
    assert 1.0 - last.efficiency / first.efficiency < 0.1
    assert table.stable.all()


PHI_RANGES = ((0.2, 0.401), (0.399, 0.601), (0.599, 0.801), (0.799, 0.951))


def test_equivalence_ratio():
    """Consistent down to about 0.2; all rises; frequency flattens, and rises more again."""
    table = swept_line("equivalence_ratio", 0.15, 0.95, 81)
    assert border(table, "equivalence_ratio") == pytest.approx(0.2, abs=0.01)
    for name in ("compression_ratio", "stroke", "efficiency", "power_density", "peak_pressure"):
        assert rises(table[name]), name
    steady = table[table.stable]

    def slopes(name):
        parts = [steady[steady.equivalence_ratio.between(*ends)] for ends in PHI_RANGES]
        return [np.polyfit(part.equivalence_ratio, part[name], 1)[0] for part in parts]

    frequency = slopes("frequency")
    assert falls(frequency[:3])
    assert 0.0 < frequency[2] < frequency[3] < 0.5 * frequency[0]
    assert falls(slopes("power_density"))


def test_egr():
    """Nothing fails from 0 to 50 %; it acts as less fuel does."""
    table = swept_line("egr", 0.0, 0.5)
    assert table.stable.all()
    for name in ("compression_ratio", "stroke", "power_density", "peak_pressure"):
        assert falls(table[name]), name
    # The text's equivalent range of phi, 0.4 to 0.7: same fuel energy, nearly the same stroke.
    lean = swept_line("equivalence_ratio", 0.3, 0.8, 60)
    same = np.interp(
        table.fuel_energy_per_cycle, lean.fuel_energy_per_cycle, lean.equivalence_ratio
    )
    assert same.min() < 0.45
    assert 0.6 < same.max() < 0.72


def test_egr_with_rcm_ignition():
    """Figures 115 and 116: ignition by RCM data hardly changes what EGR does to the efficiency."""
    design = Design().replace({"ignition": saleg.laws.RCMIgnitionPascal()})
    table = sweep.run(sweep.grid({"egr": [0.0, 0.1, 0.4, 0.5]}), design)
    assert table.stable.all()
    assert np.ptp(table.efficiency) < 0.01
