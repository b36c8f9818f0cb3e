"""Files written by an earlier version: they load, and a sweep folder goes on where it stood."""

import shutil

import pytest

import saleg
from helpers import ROOT
from saleg import sweep
from saleg.design import Design, MassModel

EARLIER = ROOT / "tests" / "data" / "earlier"
RUNS = sorted(path.name for path in EARLIER.glob("run_*"))
RTOL = 1e-3  # they were simulated with


@pytest.mark.parametrize("name", RUNS)
def test_runs_load(name):
    run = saleg.Run.load(EARLIER / name)
    assert run.status in (saleg.Status.STEADY, saleg.Status.COMPLETED)
    # At their tolerance another order of summing makes other steps.
    again = saleg.simulate(run.engine, 0.1, motored_pressure="bounce" not in name)
    assert run.performance.power == pytest.approx(again.performance.power, rel=RTOL)
    assert len(run.cycles) == len(again.cycles)
    assert (run.history is None or not len(run.history)) == ("bounce" in name)


def test_the_same_run_loads_from_every_format():
    powers = [
        saleg.Run.load(EARLIER / name).performance.power for name in RUNS if "bounce" not in name
    ]
    assert powers == pytest.approx([powers[0]] * 5, rel=1e-12)


def test_engine_files_load():
    engine = saleg.Engine.from_toml(EARLIER / "engine.toml")
    assert engine.get("right.pressure") == 2.5e5


@pytest.mark.parametrize(
    ("name", "points", "swept"),
    [
        (
            "sweep_designs",
            {"bore": [0.058, 0.062, 0.066], "equivalence_ratio": [0.4, 0.6]},
            Design(masses=MassModel.as_printed()),  # the default of its time
        ),
        ("sweep_engine", {"bore": [0.060, 0.064]}, saleg.machines.thesis_base()),
    ],
)
def test_sweep_folders_go_on(name, points, swept, tmp_path, monkeypatch):
    folder = tmp_path / name
    shutil.copytree(EARLIER / name, folder)
    results = (folder / "results.csv").read_bytes()

    def unwanted(*_, **__):
        raise AssertionError("a point that stands in the folder is solved again")

    subject = saleg.design.subjects.subject_of(swept)
    for kind in (type(subject),):
        monkeypatch.setattr(kind, "solver", lambda *_: unwanted)
    table = sweep.run(sweep.grid(points), swept, folder=folder)
    assert list(table.status) == ["steady"] * len(table)
    assert (folder / "results.csv").read_bytes() == results
    assert sweep.load(folder).equals(table)
