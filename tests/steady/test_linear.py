"""Linear models of steady states: beside multipliers, beside other steady states, beside runs."""

import numpy as np
import pytest

import saleg
from saleg import laws
from saleg.control import Plant, generator
from saleg.errors import UnknownPath, WrongArguments
from saleg.kernel import layout
from saleg.steady import NoLinearModel, NoSteadyState
from saleg.steady.entry_names import ENTRY_NAMES

#: Small steps of what a controller commands.
STEPS = {"load_weight": 0.005, "equivalence_ratio": 0.003, "intake_temperature": 1.0}


@pytest.fixture(scope="module")
def engine():
    return saleg.machines.thesis_transient()


@pytest.fixture(scope="module")
def steady(engine):
    return saleg.steady_state(engine, rtol=1e-9)


@pytest.fixture(scope="module")
def model(steady):
    return steady.linear()


def measured(signals):
    """Default outputs of a model, by hand."""
    return np.array(
        [
            abs(signals.x),
            signals.stroke,
            signals.compression_ratio,
            signals.frequency,
            signals.power,
        ]
    )


def response(engine, steps, strokes=24, settling=1.2):
    """Outputs of a plant after steps of its commands, less those before."""
    plant = Plant(engine, 3.0, rtol=1e-9)
    while plant.time < settling or plant.signals.direction < 0.0:
        plant.command(generator(plant.signals))
        plant.advance()
    before, seen = measured(plant.signals), []
    for _ in range(strokes):
        seen.append(measured(plant.signals) - before)
        signals = plant.signals
        rated = {
            "load_weight": signals.regulated_weight,
            "equivalence_ratio": signals.rated_equivalence_ratio,
            "intake_temperature": signals.rated_intake_temperature,
        }
        changed = {name: rated[name] + by for name, by in steps.items()}
        plant.command(generator(signals, **changed))
        plant.advance()
    return np.array([*seen, measured(plant.signals) - before])


def eigenvalues(model):
    values = np.linalg.eigvals(model.A)
    return values[np.argsort(-np.abs(values))]


def test_the_eigenvalues_squared_are_the_multipliers_of_a_mirrored_engine(steady, model):
    found = eigenvalues(model)[: len(steady.multipliers)] ** 2
    assert model.mirrored
    assert len(model.conserved) == 0
    np.testing.assert_allclose(
        np.sort_complex(found), np.sort_complex(steady.multipliers), rtol=0, atol=1e-8
    )


@pytest.mark.parametrize("name", STEPS)
def test_a_small_step_goes_as_the_model_says(engine, model, name):
    """Closed loop: the stroke regulator goes on regulating; within 5 % of the greatest change."""
    ran = response(engine, {name: STEPS[name]})
    changes = np.zeros((24, 3))
    changes[:, model.inputs.index(name)] = STEPS[name]
    said = model.response(changes)
    assert said[0] == pytest.approx(np.zeros(5), abs=0.0)
    np.testing.assert_allclose(said / np.abs(ran).max(0), ran / np.abs(ran).max(0), atol=0.05)


def test_a_held_change_ends_where_the_other_steady_state_is(engine, steady, model):
    """A number by its path against the steady states on either side of it."""
    by = {"alternator.load_constant": 0.05, "intake.pressure": 50.0, "moving_mass": 0.002}
    other = steady.linear(list(by), model.outputs)
    for column, (path, change) in enumerate(by.items()):
        sides = [
            saleg.steady_state(
                engine.replace(**{path: engine.get(path) + sign * change}), rtol=1e-9
            ).performance
            for sign in (1.0, -1.0)
        ]
        strokes, ratios, frequencies, powers = (
            (getattr(sides[0], name) - getattr(sides[1], name)) / (2.0 * change)
            for name in ("stroke", "compression_ratio", "frequency", "power")
        )
        gains = np.linalg.solve(np.eye(len(other.A)) - other.A, other.B[:, column])
        expected = [0.5 * strokes, strokes, ratios, frequencies, powers]
        np.testing.assert_allclose(other.C @ gains, expected, rtol=2e-3)


def test_the_load_weight_is_added_to_what_the_regulator_sets(engine, steady, model):
    """So its effect is that of the load constant times the regulated weight, at one dead centre."""
    constant, weight = engine.get("alternator.load_constant"), model.input_values[0]
    other = steady.linear(["alternator.load_constant"])
    np.testing.assert_allclose(
        model.B[:, 0] / constant, other.B[:, 0] / weight, rtol=1e-5, atol=1e-9
    )
    assert weight == pytest.approx(float(steady.strokes["load_weight"][-1]), rel=1e-6)


def test_fuel_shows_only_after_the_ports_have_closed_on_it(model):
    """Commanded at a dead centre, composed in the stroke, burnt for the most part in the next."""
    changes = np.zeros((4, 3))
    changes[0, 1] = 0.01
    strokes = np.abs(model.response(changes)[:, 1])
    assert strokes[0] == 0.0
    assert strokes[1] < 0.05 * strokes[2]


def test_unlike_sides_get_a_model_of_a_whole_cycle_and_lose_what_they_keep():
    """A sealed gas spring keeps its entropy for ever."""
    steady = saleg.steady_state(
        saleg.Engine(
            translator=saleg.Translator(mass=2.4),
            left=saleg.machines.thesis_base().left,
            right=saleg.BounceChamber(bore=0.064, half_stroke=0.100, pressure=2.5e5),
            springs=laws.LinearSprings(stiffness=20e3),
            alternator=laws.LinearLoad(load_constant=30.0),
        )
    )
    model = steady.linear(["load_weight"], ["x_left", "x_right"])
    assert not model.mirrored
    assert len(model.conserved) == 1
    assert abs(model.conserved[0] - 1.0) < 1e-5
    kept = np.sort(np.abs(eigenvalues(model)))[::-1]
    own = np.append(np.abs(steady.multipliers), 1.0)
    np.testing.assert_allclose(kept[: len(own)], np.sort(own)[::-1], atol=1e-8)


def test_every_number_of_a_state_has_a_name_of_its_own():
    assert sorted(ENTRY_NAMES) == list(range(layout.N_VECTOR))
    assert len(set(ENTRY_NAMES.values())) == layout.N_VECTOR


def test_python_control_takes_it(model):
    control = pytest.importorskip("control")
    plain, named = control.ss(*model.matrices, dt=True), model.to_control()
    assert tuple(named.input_labels) == model.inputs
    assert tuple(named.output_labels) == model.outputs
    steps = np.zeros((3, 10))
    steps[0] = 0.01
    _, seen = control.forced_response(plain, inputs=steps)
    np.testing.assert_allclose(seen.T, model.response(steps.T)[:-1], atol=1e-12)


def test_what_cannot_be_had_is_refused(engine, steady):
    with pytest.raises(NoLinearModel, match="output 'pressure': must be one of dead_centre"):
        steady.linear(outputs=["pressure"])
    with pytest.raises(NoLinearModel, match="input 'bore': must not change the geometry"):
        steady.linear(["bore"])
    with pytest.raises(UnknownPath):
        steady.linear(["no.such.path"])
    with pytest.raises(UnknownPath, match=r"input 'load': no such input.*'load_weight'"):
        steady.linear(["load"])  # before, only 'leak' was suggested
    with pytest.raises(WrongArguments, match="2 wrong fields"):
        steady.linear("load_weight", "power")  # before, output 'p'
    with pytest.raises(NoLinearModel) as caught:  # before, one at a time, and twins silently
        steady.linear(
            ["bore", "foo", "load_weight", "load_weight", "translator.mass", "moving_mass"],
            ["power", "bar", "power"],
        )
    for part in (
        "input 'bore': must not change",
        "no 'foo'",
        "input 'load_weight': is named twice",
        "input 'moving_mass': is named twice",
        "output 'bar': must be one of",
        "output 'power': is named twice",
    ):
        assert part in str(caught.value)
    off = saleg.steady_state(engine.replace(equivalence_ratio=0.0), effort=saleg.Effort.QUICK)
    with pytest.raises(NoSteadyState):
        off.linear()
