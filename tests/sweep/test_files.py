"""Sweeps as TOML files, and on the command line."""

import pytest

import saleg
from saleg import sweep
from saleg.cli import main
from saleg.sweep.files import read


def test_sweeps_on_the_command_line(tmp_path, capsys):
    file = tmp_path / "mine.toml"
    file.write_text("[fixed]\negr = 0.1\n[grid]\nbore = [0.06, 0.064]\n")
    assert main(["sweep", str(file)]) == 0
    out = capsys.readouterr().out
    assert "done 2 of 2" in out
    assert "2 steady" in out
    assert (tmp_path / "mine" / "panels.png").exists()
    table = sweep.load(tmp_path / "mine")
    assert table.power[1] == saleg.design.evaluate(bore=0.064, egr=0.1).quick_performance.power
    file.write_text('[sweep]\nmachine = "thesis-base"\n[list]\nbore = [0.06, -1.0]\n')
    assert main(["sweep", str(file), "--out", str(tmp_path / "other")]) == 1
    assert "1 of the failed: 1 wrong field" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("[grod]\nbore = [1.0]", "grod"),
        ("[fixed]\nbore = 0.06", "needs one of"),
        ("[grid]\nbore = {from = 1, to = 2}", "from, to and count"),
        ("[grid]\nbore = {from = 1, to = inf, count = 3}", "finite"),
        ("[grid]\nbore = {from = 1, to = 2, count = 99999999999}", "split the sweep"),
        ("[grid]\nheat_transfer.a = [60, 70]", 'quoted: "heat_transfer.a" ='),
        ("[list]\nheat_transfer.a = [60, 70]", 'quoted: "heat_transfer.a" ='),
        ("[fixed]\nheat_transfer.a = 60\n[grid]\nbore = [0.06]", 'quoted: "heat_transfer.a" ='),
        ("[sobol]\ncount = 4\nranges.heat_transfer.a = [6, 7]", 'quoted: "heat_transfer.a" ='),
        ("[grid]\nbore = [0.06]\n[list]\negr = [0.1]", "no more; has [grid] and [list]"),
        ("[fixed]\nbore = 0.06\n[grid]\nbore = [0.06]", "bore stands in [fixed] and in [grid]"),
        ("[sweep]\nrtol = 1\n[grid]\nbore = [0.06]", "from 1e-13 to 1e-3"),
        ("[sweep]\nrtol = 'x'\n[grid]\nbore = [0.06]", "sweep.rtol = 'x': must be a number"),
        ("[sobol]\ncount = 4\nseed = -1\nranges.bore = [0.05, 0.06]", "seed = -1"),
        ("[grid]\nmoving_mass = [2.0]", "follows from the eight"),
        ("[grid]\nbore = {from = 1, to = 2, count = 1}", "count"),
        ("[sweep]\nmachine = 'thesis-bass'\n[grid]\nbore = [0.06]", "thesis-base"),
        ("[sweep]\nwarm = 1\n[grid]\nbore = [0.06]", "sweep.warm"),
        ("[fixed]\negr = 'x'\n[grid]\nbore = [0.06]", "fixed.egr"),
        ("[fixed]\nergs = 1\n[grid]\nbore = [0.06]", "egr"),
        ("[sobol]\ncount = 8", "ranges"),
        ("[sobol]\nranges = {bore = [0.05, 0.06]}", "count"),
        ("grid = 3", "must be a table"),
        ("[grid", "not a TOML file"),
    ],
)
def test_mistakes_in_sweep_files_are_named(tmp_path, capsys, text, match):
    file = tmp_path / "wrong.toml"
    file.write_text(text)
    assert main(["sweep", str(file)]) == 2
    assert match in capsys.readouterr().err


def test_random_sets_in_files(tmp_path):
    file = tmp_path / "cloud.toml"
    file.write_text("[sobol]\ncount = 8\nseed = 2\n[sobol.ranges]\nbore = [0.05, 0.07]\n")
    assert read(file).points.equals(sweep.sobol({"bore": (0.05, 0.07)}, 8, seed=2))
