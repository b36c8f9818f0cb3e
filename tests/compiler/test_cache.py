"""The cache of compiled kernels must hit, and never be stale, mixed up or trusted blindly."""

import json
import os
import subprocess
import sys
import textwrap

import pytest

import saleg
from saleg.compiler.cache import usable_folder
from saleg.files.atomic import write_text
from saleg.files.lock import locked

SHOW = """
import json
def show(run, kernel, function):
    print(json.dumps({
        "hits": sum(function.stats.cache_hits.values()),
        "misses": sum(function.stats.cache_misses.values()),
        "name": kernel.module.__name__,
        "frequency": run.performance.frequency,
        "x": run.strokes["x_end"].tolist(),
    }))
"""

REPORT = f"""{SHOW}
from saleg.compiler.compiled_engine import kernel_for
run = saleg.simulate(engine, 0.06, rtol=1e-6)
kernel = kernel_for(engine)
show(run, kernel, kernel.module.run_on)
"""

LAW = """
from dataclasses import dataclass
from saleg.laws import Springs
from saleg.quantities import quantity
from {helper_module} import helper

FACTOR = {factor}

@dataclass(frozen=True)
class MySprings(Springs):
    stiffness: float = quantity("N/m", default=30e3)

    def force(self, motion):
        return -FACTOR * helper(self.stiffness) * motion.x{extra}

    def energy(self, motion):
        return 0.5 * FACTOR * helper(self.stiffness) * motion.x**2
"""

HELPER = """
SCALE = {scale}

def helper(stiffness):
    return SCALE * stiffness
"""


def script(tmp_path, code, cache, check=True):
    """Run code in a fresh process with its own cache folder."""
    env = {**os.environ, "SALEG_CACHE_DIR": str(cache), "PYTHONPATH": str(tmp_path)}
    env.pop("NUMBA_CACHE_DIR", None)
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)],
        capture_output=True,
        text=True,
        env=env,
        check=check,
        cwd=tmp_path,
    )


def report(tmp_path, engine, cache):
    """What a process sees of a kernel."""
    out = script(tmp_path, f"import saleg\n{engine}\n{REPORT}", cache)
    return json.loads(out.stdout.splitlines()[-1])


BASE = "engine = saleg.machines.thesis_base()"


@pytest.fixture(scope="module")
def cold(tmp_path_factory):
    """A cache folder filled by processes that start at once, and what each of them reports."""
    folder = tmp_path_factory.mktemp("cold")
    cache = folder / "cache"
    environment = {**os.environ, "SALEG_CACHE_DIR": str(cache)}
    environment.pop("NUMBA_CACHE_DIR", None)
    code = f"import saleg\n{BASE}\n{REPORT}"
    workers = [
        subprocess.Popen(
            [sys.executable, "-c", code],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
        )
        for _ in range(3)
    ]
    reports = []
    for worker in workers:
        out, err = worker.communicate(timeout=300)
        assert worker.returncode == 0, err.decode()
        reports.append(json.loads(out.splitlines()[-1]))
    return cache, reports


def test_of_parallel_cold_starts_one_compiles(cold):
    _, reports = cold
    assert len({json.dumps(item["x"]) for item in reports}) == 1
    assert sorted((item["hits"], item["misses"]) for item in reports) == [(0, 1), (1, 0), (1, 0)]


def test_a_later_process_hits_the_cache(cold, tmp_path):
    cache, (first, *_) = cold
    later = report(tmp_path, BASE, cache)
    assert (later["hits"], later["misses"]) == (1, 0)
    assert later["x"] == first["x"]


def test_changed_numbers_do_not_recompile(cold, tmp_path):
    cache, (first, *_) = cold
    other = report(tmp_path, BASE + ".replace(bore=0.06, egr=0.2)", cache)
    assert other["hits"] == 1
    assert other["x"] != first["x"]


def write_law(folder, factor=2.0, scale=1.0, extra="", name="mylaw", helper="myhelper"):
    law = LAW.format(factor=factor, extra=extra, helper_module=helper)
    (folder / f"{name}.py").write_text(law)
    (folder / f"{helper}.py").write_text(HELPER.format(scale=scale))


#: What is edited of a law: a constant of its own, its helper's, its text.
EDITS = ({"factor": 2.2}, {"scale": 1.1}, {"extra": " * 1.1"})
#: Laws in files of their own, in the kernel of the reference, which is compiled soonest.
CUSTOM = f"""{SHOW}
from importlib import import_module
import saleg
from saleg.compiler.compiled_engine import kernel_for
from saleg.compiler.text import REFERENCE
for number in range(count):
    law = import_module(f"law_{{number}}").MySprings()
    engine = saleg.machines.thesis_base().replace(springs=law)
    run = saleg.reference.simulate(engine, 0.06, rtol=1e-6, jitted=True)
    kernel = kernel_for(engine, REFERENCE)
    show(run, kernel, kernel.module.rates_of_records)
"""


def write_laws(folder, edits):
    for number, edit in enumerate(edits):
        write_law(folder, **edit, name=f"law_{number}", helper=f"helper_{number}")


def reports(tmp_path, cache, count):
    """What a process sees of the kernels of so many laws."""
    out = script(tmp_path, f"count = {count}\n{CUSTOM}", cache)
    return [json.loads(line) for line in out.stdout.splitlines()]


def test_an_edited_law_helper_or_constant_recompiles(cold, base, tmp_path):
    cache, _ = cold
    write_laws(tmp_path, [{}] * len(EDITS))
    plain = saleg.reference.simulate(base, 0.06, rtol=1e-6, jitted=True)
    (same,) = reports(tmp_path, cache, 1)
    assert same["misses"] == 1
    assert same["x"] == plain.strokes["x_end"].tolist()
    assert reports(tmp_path, cache, 1)[0]["hits"] == 1
    seen = {same["name"]}
    write_laws(tmp_path, EDITS)
    for edited in reports(tmp_path, cache, len(EDITS)):
        assert edited["misses"] == 1
        assert edited["name"] not in seen
        seen.add(edited["name"])
        assert edited["frequency"] > 1.005 * plain.performance.frequency


def test_engines_with_different_laws_in_one_process_never_mix(cold, tmp_path):
    write_law(tmp_path, name="law_a", helper="helper_a", scale=1.0)
    write_law(tmp_path, name="law_b", helper="helper_b", scale=1.3)
    code = """
    import saleg, law_a, law_b
    from saleg.reference import simulate
    base = saleg.machines.thesis_base()
    a, b = base.replace(springs=law_a.MySprings()), base.replace(springs=law_b.MySprings())
    run = lambda e: simulate(e, 0.06, jitted=True).strokes["x_end"].tolist()
    first = [run(e) for e in (base, a, b)]
    again = [run(e) for e in (b, a, base)][::-1]
    stiff = run(base.replace(**{"spring.stiffness": 39e3}))
    assert first == again
    same = lambda one, two: max(abs(a - b) for a, b in zip(one, two, strict=True)) < 1e-9
    assert same(first[0], first[1]) and not same(first[0], first[2])
    assert same(first[2], stiff)
    print("fine")
    """
    assert script(tmp_path, code, cold[0]).stdout.strip() == "fine"
    assert script(tmp_path, code, cold[0]).stdout.strip() == "fine"


def test_left_and_right_may_have_different_laws(base):
    mixed = base.replace(**{"left.heat_transfer": saleg.laws.NoHeatTransfer()})
    run = saleg.simulate(mixed, 0.1)
    assert (run.strokes["heat_lost"][:, 0] == 0.0).all()
    assert (run.strokes["heat_lost"][1:, 1] > 0.0).all()


def test_a_planted_module_is_not_executed(cold, tmp_path):
    cache, (first, *_) = cold
    module = cache / f"{first['name']}.py"
    text = module.read_text()
    module.write_text("raise SystemExit('planted')\n")
    again = report(tmp_path, BASE, cache)
    assert again["x"] == first["x"]
    assert module.read_text() == text


@pytest.mark.skipif(sys.platform == "win32", reason="modes of POSIX")
def test_a_folder_others_may_write_to_is_not_used(tmp_path, monkeypatch):
    shared = tmp_path / "shared"
    shared.mkdir()
    shared.chmod(0o777)
    monkeypatch.setenv("SALEG_CACHE_DIR", str(shared))
    with pytest.warns(RuntimeWarning, match="others may write"):
        assert usable_folder() is None
    code = """
    import saleg
    from saleg.compiler.controllers import control_of
    assert control_of(saleg.Controller()).address != 0  # compiled sooner than an engine
    """
    out = script(tmp_path, code, shared)
    assert "others may write" in out.stderr
    assert list(shared.iterdir()) == []


def test_cache_folder_is_private(tmp_path, monkeypatch):
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path / "new" / "cache"))
    folder = usable_folder()
    assert folder is not None
    if sys.platform != "win32":
        assert folder.stat().st_mode & 0o077 == 0


def test_files_are_written_whole_or_not_at_all(tmp_path, monkeypatch):
    target = tmp_path / "file.py"
    write_text(target, "whole")

    def fail(*_):
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(OSError, match="disk full"):
        write_text(target, "half")
    assert target.read_text() == "whole"
    assert list(tmp_path.iterdir()) == [target]


def test_lock_is_released(tmp_path):
    for _ in range(2):
        with locked(tmp_path / "lock"):
            pass


def test_law_without_source_runs_uncached(cold, tmp_path):
    """As typed into a plain interpreter."""
    code = """
    import saleg
    text = '''
    from dataclasses import dataclass
    import math
    from saleg.laws import Springs
    DOUBLE = 2.0
    def product(a, b):
        return math.fabs(a) * b
    @dataclass(frozen=True)
    class Typed(Springs):
        stiffness: float = 30e3
        def force(self, motion):
            return -DOUBLE * product(self.stiffness, motion.x)
        def energy(self, motion):
            return product(self.stiffness, motion.x * motion.x)
    '''
    import textwrap
    names = {"__name__": "typed"}
    exec(textwrap.dedent(text), names)
    base = saleg.machines.thesis_base()
    typed = saleg.simulate(base.replace(springs=names["Typed"]()), 0.06)
    given = saleg.simulate(base, 0.06)
    assert abs(typed.strokes["x_end"] - given.strokes["x_end"]).max() < 1e-12
    print("fine")
    """
    assert script(tmp_path, code, cold[0]).stdout.strip() == "fine"


def test_law_of_a_notebook_cell_runs_compiled(cold, tmp_path):
    pytest.importorskip("IPython")
    code = '''
    from IPython.core.interactiveshell import InteractiveShell
    shell = InteractiveShell.instance()
    cell = """
    import math
    from dataclasses import dataclass
    import saleg
    from saleg.laws import Friction

    LIMIT = 1.5

    def rubbing(v):
        return math.tanh(v / LIMIT)

    @dataclass(frozen=True)
    class Rubbing(Friction):
        force_level: float = 120.0

        def at_dead_centre(self, held, stroke):
            return self.force_level

        def force(self, held, motion):
            return held * rubbing(motion.v)

    run = saleg.simulate(saleg.machines.thesis_base().replace(friction=Rubbing()), 1.0)
    """
    import textwrap
    result = shell.run_cell(textwrap.dedent(cell))
    result.raise_error()
    run = shell.user_ns["run"]
    from saleg.compiler.compiled_engine import kernel_for
    kernel = kernel_for(run.engine)
    assert kernel.module.__file__.endswith(".py"), kernel.module.__file__
    assert run.performance.power > 2e4
    again = shell.run_cell(textwrap.dedent(cell).replace("120.0", "240.0").replace("1.5", "1.6"))
    again.raise_error()
    assert shell.user_ns["run"].performance.power < run.performance.power
    print("fine")
    '''
    out = script(tmp_path, code, cold[0])
    assert out.stdout.strip().endswith("fine"), out.stdout + out.stderr
