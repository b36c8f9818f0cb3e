"""What is learned at an engine: actions, observations, reward and the end of an episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.checks import FLAG, FUNCTION, as_array
from saleg.control import generator
from saleg.control.outcome import USUAL, refused_commands
from saleg.engine import Controller, Engine, check_engine
from saleg.errors import Problem, WrongFields, nearest
from saleg.laws import Actuators
from saleg.laws.arguments import Commands, Signals
from saleg.quantities import as_float, is_whole
from saleg.simulation.initial_state import prepare
from saleg.simulation.settings import Settings

#: Least and greatest value of a quantity, by name.
Ranges = Mapping[str, tuple[float, float]]
#: Reward from signals, commands and whether the motion ended; numbers, or arrays of many engines.
Reward = Callable[[Signals, Commands, Any], Any]
#: Makes the engine of an episode out of the one given and a source of chance.
Randomise = Callable[[Engine, np.random.Generator], Engine]

#: Range of the load weight [-] where no actions are given.
LOAD_WEIGHT = (0.0, 2.0)
#: Greatest compression ratio observed [-].
COMPRESSION_RATIO = 40.0
#: Settings of a run that suit learning: strokes agree with finer ones to some five digits.
SETTINGS = {"rtol": 1e-6, "stall_stroke": 0.01}


class TaskError(WrongFields):
    """Actions, rewards, settings that make no sense; `problems` lists them all."""

    whole = "environment"


@dataclass(frozen=True)
class PowerAndStroke:
    """Reward of a stroke: electrical power, less the deviation of the stroke from its target.

    ``power / rated_power - weight |stroke - target| / target``, less `penalty` where the motion
    ended.

    Parameters
    ----------
    rated_power : float
        Power worth a reward of one [W].
    target : float
        Target stroke [m].
    weight : float
        Weight of the deviation [-].
    penalty : float
        What a stall, a head contact or a misfire costs [-].
    """

    rated_power: float
    target: float
    weight: float = 10.0
    penalty: float = 10.0

    def __call__(self, signals: Signals, commands: Commands, ended: Any) -> Any:
        """Reward [-] of the stroke just ended."""
        deviation = np.abs(signals.stroke - self.target) / self.target
        kept = signals.power / self.rated_power - self.weight * deviation
        return kept - self.penalty * np.asarray(ended, float)


@dataclass(frozen=True)
class Task:
    """Actions, observations, reward and length of an episode at an engine.

    Parameters
    ----------
    engine : Engine
    actions : mapping of str to (float, float), optional
        Commands by name with the values of the actions -1 and +1 [units of
        :class:`saleg.laws.Commands`]; the load weight from 0 to 2 unless given. All others are
        those of :func:`saleg.control.generator`.
    observations : mapping of str to (float, float), optional
        Signals by name with the values of the observations -1 and +1 [units of
        :class:`saleg.laws.Signals`]; :func:`usual_observations` unless given.
    reward : callable, optional
        Reward from signals, commands and whether the motion ended; :class:`PowerAndStroke` unless
        given.
    strokes : int
        Strokes after which an episode is cut off.
    duration : float
        Time at which it is cut off at the latest [s].
    misfire_ends : bool
        Whether an episode ends with a misfire.
    randomise : callable, optional
        Makes the engine of an episode from `engine` and a numpy random generator.
    actuators : ActuatorLaw, optional
        Limits and lags; :class:`saleg.laws.Actuators` unless given.
    settings : mapping of str to object, optional
        Further settings of :func:`saleg.simulate`; ``rtol`` is 1e-6 here.
    num_envs : int
        How many engines learn it at a time.

    Raises
    ------
    InvalidEngine
        Naming every wrong field of the engine.
    TaskError
        Naming everything else that makes no sense.
    """

    engine: Engine
    actions: Any = None
    observations: Any = None
    reward: Any = None
    strokes: int = 200
    duration: float = 60.0
    misfire_ends: bool = True
    randomise: Randomise | None = None
    actuators: Any = None
    settings: Any = None
    num_envs: int = 1

    def __post_init__(self) -> None:
        """Fill in what is not given, and refuse what makes no sense."""
        check_engine(self.engine)
        usual = usual_observations(self.engine)
        wrong: list[Problem] = []
        filled = {
            "reward": self.reward
            or PowerAndStroke(0.5 * usual["power"][1], target_stroke(self.engine)),
            "actuators": Actuators() if self.actuators is None else self.actuators,
            "settings": {**SETTINGS, **(self.settings or {})},
        }
        for name, default, known in (
            ("actions", {"load_weight": LOAD_WEIGHT}, Commands._fields),
            ("observations", usual, Signals._fields),
        ):
            given = getattr(self, name)
            filled[name] = read_ranges(name, default if given is None else given, known, wrong)
        for name, value in filled.items():
            object.__setattr__(self, name, value)
        wrong += self._problems()
        if wrong:
            raise TaskError(wrong)

    def _problems(self) -> list[Problem]:
        """What makes no sense beside the ranges."""
        wrong = [
            Problem(name, getattr(self, name), "", wanted)
            for name, sensible, wanted in (
                ("reward", callable(self.reward), "must be a function"),
                ("strokes", is_whole(self.strokes, 1, 2**31 - 1), "must be a whole number >= 1"),
                ("misfire_ends", FLAG.read(self.misfire_ends) is not None, FLAG.wanted),
                ("randomise", self.randomise is None or callable(self.randomise), FUNCTION.wanted),
                ("num_envs", is_whole(self.num_envs, 1, 2**31 - 1), "must be a whole number >= 1"),
            )
            if not sensible
        ]
        wrong += Settings.wrong(self.duration, self.settings)
        controller = Controller(actuators=self.actuators)
        return wrong + (controller.problems() or self._beyond(controller))

    def _beyond(self, controller: Controller) -> list[Problem]:
        """Ranges of actions beyond the limits of the actuators."""
        law = type(self.actuators).__name__
        return [
            Problem(f"actions[{name!r}]", pair, "", f"must be within the limits of {law}")
            for name, pair in self.actions.items()
            for ends in [[USUAL._replace(**{name: end}) for end in pair]]
            if any(name in refused_commands(commands, controller) for commands in ends)
        ]

    def engine_of(self, chance: np.random.Generator) -> Engine:
        """Engine of an episode."""
        return self.engine if self.randomise is None else self.randomise(self.engine, chance)

    def commands(self, signals: Signals, action: Any) -> Commands:
        """Commands of an action, shape (k,), or of those of n engines, shape (n, k).

        Raises
        ------
        TaskError
            If it is no array of numbers of that shape.
        """
        found, shape = as_array(action), (*np.shape(signals.t), len(self.actions))
        if found is None or found.shape != shape:
            of = "" if found is None else f", not {found.shape}"
            wanted = f"must be numbers of shape {shape}, the last for {', '.join(self.actions)}"
            raise TaskError([Problem("action", action, "", wanted + of)])
        scaled = np.clip(found, -1.0, 1.0)
        changes = {
            name: low + 0.5 * (scaled[..., place] + 1.0) * (high - low)
            for place, (name, (low, high)) in enumerate(self.actions.items())
        }
        return generator(signals)._replace(**changes)

    def rewards(self, signals: Signals, commands: Commands, ended: Any, goes: Any = True) -> Any:
        """Rewards of a stroke, shape () or (n,); 0 for engines that did not go.

        Raises
        ------
        TaskError
            If the reward function gives anything but finite numbers.
        """
        given = self.reward(signals, commands, ended)
        try:
            found = np.broadcast_to(np.asarray(given, float), np.shape(signals.t))
        except (TypeError, ValueError):
            found = np.full(np.shape(signals.t), np.nan)
        found = np.where(goes, found, 0.0)
        if not np.isfinite(found).all():
            wanted = f"must give finite numbers of shape {found.shape}"
            raise TaskError([Problem("reward(...)", given, "", wanted)])
        return found

    def observed(self, signals: Signals) -> np.ndarray:
        """Observation of signals, from -1 to +1; 0 for what is not known yet."""
        columns = [
            2.0 * (getattr(signals, name) - low) / (high - low) - 1.0
            for name, (low, high) in self.observations.items()
        ]
        scaled = np.clip(np.nan_to_num(np.stack(columns, axis=-1)), -1.0, 1.0)
        return scaled.astype(np.float32)


def target_stroke(engine: Engine) -> float:
    """Target stroke of an engine's regulator [m]; nine tenths of the greatest without one."""
    share = float(getattr(engine.alternator, "target_stroke", 0.9))
    return share * engine.maximum_stroke


def usual_observations(engine: Engine) -> dict[str, tuple[float, float]]:
    """Ranges of the signals that are observed unless others are asked for.

    Those of frequency and power follow from the stiffness of the charge at the start: four times
    the frequency of small oscillations, and twice that of mass times speed squared.

    Parameters
    ----------
    engine : Engine

    Returns
    -------
    dict
        Least and greatest value, in SI units, by the name of the signal.
    """
    E: Any = prepare(engine).engine[0]
    frequency = float(E["speed_scale"] / E["length_scale"]) / (2.0 * math.pi)
    power = 2.0 * float(E["mass"] * E["speed_scale"] ** 2) * frequency
    stroke = engine.maximum_stroke
    return {
        "x": (-0.5 * stroke, 0.5 * stroke),
        "stroke": (0.0, stroke),
        "compression_ratio": (1.0, COMPRESSION_RATIO),
        "frequency": (0.0, 4.0 * frequency),
        "power": (-power, power),
    }


def read_ranges(
    what: str, ranges: Any, known: tuple[str, ...], wrong: list[Problem]
) -> dict[str, tuple[float, float]]:
    """Ranges as numbers; those that make no sense are noted and left out."""
    if not isinstance(ranges, Mapping) or not ranges:
        wrong.append(Problem(what, ranges, "", "must be names with a least and greatest value"))
        return {}
    found = {}
    for name, pair in ranges.items():
        try:
            low, high = map(as_float, pair)
        except (TypeError, ValueError):
            low = high = None
        if name not in known:
            text = f"no '{name}' among the {what}{nearest(str(name), known)}"
            wrong.append(Problem(f"{what}[{name!r}]", pair, "", text))
        elif low is None or high is None or not -math.inf < low < high < math.inf:
            text = "must be least and greatest, finite"
            wrong.append(Problem(f"{what}[{name!r}]", pair, "", text))
        else:
            found[name] = (low, high)
    return found
