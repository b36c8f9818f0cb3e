"""The folder of a sweep: what is kept, damaged, killed and resumed."""

import json
import math
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

from helpers import SMALL_SWEEP
from saleg import sweep
from saleg.cli import main
from saleg.design import Design
from saleg.sweep.files import read
from saleg.sweep.store import table_text

SWEEP_FILE = """
[sweep]
multipliers = false
chunk = 1
[grid]
bore = { from = 0.055, to = 0.075, count = 150 }
"""


def _command(words, pipe):
    """The command in a fork, which has imported and compiled all already; its lines in a pipe."""
    with open(pipe, "w", encoding="utf-8") as sys.stdout:
        main(words)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="kills forks")
def test_a_sweep_killed_at_random_loses_nothing_it_reported(tmp_path):
    """SIGKILL ten times at random moments; then it ends as if nothing had happened."""
    file = tmp_path / "bores.toml"
    file.write_text(SWEEP_FILE)
    asked = read(file)
    whole = sweep.run(asked.points, asked.swept, folder=tmp_path / "whole", **asked.settings)
    folder, seed = tmp_path / "killed", random.Random(5)
    words = ["sweep", str(file), "--workers", "1", "--out", str(folder)]
    fork = multiprocessing.get_context("fork")
    reported, kills, most = 0, 0, 0
    while kills < 10:
        ours, theirs = os.pipe()
        process = fork.Process(target=_command, args=(words, theirs))
        process.start()
        os.close(theirs)
        with open(ours, encoding="utf-8") as shown:
            lines = seed.randint(1, 12)
            for text in shown:
                told = text.split()
                if told[0] == "done":
                    now = int(told[1])
                    assert now > reported or now == 150
                    reported = now
                    lines -= 1
                if lines <= 0:
                    break
            time.sleep(0.02 * seed.random())
            process.kill()
            reported = max([reported] + [int(x.split()[1]) for x in shown if x.startswith("done")])
        process.join()
        assert process.exitcode == -signal.SIGKILL
        kills += 1
        kept = len(list((folder / "parts").glob("[0-9]*.json")))
        assert kept >= reported, (kept, reported)
        assert kept >= most
        most = kept
    assert kept < 150
    resumed = sweep.run(asked.points, asked.swept, folder=folder, **asked.settings)
    assert resumed.equals(whole)
    for name in ("results.csv", "points.csv", "sweep.json"):
        assert (folder / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


def test_a_sweep_that_ends_at_any_of_its_writes_is_taken_up_again(tmp_path, monkeypatch):
    """Digests and tables never disagree: inputs, description, parts, digest, results."""
    from saleg.files import atomic

    points, written = sweep.grid(SMALL_SWEEP), []

    def ends_before(last):
        def write(path, text):
            if len(written) == last:
                raise KeyboardInterrupt
            written.append(path.name)
            atomic.write_text(path, text)

        return write

    whole = sweep.run(points, chunk=3, multipliers=False)
    for last in range(6):
        folder = tmp_path / str(last)
        written.clear()
        with monkeypatch.context() as patched:
            patched.setattr("saleg.sweep.store.write_text", ends_before(last))
            with pytest.raises(KeyboardInterrupt):
                sweep.run(points, folder=folder, chunk=3, multipliers=False, workers=1)
        assert sweep.run(points, folder=folder, chunk=3, multipliers=False).equals(whole)
        assert sweep.load(folder).equals(whole)
    assert written[-1] == "results.sha256"


def test_a_folder_says_what_it_holds_and_takes_no_other_sweep(tmp_path):
    folder = tmp_path / "s"
    points = sweep.grid(SMALL_SWEEP)
    table = sweep.run(points, folder=folder, chunk=2)
    assert sweep.load(folder).equals(table)
    assert sweep.load(folder).attrs == table.attrs
    known = json.loads((folder / "sweep.json").read_text())
    assert known["inputs"] == {"bore": "m", "egr": "-"}
    assert known["swept"]["parameters"]["half_stroke"] == 0.1
    assert "[cylinder.ignition]" in known["swept"]["laws"]
    assert (folder / "results.csv").read_text().startswith("bore [m],egr [-],status [-]")
    called = []
    sweep.run(points, folder=folder, chunk=2, report=lambda done, total: called.append(done))
    assert called == [6]
    for other in (
        {"points": sweep.grid({"bore": [0.06]})},
        {"rtol": 1e-7},
        {"swept": Design().replace(bore=0.05)},
    ):
        with pytest.raises(sweep.SweepError, match="another sweep"):
            sweep.run(**{"points": points, "chunk": 2, "folder": folder, **other})
    with pytest.raises(sweep.SweepError, match="no finished sweep"):
        sweep.load(tmp_path / "none")
    strange = tmp_path / "strange"
    strange.mkdir()
    (strange / "thesis.pdf").write_text("")
    with pytest.raises(sweep.SweepError, match="no folder of a sweep"):
        sweep.run(points, folder=strange)


def test_a_sweep_goes_on_under_another_version(stopped, monkeypatch):
    """Parts kept by another version, whatever its kernel, are not done again."""
    monkeypatch.setattr("saleg.sweep.runs.__version__", "99.0")
    done = []
    sweep.run(
        sweep.grid(SMALL_SWEEP), folder=stopped, chunk=2, report=lambda now, _: done.append(now)
    )
    assert done == [6]
    assert json.loads((stopped / "sweep.json").read_text())["version"] != "99.0"


def test_a_file_of_the_users_own_is_left_alone(tmp_path):
    points = sweep.grid({"bore": [0.064]})
    (tmp_path / "points.csv").write_text("mine")
    with pytest.raises(sweep.SweepError, match=r"it holds points\.csv"):
        sweep.run(points, folder=tmp_path)
    assert (tmp_path / "points.csv").read_text() == "mine"
    assert [file.name for file in tmp_path.iterdir()] == ["points.csv"]


@pytest.fixture
def stopped(tmp_path):
    """A sweep that was stopped after some of its parts."""

    def stop(done, total):
        if done >= 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep.run(sweep.grid(SMALL_SWEEP), folder=tmp_path / "s", chunk=2, report=stop, workers=1)
    return tmp_path / "s"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{}",
        '{"status":["steady"]}',
        '{"columns": {"status": ["steady", "steady"]}}',
        None,
    ],
)
def test_a_damaged_part_is_done_again(stopped, text):
    part = stopped / "parts" / "0000000.json"
    part.write_text(part.read_text()[:-60] if text is None else text)
    whole = sweep.run(sweep.grid(SMALL_SWEEP), chunk=2)
    assert sweep.run(sweep.grid(SMALL_SWEEP), folder=stopped, chunk=2).equals(whole)


def test_a_part_with_a_changed_number_is_done_again(stopped):
    part = stopped / "parts" / "0000000.json"
    part.write_text(part.read_text().replace("steady", "stalled"))
    assert (sweep.run(sweep.grid(SMALL_SWEEP), folder=stopped, chunk=2).status == "steady").all()


@pytest.mark.parametrize(
    ("name", "damage"),
    [
        ("results.csv", lambda text: text[: text.rindex("0.064")]),  # cut at the end of a line
        ("results.csv", lambda text: text[:-9]),
        ("results.csv", lambda text: ""),
        ("results.csv", lambda text: "a,b\n1,2\n"),
        ("results.csv", lambda text: text.replace("egr [-]", "phi [-]")),
        ("results.csv", lambda text: text.replace("0.062", "wide")),
        ("results.csv", lambda text: text.replace("0.062", "0.063")),
        ("sweep.json", lambda text: "[1, 2]"),
        ("sweep.json", lambda text: "{}"),
        ("sweep.json", lambda text: text[:-40]),
    ],
)
def test_damaged_folders_are_named(tmp_path, name, damage):
    folder = tmp_path / "s"
    sweep.run(sweep.grid(SMALL_SWEEP), folder=folder, multipliers=False)
    file = folder / name
    file.write_text(damage(file.read_text()))
    with pytest.raises(sweep.SweepError, match=str(folder)):
        sweep.load(folder)
    with pytest.raises(sweep.SweepError, match=str(folder)):
        sweep.run(sweep.grid(SMALL_SWEEP), folder=folder, multipliers=False)


def test_no_points_are_a_sweep_too(tmp_path):
    points = pd.DataFrame({"bore": np.zeros(0)})
    assert len(sweep.run(points, folder=tmp_path / "s")) == 0
    assert len(sweep.run(points, folder=tmp_path / "s")) == 0


def test_missing_and_binary_files_are_named(tmp_path):
    folder = tmp_path / "s"
    sweep.run(sweep.grid(SMALL_SWEEP), folder=folder, multipliers=False)
    (folder / "results.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(sweep.SweepError, match=r"results.csv is damaged"):
        sweep.load(folder)
    with pytest.raises(sweep.SweepError, match=r"results.csv is damaged"):
        sweep.run(sweep.grid(SMALL_SWEEP), folder=folder, multipliers=False)


def test_altered_inputs_are_named_and_missing_ones_written_again(tmp_path):
    folder, points = tmp_path / "s", sweep.grid(SMALL_SWEEP)
    table = sweep.run(points, folder=folder, multipliers=False)
    written = (folder / "points.csv").read_text()
    (folder / "points.csv").write_text(written[:-5])
    with pytest.raises(sweep.SweepError, match=r"points.csv is damaged: it is not as it was"):
        sweep.run(points, folder=folder, multipliers=False)
    with pytest.raises(sweep.SweepError, match=r"another sweep \(other count, points\)"):
        sweep.run(points[:-1], folder=folder, multipliers=False)
    (folder / "points.csv").unlink()
    assert sweep.run(points, folder=folder, multipliers=False).equals(table)
    assert (folder / "points.csv").read_text() == written


def test_a_folder_made_before_digests_were_kept_is_read(tmp_path):
    folder, points = tmp_path / "s", sweep.grid(SMALL_SWEEP)
    table = sweep.run(points, folder=folder, multipliers=False)
    (folder / "results.sha256").unlink()
    with pytest.raises(sweep.SweepError, match=r"results.sha256"):
        sweep.load(folder)
    known = json.loads((folder / "sweep.json").read_text())
    del known["points_sha256"]
    (folder / "sweep.json").write_text(json.dumps(known))
    assert sweep.run(points, folder=folder, multipliers=False).equals(table)
    (folder / "points.csv").write_text("bore [m]\n")
    with pytest.raises(sweep.SweepError, match=r"another sweep \(other points\)"):
        sweep.run(points, folder=folder, multipliers=False)


def test_files_of_a_sweep_are_like_any_others(tmp_path, monkeypatch):
    folder, points = tmp_path / "s", sweep.grid({"bore": [0.064]})
    sweep.run(points, folder=folder, multipliers=False)
    sweep.run(points, folder=folder, multipliers=False)
    assert not (folder / "parts").exists()
    plain = tmp_path / "plain"
    plain.write_text("")
    for name in ("sweep.json", "points.csv", "results.csv"):
        assert (folder / name).stat().st_mode == plain.stat().st_mode
    with pytest.raises(sweep.SweepError, match=r"cannot write .*plain"):
        sweep.run(points, folder=plain / "s")

    def full(*paths):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(sweep.SweepError, match=r"cannot write .*points.csv: No space"):
        sweep.run(points, folder=tmp_path / "other")
    assert not list((tmp_path / "other").glob(".points*"))


def test_numbers_that_are_none_survive_the_folder(tmp_path):
    table = sweep.run(sweep.grid({"bore": [0.064, -1.0]}), folder=tmp_path / "s")
    assert math.isinf(table.beat_period[0]) or table.beat_period[0] > 0.0
    assert np.isnan(table.power[1])
    assert table_text(table) == (tmp_path / "s" / "results.csv").read_text()


BEGIN = """
import random, sys, time
from pathlib import Path
import pandas as pd
from saleg.errors import SweepError
from saleg.sweep.store import Folder

root, bore = Path(sys.argv[1]), float(sys.argv[2])
points = pd.DataFrame({"bore": [bore] * 500})
points.attrs["units"] = {"bore": "m"}
print("ready", flush=True)
for number in map(int, sys.stdin):
    time.sleep(0.002 * random.random())
    try:
        with Folder(root / str(number)).opened({"count": 500}, points, "0"):
            print("fine", flush=True)
    except SweepError as error:
        print(error, flush=True)
"""


@pytest.mark.parametrize("bores", [(0.06, 0.06), (0.06, 0.05)])
def test_two_sweeps_that_begin_at_once_in_one_folder(tmp_path, bores):
    """The same one goes on in both processes; of two others the second is told so."""
    both = [
        subprocess.Popen(
            [sys.executable, "-c", BEGIN, str(tmp_path), str(bore)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for bore in bores
    ]
    assert [process.stdout.readline() for process in both] == ["ready\n"] * 2
    for number in range(100):
        for process in both:
            process.stdin.write(f"{number}\n")
            process.stdin.flush()
        answers = {process.stdout.readline().strip() for process in both}
        other = f"{tmp_path / str(number)} holds another sweep (other points); name another folder"
        assert answers == ({"fine"} if bores[0] == bores[1] else {"fine", other})
    for process in both:
        process.communicate()
