"""Functional mock-up units: the trajectory of `simulate`, two at a time, what is refused."""

import importlib

import numpy as np
import pytest

import saleg
from saleg.control import Plant, generator
from saleg.errors import SalegError, UnknownPath, WrongArguments
from saleg.plugs.fmu import to_fmu
from saleg.simulation.settings import SettingsError

fmpy = pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")
fmi1 = importlib.import_module("fmpy.fmi1")
fmi2 = importlib.import_module("fmpy.fmi2")

BASE = saleg.machines.thesis_base()
#: Outputs that are compared, and how great they become.
SCALES = {"x": 0.1, "v": 17.0, "p_left": 1e7, "p_right": 1e7, "electrical_power": 5e4}


class Unit:
    """A unit as a host holds it."""

    def __init__(self, path, folder, parameters=None, messages=None):
        self.description = fmpy.read_model_description(path)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.messages = [] if messages is None else messages
        fmpy.extract(path, folder)
        self.slave = fmi2.FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=folder.name,
        )
        self.slave.instantiate(callbacks=self._callbacks(), loggingOn=True)
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.set(parameters or {})
        self.slave.exitInitializationMode()
        self.time = 0.0

    def _callbacks(self):
        def told(_environment, _instance, _status, _category, message):
            self.messages.append(message.decode())

        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(told)
        callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
        callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
        self._kept = callbacks
        return callbacks

    def set(self, values):
        self.slave.setReal([self.references[name] for name in values], list(values.values()))

    def command(self, **values):
        self.set({f"command.{name}": value for name, value in values.items()})

    def leave_to_commands(self):
        self.slave.setBoolean([self.references["command.regulated"]], [False])

    def step(self, duration):
        self.slave.doStep(self.time, duration)
        self.time += duration

    def get(self, *names):
        return self.slave.getReal([self.references[name] for name in names])


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return to_fmu(BASE, tmp_path_factory.mktemp("fmu") / "Base.fmu", rtol=1e-9)


def test_a_unit_has_the_trajectory_of_simulate_whatever_the_step(path, tmp_path):
    """Two in one process, with steps of their own, beside a run that ends there."""
    fine, coarse = Unit(path, tmp_path / "fine"), Unit(path, tmp_path / "coarse")
    for _ in range(4):
        for _ in range(25):
            fine.step(1e-3)
        coarse.step(0.025)
        run = saleg.simulate(BASE, coarse.time, rtol=1e-9, history=1)
        end = run.history.iloc[-1]
        wanted = end[list(SCALES)].to_numpy(float)
        for unit in (fine, coarse):
            error = (np.array(unit.get(*SCALES)) - wanted) / list(SCALES.values())
            assert np.abs(error).max() < 1e-8
    assert fine.get("signal.stroke")[0] == pytest.approx(run.dead_centres.stroke.iloc[-1], rel=1e-8)


def test_inputs_command_as_a_plant_is_commanded(path, tmp_path):
    unit, plant = Unit(path, tmp_path / "unit"), Plant(BASE, 1.0, rtol=1e-9)
    unit.leave_to_commands()
    for weight, ratio in ((1.0, 0.6), (1.1, 0.55), (0.9, 0.6)):
        unit.command(load_weight=weight, equivalence_ratio=ratio)
        plant.command(generator(plant.signals, load_weight=weight, equivalence_ratio=ratio))
        for _ in range(3):
            unit.step(0.01)
            plant.advance(0.01)
        assert unit.get("signal.stroke")[0] == pytest.approx(plant.signals.stroke, rel=1e-8)
        assert unit.get("signal.power")[0] == pytest.approx(plant.signals.power, rel=1e-7)
    assert unit.get("actual_load_weight") == [0.9]


def test_parameters_change_the_engine(path, tmp_path):
    changes = {"moving_mass": 2.8, "intake.pressure": 1.1e5}
    unit = Unit(path, tmp_path / "unit", changes)
    unit.step(0.05)
    engine = BASE.replace(**changes)
    end = saleg.simulate(engine, 0.05, rtol=1e-9, history=1).history.iloc[-1]
    assert unit.get("x")[0] == pytest.approx(end.x, abs=1e-9)


def test_what_makes_no_engine_is_refused_with_a_message(path, tmp_path):
    messages = []
    with pytest.raises(fmi1.FMICallException, match="fmi2ExitInitializationMode"):
        Unit(path, tmp_path / "unit", {"moving_mass": -1.0}, messages)
    assert any("translator.mass = -1.0" in message for message in messages)


def test_a_unit_says_how_the_motion_ended(path, tmp_path):
    """Twice the load stalls this engine; the step in which it does is discarded."""
    unit = Unit(path, tmp_path / "unit")
    unit.leave_to_commands()
    unit.command(load_weight=2.0)
    plant = Plant(BASE, 1.0, rtol=1e-9, stall_stroke=0.01)
    while plant.running:
        plant.command(generator(plant.signals, load_weight=2.0))
        plant.advance()
    while unit.time + 0.01 < plant.time:
        unit.step(0.01)
    with pytest.raises(fmi1.FMICallException, match=r"fmi2DoStep.*discard"):
        unit.step(0.01)
    assert any("the stroke fell to" in message for message in unit.messages)


@pytest.mark.parametrize("name", ["hold", "EngineSlave", "globals"])
def test_the_name_of_a_file_does_not_matter(tmp_path, name):
    """Before, a unit called hold could not be written: its class took the place of a function."""
    unit = Unit(to_fmu(BASE, tmp_path / f"{name}.fmu"), tmp_path / "unit")
    assert unit.get("x") == pytest.approx([-0.09])


def test_a_name_python_knows_and_an_earlier_file(tmp_path):
    path = to_fmu(BASE, tmp_path / "json.fmu", rtol=np.float64(1e-7))
    with pytest.raises(SalegError, match=r"json\.fmu"):
        to_fmu(BASE, path)
    unit = Unit(to_fmu(BASE, path, overwrite=True), tmp_path / "unit")
    assert unit.get("x") == pytest.approx([-0.09])


def test_what_cannot_become_a_unit_is_named(tmp_path):
    with pytest.raises(UnknownPath, match="no number"):
        to_fmu(BASE, tmp_path / "Base.fmu", parameters=["friction"])
    with pytest.raises(SalegError, match=r"letters and \.fmu"):
        to_fmu(BASE, tmp_path / "base case.fmu")
    with pytest.raises(UnknownPath, match=r"(?s)no 'foo'.*no 'bar'.*'bore' stands twice"):
        to_fmu(BASE, tmp_path / "Base.fmu", parameters=["foo", "bar", "bore", "bore"])
    with pytest.raises(SalegError, match=r"parameters = 'moving_mass': must be a list of names"):
        to_fmu(BASE, tmp_path / "Base.fmu", parameters="moving_mass")
    with pytest.raises(SettingsError, match=r"rtoll = 3: no setting of simulate"):
        to_fmu(BASE, tmp_path / "Base.fmu", rtoll=3)
    with pytest.raises(WrongArguments) as caught:  # before, one at a time
        to_fmu(BASE.replace(bore=-1), 3, parameters=3, overwrite="no", rtol=np.nan, stall_stroke=-1)
    wrong = ["bore", "path", "parameters", "overwrite", "rtol", "stall_stroke"]
    assert [problem.path for problem in caught.value.problems] == wrong
    assert list(tmp_path.iterdir()) == []
