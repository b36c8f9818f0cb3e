import dataclasses
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

import saleg
from saleg.cli import folder, main
from saleg.export import csv_folder


def run(*words):
    return main(["run", *words])


def mistake(capsys, *words):
    """Message of a command that must end as a user's mistake."""
    assert main(list(words)) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "Traceback" not in shown.err
    return shown.err


def test_a_process_of_its_own():
    shown = subprocess.run(
        [sys.executable, "-m", "saleg", "--version"], capture_output=True, text=True, check=True
    )
    assert shown.stdout == f"saleg {saleg.__version__}\n"
    failed = subprocess.run(
        [sys.executable, "-m", "saleg", "run", "thesis-bass"], capture_output=True, text=True
    )
    assert failed.returncode == 2
    assert "'thesis-base'" in failed.stderr
    assert "Traceback" not in failed.stderr


def test_list_shows_machines_and_laws(capsys):
    assert main(["list"]) == 0
    machines = capsys.readouterr().out
    assert main(["list", "laws"]) == 0
    laws = capsys.readouterr().out
    assert all(name in machines for name in saleg.machines.CATALOGUE)
    assert "64 mm bore" in machines
    assert all(word in laws for word in ("heat_transfer", "Hohenberg", "start", "AtRest"))


def test_the_base_case_stands_beside_the_thesis(capsys):
    assert run("thesis-base") == 0
    shown = capsys.readouterr().out
    assert "steady" in shown
    frequency = next(line for line in shown.splitlines() if "frequency" in line and "%" in line)
    assert "46.9 " in frequency
    assert "47.02" in frequency
    assert frequency.count("%") == 2
    assert "Why they differ" in shown


def test_a_changed_engine_stands_alone(capsys):
    assert run("thesis-base", "--set", "intake.temperature=330", "--duration", "0.5") == 0
    assert "Table" not in capsys.readouterr().out


def test_the_other_machine(capsys):
    assert run("thesis-transient") == 0
    assert "Table 13" in capsys.readouterr().out


MISTAKES = [
    (["thesis-bass"], "'thesis-base'"),
    (["nowhere.toml"], "cannot read nowhere.toml"),
    (["thesis-base", "--set", "boar=0.06"], "'bore'"),
    (["thesis-base", "--set", "bore"], "PATH=VALUE"),
    (["thesis-base", "--set", "bore="], "PATH=VALUE"),
    (["thesis-base", "--set", "bore=wide"], "bore = 'wide' [m]: must be a number"),
    (["thesis-base", "--set", "bore=-1"], "bore = -1.0 [m]: must be > 0"),
    (["thesis-base", "--set", "bore=nan"], "bore = nan [m]: must be a finite number > 0"),
    (["thesis-base", "--set", "heat_transfer=Hohenburg"], "'Hohenberg'"),
    (["thesis-base", "--duration", "-1"], "duration = -1.0"),
    (["thesis-base", "--order", "7"], "order = 7: must be one of 1, 2, 3, 4, 5, 8"),
    (["thesis-base", "--order", "4", "--method", "adaptive"], "--order does not belong"),
    (["thesis-base", "--rtol", "1e-6", "--method", "fixed"], "--rtol does not belong"),
]


@pytest.mark.parametrize(("words", "message"), MISTAKES)
def test_a_mistake_gives_one_clear_message(capsys, words, message):
    assert message in mistake(capsys, "run", *words)


@pytest.mark.parametrize(
    ("words", "message"),
    [([], "COMMAND"), (["run", "thesis-base", "--step", "tiny"], "'tiny'"), (["fly"], "'fly'")],
)
def test_words_argparse_refuses(capsys, words, message):
    with pytest.raises(SystemExit) as caught:
        main(words)
    assert caught.value.code == 2
    assert message in capsys.readouterr().err


def test_a_bad_engine_file_is_named(capsys, base, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(base.to_toml().replace("bore", "boar"))
    assert "cylinder.boar" in mistake(capsys, "run", str(path))
    path.write_text(base.to_toml().replace("bore = 0.064", "bore = -1.0"))
    message = mistake(capsys, "run", str(path))
    assert "mine.toml" in message
    assert "bore = -1.0 [m]" in message


def test_a_run_that_ends_badly_is_still_shown(capsys):
    assert run("thesis-base", "--set", "equivalence_ratio=0", "--duration", "2") == 1
    shown = capsys.readouterr().out
    assert "stalled" in shown
    assert "nan" not in shown


def test_laws_are_changed_by_name(capsys):
    words = ["--set", "friction=BlairViscousFriction", "--set", "name=tuned"]
    assert run("thesis-base", *words, "--duration", "0.5") == 0
    assert capsys.readouterr().out.startswith("tuned: ")


def test_settings_reach_the_integrator(capsys, monkeypatch):
    seen = {}

    def spy(engine, duration, **settings):
        seen.update(settings, duration=duration)
        return saleg.simulate(engine, 0.05)

    monkeypatch.setattr("saleg.cli.run.simulate", spy)
    run("thesis-base", "--order", "8", "--step", "2e-5", "--duration", "0.2")
    assert seen == {"method": "fixed", "order": 8, "step": 2e-5, "duration": 0.2}
    seen.clear()
    run("thesis-base", "--rtol", "1e-6")
    assert seen == {"method": "adaptive", "rtol": 1e-6, "duration": 2.5}


def test_a_history_is_kept_and_written(base, tmp_path, capsys):
    target = tmp_path / "case"
    words = ["thesis-base", "--duration", "0.1", "--history", "20"]
    assert run(*words, "--out", str(target)) == 0
    kept = saleg.simulate(base, 0.1, history=20).history
    assert saleg.Run.load(target).history.equals(kept)
    capsys.readouterr()
    assert "--history belongs to --out" in mistake(capsys, "run", *words)


def test_less_than_a_cycle_is_not_compared(capsys):
    assert run("thesis-base", "--duration", "0.003") == 0
    shown = capsys.readouterr().out
    assert "less than a cycle" in shown
    assert "nan" not in shown
    assert "Table" not in shown


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A folder as ``--out`` leaves it, below folders that were not there before."""
    target = tmp_path_factory.mktemp("out") / "new" / "case"
    assert (
        run("thesis-base", "--set", "bore=0.0641", "--duration", "0.5", "--out", str(target)) == 0
    )
    return target


def test_out_writes_everything_and_nothing_else(written):
    assert {path.name for path in written.iterdir()} == set(folder.FILES)
    assert [path.name for path in written.parent.iterdir()] == ["case"]
    for name in ("pv.png", "velocity_position.png"):
        assert (written / name).read_bytes().startswith(b"\x89PNG")


def test_tables_carry_units_and_the_whole_precision(written, base):
    engine = base.replace(bore=0.0641)
    again = saleg.simulate(engine, 0.5)
    cycles = pd.read_csv(written / "cycles.csv")
    assert list(cycles["stroke [m]"]) == list(again.cycles["stroke"])
    assert list(cycles.columns[:3]) == ["cycle", "t [s]", "period [s]"]
    performance = pd.read_csv(written / "performance.csv").iloc[0]
    assert performance["power [W]"] == again.performance.power
    assert list(performance.index) == [
        f"{name} [{folder.PERFORMANCE_UNITS[name]}]" for name in again.performance.to_dict()
    ]
    assert list(pd.read_csv(written / "events.csv").columns[:4]) == [
        "t [s]",
        "event",
        "side",
        "x [m]",
    ]
    assert "p_left [Pa]" in pd.read_csv(written / "orbit.csv")


def test_every_figure_has_a_unit():
    names = {item.name for item in dataclasses.fields(saleg.Performance)}
    assert names <= set(folder.PERFORMANCE_UNITS)


def test_the_engine_written_runs_again(written, base, capsys):
    path = written / "engine.toml"
    assert saleg.Engine.from_toml(path) == base.replace(bore=0.0641)
    assert run(str(path), "--duration", "0.1") == 0


def test_a_run_without_a_cycle_writes_its_tables(tmp_path, capsys):
    target = tmp_path / "short"
    run("thesis-base", "--duration", "1e-3", "--out", str(target))
    assert {path.name for path in target.iterdir()} == {
        "engine.toml",
        "run.json",
        "performance.csv",
        "cycles.csv",
        "events.csv",
        "strokes.csv",
    }
    assert "less than a cycle" in saleg.Run.load(target).message


def test_an_existing_folder_is_kept_without_force(written, capsys):
    before = (written / "engine.toml").read_bytes()
    assert "--force" in mistake(capsys, "run", "thesis-base", "--out", str(written))
    assert (written / "engine.toml").read_bytes() == before


def test_force_replaces_an_earlier_run(written, tmp_path, capsys):
    target = tmp_path / "case"
    shutil.copytree(written, target)
    assert run("thesis-base", "--duration", "0.1", "--out", str(target), "--force") == 0
    assert "bore = 0.064 " in (target / "engine.toml").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["case"]


def test_force_leaves_a_strange_folder_alone(tmp_path, capsys):
    target = tmp_path / "thesis"
    target.mkdir()
    (target / "chapter1.tex").write_text("years of work")
    message = mistake(capsys, "run", "thesis-base", "--out", str(target), "--force")
    assert "chapter1.tex" in message
    assert (target / "chapter1.tex").read_text() == "years of work"


@pytest.mark.parametrize("place", ["file", "file/below"])
def test_a_file_in_the_way(tmp_path, capsys, place):
    (tmp_path / "file").write_text("mine")
    message = mistake(capsys, "run", "thesis-base", "--out", str(tmp_path / place))
    assert "is a file" in message


def test_a_folder_that_cannot_be_made(tmp_path, capsys, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "mkdir", refuse)
    message = mistake(capsys, "run", "thesis-base", "--out", str(tmp_path / "case"))
    assert "cannot write" in message
    assert "Permission denied" in message


@pytest.mark.parametrize("place", ["simulate", "write_run"])
def test_ctrl_c_leaves_nothing(tmp_path, capsys, monkeypatch, place):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(f"saleg.cli.run.{place}", interrupted)
    assert run("thesis-base", "--duration", "0.1", "--out", str(tmp_path / "a" / "b")) == 130
    assert "interrupted" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_while_writing_keeps_the_earlier_run(written, tmp_path, capsys, monkeypatch):
    target = tmp_path / "case"
    shutil.copytree(written, target)
    write = csv_folder.write_table
    count = []

    def interrupted(file, columns):
        count.append(file)
        if len(count) == 3:
            raise KeyboardInterrupt
        write(file, columns)

    monkeypatch.setattr(csv_folder, "write_table", interrupted)
    assert run("thesis-base", "--duration", "0.1", "--out", str(target), "--force") == 130
    assert [path.name for path in tmp_path.iterdir()] == ["case"]
    assert {path.name for path in target.iterdir()} == set(folder.FILES)
    assert "bore = 0.0641" in (target / "engine.toml").read_text()


def test_a_full_disk_is_told_and_leaves_nothing(tmp_path, capsys, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(csv_folder, "write_table", full)
    message = mistake(
        capsys, "run", "thesis-base", "--duration", "0.1", "--out", str(tmp_path / "case")
    )
    assert "No space left" in message
    assert list(tmp_path.iterdir()) == []


def test_warnings_are_one_line(capsys, monkeypatch, recwarn):
    import warnings

    def warn(*_, **__):
        warnings.warn("beware", RuntimeWarning, stacklevel=1)
        return saleg.simulate(saleg.machines.thesis_base(), 0.1)

    warnings.simplefilter("always")
    monkeypatch.setattr("saleg.cli.run.simulate", warn)
    run("thesis-base")
    assert capsys.readouterr().err == "saleg: warning: beware\n"
