"""Engine trees: paths, validation, files' raw material."""

import dataclasses
import math
import subprocess
import sys

import numpy as np
import pytest

import saleg
from saleg import BounceChamber, Engine, InvalidEngine, Translator, UnknownPath
from saleg.laws import FrictionShare, Hohenberg, LinearSprings, Wiebe
from saleg.simulation.settings import SettingsError

CONTRACT_PATHS = {
    "bore": 0.064,
    "half_stroke": 0.100,
    "port_closing": 0.133,
    "moving_mass": 2.39,
    "spring.stiffness": 30e3,
    "intake.pressure": 1.05e5,
    "intake.temperature": 325.05,
    "equivalence_ratio": 0.6,
    "egr": 0.12,
    "wall_temperature": 550.0,
    "friction.coefficient": 12.4,
    "alternator.load_constant": 70.6,
    "alternator.regulator_gain": 7.5,
}


@pytest.mark.parametrize(("path", "value"), CONTRACT_PATHS.items())
def test_contract_paths(base, path, value):
    assert base.get(path) == value
    assert base.replace(**{path: 1.1 * value}).get(path) == 1.1 * value


def test_cylinder_paths_change_both_sides_or_one(base):
    both = base.replace(bore=0.05)
    assert both.left.bore == both.right.bore == 0.05
    one = base.replace(**{"left.bore": 0.05})
    assert (one.left.bore, one.right.bore) == (0.05, 0.064)
    assert not one.is_mirrored
    with pytest.raises(UnknownPath, match=r"left\.bore"):
        one.get("bore")


def test_laws_and_their_numbers_can_be_replaced_together(base):
    engine = base.replace(**{"heat_release.a": 6.0}, heat_release=Wiebe(combustion_duration=2e-3))
    assert engine.left.heat_release == Wiebe(combustion_duration=2e-3, a=6.0)
    assert base.left.heat_release == Wiebe()


@pytest.mark.parametrize(
    ("path", "hint"),
    [
        ("intake.presure", "intake.pressure"),
        ("spring.stifness", "spring.stiffness"),
        ("moving_mas", "moving_mass"),
        ("friction.coeficient", "friction.coefficient"),
        ("left.boer", "left.bore"),
    ],
)
def test_unknown_path_names_the_nearest(base, path, hint):
    for ask in (lambda: base.get(path), lambda: base.replace(**{path: 1.0})):
        with pytest.raises(UnknownPath) as error:
            ask()
        assert f"'{hint}'" in str(error.value)


@pytest.mark.parametrize("path", ["", ".", "left.", "bore.", "bore.x", "..", "left.left.bore", 3])
def test_odd_paths_are_refused(base, path):
    with pytest.raises(UnknownPath):
        base.get(path)


def test_every_wrong_field_is_named_together(base):
    bad = base.replace(
        **{
            "bore": -0.06,
            "port_closing": 0.25,
            "intake.temperature": math.nan,
            "intake.pressure": "high",
            "moving_mass": 0.0,
            "egr": 1.0,
            "heat_transfer.a": math.inf,
        }
    )
    with pytest.raises(InvalidEngine) as error:
        saleg.simulate(bad, 1.0)
    text = str(error.value)
    assert {problem.path for problem in error.value.problems} == {
        "bore",
        "port_closing",
        "intake.temperature",
        "intake.pressure",
        "translator.mass",
        "gas_exchange.egr",
        "heat_transfer.a",
    }
    assert "7 wrong fields" in text
    assert "bore = -0.06 [m]: must be > 0" in text
    assert "'high' [Pa]: must be a number > 0" in text
    assert "port_closing = 0.25 [m]: must be > head_gap (0.0001 m) and < the maximum stroke" in text


@pytest.mark.parametrize("value", ["1", None, True, [1.0], 1 + 2j, math.nan, -math.inf])
def test_what_is_not_a_finite_number_is_refused(base, value):
    with pytest.raises(InvalidEngine, match="bore"):
        base.replace(bore=value).validate()


def test_wrong_side_is_named(base):
    with pytest.raises(InvalidEngine, match=r"right\.bore"):
        base.replace(**{"right.bore": -1.0}).validate()


def test_law_in_the_wrong_slot(base):
    with pytest.raises(InvalidEngine, match=r"left\.heat_transfer.*must be a HeatTransfer"):
        base.replace(heat_transfer=LinearSprings()).validate()
    with pytest.raises(InvalidEngine, match="springs"):
        base.replace(springs=Hohenberg()).validate()


def test_engines_are_values(base):
    assert base == saleg.machines.thesis_base()
    assert hash(base) == hash(saleg.machines.thesis_base())
    assert base.replace(bore=0.06) != base
    with pytest.raises(dataclasses.FrozenInstanceError):
        base.name = "other"


def test_settings_are_checked_together(base):
    with pytest.raises(SettingsError) as error:
        saleg.simulate(base, -1.0, method="magic", order=6, step=0.0, rtol="x", history=0)
    for name in ("duration", "method", "order", "step", "rtol", "history"):
        assert f"{name} =" in str(error.value)


def test_bounce_chamber_engine_fires(base):
    engine = Engine(
        translator=Translator(2.0),
        left=base.left,
        right=BounceChamber(bore=0.064, half_stroke=0.1, pressure=3e5),
        springs=base.springs,
        # As good as viscous; the reference's tests share its kernels, left and right.
        friction=FrictionShare(initial=base.friction.coefficient, relaxation=1e-9),
        alternator=base.alternator.__class__(load_constant=30.0, regulator_gain=0.0),
        name="single",
    )
    run = saleg.simulate(engine, 1.0)
    assert run.status in (saleg.Status.STEADY, saleg.Status.COMPLETED)
    assert run.performance.power > 0.0
    assert abs(run.energy.residual) < 1e-6 * run.energy.fuel
    mirrored = dataclasses.replace(engine, left=engine.right, right=engine.left)
    other = saleg.simulate(mirrored, 1.0)
    assert other.performance.frequency == pytest.approx(run.performance.frequency, rel=1e-6)


def test_core_imports_neither_pandas_nor_matplotlib_nor_scipy_nor_numba():
    code = (
        "import sys, saleg; saleg.machines.thesis_base().validate();"
        "print([m for m in ('pandas', 'matplotlib', 'scipy', 'numba', 'tqdm') if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_running_imports_neither_pandas_nor_matplotlib():
    code = (
        "import sys, saleg; run = saleg.simulate(saleg.machines.thesis_base(), 0.1);"
        "run.performance; str(run);"
        "heavy = ('pandas', 'matplotlib', 'scipy.integrate', 'tqdm');"
        "print([m for m in heavy if m in sys.modules])"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_an_engine_says_its_laws_by_the_path_of_their_slot(base):
    for path, law in base.laws.items():
        assert base.get(path) is law
    assert len(base.laws) == 2 * 11 + 5
    bounce = saleg.BounceChamber(bore=0.06, half_stroke=0.1)
    assert list(bounce.laws) == ["gas_properties", "heat_transfer", "leak", "wall"]


def test_an_engine_says_whether_a_law_needs_the_motored_pressure(base):
    assert not base.needs_motored_pressure
    woschni = saleg.laws.Woschni()
    assert base.replace(**{"right.heat_transfer": woschni}).needs_motored_pressure


def test_laws_are_checked_without_being_called(base):
    class Loose(saleg.laws.Springs):
        def force(self, motion):
            raise AssertionError("called")

        def energy(self, motion):
            raise AssertionError("called")

    base.check_laws()
    with pytest.raises(saleg.LawError, match="frozen dataclass"):
        base.replace(springs=Loose()).check_laws()


def test_a_name_is_text_and_a_masked_number_none(base):
    with pytest.raises(saleg.InvalidEngine, match="name = 5: must be text"):
        saleg.simulate(base.replace(name=5), 0.1)
    with pytest.raises(saleg.InvalidEngine, match="egr = masked: must be a number"):
        saleg.simulate(base.replace(egr=np.ma.masked), 0.1)
