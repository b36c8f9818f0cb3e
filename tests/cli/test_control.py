import subprocess
import sys

import pandas as pd
import pytest

import saleg
from saleg.cli import main
from saleg.thesis.chapter_5 import EXPERIMENTS


@pytest.fixture(scope="module")
def misfired(tmp_path_factory):
    """Folder of a misfire, and an animation of it."""
    folder = tmp_path_factory.mktemp("control")
    words = ["--out", str(folder / "out"), "--animate", str(folder / "a.gif")]
    assert main(["control", "misfire", *words]) == 0
    return folder


def mistake(capsys, *words):
    """Message of a command that must end as a user's mistake."""
    assert main(["control", *words]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "Traceback" not in shown.err
    return shown.err


def line(text, what):
    return next(line for line in text.splitlines() if line.strip().startswith(what)).split()


def test_without_a_name_all_are_listed(capsys):
    assert main(["control"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(EXPERIMENTS)
    assert all(len(line) < 100 for line in lines)


def test_a_wrong_name_lists_them_too(capsys):
    shown = mistake(capsys, "fuel-cat")
    assert "did you mean 'fuel-cut'" in shown
    assert all(experiment.summary in shown for experiment in EXPERIMENTS.values())


def test_listing_loads_little():
    code = (
        "import sys; from saleg.cli import main; main(['control']);"
        "assert not {'matplotlib', 'pandas', 'numba'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_start_up_stands_beside_the_dissertation(capsys):
    words = ["start-up", "--base-frequency", "38", "--duration", "1.2"]
    assert main(["control", *words]) == 0
    shown = capsys.readouterr().out
    assert "dissertation" in shown
    assert line(shown, "fired")[1] == "0.496"
    assert main(["control", *words, "--phase", "integrated"]) == 0
    assert line(capsys.readouterr().out, "fired")[1] == "0.487"
    assert line(shown, "compression ratio")[2:] == ["17.87", "17.9"]
    assert main(["control", *words, "--set", "equivalence_ratio=0.6"]) == 0
    assert "dissertation" not in capsys.readouterr().out


def test_start_ups(capsys, tmp_path):
    assert main(["control", "start-ups", "--out", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    times = {f: line(shown, f"fired from {f} Hz")[4] for f in (30, 35, 38, 40, 50)}
    assert times == {30: "1.961", 35: "1.075", 38: "0.496", 40: "never", 50: "never"}
    table = pd.read_csv(tmp_path / "out" / "results.csv")
    assert table["base_frequency [Hz]"].tolist() == [30.0, 35.0, 38.0, 40.0, 50.0]
    assert table["fired_at [s]"].isna().tolist() == [False] * 3 + [True] * 2


def test_a_folder_holds_engine_tables_and_pictures(misfired):
    out = misfired / "out"
    names = ["cycles.csv", "dead_centres.csv", "duty_cycle.png", "engine.toml", "recovery.png"]
    assert sorted(path.name for path in out.iterdir()) == names
    ran = saleg.machines.thesis_transient().replace(start=saleg.engine.start.AtRest())
    assert saleg.Engine.from_toml(out / "engine.toml") == ran
    run = saleg.control.misfire(saleg.machines.thesis_transient())
    written = pd.read_csv(out / "dead_centres.csv")
    assert written["compression_ratio [-]"].tolist() == run.dead_centres.compression_ratio.tolist()
    assert written["motoring [-]"].tolist() == run.dead_centres.motoring.tolist()
    assert list(written)[:2] == ["t [s]", "x [m]"]
    assert (misfired / "a.gif").read_bytes()[:4] == b"GIF8"


def test_a_folder_is_replaced_only_if_told_to(misfired, capsys):
    out = str(misfired / "out")
    assert "add --force" in mistake(capsys, "misfire", "--out", out)
    words = ["misfire", "--strokes", "2", "--no-motor", "--out", out, "--force"]
    assert main(["control", *words]) == 1  # it stalls
    shown = capsys.readouterr().out
    assert line(shown, "recovered after")[2] == "never"
    (misfired / "out" / "notes.txt").write_text("mine")
    assert "left alone" in mistake(capsys, "fuel-cut", "--out", out, "--force")


def test_a_fuel_cut_rings_down(capsys):
    assert main(["control", "fuel-cut"]) == 0
    shown = capsys.readouterr().out
    assert float(line(shown, "0.1 s later")[3]) < 10.0
    assert float(line(shown, "at last")[2]) < 2.0


def test_a_run_too_short_for_a_cycle_has_nothing_to_report(capsys, tmp_path):
    words = ["start-up", "--duration", "0.005", "--out", str(tmp_path / "out")]
    assert main(["control", *words]) == 0
    assert "wrote" in capsys.readouterr().out
    assert not list((tmp_path / "out").glob("*.png"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["start-up", "--strokes", "2"], "--strokes does not belong to start-up"),
        (["misfire", "--base-frequency", "30"], "--base-frequency does not belong to misfire"),
        (["overload", "--no-motor"], "--no-motor does not belong to overload"),
        (["fuel-cut", "--demand", "x.csv"], "--demand does not belong to fuel-cut"),
        (["map", "--duration", "2"], "--duration does not belong to map"),
        (["misfire", "--phase", "literal"], "--phase does not belong to misfire"),
        (["map", "--animate", "a.gif"], "--animate needs a single run, and map is none"),
        (["misfire", "--animate", "a.mp4"], "must end in .gif or .html"),
        (["misfire", "thesis-bass"], "'thesis-base'"),
        (["misfire", "--strokes", "-1"], "strokes"),
        (["start-up", "--duration", "-1"], "duration = -1.0: must be a number > 0"),
        (["start-up", "--base-frequency", "-1"], "base_frequency"),
        (["load-step", "--demand", "nowhere.csv"], "nowhere.csv"),
    ],
)
def test_mistakes(capsys, words, message):
    assert message in mistake(capsys, *words)


def test_a_demand_that_cannot_be_read(capsys, tmp_path):
    path = tmp_path / "demand.csv"
    path.write_text("time,power\n0,3900\n2,many\n")
    assert "line 3" in mistake(capsys, "load-step", "--demand", str(path))
