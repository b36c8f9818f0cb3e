"""Settings of a run: how it is integrated, and what is kept of it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from saleg.errors import InvalidEngine, Problem, SalegError, WrongArguments, nearest, shown
from saleg.kernel import tableaus
from saleg.quantities import as_float, is_whole

#: Fixed step [s] where none is given.
DEFAULT_STEP = 5e-6


class SettingsError(SalegError, ValueError):
    """A setting of :func:`saleg.simulate` that makes no sense."""


def refuse(call: str, engines: Sequence[Problem], settings: Sequence[Problem]) -> None:
    """Raise one error that names all that is wrong with the engines and settings of a call.

    Parameters
    ----------
    call : str
        Name of the function or class that was called.
    engines, settings : sequence of Problem

    Raises
    ------
    InvalidEngine, SettingsError
        If one kind alone is wrong.
    WrongArguments
        If both are.
    """
    if engines and settings:
        raise WrongArguments([*engines, *settings], f"arguments of {call}()")
    if engines:
        raise InvalidEngine(engines)
    if settings:
        raise SettingsError("cannot simulate:\n" + "\n".join(f"  {item}" for item in settings))


def check_flag(name: str, value: Any) -> None:
    """Refuse what is neither True nor False.

    Raises
    ------
    SettingsError
    """
    if not isinstance(value, (bool, np.bool_)):
        raise SettingsError(f"{name} = {shown(value)}: must be True or False")


@dataclass(frozen=True)
class Settings:
    """Settings of a run, as :func:`saleg.simulate` describes them."""

    duration: float
    method: str = "adaptive"
    order: int = 4
    step: float | None = None
    rtol: float = 1e-8
    history: int | None = None
    motored_pressure: bool = False
    stall_stroke: float = 0.01
    keep_cycles: int | None = None

    @property
    def adaptive(self) -> bool:
        """Whether the steps are adaptive; giving a step asks for a fixed one."""
        return self.method == "adaptive" and self.step is None

    @property
    def fixed_step(self) -> float:
        """Fixed step [s]."""
        return DEFAULT_STEP if self.step is None else self.step

    @classmethod
    def of(cls, duration: Any, given: Mapping[str, Any]) -> Settings:
        """Settings by name as plain numbers, if there are such and they make sense.

        Raises
        ------
        SettingsError
            Naming everything that is wrong.
        """
        refuse("simulate", [], cls.wrong(duration, given))
        return cls(duration, **given).checked()

    @classmethod
    def wrong(cls, duration: Any, given: Mapping[str, Any]) -> list[Problem]:
        """Everything that is wrong with settings by name."""
        names = [item.name for item in fields(cls)][1:]  # all but the duration
        known = {name: value for name, value in given.items() if name in names}
        unknown = [
            Problem(name, value, "", f"no setting of simulate{nearest(name, names)}")
            for name, value in given.items()
            if name not in names
        ]
        return cls(duration, **known).problems() + unknown

    def checked(self) -> Settings:
        """The same as plain numbers, if they make sense.

        Raises
        ------
        SettingsError
            Naming everything that is wrong.
        """
        refuse("simulate", [], self.problems())
        return replace(
            self,
            duration=float(self.duration),
            order=int(self.order),
            step=None if self.step is None else float(self.step),
            rtol=float(self.rtol),
            history=None if self.history is None else int(self.history),
            motored_pressure=bool(self.motored_pressure),
            stall_stroke=float(self.stall_stroke),
            keep_cycles=None if self.keep_cycles is None else int(self.keep_cycles),
        )

    def problems(self) -> list[Problem]:
        """Every setting that makes no sense."""
        wrong = {}
        if not isinstance(self.method, str) or self.method not in ("adaptive", "fixed"):
            wrong["method"] = "must be 'adaptive' or 'fixed'"
        if as_float(self.order) not in tableaus.FIXED_STEP:
            orders = ", ".join(str(number) for number in tableaus.FIXED_STEP)
            wrong["order"] = f"must be one of {orders}"
        for name, value, low, high in (
            ("duration", self.duration, 0.0, math.inf),
            ("step", self.fixed_step, 1e-12, 1.0),
        ):
            number = as_float(value)
            if number is None or not low < number < high:
                wrong[name] = f"must be a number > {low:g} and < {high:g}"
        rtol = as_float(self.rtol)
        if rtol is None or not 1e-14 <= rtol <= 1e-2:
            wrong["rtol"] = "must be a number from 1e-14 to 1e-2"
        share = as_float(self.stall_stroke)
        if share is None or not 0.0 <= share < 1.0:
            wrong["stall_stroke"] = "must be a number >= 0 and < 1"
        for name, count in (("history", self.history), ("keep_cycles", self.keep_cycles)):
            if count is not None and not is_whole(count, 1, 2**31 - 1):
                wrong[name] = "must be a whole number >= 1, or None"
        if not isinstance(self.motored_pressure, (bool, np.bool_)):
            wrong["motored_pressure"] = "must be True or False"
        return [Problem(name, getattr(self, name), "", text) for name, text in wrong.items()]

    def described(self) -> dict[str, Any]:
        """Method and tolerance, or order and step, as a run names them."""
        motored = {"motored_pressure": self.motored_pressure}
        if self.adaptive:
            return {"method": "adaptive", "rtol": self.rtol, **motored}
        return {"method": "fixed", "order": self.order, "step": self.fixed_step, **motored}


@dataclass(frozen=True)
class Detail:
    """Detail in which the kernel follows a run, beside its settings.

    Attributes
    ----------
    peaks : int
        0 looks for no peaks, 1 takes those at the steps, 2 locates them within the steps.
    dense : int
        Instants recorded within each step of the history.
    last_stroke : float
        Number of the stroke with whose end the run ends at the latest.
    most_steps : float
        Steps after which the run ends as if its time were over.
    """

    peaks: int = 1
    dense: int = 0
    last_stroke: float = math.inf
    most_steps: float = math.inf
