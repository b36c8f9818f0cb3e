"""``saleg optimize``: what it writes and prints, going on, and what it refuses."""

import numpy as np
import pandas as pd
import pytest

import saleg
from saleg.cli import main

WANTED = """
[optimize]
target_power = 1e4
method = "ga"
evaluations = 12
seed = 2
[settings]
size = 6
[bounds]
bore = [0.05, 0.07]
half_stroke = [0.06, 0.1]
[fixed]
port_location = 0.45
intake_pressure = 1.2e5
intake_temperature = 300.0
spring_stiffness = 150e3
equivalence_ratio = 0.5
egr = 0.2
[improve]
evaluations = 6
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("optimize")
    (folder / "ten.toml").write_text(WANTED)
    assert main(["optimize", str(folder / "ten.toml"), "--workers", "1"]) == 0
    return folder / "ten"


def test_the_best_engine_runs_and_delivers_what_its_row_says(folder):
    table = pd.read_csv(folder / "designs.csv")
    best = saleg.Engine.from_toml(folder / "best.toml")
    found = saleg.steady_state(best)
    rows = table[np.isclose(table["bore [m]"], best.left.bore, rtol=1e-12)]
    assert found.performance.power == pytest.approx(rows["power [W]"].iloc[0], rel=1e-4)


def test_pictures_and_the_log_are_there(folder):
    names = {path.name for path in folder.iterdir()}
    assert {"designs.csv", "best.toml", "convergence.png", "parallel.png", "improved"} <= names
    assert [path.name for path in (folder / "improved").glob("*.toml")] == []
    assert len(pd.read_csv(folder / "designs.csv")) == 12


def test_the_same_command_goes_on_and_changes_nothing(folder, capsys):
    before = (folder / "designs.csv").read_bytes()
    assert main(["optimize", f"{folder}.toml"]) == 0
    assert (folder / "designs.csv").read_bytes() == before
    printed = capsys.readouterr().out
    assert "12 of 12 designs, score 0." in printed
    assert "no steady state within the limits in 6 designs" in printed  # of the second stage
    assert "best design (steady, stable):" in printed


def test_another_optimisation_is_refused_in_its_folder(folder, tmp_path, capsys):
    other = tmp_path / "other.toml"
    other.write_text(WANTED.replace("seed = 2", "seed = 3"))
    assert main(["optimize", str(other), "--out", str(folder)]) == 2
    assert "seed" in capsys.readouterr().err


def test_a_mistake_in_the_file_is_named(tmp_path, capsys):
    path = tmp_path / "wrong.toml"
    path.write_text("[optimize]\nevaluation = 3\n")
    assert main(["optimize", str(path)]) == 2
    assert "optimize.evaluation: unknown key; did you mean 'evaluations'" in capsys.readouterr().err
    assert main(["optimize", str(tmp_path / "none.toml")]) == 2
