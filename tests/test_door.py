"""What users hand in: numbers of every type, names, files. Wrong ones end in one clear error."""

import dataclasses
import math
import os
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest

import saleg
from saleg import (
    BounceChamber,
    Engine,
    InvalidEngine,
    SalegError,
    SalegWarning,
    Translator,
    laws,
    sweep,
)
from saleg.control import Demand, Sensors
from saleg.design.designs import NAMES as PARAMETERS
from saleg.engine.start import MidpointVelocity
from saleg.engine.toml import laws_by_slot
from saleg.errors import PathsClash, RunFileError, WrongQuantity
from saleg.laws import HeatedIntake, LinearSprings, PreloadedSprings, Wiebe
from saleg.optimize.files import read as read_optimisation
from saleg.quantities import quantity, series, unusual
from saleg.sweep.files import read as read_sweep
from saleg.thesis.tables import columns

NAN = float("nan")


# Numbers become floats at the door.

TWINS = [
    np.float16(0.0625),
    np.float32(0.0625),
    np.longdouble(0.0625),
    Decimal("0.0625"),
    Fraction(1, 16),
    np.array(0.0625),
    pd.Series([0.0625]).iloc[0],
]


@pytest.mark.parametrize("bore", TWINS, ids=lambda number: type(number).__name__)
def test_an_engine_equals_its_twin_of_another_type(base, bore):
    engine = base.replace(bore=bore)
    assert type(engine.left.bore) is float
    assert engine == base.replace(bore=0.0625)
    assert hash(engine) == hash(base.replace(bore=0.0625))


def test_an_engine_of_another_type_gives_the_figures_of_its_twin(base):
    """Before, with float16 and Decimal, the start was computed with their few digits or failed."""
    half = base.replace(bore=np.float32(0.064), moving_mass=Decimal("2.39"))
    twin = base.replace(bore=float(np.float32(0.064)), moving_mass=2.39)
    one, other = (saleg.simulate(engine, 0.1, rtol=1e-6) for engine in (half, twin))
    assert one.performance == other.performance


@pytest.mark.parametrize(
    ("made", "name", "value"),
    [
        (LinearSprings(np.float32(3.0)), "stiffness", 3.0),
        (MidpointVelocity(frequency=Decimal(40)), "frequency", 40.0),
        (Sensors(position_noise=np.float16(0.5)), "position_noise", 0.5),
        (saleg.design.Parameters(egr=Fraction(1, 4)), "egr", 0.25),
        (saleg.fundamental.ConstantLoad(np.float32(0.5)), "amplitude", 0.5),
        (saleg.fundamental.Isentropic(Decimal("1.5")), "gamma", 1.5),
        (HeatedIntake(times=(np.int64(1), Decimal(2))), "times", (1.0, 2.0)),
        (Demand((0, np.float32(1)), (1, 2)), "times", (0.0, 1.0)),
    ],
    ids=lambda item: type(item).__name__,
)
def test_every_part_holds_floats(made, name, value):
    held = getattr(made, name)
    assert held == value
    assert all(type(number) is float for number in (held if isinstance(held, tuple) else [held]))


def test_whole_numbers_stay_whole():
    sensors = Sensors(delay=np.int64(3))
    assert type(sensors.delay) is int
    with pytest.raises(SalegError, match=r"sensors\.delay = 1\.5.*whole number"):
        Sensors(delay=1.5).validate()


@pytest.mark.parametrize("unit", ["m\n[sweep]", "kg\r", "\0", 5, None], ids=repr)
def test_a_unit_is_one_line_of_text(unit):
    """A line break in a unit made engine files that could not be read back."""
    for declare in (quantity, series):
        with pytest.raises(WrongQuantity, match="one line of text"):
            declare(unit)


# Malformed input: one error each, whose text names what is wrong.

NUMBERS = [None, "0.06", True, np.True_, 1j, np.complex128(1), [0.06], (0.06,), {}, b"1"]
NUMBERS += [NAN, math.inf, Decimal("sNaN"), np.array([0.06, 0.07]), np.array([]), 10**400]
NUMBERS += [pd.NA, pd.Series([0.06]), pd.Timestamp(0), np.datetime64("2020"), int, abs]


@pytest.mark.parametrize("value", NUMBERS, ids=repr)
def test_what_is_no_number_is_refused_by_name(base, value):
    for path in ("left.bore", "spring.stiffness", "left.intake.pressure", "start.position"):
        with pytest.raises(InvalidEngine, match=path.replace("spring.", "springs.")):
            base.replace(**{path: value}).validate()
    with pytest.raises(SalegError, match="rtol"):
        saleg.simulate(base, 0.01, rtol=value)
    with pytest.raises(SalegError, match=r"demand\.times"):
        Demand.step(value, 1.0, 2.0)


def fails(label, call, text):
    return pytest.param(call, text, id=label)


RISING = ((2.0, 1.0), (3.0, 4.0))
CALLS = [
    fails("simulate", lambda base: saleg.simulate(None, 0.1), "engine = None"),
    fails("steady_state", lambda base: saleg.steady_state(5), "engine = 5"),
    fails("simulate_many", lambda base: saleg.simulate_many(None, 0.1), "engines = None"),
    fails("steady_states", lambda base: saleg.steady_states(base), "engines = "),
    fails("unknown", lambda base: saleg.simulate_many([base], 0.1, rtoll=1), "no setting of simul"),
    fails(
        "commanded",
        lambda base: saleg.control.Plant(base, 0.1, rtoll=1, rtol=2),
        "rtol = 2: must be a number from 1e-14 to 1e-2\n  rtoll = 1: no setting",
    ),
    fails("executor", lambda base: saleg.steady_states([base], executor=3), "executor = 3"),
    fails("workers", lambda base: saleg.steady_states([base], workers=True), "workers = True"),
    fails("reference", lambda base: saleg.reference.simulate("x", 0.1), "engine = 'x'"),
    fails("solver", lambda base: saleg.reference.simulate(base, 0.1, solver="x"), "solver = 'x'"),
    fails("hang", lambda base: saleg.reference.simulate(base, 0.1, rtol=math.inf), "rtol = inf"),
    fails("branch", lambda base: saleg.continuation.branch(None, "bore", 0.06), "engine = None"),
    fails("stop", lambda base: saleg.continuation.branch(base, "bore", "x"), "'x'"),
    fails("start_up", lambda base: saleg.control.start_up(None), "engine = None"),
    fails("controller", lambda base: saleg.control.start_up(base, controller=5), "controller = 5"),
    fails(
        "sensors",
        lambda base: saleg.control.simulate(base, saleg.Controller(), 0.1, sensors=5),
        "sensors = 5",
    ),
    fails(
        "sample_time",
        lambda base: saleg.control.simulate(base, saleg.Controller(), 0.1, sample_time="x"),
        "sample_time",
    ),
    fails("design", lambda base: saleg.design.evaluate(bore=np.True_), "bore = np.True_"),
    fails("history", lambda base: saleg.simulate(base, 0.1, history=True), "history = True"),
    fails("keep", lambda base: saleg.simulate(base, 0.1, keep_cycles=12.5), "keep_cycles = 12.5"),
    fails("method", lambda base: saleg.simulate(base, 0.1, method=["fixed"]), "method = "),
    fails("flag", lambda base: saleg.simulate(base, 0.1, motored_pressure="no"), "'no'"),
    fails("max_maps", lambda base: saleg.steady_state(base, max_maps=True), "max_maps = True"),
    fails("points", lambda base: sweep.run(None), "DataFrame"),
    fails("swept", lambda base: sweep.run(sweep.grid({"bore": [0.06]}), 5), "cannot sweep 5"),
    fails("warm", lambda base: sweep.run(sweep.grid({"bore": [0.06]}), warm="no"), "warm = 'no'"),
    fails("many", lambda base: sweep.latin_hypercube({"bore": (0.05, 0.06)}, 10**400), "points"),
    fails("falling", lambda base: Demand(*RISING), "demand.times"),
    fails("nan", lambda base: Demand((0.0, NAN), (1.0, 2.0)), "demand.times"),
    fails("text", lambda base: Demand("ab", (1.0, 2.0)), "demand.times"),
    fails("lengths", lambda base: Demand((0.0, 1.0), (1.0,)), "demand.powers"),
    fails("negative", lambda base: Demand.step(1.0, -1.0, 2.0), "demand.powers"),
    fails("chamber", lambda base: base.replace(left=5).validate(), "left = 5"),
    fails("law", lambda base: base.replace(springs=Wiebe()).validate(), "springs"),
    fails("path", lambda base: base.get(5), "a path is text"),
    fails("self", lambda base: base.replace(**{"self": 1.0}), "'self'"),
]


@pytest.mark.parametrize(("call", "text"), CALLS)
def test_one_clear_error(base, call, text):
    with pytest.raises(SalegError) as caught:
        call(base)
    assert text in str(caught.value)


# Names of files.

LONG = "x" * 5000
NAMES = [5, None, [1], "a\0b", "a\0b.npz", LONG, f"{LONG}.npz", "/dev/null", "/dev/zero"]
READERS = [saleg.Run.load, Engine.from_toml, Demand.read, sweep.load, read_sweep]


@pytest.mark.parametrize("name", NAMES, ids=lambda name: repr(name)[:20])
@pytest.mark.parametrize("read", READERS, ids=lambda read: read.__qualname__)
def test_names_that_are_no_file(read, name):
    with pytest.raises(SalegError):
        read(name)


@pytest.mark.parametrize("name", NAMES, ids=lambda name: repr(name)[:20])
def test_names_that_cannot_be_written(base_run, name):
    with pytest.raises(RunFileError):
        base_run.save(name, overwrite=True)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_a_pipe_is_not_waited_for(base, base_run, tmp_path):
    for read, name in zip(READERS, ("run.npz", "e.toml", "d.csv", "s", "s.toml"), strict=True):
        os.mkfifo(tmp_path / name)
        with pytest.raises(SalegError, match="pipe"):
            read(tmp_path / name)
    base_run.save(tmp_path / "folder")
    (tmp_path / "folder" / "engine.toml").unlink()
    os.mkfifo(tmp_path / "folder" / "engine.toml")
    with pytest.raises(RunFileError, match="pipe"):
        saleg.Run.load(tmp_path / "folder")
    with pytest.raises(RunFileError, match="pipe"):
        base_run.save(tmp_path / "run.npz", overwrite=True)


def test_laws_handed_in_must_be_classes(base_run, tmp_path):
    base_run.save(tmp_path / "run.npz")
    with pytest.raises(RunFileError, match="laws = 5"):
        saleg.Run.load(tmp_path / "run.npz", laws=5)


ENGINE = "[sweep]\nmachine = 'thesis-base'\n"
SWEEPS = {
    "[sweep]\nmachine = [1]\n[grid]\nbore = [0.06]": "no machine [1]",
    "[sweep]\nmachine = {a = 1}\n[grid]\nbore = [0.06]": "no machine {'a': 1}",
    "[sweep]\nwarm = 1\n[grid]\nbore = [0.06]": "sweep.warm = 1",
    "[fixed]\nself = 1\n[grid]\nbore = [0.06]": "self",
    "[fixed]\nvalues = 1\n[grid]\nbore = [0.06]": "values",
    ENGINE + "[fixed]\negr = 0.1\n[grid]\n'gas_exchange.egr' = [0.2]": "egr",
    ENGINE + "[fixed]\nbore = 0.06\n[grid]\n'left.bore' = [0.05]": "bore",
    "[grid]\nbore = " + "[" * 10_000 + "]" * 10_000: "TOML",
}


@pytest.mark.parametrize(("text", "wanted"), SWEEPS.items(), ids=lambda text: text[-30:])
def test_sweep_files(tmp_path, text, wanted):
    (tmp_path / "sweep.toml").write_text(text)
    with pytest.raises(SalegError) as caught:
        read_sweep(tmp_path / "sweep.toml")
    assert wanted in str(caught.value)


def test_a_part_of_a_sweep_that_nests_too_deeply_is_done_again(base, tmp_path):
    points = sweep.grid({"bore": [0.060, 0.064]})
    before = sweep.run(points, base, folder=tmp_path / "sweep", multipliers=False, chunk=1)
    (tmp_path / "sweep" / "results.csv").unlink()
    (tmp_path / "sweep" / "parts").mkdir()
    nested = "[" * 100_000 + "]" * 100_000
    (tmp_path / "sweep" / "parts" / "0000000.json").write_text(nested)
    again = sweep.run(points, base, folder=tmp_path / "sweep", multipliers=False, chunk=1)
    pd.testing.assert_frame_equal(before, again)
    (tmp_path / "sweep" / "sweep.json").write_text(nested)
    with pytest.raises(SalegError, match="no folder of a sweep"):
        sweep.load(tmp_path / "sweep")


def test_a_folder_in_place_of_a_cached_kernel(tmp_path, monkeypatch):
    from saleg.compiler.module import load

    monkeypatch.setenv("SALEG_CACHE_DIR", str(tmp_path))
    first = load("x = 1\n", "kernel")
    path = next(tmp_path.glob("*.py"))
    assert first.kept.lock == path.with_suffix(".lock")
    for name in (path, path.with_suffix(".lock")):
        name.unlink()
        name.mkdir()
        again = load("x = 1\n", "kernel")
        assert again.module.x == 1
        assert again.kept.lock.is_file()
        name.rmdir()
        name.touch()


# Two names for one number.

CLASHES = [
    ("egr", "gas_exchange.egr"),
    ("bore", "left.bore"),
    ("moving_mass", "translator.mass"),
    ("spring.stiffness", "springs.stiffness"),
    ("left.egr", "left.gas_exchange.egr"),
    ("intake.pressure", "right.intake.pressure"),
]


@pytest.mark.parametrize("names", CLASHES, ids="-".join)
def test_two_names_for_one_number_are_refused(base, names):
    """Before, the last one won: a sweep's row said 0.1 and had 0.3."""
    for pair in (names, names[::-1]):
        with pytest.raises(PathsClash, match=f"'{names[0]}'") as caught:
            base.replace(**dict.fromkeys(pair, 0.1))
        assert f"'{names[1]}'" in str(caught.value)
        with pytest.raises(PathsClash):
            sweep.run(sweep.grid({name: [0.1] for name in pair}), base)


def test_designs_refuse_two_names_for_one_number():
    with pytest.raises(PathsClash):
        saleg.design.Design().replace({"heat_transfer.a": 100.0, "left.heat_transfer.a": 110.0})


def test_a_law_and_one_of_its_numbers_go_together(base):
    law = PreloadedSprings(preload=1e3)
    changed = base.replace(**{"springs.stiffness": 2e4, "springs": law})
    assert changed.springs == dataclasses.replace(law, stiffness=2e4)


# A cylinder's path does not reach a chamber that is none.


def single_piston(base):
    bounce = BounceChamber(bore=0.09, half_stroke=0.12, pressure=2e5)
    return dataclasses.replace(base, right=bounce)


def test_a_cylinders_path_leaves_the_bounce_chamber_alone(base):
    engine = single_piston(base)
    changed = engine.replace(bore=0.07, half_stroke=0.11, wall_temperature=500.0)
    assert changed.right == engine.right
    assert (changed.left.bore, changed.get("bore")) == (0.07, 0.07)
    assert changed.left.half_stroke == 0.11
    assert engine.replace(**{"right.bore": 0.08}).right.bore == 0.08
    assert engine.replace(**{"right.bore": 0.08}).left == engine.left
    both = engine.replace(**{"bore": 0.07, "right.bore": 0.08})
    assert (both.left.bore, both.right.bore) == (0.07, 0.08)
    assert engine.replace(pressure=3e5).right.pressure == 3e5


def test_a_path_of_two_bounce_chambers_reaches_both():
    chamber = BounceChamber(bore=0.06, half_stroke=0.1)
    changed = Engine.mirrored(Translator(mass=1.0), chamber).replace(bore=0.07)
    assert changed.left.bore == changed.right.bore == 0.07


# Results are read-only or copies.


def test_changing_a_table_does_not_change_the_run(base_run):
    """Before, a plot showed a stroke of 180,690 mm after this."""
    run = base_run
    kept = run.cycles["stroke"].to_numpy().copy()
    table = run.cycles
    table["stroke"] *= 1000.0
    table.loc[0, "power"] = 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # from version 3 on pandas says it works on a copy
        run.cycles["stroke"] *= 1000.0
    assert np.array_equal(run.cycles["stroke"], kept)
    assert run.cycles.loc[0, "power"] != 0.0
    for name in ("dead_centres", "events"):
        table = getattr(run, name)
        table["t"] += 1.0
        assert getattr(run, name)["t"].iloc[-1] <= run.duration
    assert run.cycles.attrs["units"]["stroke"] == "m"


def test_records_cannot_be_written_to(base):
    run = saleg.simulate(base, 0.2, rtol=1e-6, history=10)
    found = saleg.steady_state(base)
    for records in (run.strokes["t"], run.event_rows["t"], run.history_rows["t"]):
        with pytest.raises(ValueError, match="read-only"):
            records[0] = 1.0
    for records in (found.strokes["t"], found.multipliers, found.orbit.strokes["t"]):
        with pytest.raises(ValueError, match="read-only"):
            records[0] = 1.0
    history = run.history
    history["T_left"] *= 2.0
    assert history["T_left"].iloc[0] == 2.0 * run.history["T_left"].iloc[0]


# Unit slips.

SLIPS = {
    "bore": (66.0, "0.066 if given in mm"),
    "half_stroke": (100.0, "0.1 if given in mm"),
    "head_gap": (0.1, "0.0001 if given in mm"),
    "left.bore": (6.6, "0.0066 if given in mm, 0.066 if given in cm"),
    "alternator.load_constant": (0.07, "70 if given in kN s/m"),
    "moving_mass": (2390.0, "2.39 if given in g"),
    "intake.pressure": (1.05, "105000 if given in bar"),
    "intake.temperature": (125.0, "398.15 if given in degC"),
    "fuel.lower_heating_value": (48.0, "4.8e+07 if given in MJ/kg"),
    "right.bore": (2.5, "0.0635 if given in inch"),
    "friction.coefficient": (12400.0, "usually 0.001 to 5000"),
    "fuel.air_fuel_ratio": (0.057, "usually 1 to 60"),
    "spring.stiffness": (30.0, "30000 if given in kN/m"),
    "springs.stiffness": (2e7, "usually 100 to 1e+07"),
    "heat_release.combustion_duration": (1.25, "0.00125 if given in ms"),
}


@pytest.mark.parametrize("path", SLIPS)
def test_a_number_in_another_unit_is_warned_of(base, path):
    value, hint = SLIPS[path]
    (problem,) = base.replace(**{path: value}).unusual()
    assert path.rpartition(".")[2].replace("moving_", "") in problem.path
    assert hint in str(problem)
    assert repr(value) in str(problem)


def test_one_warning_for_one_engine(base):
    slipped = base.replace(bore=66.0, moving_mass=2390.0)
    for call in (lambda: saleg.simulate(slipped, 0.01), lambda: saleg.steady_state(slipped)):
        with pytest.warns(SalegWarning, match=r"bore = 66\.0") as caught:
            call()
        assert len(caught) == 1
        assert "mass = 2390.0" in str(caught[0].message)
        assert caught[0].filename == __file__


def test_the_reference_warns_as_well(base):
    with pytest.warns(SalegWarning, match=r"mass = 2390\.0"):
        saleg.reference.simulate(base.replace(moving_mass=2390.0), 1e-4)


LAW_SLIPS = [
    (MidpointVelocity(frequency=2700.0), "45 if given in 1/min"),
    (PreloadedSprings(preload=3.0), "3000 if given in kN"),
    (laws.ProgressiveSprings(deflections=(0.0, 100.0)), "0.1 if given in mm"),
    (laws.EndStops(gap=95.0), "0.095 if given in mm"),
    (laws.FluxProfile(wavelength=50.0), "0.05 if given in mm"),
    (laws.CosineForce(amplitude=1.5), "1500 if given in kN"),
    (laws.SinusoidalMotor(amplitude=0.264), "264 if given in kN"),
    (laws.ConstantGamma(gas_constant=0.287), "287 if given in kJ/kg/K"),
    (laws.SteadyMotor(amplitude=0.066), "66 if given in kN"),
    (laws.Actuators(load_lag=20.0), "0.02 if given in ms"),
    (laws.Actuators(coldest=20.0), "293.15 if given in degC"),
    (laws.PowerDemand(times=(2000.0, 4000.0)), "2 if given in ms"),
    (Demand.step(2.0, 4.0, 2.0), "4000 if given in kW"),
    (Sensors(position_resolution=0.05), "5e-05 if given in mm"),
]


@pytest.mark.parametrize(("part", "hint"), LAW_SLIPS)
def test_a_number_of_a_law_in_another_unit_is_unusual(part, hint):
    (problem,) = unusual(part)
    assert hint in str(problem)


def test_parts_of_a_tenth_to_ten_times_the_size_are_usual():
    """Every law, controller and chamber, each number scaled as its unit says."""
    powers = {"m": 1, "s": 1, "N": 2, "N/m": 1, "N s/m": 2, "Hz": -1, "W": 2}

    def scaled(part, size):
        changes = {}
        for field in dataclasses.fields(part):
            value, limits = getattr(part, field.name), field.metadata.get("limits")
            if limits is not None:
                by = size ** powers.get(limits.unit, 0)
                many = isinstance(value, tuple)
                changes[field.name] = tuple(by * each for each in value) if many else by * value
            elif dataclasses.is_dataclass(value):
                changes[field.name] = scaled(value, size)
        return dataclasses.replace(part, **changes)

    kinds = [kind for kinds in laws_by_slot().values() for kind in kinds.values()]
    parts = [kind() for kind in kinds] + [saleg.Controller()]
    machines = [make().left for make in saleg.machines.CATALOGUE.values()]
    parts += [part for part in machines if part.bore < 0.1]  # larger ones ten times are not built
    for size in (0.1, 0.3, 1.0, 3.0, 10.0):
        assert [unusual(scaled(part, size)) for part in parts] == [[]] * len(parts)


def test_a_controller_run_as_python_is_warned_of_once():
    controller = saleg.Controller(motor_control=laws.SteadyMotor(frequency=2100.0))
    odd = Sensors(position_resolution=0.05)
    engine = saleg.machines.thesis_transient()
    with pytest.warns(SalegWarning, match=r"35 if given in 1/min") as caught:
        saleg.control.simulate(engine, controller, 1e-3, sensors=odd)
    (warning,) = caught
    assert warning.filename == __file__
    assert "sensors.position_resolution = 0.05" in str(warning.message)
    (row,) = saleg.control.simulate_many([(engine, controller)], 1e-3, workers=1).message
    assert "unusual: controller.motor_control.frequency = 2100.0" in row


def test_a_target_power_of_a_file_in_kilowatts_is_warned_of(tmp_path):
    file = tmp_path / "kilowatts.toml"
    file.write_text("[optimize]\ntarget_power = 22.0\n")
    with pytest.warns(SalegWarning, match=r"target_power = 22\.0 \[W\].*22000 if given in kW"):
        read_optimisation(file)


def test_a_controller_in_other_units_is_warned_of():
    controller = saleg.Controller(
        motor_control=saleg.laws.ResonanceSearch(base_frequency=1800.0),
        load_control=saleg.laws.PowerDemand(times=(0.0, 1.0), demands=(3.8, 1.8)),
    )
    with pytest.warns(SalegWarning, match=r"3800 if given in kW") as caught:
        saleg.control.simulate(saleg.machines.thesis_transient(), controller, 0.001)
    (warning,) = caught
    assert "30 if given in 1/min" in str(warning.message)


def test_a_target_power_in_kilowatts_is_warned_of():
    with pytest.warns(SalegWarning, match=r"target_power = 4\.0 \[W\].*4000 if given in kW"):
        saleg.optimize.thesis_problem(4.0)


def test_engines_of_a_tenth_and_five_times_the_size_are_usual(base):
    for size in (0.1, 5.0):
        changes = {
            "bore": size, "half_stroke": size, "port_closing": size, "moving_mass": size**3,
            "spring.stiffness": size, "alternator.load_constant": size**2,
            "friction.coefficient": size**2, "heat_release.combustion_duration": size,
        }  # fmt: skip
        scaled = base.replace(**{path: base.get(path) * by for path, by in changes.items()})
        assert scaled.unusual() == []


def test_a_table_says_it_in_the_row(base):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = saleg.steady_states([base, base.replace(moving_mass=2390.0)])
    assert "unusual" not in table.message[0]
    assert "unusual: translator.mass = 2390.0 [kg]" in table.message[1]


def test_nothing_we_publish_is_unusual():
    engines = [make() for make in saleg.machines.CATALOGUE.values()]
    for number in (9, 10, 11, 12):
        for column in columns(number).values():
            known = {name: column[name] for name in PARAMETERS if name in column}
            known["half_stroke"] = column["neutral_clearance_length"]
            engines.append(saleg.design.Design().replace(known).engine(column["moving_mass"]))
    assert [engine.unusual() for engine in engines] == [[]] * len(engines)


def test_no_default_is_unusual():
    for kinds in laws_by_slot().values():
        for law in kinds.values():
            assert unusual(law()) == []


# Figures beyond what is built.


def test_a_run_remarks_on_what_no_engine_comes_near(base):
    """Twice the fuel at five times the pressure on a light translator: a solver has no doubts."""
    assert saleg.steady_state(base).remarks == []
    harsh = saleg.steady_state(base.replace(**{"intake.pressure": 6e5, "equivalence_ratio": 0.9}))
    assert harsh.performance.peak_pressure > 400e5
    (remark,) = [text for text in harsh.remarks if "pressure" in text]
    assert f"{harsh.performance.peak_pressure / 1e5:.4g} bar" in remark
    assert f"beyond what is built: {remark}" in str(harsh)


def test_walls_that_heat_the_gas_are_remarked_on(base):
    """Walls at 1500 K give a cycle more than its fuel: the efficiency alone looks like a marvel."""
    hot = saleg.steady_state(base.replace(wall_temperature=1500.0, equivalence_ratio=0.05))
    assert hot.energy.heat_transfer < -hot.energy.released < 0.0
    assert any("heat from the walls" in text for text in hot.remarks)
