"""Nothing compiled: ``NUMBA_DISABLE_JIT=1`` runs the same modules and laws as Python."""

import json
import os
import subprocess
import sys

import pytest

import saleg

CODE = """
import json, sys
from dataclasses import dataclass
import saleg
from saleg.engine.start import AtRest
from saleg.laws import LinearSprings

@dataclass(frozen=True)
class Watched(LinearSprings):
    def force(self, motion):
        CALLS.append(1)
        return LinearSprings.force(self, motion)

CALLS = []

def strokes(run):
    names = [name for name, kind in run.strokes.dtype.fields.items() if kind[0].shape == ()]
    return {name: run.strokes[name].tolist() for name in names} | {"t": run.duration}

def results():
    base = saleg.machines.thesis_base()
    fixed = {"method": "fixed", "step": 5e-5}
    run = saleg.simulate(base, 0.05, history=1, **fixed)
    found = saleg.steady_state(base, rtol=1e-8)
    at_rest = saleg.machines.thesis_transient().replace(start=AtRest())
    motored = saleg.control.simulate(at_rest, saleg.Controller(), 0.1, compiled=True, **fixed)
    return {
        "simulate": strokes(run),
        "adverse": run.performance.adverse_work,
        "rows": len(run.history),
        "steady": [found.performance.power, found.performance.stroke],
        "message": found.message.partition(";")[0],
        "motored": strokes(motored),
    }
"""
OWN_LAW = """
run = saleg.simulate(saleg.machines.thesis_base().replace(springs=Watched()), 0.002)
print(len(CALLS))
"""


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """What a process without compilation finds; its cache folder."""
    cache = tmp_path_factory.mktemp("cache")
    env = {**os.environ, "NUMBA_DISABLE_JIT": "1", "SALEG_CACHE_DIR": str(cache)}
    code = f"{CODE}\n{OWN_LAW}\nprint(json.dumps(results()))"
    out = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=env, check=True
    )
    calls, found = out.stdout.splitlines()
    return int(calls), json.loads(found), cache


@pytest.fixture(scope="module")
def compiled():
    names = {}
    exec(CODE, names)
    return json.loads(json.dumps(names["results"]()))


def agree(found, wanted, rel=1e-9):
    if isinstance(wanted, dict):
        assert found.keys() == wanted.keys()
        for name in wanted:
            agree(found[name], wanted[name], rel)
    else:
        scale = max(map(abs, wanted), default=0.0) if isinstance(wanted, list) else abs(wanted)
        assert found == pytest.approx(wanted, rel=rel, abs=1e-9 * scale, nan_ok=True)


@pytest.mark.parametrize("what", ["simulate", "adverse", "rows", "motored"])
def test_a_run_is_the_same(what, plain, compiled):
    agree(plain[1][what], compiled[what])


def test_a_steady_state_is_the_same(plain, compiled):
    agree(plain[1]["steady"], compiled["steady"])
    assert plain[1]["message"] == compiled["message"]


def test_the_motor_has_moved_the_engine(compiled):
    assert len(compiled["motored"]["x_end"]) >= 3


def test_laws_are_called_as_written_and_nothing_is_kept(plain):
    assert plain[0] > 100
    assert list(plain[2].iterdir()) == []


def test_compilation_is_the_rule(base):
    from saleg.compiler import plain

    assert not plain.is_wanted()
    assert saleg.simulate(base, 0.01).strokes.dtype.names
