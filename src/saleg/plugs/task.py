"""What is learned at an engine: actions, observations, reward and the end of an episode."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from saleg.control import generator
from saleg.engine import Engine, check_engine
from saleg.errors import SalegError, nearest, shown
from saleg.laws.arguments import Commands, Signals
from saleg.quantities import as_float, is_whole
from saleg.simulation.initial_state import prepare

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


class TaskError(SalegError, ValueError):
    """Actions, observations or an episode that make no sense."""


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
    """

    engine: Engine
    actions: Any = None
    observations: Any = None
    reward: Any = None
    strokes: int = 200
    duration: float = 60.0
    misfire_ends: bool = True

    def __post_init__(self) -> None:
        """Fill in what is not given, and refuse what makes no sense."""
        check_engine(self.engine)
        usual = usual_observations(self.engine)
        actions = {"load_weight": LOAD_WEIGHT} if self.actions is None else self.actions
        observations = usual if self.observations is None else self.observations
        reward = self.reward or PowerAndStroke(0.5 * usual["power"][1], target_stroke(self.engine))
        for name, value in (("actions", actions), ("observations", observations)):
            known = Commands._fields if name == "actions" else Signals._fields
            object.__setattr__(self, name, checked_ranges(name, value, known))
        object.__setattr__(self, "reward", reward)
        if not is_whole(self.strokes, 1, 2**31 - 1):
            raise TaskError(f"strokes = {shown(self.strokes)}: must be a whole number >= 1")

    def commands(self, signals: Signals, action: np.ndarray) -> Commands:
        """Commands of an action, shape (k,), or of those of n engines, shape (n, k)."""
        action = np.clip(np.asarray(action, float), -1.0, 1.0)
        changes = {
            name: low + 0.5 * (action[..., place] + 1.0) * (high - low)
            for place, (name, (low, high)) in enumerate(self.actions.items())
        }
        return generator(signals)._replace(**changes)

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


def checked_ranges(
    what: str, ranges: Any, known: tuple[str, ...]
) -> dict[str, tuple[float, float]]:
    """Ranges as numbers, if they make sense.

    Raises
    ------
    TaskError
        Naming the first that does not.
    """
    if not isinstance(ranges, Mapping) or not ranges:
        raise TaskError(f"{what} = {shown(ranges)}: must be names with a least and greatest value")
    found = {}
    for name, pair in ranges.items():
        if name not in known:
            raise TaskError(f"{what}: no '{name}'{nearest(str(name), list(known))}")
        try:
            low, high = map(as_float, pair)
        except (TypeError, ValueError):
            low = high = None
        if low is None or high is None or not -math.inf < low < high < math.inf:
            raise TaskError(f"{what}['{name}'] = {shown(pair)}: must be least and greatest")
        found[name] = (low, high)
    return found
