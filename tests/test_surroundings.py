"""Where saleg runs: without a console, from a zip file, without its source; paths and codings."""

import io
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import saleg
from saleg import EngineFileError, sweep
from saleg.cli import main
from saleg.compiler import plain
from saleg.compiler.cache import cache_folder
from saleg.control import Demand
from saleg.errors import ControllerError, RunFileError, SweepError
from saleg.sweep.files import read as read_sweep


class OnlyWrites:
    """What some programs that embed Python put in the place of ``sys.stderr``."""

    def write(self, text):
        return len(text)


def closed():
    file = io.StringIO()
    file.close()
    return file


@pytest.fixture(params=[lambda: None, OnlyWrites, closed], ids=["none", "no isatty", "closed"])
def no_console(request, monkeypatch):
    monkeypatch.setattr(sys, "stderr", request.param())


@pytest.mark.usefixtures("no_console")
def test_without_a_console_all_goes_on(base):
    assert saleg.simulate(base, 0.1).status is saleg.Status.COMPLETED
    assert list(sweep.run(sweep.grid({"bore": [0.064]}), multipliers=False).status) == ["steady"]


def test_commands_without_a_console(monkeypatch, capsys):
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["run", "thesis-base", "--duration", "0.1"]) == 0
    assert "completed" in capsys.readouterr().out
    assert main(["run", "thesis-bass"]) == 2
    assert capsys.readouterr().out == ""  # no complaint among the results
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["list"]) == 0


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("SALEG_CACHE_DIR", str(cache_folder()))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_home_folder_in_paths(base_run, home):
    base_run.save("~/run.npz")
    assert saleg.Run.load("~/run.npz").engine == base_run.engine
    base_run.save("~/tables")
    assert saleg.Run.load(Path("~/tables")).engine == base_run.engine
    saleg.plotting.animate(base_run, "~/film.gif", frames=2, width=4.0)
    points = sweep.grid({"bore": [0.064]})
    table = sweep.run(points, folder="~/sweep", multipliers=False)
    assert sweep.load("~/sweep").equals(table)
    (home / "engine.toml").write_text(base_run.engine.to_toml())
    assert saleg.Engine.from_toml("~/engine.toml") == base_run.engine
    assert main(["run", "~/engine.toml", "--duration", "0.3", "--out", "~/out"]) == 0
    assert main(["fundamental", "9", "--out", "~/figure.png"]) == 0
    names = {entry.name for entry in home.iterdir()}
    assert names >= {"run.npz", "tables", "film.gif", "sweep", "engine.toml", "out", "figure.png"}
    assert "~" not in names


def test_a_name_that_only_looks_like_a_home(base_run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    base_run.save("~no such user.npz")
    assert (tmp_path / "~no such user.npz").is_file()


@pytest.mark.parametrize("coding", ["utf-16-le", "utf-16-be"])
def test_files_in_utf16_are_named_as_such(base, base_run, tmp_path, coding):
    """As some editors and older PowerShells save them."""

    def wide(file, text):
        file.write_bytes(("\ufeff" + text).encode(coding))
        return file

    with pytest.raises(EngineFileError, match=r"engine\.toml: .*UTF-16"):
        saleg.Engine.from_toml(wide(tmp_path / "engine.toml", base.to_toml()))
    with pytest.raises(EngineFileError, match=r"sweep\.toml: .*UTF-16"):
        read_sweep(wide(tmp_path / "sweep.toml", "[grid]\nbore = [0.064]\n"))
    with pytest.raises(ControllerError, match=r"demand\.csv: .*UTF-16"):
        Demand.read(wide(tmp_path / "demand.csv", "t,P\n0,1e4\n1,2e4\n"))
    base_run.save(tmp_path / "run")
    strokes = tmp_path / "run" / "strokes.csv"
    wide(strokes, strokes.read_text())
    with pytest.raises(RunFileError, match="UTF-16"):
        saleg.Run.load(tmp_path / "run")
    folder = tmp_path / "sweep"
    sweep.run(sweep.grid({"bore": [0.064]}), folder=folder, multipliers=False)
    wide(folder / "results.csv", (folder / "results.csv").read_text())
    with pytest.raises(SweepError, match=r"results\.csv is damaged: .*UTF-16"):
        sweep.load(folder)


ZIPPED = """
import saleg
assert ".zip" in saleg.__file__
run = saleg.simulate(saleg.machines.thesis_base(), 0.1)
from saleg.thesis.tables import columns, table
print(run.performance.frequency, len(columns(9)), len(table(2)))
"""


def test_from_a_zip_file(base, tmp_path):
    package = Path(saleg.__file__).parent
    with zipfile.ZipFile(tmp_path / "saleg.zip", "w") as file:
        for entry in [*package.rglob("*.py"), *package.rglob("*.csv")]:
            file.write(entry, Path("saleg") / entry.relative_to(package))
    out = subprocess.run(
        [sys.executable, "-c", ZIPPED],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "saleg.zip")},
    )
    frequency = saleg.simulate(base, 0.1).performance.frequency
    assert out.stdout.split()[:2] == [str(frequency), "9"], out.stderr


def test_without_source_all_runs_as_python(base, monkeypatch):
    """As where only ``.pyc`` files are installed."""
    compiled = saleg.simulate(base, 0.015, rtol=1e-8)

    def gone(*_):
        raise FileNotFoundError

    with monkeypatch.context() as changed:
        changed.setattr("pkgutil.get_data", gone)
        plain._has_source.cache_clear()
        with pytest.warns(RuntimeWarning, match="without its source") as caught:
            runs = [saleg.simulate(base, 0.015, rtol=1e-8) for _ in range(2)]
    plain._has_source.cache_clear()
    assert len(caught) == 1
    assert runs[0].strokes["x_end"] == pytest.approx(compiled.strokes["x_end"], rel=1e-9)
