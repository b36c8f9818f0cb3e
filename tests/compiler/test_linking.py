"""A kernel without laws, and laws linked into it."""

import hashlib
import re
import types
from pathlib import Path

import numba
import numpy as np
import pytest

import saleg
from saleg import laws
from saleg.compiler import linking, machine_code
from saleg.compiler.compiled_engine import kernel_for
from saleg.compiler.needs import Needs
from saleg.compiler.shared_kernel import SharedKernel
from saleg.compiler.text import CACHED, CHOICE, COMPILED_HEADER, own_text
from saleg.kernel.tuples import Integration

HEADER = "import math\nimport numba\nimport numpy as np\n"
#: A kernel that asks for two laws, with whole numbers where they are shown real ones.
KERNEL = """
springs_force = DECLARED("springs_force", globals())
gas_exchange_exhaust = DECLARED("gas_exchange_exhaust", globals())

@compiled
def twice(P, motion):
    return 2.0 * springs_force(P, motion)

@inline
def run_on(run):
    P = run.laws[0]
    p, T = gas_exchange_exhaust(P, 1)
    run.y[0] = twice(P, Motion(0, run.y[0], 0.0, 1, 0.0))
    run.y[1] = p + T
    return 7
"""
LAWS = """
@inline
def springs_force(P, motion):
    return -P.stiffness * motion.x

@inline
def gas_exchange_exhaust(P, side):
    return {exhaust}

integrate = LINKED(globals())

@cached
def run_on(run):
    return integrate(run)
"""


def module_of(text, **names):
    module = types.ModuleType("toy")
    compilers = {"INNER": machine_code.inner_compiler(), "ENTRY": machine_code.entry_compiler()}
    module.__dict__.update(names, **compilers, ON_DISK=False)
    parts = [HEADER, COMPILED_HEADER + CACHED, CHOICE, own_text("laws/arguments.py"), text]
    exec("\n".join(parts), module.__dict__)
    return module


def integration(stiffness, *more):
    record = np.dtype([("stiffness", np.float64), *((name, np.float64) for name in more)])
    numbers = np.array([stiffness, *[1.0] * len(more)]).view(record)
    nothing = dict.fromkeys(Integration._fields, 0.0)
    return Integration(**{**nothing, "laws": numbers, "y": np.array([0.5, 0.0])})


def bitcode_for(run):
    kernel = module_of(KERNEL, DECLARED=linking.declared)
    return linking.lowered(kernel.run_on, run)


def test_laws_are_linked_into_a_kernel_that_knew_none():
    kept = {}

    def once(run):
        if run not in kept:
            kept[run] = bitcode_for(run)
        return kept[run]

    linked = []
    for exhaust, runs in [("1.0e5, 300", integration(30.0)), ("2.0, 1.0", integration(7.0, "a"))]:
        module = module_of(LAWS.format(exhaust=exhaust), LINKED=lambda n: linking.linked(n, once))
        assert module.run_on(runs) == 7
        linked.append((module, runs.y.copy()))
    assert [list(y) for _, y in linked] == [[-30.0, 100300.0], [-7.0, 3.0]]
    assert len(kept) == 1  # one kernel, whatever the records of the laws are
    again = integration(3.0)
    linked[0][0].run_on(again)  # the second has not taken the place of the first
    assert list(again.y) == [-3.0, 100300.0]


def test_all_slots_are_declared_with_the_types_they_are_called_with():
    names = {name: getattr(laws, name) for name in ("Gas", "Charge", "Motion", "Stroke")}
    found = linking.signature_of("springs_force", names)
    assert found.return_type == numba.types.float64
    assert found.args == (
        linking.NUMBERS,
        numba.types.NamedUniTuple(numba.types.float64, 5, laws.Motion),
    )
    areas = linking.signature_of("gas_exchange_areas", names)
    assert areas.return_type == numba.types.UniTuple(numba.types.float64, 2)
    assert areas.args[1:] == (numba.types.int64, numba.types.float64)


@pytest.fixture
def own_folder(tmp_path, monkeypatch):
    tmp_path.chmod(0o700)
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))
    return tmp_path


def test_a_kernel_is_lowered_once_and_afresh_if_damaged(own_folder, monkeypatch):
    lowered = []
    monkeypatch.setattr(
        machine_code, "lowered", lambda kernel, run: lowered.append(run) or b"bitcode"
    )
    needs = Needs(motored_pressure=False, current=False)

    def found():
        return SharedKernel(needs).bitcode("arguments")

    assert [found(), found()] == [b"bitcode"] * 2
    assert len(lowered) == 1
    (path,) = own_folder.rglob("*.bc")
    assert path.read_bytes() == hashlib.sha256(b"bitcode").digest() + b"bitcode"
    path.write_bytes(path.read_bytes()[:-1])
    assert found() == b"bitcode"
    assert len(lowered) == 2


def test_laws_with_the_same_needs_share_a_kernel():
    base = saleg.machines.thesis_base()
    other = base.replace(friction=laws.FrictionShare(share=0.06))
    motored = base.replace(heat_transfer=laws.Woschni())
    kernels = []
    for engine in (base, other, motored):
        text = Path(kernel_for(engine).module.__file__).read_text()
        kernels.append(re.search(r"^# kernel: (\w+)$", text, flags=re.MULTILINE)[1])
    assert kernels[0] == kernels[1] != kernels[2]


@pytest.mark.parametrize("name", machine_code.LINKING_NEEDS)
def test_all_that_linking_needs_is_asked_for(name, monkeypatch):
    monkeypatch.setattr(machine_code, "LINKING_NEEDS", (name + "_gone",))
    assert not machine_code.has_halves()


def test_this_numba_has_halves():
    assert machine_code.has_halves()
