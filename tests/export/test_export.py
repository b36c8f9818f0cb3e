"""Runs on disk: what comes back equals what went in, and bad files say what is wrong."""

import contextlib
import dataclasses
import json
import subprocess
import sys
import tracemalloc
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.io
from hypothesis import given
from hypothesis import strategies as st

import saleg
from saleg import export, performance
from saleg.cli import main
from saleg.export import csv_folder, description, matlab, units
from saleg.files.atomic import new_file
from saleg.kernel import layout
from saleg.laws import Friction, ViscousFriction
from saleg.quantities import quantity

h5py = pytest.importorskip("h5py")
xarray = pytest.importorskip("xarray")

NAMES = {
    "csv": "folder",
    "npz": "run.npz",
    "mat": "run.mat",
    "hdf5": "run.h5",
    "netcdf": "run.nc",
}
FILE_FORMATS = [name for name in NAMES if name != "csv"]
every_format = pytest.mark.parametrize("form", list(NAMES))


@pytest.fixture(scope="module")
def short_run(base):
    """Half a second, every third step kept, its name no plain ASCII."""
    engine = base.replace(name='Größe "A" 🚀\n%s')
    return saleg.simulate(engine, 0.3, history=3, rtol=1e-6, motored_pressure=True)


def save(form, run, path, **options):
    getattr(export, f"save_{form}")(run, path, **options)


def load(form, path, **options):
    return getattr(export, f"load_{form}")(path, **options)


def same_rows(one, other):
    if one is None or other is None:
        return one is other
    return one.dtype == other.dtype and one.tobytes() == other.tobytes()


def assert_equal_runs(one, other):
    """Equal in everything, bit by bit, down to the last cycle."""
    for item in dataclasses.fields(saleg.Run):
        if item.name in ("strokes", "event_rows", "history_rows"):
            assert same_rows(getattr(one, item.name), getattr(other, item.name)), item.name
        elif item.name == "replay":
            assert (one.orbit is None) == (other.orbit is None)
        else:
            assert getattr(one, item.name) == getattr(other, item.name), item.name
    assert repr(one.performance) == repr(other.performance)
    assert one.energy == other.energy
    assert one.cycles.equals(other.cycles)
    assert one.events.equals(other.events)
    assert (one.history is None) == (other.history is None)
    if one.history is not None:
        assert one.history.equals(other.history)
        assert one.history.attrs == other.history.attrs
    if one.orbit is not None:
        assert_equal_runs(one.orbit, other.orbit)


# What is saved comes back.


@every_format
def test_a_run_read_back_equals_the_run_saved(form, short_run, tmp_path, monkeypatch):
    save(form, short_run, tmp_path / NAMES[form])
    monkeypatch.setattr("saleg.simulation.integration.integrate", None)  # nothing runs again
    loaded = load(form, tmp_path / NAMES[form])
    assert_equal_runs(short_run, loaded)
    assert loaded.performance.adverse_work == short_run.performance.adverse_work
    assert len(loaded.history_rows) > 500
    assert [path.name for path in tmp_path.iterdir()] == [NAMES[form]]


@pytest.mark.parametrize("name", [*NAMES.values(), "RUN.NPZ", "run.hdf5"])
def test_the_suffix_chooses_the_format(name, base_run, tmp_path):
    base_run.save(tmp_path / name)
    assert_equal_runs(base_run, saleg.Run.load(tmp_path / name))


@every_format
def test_runs_without_history_or_cycle_or_event(form, base, tmp_path):
    for number, change in enumerate(({}, {"equivalence_ratio": 0.0})):
        run = saleg.simulate(base.replace(**change), 1e-3 if not change else 2.0)
        path = tmp_path / f"{number}{NAMES[form]}"
        save(form, run, path)
        assert_equal_runs(run, load(form, path))


@every_format
def test_the_fixed_step_and_other_engines(form, transient, tmp_path):
    run = saleg.simulate(transient, 0.1, step=1e-4, order=5)
    save(form, run, tmp_path / NAMES[form])
    assert_equal_runs(run, load(form, tmp_path / NAMES[form]))


@every_format
def test_every_float_and_an_empty_history_survive(form, short_run, tmp_path):
    strange = [np.nan, np.inf, -np.inf, -0.0, 5e-324, 1.7976931348623157e308, 0.1 + 0.2, 1e-17]
    rows = short_run.history_rows[: len(strange)].copy()
    rows["x"], rows["p"][:, 1] = strange, strange
    for history in (rows, rows[:0]):
        run = dataclasses.replace(short_run, history_rows=history)
        path = tmp_path / f"{len(history)}{NAMES[form]}"
        save(form, run, path)
        assert same_rows(load(form, path).history_rows, history)


def test_tables_give_the_run_back_without_a_file(short_run):
    assert_equal_runs(short_run, export.from_tables(export.as_tables(short_run)))


def test_a_loaded_run_can_be_saved_again(short_run, tmp_path):
    short_run.save(tmp_path / "one.npz")
    saleg.Run.load(tmp_path / "one.npz").save(tmp_path / "two.npz")
    with zipfile.ZipFile(tmp_path / "one.npz") as one, zipfile.ZipFile(tmp_path / "two.npz") as two:
        assert {i.filename: i.CRC for i in one.infolist()} == {
            i.filename: i.CRC for i in two.infolist()
        }


def test_columns_of_a_history_are_views(short_run):
    tables = export.as_tables(short_run).tables
    for column in tables["history"].values():
        assert np.shares_memory(column.values, short_run.history_rows)


def test_nothing_of_a_run_is_forgotten():
    written = {*description.PLAIN, "engine", "status", "strokes", "event_rows", "history_rows"}
    assert {item.name for item in dataclasses.fields(saleg.Run)} == written | {"replay"}
    assert set(units.STROKE_UNITS) == set(layout.STROKE_RECORD.names)
    figures = {item.name for item in dataclasses.fields(saleg.Performance)}
    assert figures == set(performance.UNITS)


# Laws of the user.


@dataclasses.dataclass(frozen=True)
class OwnFriction(ViscousFriction):
    """Friction that grows with the square of the speed."""

    quadratic: float = quantity("N s^2/m^2", default=0.5, low=0)

    def force(self, held: float, motion) -> float:
        return self.coefficient * motion.v + self.quadratic * motion.v * abs(motion.v)


@pytest.fixture(scope="module")
def own_run(base_run):
    """A run with a law of one's own; nothing is compiled for it."""
    engine = base_run.engine.replace(friction=OwnFriction(coefficient=12.0))
    orbit = dataclasses.replace(base_run.orbit, engine=engine)
    return dataclasses.replace(base_run, engine=engine, replay=lambda: orbit)


@every_format
def test_a_law_of_ones_own_is_handed_in(form, own_run, tmp_path):
    path = tmp_path / NAMES[form]
    save(form, own_run, path)
    assert_equal_runs(own_run, load(form, path, laws=[OwnFriction]))
    with pytest.raises(saleg.SalegError, match=r"OwnFriction.*laws=\[OwnFriction\]") as caught:
        load(form, path)
    assert str(path) in str(caught.value)


def test_a_law_of_ones_own_is_not_taken_for_saleg_s(own_run, tmp_path):
    namesake = dataclasses.make_dataclass(
        "ViscousFriction", [], bases=(OwnFriction,), frozen=True, namespace={"__module__": "mine"}
    )
    run = dataclasses.replace(own_run, engine=own_run.engine.replace(friction=namesake(3.0)))
    run.replay = None
    run.save(tmp_path / "x.npz")
    with pytest.raises(saleg.SalegError, match="ViscousFriction"):
        saleg.Run.load(tmp_path / "x.npz")
    loaded = saleg.Run.load(tmp_path / "x.npz", laws=[namesake])
    assert type(loaded.engine.friction) is namesake


def test_a_law_of_ones_own_does_not_replace_saleg_s(base_run, tmp_path):
    other = dataclasses.make_dataclass(
        "ViscousFriction", [], bases=(Friction,), frozen=True, namespace={"__module__": "mine"}
    )
    base_run.save(tmp_path / "x.npz")
    assert saleg.Run.load(tmp_path / "x.npz", laws=[other]).engine == base_run.engine


def test_a_law_that_has_changed_is_named(own_run, tmp_path):
    changed = dataclasses.make_dataclass("OwnFriction", [], bases=(ViscousFriction,), frozen=True)
    own_run.save(tmp_path / "x.npz")
    with pytest.raises(saleg.SalegError, match=r"x\.npz: its engine:\s+friction\.quadratic"):
        saleg.Run.load(tmp_path / "x.npz", laws=[changed])


# What other programs see.


def test_npz_needs_no_pickle_and_carries_units(short_run, tmp_path):
    short_run.save(tmp_path / "x.npz")
    with np.load(tmp_path / "x.npz", allow_pickle=False) as arrays:
        assert list(arrays["cycles.stroke"]) == list(short_run.cycles["stroke"])
        assert all(arrays[name].dtype != object for name in arrays.files)
        assert json.loads(str(arrays["units_json"]))["history"]["p_left"] == "Pa"
        assert json.loads(str(arrays["codes_json"]))["event"][3] == "ignition"


def test_mat_is_structs_of_columns(short_run, tmp_path):
    short_run.save(tmp_path / "x.mat")
    content = scipy.io.loadmat(tmp_path / "x.mat")
    tables = export.as_tables(short_run).tables
    for name, columns in tables.items():
        struct = content[name]
        assert struct.shape == (1, 1)
        assert set(struct.dtype.names) == set(columns)  # nothing dropped
        for column, held in columns.items():
            assert struct[column][0, 0].dtype != object
            assert struct[column][0, 0].shape == (len(held.values), 1)
            assert "".join(content[f"{name}_units"][column][0, 0]) == held.unit
    texts = {"engine_toml", "run_json", "codes"}
    ours = {name for name in content if not name.startswith("__")}
    assert ours == {*tables, *(f"{name}_units" for name in tables), *texts}
    assert content["codes"]["event"][0, 0][3].strip() == "ignition"
    assert content["engine_toml"][0] == short_run.engine.to_toml()


def test_names_of_saleg_are_legal_in_matlab():
    for table in [performance.UNITS, *(held.places for held in units.LAYOUTS.values())]:
        assert matlab.legal_names(table) == {name: name for name in table}


@given(st.lists(st.text(max_size=70), max_size=20))
def test_any_names_become_legal_and_unique(names):
    legal = matlab.legal_names([*names, "x", "x_", "a" * 70, "a" * 71])
    assert len(set(legal.values())) == len(legal)
    for name in legal.values():
        assert len(name) <= 63
        assert name[0].isascii()
        assert name[0].isalpha()
        assert name.isidentifier()


def test_hdf5_carries_units(short_run, tmp_path):
    short_run.save(tmp_path / "x.h5")
    with h5py.File(tmp_path / "x.h5") as file:
        assert list(file["cycles"])[:3] == ["cycle", "t", "period"]  # in their order
        assert file["history/p_left"].attrs["units"] == "Pa"
        assert file["events/event"].attrs["flag_meanings"].split()[3] == "ignition"
        assert file.attrs["engine_toml"] == short_run.engine.to_toml()


def test_xarray_has_dimensions_units_and_the_engine(short_run, tmp_path):
    datasets = export.to_xarray(short_run)
    short_run.save(tmp_path / "x.nc")
    for name, dataset in datasets.items():
        assert dataset.attrs["engine_toml"] == short_run.engine.to_toml()
        with xarray.open_dataset(tmp_path / "x.nc", group=name, engine="h5netcdf") as again:
            xarray.testing.assert_identical(again.load(), dataset)
    assert datasets["cycles"].sizes == {"cycle": len(short_run.cycles)}
    assert "t" in datasets["cycles"].coords
    assert datasets["history"].p_left.dims == ("t",)
    assert datasets["history"].p_left.attrs["units"] == "Pa"
    assert float(datasets["performance"].stroke) == short_run.performance.stroke
    assert np.shares_memory(datasets["history"].p_left.values, short_run.history_rows)


def test_csv_has_units_in_its_headers(short_run, tmp_path):
    short_run.save(tmp_path / "x")
    names = {path.name for path in (tmp_path / "x").iterdir()}
    assert names == set(csv_folder.FILES)
    header = (tmp_path / "x" / "cycles.csv").read_text().splitlines()[0]
    assert header.startswith("cycle,t [s],period [s]")
    assert ",dead centre,right," in (tmp_path / "x" / "events.csv").read_text()
    assert saleg.Engine.from_toml(tmp_path / "x" / "engine.toml") == short_run.engine


# There whole or not at all.


@every_format
def test_an_existing_file_is_kept_unless_told_otherwise(form, base_run, own_run, tmp_path):
    path = tmp_path / "new" / NAMES[form]
    save(form, base_run, path)
    with pytest.raises(saleg.SalegError, match=r"exists already.*overwrite=True"):
        save(form, own_run, path)
    assert_equal_runs(load(form, path), base_run)
    save(form, own_run, path, overwrite=True)
    assert_equal_runs(load(form, path, laws=[OwnFriction]), own_run)
    assert [entry.name for entry in path.parent.iterdir()] == [NAMES[form]]


@every_format
@pytest.mark.parametrize("failure", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_half_written_files_never_remain(form, failure, base_run, own_run, tmp_path, monkeypatch):
    path = tmp_path / NAMES[form]
    save(form, base_run, path)
    write = export.formats.SUFFIXES[path.suffix].write

    def broken(described, place):
        write(described, place)
        assert len(list(tmp_path.iterdir())) == 2
        raise failure

    monkeypatch.setattr(export.formats.SUFFIXES[path.suffix], "write", broken)
    expected = saleg.SalegError if isinstance(failure, OSError) else KeyboardInterrupt
    for target in (path, tmp_path / "a" / "b" / NAMES[form]):
        with pytest.raises(expected):
            save(form, own_run, target, overwrite=True)
        assert [entry.name for entry in tmp_path.iterdir()] == [NAMES[form]]
    assert_equal_runs(load(form, path), base_run)


def test_a_column_that_fails_leaves_nothing(base_run, tmp_path, monkeypatch):
    """The formats themselves fail in the middle."""
    broken = export.as_tables(base_run)
    broken.tables["events"]["v"] = description.Column(None, "m/s")
    monkeypatch.setattr("saleg.export.formats.as_tables", lambda run: broken)
    for form in NAMES:
        with pytest.raises((AttributeError, TypeError, ValueError)):
            save(form, base_run, tmp_path / NAMES[form])
        assert list(tmp_path.iterdir()) == [], form


def test_a_folder_with_other_things_is_left_alone(base_run, tmp_path):
    (tmp_path / "case").mkdir()
    (tmp_path / "case" / "thesis.tex").write_text("years of work")
    with pytest.raises(saleg.SalegError, match=r"thesis\.tex"):
        base_run.save(tmp_path / "case", overwrite=True)
    with pytest.raises(saleg.SalegError, match="is a folder"):
        export.save_npz(base_run, tmp_path / "case", overwrite=True)
    with pytest.raises(saleg.SalegError, match="is a file"):
        base_run.save(tmp_path / "case" / "thesis.tex" / "x.npz")
    with pytest.raises(saleg.SalegError, match="is a file"):
        export.save_csv(base_run, tmp_path / "case" / "thesis.tex", overwrite=True)


def test_a_file_that_appears_meanwhile_is_kept(tmp_path):
    def race():
        with new_file(tmp_path / "x") as temporary:
            temporary.write_text("ours")
            (tmp_path / "x").write_text("theirs")

    with pytest.raises(saleg.SalegError, match="exists already"):
        race()
    assert (tmp_path / "x").read_text() == "theirs"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize(
    "settings", [{"a": (1, 2)}, {1: 2}, {"a": object()}, {"a": float("nan")}, {"a": np.ones(2)}]
)
def test_settings_that_would_not_come_back_are_refused(settings, base_run, tmp_path):
    run = dataclasses.replace(base_run, settings=settings)
    with pytest.raises(saleg.SalegError, match="settings"):
        run.save(tmp_path / "x.npz")
    assert list(tmp_path.iterdir()) == []


def test_settings_may_be_numpy_numbers(base_run, tmp_path):
    settings = {"order": np.int64(4), "rtol": np.float64(1e-9), "far": float("inf"), "all": [None]}
    dataclasses.replace(base_run, settings=settings).save(tmp_path / "x.npz")
    assert saleg.Run.load(tmp_path / "x.npz").settings == settings


# Bad files.


def refused(path, match, form=None, **options):
    with pytest.raises(saleg.SalegError, match=match) as caught:
        load(form, path, **options) if form else saleg.Run.load(path, **options)
    assert path.name in str(caught.value)


def test_names_that_lead_nowhere(base_run, tmp_path):
    refused(tmp_path / "none.npz", "does not exist")
    refused(tmp_path / "run.xlsx", r"suffix '\.xlsx'; there are \.npz, \.mat")
    with pytest.raises(saleg.SalegError, match="suffix"):
        base_run.save(tmp_path / "run.xlsx")
    (tmp_path / "dir.npz").mkdir()
    refused(tmp_path / "dir.npz", "is a folder", "npz")
    (tmp_path / "plain").write_text("x")
    refused(tmp_path / "plain", "is a file")
    refused(tmp_path / "dir.npz", "No such file")


@pytest.mark.parametrize("form", FILE_FORMATS)
def test_files_that_are_not_ours(form, tmp_path):
    path = tmp_path / NAMES[form]
    for content in (b"", b"not ours", bytes(5000)):
        path.write_bytes(content)
        refused(path, "cannot load")


def test_files_of_the_right_kind_but_not_ours(tmp_path):
    np.savez(tmp_path / "x.npz", a=np.ones(3))
    np.savez(tmp_path / "y.npz", engine_toml="", run_json='{"format": "other"}')
    np.savez(tmp_path / "z.npz", engine_toml=np.array([{}], dtype=object))
    scipy.io.savemat(tmp_path / "x.mat", {"a": np.ones(3)})
    with h5py.File(tmp_path / "x.h5", "w") as file:
        file["a"] = 1
    refused(tmp_path / "x.npz", "engine_toml")
    refused(tmp_path / "y.npz", "not a saleg run")
    refused(tmp_path / "z.npz", "pickle|allow_pickle")
    refused(tmp_path / "x.mat", "saleg did not write it")
    refused(tmp_path / "x.h5", "engine_toml")


@pytest.mark.parametrize("form", FILE_FORMATS)
def test_files_cut_short(form, own_run, tmp_path):
    path = tmp_path / NAMES[form]
    save(form, own_run, path)
    whole = path.read_bytes()
    for length in (*np.linspace(0, len(whole) - 1, 12, dtype=int), len(whole) - 1):
        path.write_bytes(whole[:length])
        refused(path, "cannot load", laws=[OwnFriction])


@pytest.mark.parametrize("form", FILE_FORMATS)
def test_a_changed_byte_never_changes_a_run(form, own_run, tmp_path):
    """Some bytes do not matter; where one does, the file is refused. (scipy's reader crashes.)"""
    path = tmp_path / NAMES[form]
    save(form, own_run, path)
    whole = path.read_bytes()
    for place in np.random.default_rng(1).integers(0, len(whole), 40):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        with contextlib.suppress(saleg.SalegError):
            assert_equal_runs(own_run, load(form, path, laws=[OwnFriction]))


@every_format
def test_another_version_is_named(form, base_run, tmp_path, monkeypatch):
    monkeypatch.setattr(description, "FORMAT_VERSION", 7)
    monkeypatch.setattr(description, "__version__", "9.9")
    save(form, base_run, tmp_path / NAMES[form])
    monkeypatch.undo()
    refused(tmp_path / NAMES[form], r"version 7 of the format, written by saleg 9\.9")


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda text: text[: len(text) // 2], "cut short"),
        (lambda text: text[: text.rindex("\n", 0, -1) + 1], "should have"),
        (lambda text: text.replace("x_start [m]", "x_start [mm]"), r"lacks.*x_start \[m\]"),
        (lambda text: text.replace(",", ";"), "lacks the column"),
        (lambda text: text.replace("e-", "f-"), "damaged"),
        (lambda text: text.partition("\n")[0] + "\n", "should have"),
        (lambda text: "", "strokes.csv"),
    ],
)
def test_tables_somebody_changed(change, match, base_run, tmp_path):
    base_run.save(tmp_path / "x")
    path = tmp_path / "x" / "strokes.csv"
    path.write_text(change(path.read_text()))
    refused(tmp_path / "x", match)


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [
        ("engine.toml", "bore = 0.064", "bore = 0.065"),
        ("engine.toml", "bore = 0.064", "bore = -1.0"),
        ("run.json", '"status": "steady"', '"status": "completed"'),
    ],
)
def test_an_engine_somebody_changed_has_no_results(name, before, after, base_run, tmp_path):
    base_run.save(tmp_path / "x")
    path = tmp_path / "x" / name
    assert before in path.read_text()
    path.write_text(path.read_text().replace(before, after))
    refused(tmp_path / "x", "not what was saved.*a new run")


def test_tables_and_texts_from_other_editors_are_read(base_run, tmp_path):
    base_run.save(tmp_path / "x")
    for path in (tmp_path / "x").iterdir():
        path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert_equal_runs(saleg.Run.load(tmp_path / "x"), base_run)


@pytest.mark.parametrize("name", ["engine.toml", "run.json", "events.csv"])
def test_a_table_that_is_missing(name, base_run, tmp_path):
    base_run.save(tmp_path / "x")
    (tmp_path / "x" / name).unlink()
    refused(tmp_path / "x", name)


@pytest.mark.parametrize("form", ["hdf5", "netcdf"])
def test_a_full_disk_is_told_before_the_library_crashes(form, base_run, tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1_000_000))
    with pytest.raises(export.RunFileError, match="No space left"):
        save(form, base_run, tmp_path / NAMES[form])
    assert list(tmp_path.iterdir()) == []


def test_what_the_library_raises_names_the_file(base_run, tmp_path, monkeypatch):
    def fails(*_, **__):
        raise RuntimeError("Can't decrement id ref count")

    monkeypatch.setattr(h5py, "File", fails)
    with pytest.raises(export.RunFileError, match=r"cannot write .*run\.h5: Can't decrement"):
        base_run.save(tmp_path / "run.h5")


@pytest.mark.parametrize(
    ("form", "package", "words"),
    [
        ("hdf5", "h5py", 'pip install "saleg[hdf5]"'),
        ("netcdf", "xarray", 'pip install "saleg[xarray]"'),
        ("netcdf", "h5netcdf", 'pip install "saleg[xarray]"'),
        ("netcdf", "h5py", 'pip install "saleg['),
    ],
)
def test_a_missing_extra_says_what_to_type(form, package, words, base_run, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(saleg.SalegError) as caught:
        save(form, base_run, tmp_path / NAMES[form])
    assert words in str(caught.value)
    assert list(tmp_path.iterdir()) == []
    assert main(["run", "thesis-base", "--out", str(tmp_path / "a"), "--format", form]) == 2
    if package == "xarray":
        with pytest.raises(export.MissingExtra):
            export.to_xarray(base_run)


# Memory, start-up time, example, command line.


@pytest.mark.parametrize("form", list(NAMES))
def test_a_long_history_is_never_in_memory_twice(form, short_run, tmp_path):
    count = 20_000 if form == "csv" else 100_000
    rows = np.resize(short_run.history_rows, count)
    run = dataclasses.replace(short_run, history_rows=rows)
    assert run.performance  # simulates the last cycle
    save(form, dataclasses.replace(run, history_rows=None), tmp_path / f"warm{NAMES[form]}")
    tracemalloc.start()
    save(form, run, tmp_path / NAMES[form])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    limit = 15e6 if form == "csv" else 0.25 * rows.nbytes
    assert peak < limit, f"{peak / 1e6:.1f} MB for {rows.nbytes / 1e6:.1f} MB"


def test_importing_export_is_light():
    code = (
        "import sys, saleg.export; "
        "print([n for n in ('pandas', 'scipy.io', 'h5py', 'xarray') if n in sys.modules])"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert shown.stdout == "[]\n"


def test_the_command_line_writes_the_formats_wanted(tmp_path, capsys):
    target = tmp_path / "case"
    words = ["run", "thesis-base", "--duration", "0.3", "--out", str(target)]
    assert main([*words, "--format", "npz, mat,hdf5,netcdf"]) == 0
    names = {"run.npz", "run.mat", "run.h5", "run.nc"}
    plots = {"pv.png", "velocity_position.png"}
    assert {path.name for path in target.iterdir()} == {*names, *plots, "engine.toml"}
    assert "run.h5" in capsys.readouterr().out
    runs = [saleg.Run.load(target / name) for name in sorted(names)]
    for run in runs[1:]:
        assert_equal_runs(runs[0], run)
    assert main([*words, "--force"]) == 0
    assert_equal_runs(saleg.Run.load(target), runs[0])


@pytest.mark.parametrize(
    ("words", "message"),
    [(["--format", "np", "--out", "x"], "'npz'"), (["--format", "npz"], "--out")],
)
def test_mistakes_on_the_command_line(words, message, capsys):
    assert main(["run", "thesis-base", *words]) == 2
    assert message in capsys.readouterr().err
    assert not Path("x").exists()
