"""Environments of gymnasium for reinforcement learning: one engine, or many in one compiled loop.

A step is a stroke, from dead centre to dead centre. Actions and observations go from -1 to +1.
Once this is imported ``gymnasium.make("saleg/Engine-v0", engine=...)`` makes one and
``gymnasium.make_vec`` many.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from saleg.control.plant import Plant
from saleg.control.plants import Plants
from saleg.engine import Engine
from saleg.errors import Problem, SalegError
from saleg.export.extras import extra
from saleg.laws.arguments import Commands
from saleg.laws.control.base import ActuatorLaw
from saleg.plugs.task import Randomise, Ranges, Reward, Task, TaskError
from saleg.quantities import is_whole

try:
    from gymnasium import Env, register, spaces
    from gymnasium.utils import seeding
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError:
    extra("gymnasium")  # says what to type
    raise

#: Of a run only its latest cycles are kept.
KEPT = {"keep_cycles": 11}
METADATA: dict[str, Any] = {"render_modes": []}


class EngineEnv(Env[Any, Any]):
    """An engine as an environment: a step is a stroke.

    Parameters
    ----------
    engine : Engine
        Begins as its start law has it.
    actions, observations, reward, strokes, duration, misfire_ends
        What is to be learned, see :class:`saleg.plugs.task.Task`.
    randomise : callable, optional
        Makes the engine of an episode from `engine` and a numpy random generator, which
        ``reset(seed=...)`` seeds: another start, other numbers of its laws.
    actuators : ActuatorLaw, optional
        Limits and lags; :class:`saleg.laws.Actuators` unless given.
    **settings
        Further settings of :func:`saleg.simulate`; ``rtol`` is 1e-6 here.

    Notes
    -----
    An episode ends (``terminated``) with a stall, a head contact or a misfire, and is cut off
    (``truncated``) after `strokes` strokes or at `duration`. ``info`` has the signals in SI units
    and ``misfired``.

    Examples
    --------
    >>> import saleg
    >>> from saleg.plugs.gymnasium import EngineEnv
    >>> env = EngineEnv(saleg.machines.thesis_base(), actions={"load_weight": (0.5, 1.5)})
    >>> observation, info = env.reset(seed=1)
    >>> observation, reward, terminated, truncated, info = env.step([0.0])
    >>> round(info["stroke"], 3)
    0.179
    """

    metadata = METADATA

    def __init__(
        self,
        engine: Engine,
        *,
        actions: Ranges | None = None,
        observations: Ranges | None = None,
        reward: Reward | None = None,
        strokes: int = 200,
        duration: float = 60.0,
        misfire_ends: bool = True,
        randomise: Randomise | None = None,
        actuators: ActuatorLaw | None = None,
        **settings: Any,
    ):
        self.task = Task(
            engine,
            actions,
            observations,
            reward,
            strokes,
            duration,
            misfire_ends,
            randomise,
            actuators,
            {**KEPT, **settings},
        )
        self.action_space, self.observation_space = _spaces(self.task)
        self._plant: Plant | None = None
        self._strokes = 0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode.

        Parameters
        ----------
        seed : int, optional
            Of `randomise`.
        options : dict, optional
            None are known.

        Returns
        -------
        observation : ndarray of float32, shape (k,)
        info : dict
        """
        super().reset(seed=seed)
        task = self.task
        given = {**task.settings, "actuators": task.actuators}
        self._plant = Plant(task.engine_of(self.np_random), task.duration, **given)
        self._strokes = 0
        signals = self._plant.signals
        return self.task.observed(signals), {**signals._asdict(), "misfired": False}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Command the engine and go on to the next dead centre.

        Parameters
        ----------
        action : array_like, shape (k,)
            From -1 to +1.

        Returns
        -------
        observation : ndarray of float32, shape (k,)
        reward : float
            In the unit of the reward function.
        terminated, truncated : bool
        info : dict
        """
        plant = self._plant
        if plant is None:
            raise SalegError("the environment has not begun: call reset first")
        commands = self.task.commands(plant.signals, action)
        plant.command(Commands(*map(float, commands)))
        plant.advance()
        self._strokes += 1
        signals, misfired = plant.signals, plant.misfired
        stopped = not (plant.running or plant.time_is_up)
        ended = stopped or (misfired and self.task.misfire_ends)
        cut = not ended and (plant.time_is_up or self._strokes >= self.task.strokes)
        reward = float(self.task.rewards(signals, commands, ended))
        info = {**signals._asdict(), "misfired": misfired}
        return self.task.observed(signals), reward, ended, cut, info


class EngineVectorEnv(VectorEnv[Any, Any, Any]):
    """Many engines as one environment: a step is a stroke of each, in one compiled loop.

    Parameters
    ----------
    engine : Engine
    num_envs : int
        How many.
    randomise : callable, optional
        Makes the engine of an episode, of the same laws, from `engine` and a numpy random
        generator; each has one of its own, so that row n of ``reset(seed=s)`` is as
        :class:`EngineEnv` after ``reset(seed=s + n)``.
    actions, observations, reward, strokes, duration, misfire_ends, actuators, **settings
        As for :class:`EngineEnv`. The reward is given signals and commands as arrays.

    Notes
    -----
    An engine whose episode is over begins the next at the next step, whatever the action
    (``AutoresetMode.NEXT_STEP``). ``info`` has the signals as arrays.

    Examples
    --------
    >>> import numpy as np
    >>> import saleg
    >>> from saleg.plugs.gymnasium import EngineVectorEnv
    >>> envs = EngineVectorEnv(saleg.machines.thesis_base(), 3)
    >>> observations, info = envs.reset(seed=1)
    >>> observations, rewards, ended, cut, info = envs.step(np.zeros((3, 1)))
    >>> info["stroke"].round(3)
    array([0.179, 0.179, 0.179])
    """

    def __init__(
        self,
        engine: Engine,
        num_envs: int,
        *,
        actions: Ranges | None = None,
        observations: Ranges | None = None,
        reward: Reward | None = None,
        strokes: int = 200,
        duration: float = 60.0,
        misfire_ends: bool = True,
        randomise: Randomise | None = None,
        actuators: ActuatorLaw | None = None,
        **settings: Any,
    ):
        self.metadata = {**METADATA, "autoreset_mode": AutoresetMode.NEXT_STEP}
        self.task = Task(
            engine,
            actions,
            observations,
            reward,
            strokes,
            duration,
            misfire_ends,
            randomise,
            actuators,
            settings,
            num_envs,
        )
        self.num_envs = num_envs
        self.single_action_space, self.single_observation_space = _spaces(self.task)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._plants: Plants | None = None
        self._chances: list[np.random.Generator] = []

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode of each.

        Parameters
        ----------
        seed : int or list of int, optional
            Of `randomise`; of a number the rows have the numbers from there on.
        options : dict, optional
            None are known.

        Returns
        -------
        observations : ndarray of float32, shape (n, k)
        info : dict of ndarray, shape (n,)
        """
        if seed is not None or not self._chances:
            seeds = _seeds(seed, self.num_envs)
            super().reset(seed=seeds[0])
            self._chances = [seeding.np_random(one)[0] for one in seeds]
        task = self.task
        engines = [task.engine_of(chance) for chance in self._chances]
        given = {**task.settings, "actuators": task.actuators}
        self._plants = Plants(engines, task.duration, **given)
        self._strokes = np.zeros(self.num_envs, int)
        self._over = np.zeros(self.num_envs, bool)
        return self._seen(self._plants)

    def step(
        self, actions: Any
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Command the engines and go on to the next dead centre of each.

        Parameters
        ----------
        actions : array_like, shape (n, k)
            From -1 to +1.

        Returns
        -------
        observations : ndarray of float32, shape (n, k)
        rewards : ndarray, shape (n,)
            0 where an episode begins.
        terminated, truncated : ndarray of bool, shape (n,)
        info : dict of ndarray, shape (n,)
        """
        plants = self._plants
        if plants is None:
            raise SalegError("the environment has not begun: call reset first")
        begins, goes = self._over, ~self._over
        for row in np.flatnonzero(begins):
            plants.restart(int(row), self.task.engine_of(self._chances[row]))
        commands = self.task.commands(plants.signals, actions)
        if goes.any():
            plants.advance(commands, goes)
        self._strokes = np.where(begins, 0, self._strokes + 1)
        stopped = ~(plants.running | plants.time_is_up)
        ended = goes & (stopped | (plants.misfired & self.task.misfire_ends))
        cut = goes & ~ended & (plants.time_is_up | (self._strokes >= self.task.strokes))
        self._over = ended | cut
        rewards = self.task.rewards(plants.signals, commands, ended, goes)
        observations, info = self._seen(plants)
        return observations, rewards, ended, cut, info

    def _seen(self, plants: Plants) -> tuple[np.ndarray, dict[str, Any]]:
        """Observations, and the signals as info."""
        signals = plants.signals
        return self.task.observed(signals), {**signals._asdict(), "misfired": plants.misfired}


def _spaces(task: Task) -> tuple[Any, Any]:
    """Spaces of actions and observations."""
    sizes = (len(task.actions), len(task.observations))
    actions, observations = (spaces.Box(-1.0, 1.0, (size,), np.float32) for size in sizes)
    return actions, observations


def _seeds(seed: Any, count: int) -> list[int | None]:
    """Seed of each of some environments."""
    if seed is None or is_whole(seed):
        return [None if seed is None else int(seed) + n for n in range(count)]
    if not isinstance(seed, Sequence) or len(seed) != count:
        wanted = f"must be a whole number, or a list of {count}"
        raise TaskError([Problem("seed", seed, "", wanted)])
    return list(seed)


register(
    "saleg/Engine-v0",
    entry_point=f"{__name__}:EngineEnv",
    vector_entry_point=f"{__name__}:EngineVectorEnv",
)
