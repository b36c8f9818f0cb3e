"""The command line tells: parameters, units, what is compiled, what is swept; pictures by name."""

import logging
import os
import subprocess
import sys

import numpy as np
import pytest

import saleg
from saleg.cli import main
from saleg.cli.parameters import parameters_of
from saleg.compiler import machine_code
from saleg.compiler.kernel import COMPILING, Kernel
from saleg.compiler.module import load
from saleg.files.units import UNITS, UnitError, number_in_si
from saleg.quantities import GIVEN_IN
from saleg.studies import elasticities


def said(capsys, *words, code=0):
    assert main(list(words)) == code
    shown = capsys.readouterr()
    assert "Traceback" not in shown.err
    return shown.err if code == 2 else shown.out


def test_every_parameter_can_be_set_to_its_own_value(base):
    bounce = saleg.BounceChamber(bore=0.064, half_stroke=0.15, pressure=4e5)
    for engine in (base, base.replace(right=bounce)):
        parameters = list(parameters_of(engine))
        assert len(parameters) > 30
        for parameter in parameters:
            assert parameter.meaning, parameter.path
            value = engine.get(parameter.path)
            assert engine.replace(**{parameter.path: value}) == engine
    rows = {parameter.path: parameter for parameter in parameters_of(base)}
    assert rows["bore"][1:] == ("0.064", "m", "> 0 (usual 0.0001 to 1)", "Bore b")
    assert "Eq. 59" in rows["alternator.target_stroke"].meaning


def test_list_parameters(capsys, base, tmp_path):
    told = said(capsys, "list", "parameters")
    assert "springs.stiffness" in told
    assert told == said(capsys, "list", "parameters", "thesis-base")
    file = tmp_path / "engine.toml"
    file.write_text(base.replace(bore=0.07).to_toml())
    assert "bore" in said(capsys, "list", "parameters", str(file))
    assert "'thesis-base'" in said(capsys, "list", "parameters", "thesis-bass", code=2)
    assert "takes no machine" in said(capsys, "list", "laws", "thesis-base", code=2)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("66mm", "m", 0.066),
        (" 66 mm ", "m", 0.066),
        ("0.066", "m", 0.066),
        ("2.5 inch", "m", 0.0635),
        ("1.05bar", "Pa", 1.05e5),
        ("105 kPa", "Pa", 1.05e5),
        ("1 atm", "Pa", 101325.0),
        ("51.9 °C", "K", 325.05),
        ("20kN/m", "N/m", 2e4),
        ("20 N/mm", "N/m", 2e4),
        ("1.25 ms", "s", 1.25e-3),
        ("50 µs", "s", 50e-6),
        ("12%", "-", 0.12),
        ("2390 g", "kg", 2.39),
        ("12.4 N*s/m", "N s/m", 12.4),
        ("-1e-2m", "m", -0.01),
    ],
)
def test_a_number_with_its_unit(text, unit, value):
    assert number_in_si(text, unit) == pytest.approx(value, rel=1e-15)


def test_units_agree_with_those_of_the_hints():
    for si, units in GIVEN_IN.items():
        for name, factor, offset in units:
            if name in UNITS.get(si, {}):
                assert UNITS[si][name] == (factor, offset)


@pytest.mark.parametrize("text", ["66 bar", "66 m m", "66furlong", "1,5 mm", "6e mm"])
def test_a_wrong_unit(text):
    with pytest.raises(UnitError):
        number_in_si(text, "m")
    assert number_in_si("wide", "m") is None


def test_values_with_units_and_paths_of_files(capsys):
    plain = said(capsys, "steady", "thesis-base", "--set", "bore=0.066", "--set", "egr=0.13")
    for words in (("bore=66mm", "egr=13%"), ("cylinder.bore=6.6 cm", "cylinder.egr=13 %")):
        changes = [word for change in words for word in ("--set", change)]
        assert said(capsys, "steady", "thesis-base", *changes) == plain
    told = said(capsys, "steady", "thesis-base", "--set", "bore=66bar", code=2)
    assert told == (
        "saleg: --set bore=66bar: 'bar' is no unit here; there are m, mm, cm, um, inch\n"
    )
    assert "'bore'" in said(capsys, "steady", "thesis-base", "--set", "boar=66mm", code=2)


def test_what_is_compiled_is_told_once(tmp_path, monkeypatch, caplog):
    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))
    caplog.set_level(logging.INFO, "saleg.compiler")
    text = "import numba\n@numba.njit(cache=ON_DISK)\ndef twice(x):\n    return 2 * x\n"
    kernels = [Kernel(*load(text, "told")) for _ in range(2)]
    assert kernels[0].call("twice", 4) == 8
    assert [record.getMessage() for record in caplog.records] == [COMPILING]
    kernels[0].call("twice", 5)
    assert kernels[1].call("twice", 4) == 8  # from disk
    assert len(caplog.records) == 1
    kept = kernels[1]._kept
    assert machine_code.is_on_disk(kernels[1].function("twice"), kept.path, kept.code)


def test_the_command_line_says_what_is_compiled(capsys, monkeypatch):
    def slow(*_):
        for _ in range(3):
            logging.getLogger("saleg.compiler.kernel").info(COMPILING)

    monkeypatch.setattr("saleg.cli.listing.laws_by_slot", lambda: slow() or {})
    assert main(["list", "laws"]) == 0
    assert capsys.readouterr().err == f"saleg: {COMPILING}\n"
    slow()  # nothing listens any more
    assert capsys.readouterr().err == ""


def test_plot_by_name(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = said(capsys, "steady", "thesis-base", "--plot", "forces", "--plot", "dynamics")
    assert "wrote forces.png, dynamics.png" in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dynamics.png", "forces.png"]
    words = ["run", "thesis-base", "--duration", "0.2", "--plot", "power", "--out", "out"]
    assert "power.png" in said(capsys, *words)
    assert (tmp_path / "out" / "power.png").is_file()
    assert "power.png" in said(capsys, *words, "--force")
    assert "'forces'" in said(capsys, "run", "thesis-base", "--plot", "force", code=2)


def test_sweep_says_what_it_sweeps_and_draws_two_inputs(capsys, tmp_path):
    file = tmp_path / "two.toml"
    file.write_text(
        '[sweep]\nmachine = "thesis-base"\nmultipliers = false\n'
        "[grid]\nbore = [0.06, 0.064]\negr = [0.1, 0.2]\n"
    )
    told = said(capsys, "sweep", str(file))
    assert told.startswith("engine thesis-base, fixed mass: 4 points of bore 0.06 to 0.064, egr")
    assert (tmp_path / "two" / "map.png").is_file()


def test_design(capsys, tmp_path):
    out = tmp_path / "engine.toml"
    told = said(capsys, "design", "--set", "bore=60mm", "--out", str(out))
    designed = saleg.design.evaluate(bore=0.06)
    assert f"{1e3 * designed.component_figures['engine_length']:.4g} mm" in told
    assert saleg.Engine.from_toml(out).get("bore") == 0.06
    assert "spring_stiffness" in said(capsys, "design", "--list")
    assert "'bore'" in said(capsys, "design", "--set", "boar=60mm", code=2)
    assert "no unit here" in said(capsys, "design", "--set", "bore=60bar", code=2)
    assert "NAME=VALUE" in said(capsys, "design", "--set", "bore", code=2)


def test_sensitivity(capsys, base, tmp_path):
    words = ["--inputs", "bore", "--figures", "power,stroke", "--out", str(tmp_path / "a.csv")]
    told = said(capsys, "sensitivity", "thesis-base", *words)
    table = elasticities(base, ["bore"], ["power", "stroke"])
    assert f"{table.loc['bore', 'power']:+.3f}" in told
    head, row = (tmp_path / "a.csv").read_text().splitlines()
    assert head == "input [-],power [-],stroke [-]"
    np.testing.assert_allclose([float(cell) for cell in row.split(",")[1:]], table.iloc[0])
    assert "'bore'" in said(capsys, "sensitivity", "thesis-base", "--inputs", "bor", code=2)
    assert "'power'" in said(capsys, "sensitivity", "thesis-base", "--figures", "pover", code=2)


def test_studies(capsys, tmp_path):
    assert "friction-laws" in said(capsys, "studies")
    told = said(capsys, "studies", "friction-laws", "--out", str(tmp_path / "a.csv"))
    assert "viscous" in told
    assert "efficiency [%]" in told
    assert "message" in (tmp_path / "a.csv").read_text().splitlines()[0]
    assert "'friction-laws'" in said(capsys, "studies", "friction-law", code=2)


def completed(line, tmp_path):
    """What a shell is told of how a line may go on."""
    answer = tmp_path / "answer"
    environment = {
        **os.environ,
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_SHELL": "bash",
        "_ARGCOMPLETE_IFS": "\n",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(answer),
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
        "COMP_TYPE": "9",
    }
    subprocess.run([sys.executable, "-m", "saleg"], env=environment, check=False, cwd=tmp_path)
    return [word.strip() for word in answer.read_text().splitlines()]


def test_completion(tmp_path):
    pytest.importorskip("argcomplete")
    assert "steady" in completed("saleg st", tmp_path)
    assert {"thesis-base", "thesis-transient"} <= set(completed("saleg run thesis-", tmp_path))
    assert "intake.pressure=" in completed("saleg run thesis-base --set intake.p", tmp_path)
    assert "forces" in completed("saleg run thesis-base --plot for", tmp_path)
    assert "friction-laws" in completed("saleg studies fri", tmp_path)
