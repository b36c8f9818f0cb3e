"""Greatest values in a cycle, against the densest history of it and converged ones."""

import numpy as np
import pytest

import saleg
from saleg import design, laws
from saleg.steady import lanes

#: Peaks of the results, and the column of the history each is the greatest value of.
PEAKS = {
    "peak_pressure": "p_left",
    "peak_temperature": "T_left",
    "peak_pressure_rise": "p_rate_left",
    "peak_acceleration": "a",
    "peak_velocity": "v",
}
#: Designs whose dp/dt peaks at the end of the compression, long after a low peak of combustion or
#: without one, in steps that were not looked into.
NAMES = (
    "bore",
    "half_stroke",
    "port_location",
    "intake_pressure",
    "intake_temperature",
    "spring_stiffness",
    "equivalence_ratio",
    "egr",
)
STEEP = [
    (
        0.09749099152893548,
        0.09823264479662606,
        0.07881694323031388,
        126482.98317195455,
        415.70938895184554,
        23308.30938718148,
        0.5807583935989639,
        0.05470992644721817,
    ),
    (
        0.08608660018866905,
        0.06658562743542071,
        0.2357511671932197,
        264040.01971827855,
        411.235606375114,
        354979.0743521883,
        0.8027125379055271,
        0.37037320199796925,
    ),
    (
        0.048188925299545604,
        0.03274764211819219,
        0.6682437997295144,
        494104.8433605176,
        730.1069667469453,
        27166.34631456107,
        0.41562421577223996,
        0.12225997184866877,
    ),
]


#: A burn profile whose third stretch, a step or two long, has the steepest rise within a step that
#: begins at a breakpoint, both ends of it far lower.
HUMP = laws.BurnProfile(
    combustion_duration=2.0459906653272673e-4,
    times=(0.0, 0.2, 0.7, 0.711789731634719, 1.0),
    fractions=(0.0, 0.4982080313629953, 0.5807032715291061, 0.6149800284680454, 1.0),
)


def engines_around(base, count):
    """Random engines of the laws of the base case."""
    rng = np.random.default_rng(7)
    names = ("bore", "moving_mass", "spring.stiffness", "intake.pressure", "equivalence_ratio")
    names += ("egr", "alternator.load_constant", "friction.coefficient")
    for _ in range(count):
        changes = {name: base.get(name) * rng.uniform(0.7, 1.3) for name in names}
        yield base.replace(**changes, **{"intake.temperature": 325.0 * rng.uniform(0.92, 1.08)})


def assert_peaks_are_found(found, converged):
    for name in PEAKS:
        np.testing.assert_allclose(found[name], converged[name], rtol=1e-4, err_msg=name)


@pytest.mark.parametrize("values", STEEP)
def test_peaks_of_a_design_are_those_of_its_history(values):
    found = design.evaluate(design.Design().replace(**dict(zip(NAMES, values, strict=True))))
    cycle = saleg.steady_state(found.engine, rtol=1e-9).replay().history
    performance = found.performance.to_dict()
    for name, column in PEAKS.items():
        highest = np.abs(cycle[column]).max() if column in "av" else cycle[column].max()
        assert performance[name] == pytest.approx(highest, rel=1e-3), name


def test_a_peak_within_the_first_step_after_a_breakpoint_is_found(base):
    engine = base.replace(heat_release=HUMP, equivalence_ratio=0.5)
    peaks = [
        saleg.steady_state(engine, rtol=rtol).performance.peak_pressure_rise
        for rtol in (1e-5, 3e-6, 1e-6, 1e-8)
    ]
    assert peaks == pytest.approx([peaks[-1]] * 4, rel=1e-4)


def test_peaks_of_many_engines_have_converged(base, monkeypatch):
    """One by one and in lanes; at rtol 1e-6 within 4e-5 in a thousand."""
    engines = list(engines_around(base, 820))
    engines = [*engines[640:700], *engines[780:]]
    converged = saleg.steady_states(engines, rtol=1e-10, workers=1)
    assert (converged.status == "steady").all()
    assert_peaks_are_found(saleg.steady_states(engines, workers=1), converged)
    monkeypatch.setattr(lanes, "MANY", 1)
    monkeypatch.setattr(lanes, "WORTH_COMPILING", 1)
    assert_peaks_are_found(saleg.steady_states(engines, workers=1), converged)
