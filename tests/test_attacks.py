"""What a sceptical reviewer found, kept from coming back."""

import copy
import dataclasses
import math
import pickle
import sys
import types

import numba
import numpy as np
import pytest

import saleg
from helpers import compiled_method
from own_laws import faulty
from saleg import InvalidEngine, LawError, UnknownPath
from saleg.cli import main
from saleg.compiler.compiled_engine import kernel_for
from saleg.compiler.slot_text import methods_text
from saleg.engine.start import AtRest, MidpointVelocity
from saleg.errors import StartError
from saleg.laws import Friction, InstantExchange, LinearSprings, Springs
from saleg.laws.base import ENGINE_SLOTS
from saleg.simulation.settings import SettingsError


def module(name, text, **names):
    """A module of that text, importable and with its source at hand."""
    import linecache

    made = types.ModuleType(name)
    made.__dict__.update(names)
    filename = f"<{name}>"
    linecache.cache[filename] = (len(text), None, text.splitlines(keepends=True), filename)
    sys.modules[name] = made
    exec(compile(text, filename, "exec"), made.__dict__)
    return made


def test_names_of_helpers_and_constants_do_not_collide():
    a = module("attack_a", "K = 1.0\ndef f(x):\n    return K * x\n")
    b = module("attack_b", "K = 100.0\ndef f(x):\n    return K * x\n")
    text = """
from dataclasses import dataclass
K = 3.0

@dataclass(frozen=True)
class Mixed(Springs):
    def force(self, motion):
        return K * motion.x + fa(motion.x) + 10.0 * fb(motion.x)

    def energy(self, motion):
        return 0.0
"""
    law = module("attack_law", text, Springs=Springs, fa=a.f, fb=b.f).Mixed()
    motion = saleg.laws.Motion(0.0, 2.0, 0.0, 1.0)
    assert law.force(motion) == 3 * 2 + 2 + 10 * 200
    assert compiled_method(law, "force")(motion) == law.force(motion)


STALE = """
from dataclasses import dataclass
C = 12.4

def helper(v):
    return C * v

@dataclass(frozen=True)
class Rubbing(Friction):
    def at_dead_centre(self, held, stroke):
        return 0.0

    def force(self, held, motion):
        return helper(motion.v)
"""


def test_a_constant_changed_in_the_same_process_is_seen(base):
    made = module("attack_stale", STALE, Friction=Friction)
    engine = base.replace(friction=made.Rubbing())
    first = saleg.simulate(engine, 0.2, rtol=1e-6).performance.power
    made.C = 40.0
    second = saleg.simulate(engine, 0.2, rtol=1e-6).performance.power
    wanted = saleg.simulate(
        base.replace(**{"friction.coefficient": 40.0}), 0.2, rtol=1e-6
    ).performance.power
    assert second == pytest.approx(wanted, rel=1e-9)
    assert first > 1.1 * second
    assert kernel_for(engine) is kernel_for(engine)


@pytest.mark.parametrize("turned", [False, True])
def test_a_law_and_its_number_in_one_call(base, turned):
    changes = {"egr": 0.3, "gas_exchange": InstantExchange(), "left.wall_temperature": 500.0}
    items = list(changes.items())
    engine = base.replace(**dict(items[::-1] if turned else items))
    assert engine.get("egr") == 0.3
    moved = {"moving_mass": 3.0, "translator": saleg.Translator(9.0)}
    assert base.replace(**moved).get("moving_mass") == 3.0


def test_all_unknown_paths_are_named(base):
    with pytest.raises(UnknownPath) as error:
        base.replace(**{"boer": 1.0, "intake.presure": 2.0, "bore": -1, "moving_mass": math.nan})
    assert "'boer'" in str(error.value)
    assert "bore = -1.0 [m]" in str(error.value)  # before, the paths alone
    assert "mass = nan" in str(error.value)
    assert "'intake.presure'" in str(error.value)


@pytest.mark.parametrize(
    "settings", [{"step": 0.9}, {"step": 2e-3, "order": 1}, {"step": 5e-4, "order": 1}]
)
def test_results_that_do_not_conserve_energy_are_no_results(base, settings):
    run = saleg.simulate(base, 2.0, **settings)
    assert run.status not in (saleg.Status.STEADY, saleg.Status.COMPLETED), run.message


@pytest.mark.parametrize(
    "settings",
    [
        {"rtol": 0.09},
        {"rtol": 1e-300},
        {"step": 1e-18},
        {"order": [4]},
        {"history": 10**30},
        {"keep_cycles": 0},
    ],
)
def test_senseless_settings_are_refused(base, settings):
    with pytest.raises(SettingsError):
        saleg.simulate(base, 0.1, **settings)


def test_overflow_at_the_start_is_explained(base):
    with pytest.raises(StartError, match="law cannot be evaluated"):
        saleg.simulate(base.replace(**{"heat_transfer.c": 400.0}), 0.1)


@pytest.mark.parametrize(
    "words",
    [
        ["run", "a" * 400],
        ["run", "thesis-base", "--set", "heat_transfer.c=400"],
        ["run", "thesis-base", "--rtol", "0.0999"],
        ["run", "thesis-base", "--step", "1e-18"],
    ],
)
def test_command_line_mistakes_have_no_traceback(words, capsys):
    assert main(words) == 2
    assert capsys.readouterr().err.startswith("saleg: ")


@pytest.mark.parametrize("law", ['["Hohenberg"]', "{ a = 1 }", "3"])
def test_a_law_that_is_no_name(tmp_path, law):
    path = tmp_path / "engine.toml"
    text = saleg.machines.thesis_base().to_toml()
    start = text.index('law = "Hohenberg"')
    path.write_text(text[:start] + f"law = {law}" + text[start + len('law = "Hohenberg"') :])
    with pytest.raises(saleg.EngineFileError, match=r"heat_transfer\.law"):
        saleg.Engine.from_toml(path)


@dataclasses.dataclass(frozen=True)
class NoForce(Springs):
    def energy(self, motion):
        return 0.0


class NotADataclass(LinearSprings):
    pass


@dataclasses.dataclass(frozen=True)
class KeywordOnly(LinearSprings):
    def force(self, *, motion):
        return 0.0


@dataclasses.dataclass(frozen=True)
class TextField(LinearSprings):
    label: str = "soft"


@pytest.mark.parametrize(
    ("law", "error", "hint"),
    [
        (NoForce(), LawError, r"NoForce\.force is missing"),
        (KeywordOnly(), LawError, r"KeywordOnly\.force"),
        (TextField(), InvalidEngine, r"springs\.label"),
    ],
)
def test_law_mistakes_name_the_law(base, law, error, hint):
    with pytest.raises(error, match=hint):
        saleg.simulate(base.replace(springs=law), 0.1)


@dataclasses.dataclass(frozen=True)
class Annotated(LinearSprings):
    def force(self, motion):
        rate: float = 1.0
        parts = (rate * motion.x, rate * 2.0 * motion.x)
        return parts[0] + parts[1]


def test_tuples_and_annotations_are_fine():
    law = Annotated()
    text = "\n".join(methods_text(Annotated, "force", "one", ENGINE_SLOTS["springs"]))
    names = {"inline": numba.njit(error_model="numpy")}
    exec(text, names)
    motion = saleg.laws.Motion(0.0, 2.0, 0.0, 1.0)
    record = np.zeros(1, [("stiffness", float)])[0]
    assert names["one_force"](record, motion) == law.force(motion) == 6.0


def test_a_law_that_returns_nan_is_a_step_failure(base):
    run = saleg.simulate(faulty(base, broken=1.0), 0.1)
    assert run.status is saleg.Status.STEP_FAILURE
    assert "NanPower.electrical_power returns nan at " in run.message


def test_an_engine_in_equilibrium_says_that_it_never_moved(base):
    run = saleg.simulate(base.replace(start=AtRest()), 0.1)
    assert "never moved" in run.message


def test_motion_below_the_resolution_of_time_ends(base):
    """Found by random engines: dead centres and ports within one instant, for ever."""
    start = MidpointVelocity(frequency=170.0, factor=4.4e-129)
    still = base.replace(start=start, port_closing=0.100, **{"intake.temperature": 688.0})
    for stall_stroke in (0.01, 0.0):
        run = saleg.simulate(still, 0.1, rtol=1e-6, stall_stroke=stall_stroke)
        assert isinstance(run.status, saleg.Status)


def test_runs_and_errors_travel_between_processes(base):
    run = saleg.simulate(base, 0.2, rtol=1e-6)
    copies = [pickle.loads(pickle.dumps(run)), copy.deepcopy(run)]
    assert all(again.performance == run.performance for again in copies)
    assert len(repr(run)) < 3000
    assert run != copies[0]
    error = InvalidEngine(base.replace(bore=-1.0).problems())
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_heavier_parts_are_there_without_importing_them():
    assert saleg.reference.simulate
    assert saleg.plotting.pressure_volume
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        saleg.nothing  # noqa: B018


def test_a_damaged_cache_is_compiled_afresh(tmp_path, monkeypatch):
    import os
    import subprocess

    code = (
        "import saleg; e = saleg.machines.thesis_base();"
        "run = saleg.reference.simulate(e, 0.05, jitted=True);"  # its kernel is compiled soonest
        "print(run.strokes['x_end'].tolist())"
    )
    env = {**os.environ, "SALEG_CACHE_DIR": str(tmp_path)}

    def run():
        done = subprocess.run(
            [sys.executable, "-c", code], env=env, capture_output=True, check=True
        )
        return done.stdout

    first = run()
    for kept in [*tmp_path.glob("__pycache__/*.nbc"), *tmp_path.glob("__pycache__/*.nbi")]:
        kept.write_bytes(kept.read_bytes()[:50])
    next(tmp_path.glob("saleg_kernel_*.py")).write_bytes(b"\xff\xfe")
    assert run() == first
