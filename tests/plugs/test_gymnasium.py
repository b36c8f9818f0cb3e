"""Environments of gymnasium: what its checker says, one engine beside many, speed."""

import importlib
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest

import saleg
from saleg.control import Plant, Plants, generator
from saleg.errors import ControllerError, InvalidEngine, WrongArguments
from saleg.export import MissingExtra
from saleg.laws import Actuators
from saleg.plugs.task import TaskError
from saleg.simulation.settings import SettingsError

gymnasium = pytest.importorskip("gymnasium")
check_env = importlib.import_module("gymnasium.utils.env_checker").check_env
plug = importlib.import_module("saleg.plugs.gymnasium")
EngineEnv, EngineVectorEnv = plug.EngineEnv, plug.EngineVectorEnv

BASE = saleg.machines.thesis_base()
ACTIONS = {
    "load_weight": (0.3, 1.7),
    "equivalence_ratio": (0.3, 0.8),
    "intake_temperature": (300.0, 340.0),
}


def heavier(engine, chance):
    return engine.replace(moving_mass=2.39 * chance.uniform(0.9, 1.1))


def test_the_checker_of_gymnasium_has_nothing_to_say():
    env = gymnasium.make("saleg/Engine-v0", engine=BASE, actions=ACTIONS, randomise=heavier)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    envs = gymnasium.make_vec("saleg/Engine-v0", num_envs=2, engine=BASE)
    assert envs.observation_space.contains(envs.reset(seed=1)[0])


def test_many_plants_do_what_each_plant_does_to_the_last_bit():
    engines = [BASE, BASE.replace(moving_mass=2.6), BASE]
    actuators = Actuators(load_lag=0.02)
    plants = Plants(engines, 0.3, actuators=actuators, history=1)  # which nobody keeps
    alone = [Plant(engine, 0.3, actuators=actuators) for engine in engines]
    weights = np.array([1.0, 0.9, 1.2])
    while plants.running.any():
        seen = plants.signals
        plants.advance(generator(seen, load_weight=weights * seen.regulated_weight))
        for plant, weight in zip(alone, weights, strict=True):
            if plant.running:
                seen_alone = plant.signals
                plant.command(
                    generator(seen_alone, load_weight=weight * seen_alone.regulated_weight)
                )
                plant.advance()
        np.testing.assert_array_equal(
            np.array(plants.signals).T, np.array([plant.signals for plant in alone])
        )
    assert plants.time_is_up.all()
    assert all(plant.time_is_up for plant in alone)


def test_an_episode_is_the_same_alone_and_among_many():
    strokes, seed = 12, 5
    given = {"actions": ACTIONS, "randomise": heavier, "strokes": 5}
    many = EngineVectorEnv(BASE, 2, **given)
    others = gymnasium.vector.SyncVectorEnv([lambda: EngineEnv(BASE, **given)] * 2)
    chance = np.random.default_rng(1)
    (seen, _), (seen_others, _) = many.reset(seed=seed), others.reset(seed=seed)
    np.testing.assert_array_equal(seen, seen_others)
    for _ in range(strokes):
        action = chance.uniform(-0.3, 0.3, (2, 3))
        *found, info = many.step(action)
        *wanted, _ = others.step(action)
        for one, other in zip(found, wanted, strict=True):
            np.testing.assert_array_equal(one, other)
        assert many.observation_space.contains(found[0])
    assert info["stroke"].shape == (2,)


def test_no_load_ends_at_a_head_and_too_much_load_in_a_stall():
    """What nothing brakes meets a head; twice the load takes more than the charges give."""
    env = EngineEnv(BASE, actions={"load_weight": (0.0, 2.0)}, misfire_ends=False)
    for action, stroke in ((-1.0, 0.18), (1.0, 0.002)):
        env.reset()
        ended = cut = False
        while not (ended or cut):
            _, reward, ended, cut, info = env.step([action])
        assert ended
        assert not cut
        assert info["stroke"] > stroke if action < 0.0 else info["stroke"] < stroke
        assert reward < -7.0  # the penalty of ten


def test_a_misfire_ends_an_episode_at_its_stroke():
    """Too much load compresses too little: both end at the first stroke that fails to fire."""
    actions = {"load_weight": (1.0, 9.0)}
    env, envs = EngineEnv(BASE, actions=actions), EngineVectorEnv(BASE, 2, actions=actions)
    env.reset()
    envs.reset()
    for _ in range(10):
        *_, ended, _, info = env.step([1.0])
        *_, all_ended, _, infos = envs.step([[1.0], [-1.0]])
        assert all_ended.tolist() == [ended, False]
        assert infos["misfired"].tolist() == [info["misfired"], False]
        if ended:
            break
    assert info["misfired"]


def test_rewards_are_power_less_deviation():
    env = EngineEnv(BASE, observations={"power": (0.0, 4e4)})
    env.reset()
    observation, reward, *_, info = env.step([0.0])
    assert observation == pytest.approx([info["power"] / 2e4 - 1.0], rel=1e-6)
    task = env.task.reward
    deviation = abs(info["stroke"] / 0.18 - 1.0)
    assert reward == pytest.approx(info["power"] / task.rated_power - 10.0 * deviation)


def test_what_makes_no_sense_is_named():
    with pytest.raises(TaskError, match=r"no 'load_wait'.*load_weight"):
        EngineEnv(BASE, actions={"load_wait": (0, 1)})
    with pytest.raises(TaskError, match="least and greatest"):
        EngineEnv(BASE, observations={"power": (1.0, 0.0)})
    with pytest.raises(InvalidEngine, match=r"mass = -1\.0"):
        EngineEnv(BASE.replace(moving_mass=-1.0))
    with pytest.raises(TaskError, match="strokes = 0"):
        EngineVectorEnv(BASE, 2, strokes=0)
    with pytest.raises(SettingsError, match=r"engines\[1\] has other laws"):
        Plants([BASE, BASE.replace(friction=saleg.laws.ConstantFriction())], 1.0)


def test_all_that_makes_no_sense_is_named_where_an_environment_is_made():
    """Before, the first of the ranges alone, and settings only where an episode began."""
    wrong = {
        "actions": {"load_weight": (np.nan, 1), "fuel": (0, 1), "equivalence_ratio": (-1, 1)},
        "observations": {"power": (1.0, 0.0)},
        "strokes": -3,
        "duration": 0,
        "randomise": 3,
        "rtoll": 1,
        "rtol": -1,
    }
    for make in (EngineEnv, lambda engine, **given: EngineVectorEnv(engine, 2.5, **given)):
        with pytest.raises(TaskError) as caught:
            make(BASE, **wrong)
        text = str(caught.value)
        for name in wrong:
            assert f"{name} = " in text or f"{name}[" in text
        assert "actions['equivalence_ratio'] = (-1.0, 1.0): must be within the limits" in text
        assert "rtoll = 1: no setting of simulate; did you mean 'rtol'?" in text
    assert "num_envs = 2.5" in text
    for given in ({"actuators": 3}, {"reward": 3}, {"misfire_ends": "no"}):
        with pytest.raises(TaskError, match=next(iter(given))):
            EngineEnv(BASE, **given)
    with pytest.raises(TaskError, match="num_envs = 0"):
        EngineVectorEnv(BASE, 0)


def test_actions_and_rewards_of_another_shape_are_refused():
    """Before, a second action was dropped, and a reward of NaN passed."""
    env, envs = EngineEnv(BASE), EngineVectorEnv(BASE, 2)
    env.reset()
    envs.reset()
    for action in ([0.0, 0.0], "x", 0.0, [[0.0]], None, []):
        with pytest.raises(
            TaskError, match=r"action = .*of shape \(1,\), the last for load_weight"
        ):
            env.step(action)
    for actions in (np.zeros((3, 1)), np.zeros(2), "x"):
        with pytest.raises(TaskError, match=r"action = .*of shape \(2, 1\)"):
            envs.step(actions)
    assert env.step([0.0])[4]["t"] > 0.0
    with pytest.raises(TaskError, match="seed"):
        envs.reset(seed=[1, 2, 3])
    for value in (np.nan, "much", [1.0, 2.0, 3.0]):
        for odd in (
            EngineEnv(BASE, reward=lambda *_, v=value: v),
            EngineVectorEnv(BASE, 2, reward=lambda *_, v=value: v),
        ):
            odd.reset()
            with pytest.raises(TaskError, match="must give finite numbers of shape"):
                odd.step(np.zeros(odd.action_space.shape))


def test_many_plants_name_all_that_is_wrong():
    with pytest.raises(WrongArguments) as caught:
        Plants([BASE, 3, BASE.replace(bore=-1)], duration=-1.0, rtoll=3)
    for part in ("engines[1] = 3", "engines[2].bore = -1.0", "duration = -1.0", "rtoll = 3"):
        assert part in str(caught.value)
    plants = Plants([BASE, BASE], 1.0)
    with pytest.raises(ControllerError, match=r"load_weight = 'x', force = .*of shape \(2,\)"):
        plants.advance(generator(plants.signals, load_weight="x", force=np.zeros(3)))
    with pytest.raises(ControllerError) as refused:
        plants.advance(generator(plants.signals, load_weight=-3.0, sweep=np.array([0.0, np.nan])))
    assert "engine 0: load_weight = -3.0: must" in str(refused.value)
    assert "engine 1: load_weight = -3.0, sweep = nan: must" in str(refused.value)


def test_refused_commands_move_no_engine():
    plants = Plants([BASE, BASE], 1.0)
    seen = plants.signals
    with pytest.raises(ControllerError, match=r"engine 1: load_weight = 11\.0"):
        plants.advance(generator(seen, load_weight=np.array([1.0, 11.0])))
    assert plants.time.tolist() == [0.0, 0.0]


def test_many_make_ten_times_the_strokes_of_one():
    """In one process and thread, by turns, by the time of the processor."""
    env, envs = EngineEnv(BASE, strokes=1000), EngineVectorEnv(BASE, 256)
    env.reset()
    envs.reset()
    actions = np.zeros((256, 1))

    def seconds(step, times):
        begun = time.thread_time()
        for _ in range(times):
            step()
        return time.thread_time() - begun

    turns = [
        (seconds(lambda: env.step([0.0]), 40), seconds(lambda: envs.step(actions), 2))
        for _ in range(9)
    ]
    one, many = np.median(turns, axis=0)
    assert 512 / many > 10.0 * 40 / one


def test_without_gymnasium_the_message_says_what_to_type(monkeypatch):
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    monkeypatch.delitem(sys.modules, "saleg.plugs.gymnasium")
    with pytest.raises(MissingExtra, match=r'pip install "saleg\[rl\]"'):
        importlib.import_module("saleg.plugs.gymnasium")


def test_saleg_imports_no_plug():
    code = (
        "import sys, saleg, saleg.plugs\nassert not {'gymnasium', 'pythonfmu'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
