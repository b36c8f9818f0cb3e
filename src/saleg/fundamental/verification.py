"""The numeric engine under the assumptions of Chapter 2, beside the closed form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from saleg.checks import a, checked, whole
from saleg.fundamental.assumptions import BASE_CASE, to_engine
from saleg.fundamental.checks import SCALAR
from saleg.fundamental.energy import stroke_balance
from saleg.fundamental.history import History, march
from saleg.fundamental.scales import Scales
from saleg.fundamental.stroke import Stroke
from saleg.fundamental.system import System
from saleg.simulation.run import Run

#: Time for which the numeric engine runs on after the last stroke of the closed form, in
#: sqrt(m/k): what it computes of one stroke more is not looked at.
MARGIN = 0.05
#: Stroke over the maximum one below which the numeric engine has come to rest: a load that holds
#: the translator at its dead centre leaves none at all.
AT_REST = 1e-9


@dataclass(frozen=True, eq=False)
class Verification:
    """Closed form and numeric engine of one system, side by side; :func:`verify` makes it.

    Attributes
    ----------
    history : History
        The closed form.
    run : Run
        The numeric engine, every step in its history.
    scales : Scales
    """

    history: History
    run: Run
    scales: Scales

    @property
    def strokes(self) -> int:
        """Number of strokes that both models finish: either may meet a head, or never begin."""
        return min(len(self.history.strokes), len(self.run.strokes))

    @cached_property
    def closed_form(self) -> dict[str, np.ndarray]:
        """What the closed form says of every stroke, dimensionless; arrays of shape (strokes,).

        Dead centre at its end, duration, the work of the load, the heat of charges that burnt,
        losses to the walls, heat rejected as it began, and energy stored as it ends, before
        anything burns or is rejected there.
        """
        done = self.history.strokes[: self.strokes]
        balances = [stroke_balance(stroke) for stroke in done]
        return {
            "dead_centre": np.array([float(stroke.end) for stroke in done]),
            "duration": np.array([float(stroke.duration) for stroke in done]),
            "work": np.array([balance.work for balance in balances]),
            "heat": self._heat([balance.heat for balance in balances]),
            "heat_transfer": np.array([balance.heat_transfer for balance in balances]),
            "rejected": np.array([0.0, *(b.rejected for b in balances)])[: self.strokes],
            "stored": np.array([_stored_at_end(stroke) for stroke in done]),
        }

    @cached_property
    def numeric(self) -> dict[str, np.ndarray]:
        """The same of the numeric engine."""
        rows, energy = self.run.strokes[: self.strokes], self.scales.energy
        stored = rows["internal_energy"].sum(axis=1) + rows["spring_energy"]
        return {
            "dead_centre": rows["x_end"] / self.scales.length,
            "duration": rows["duration"] / self.scales.time,
            "work": rows["alternator_work"] / energy,
            "heat": rows["heat_released"].sum(axis=1) / energy,
            "heat_transfer": rows["heat_lost"].sum(axis=1) / energy,
            "rejected": rows["exhaust_energy"].sum(axis=1) / energy,
            "stored": stored / energy,
        }

    @cached_property
    def deviations(self) -> dict[str, np.ndarray]:
        """Distance of both in every stroke [-]; arrays of shape (strokes,).

        Of dead centres in half strokes, of durations relative, of energies over the greatest
        energy there is in the stroke, kinetic or stored. That of `velocity` is the greatest one of
        the squares of the velocities at all places the numeric engine stepped on, over the
        greatest square.
        """
        kinetic, velocity = self._along_the_strokes()
        unit = np.maximum(kinetic, self.closed_form["stored"])
        units = {"dead_centre": 1.0, "duration": self.closed_form["duration"]}
        found = {
            name: np.abs(self.numeric[name] - values) / units.get(name, unit)
            for name, values in self.closed_form.items()
        }
        return {**found, "velocity": velocity}

    @property
    def worst(self) -> float:
        """Greatest of all deviations [-]."""
        return max(float(values.max(initial=0.0)) for values in self.deviations.values())

    @property
    def frequencies(self) -> tuple[float, float]:
        """Frequency of the last two strokes [Hz], of the closed form and of the numeric engine."""
        closed, numeric = (
            1.0 / float(found["duration"][-2:].sum()) / self.scales.time
            for found in (self.closed_form, self.numeric)
        )
        return closed, numeric

    def _heat(self, burnt_at_end: list[float]) -> np.ndarray:
        """Heat released within each stroke: that of a dead centre belongs to the one it begins."""
        system = self.history.strokes[0].system
        heat = np.array(burnt_at_end)
        if np.isinf(system.ignition.position(system.gas)):
            return np.array([system.heat, *heat])[: self.strokes]
        heat[:1] += system.heat  # what burns at the start, whatever the ignition
        return heat

    def _along_the_strokes(self) -> tuple[np.ndarray, np.ndarray]:
        """Greatest kinetic energy of every stroke [-], and greatest deviation from it over that."""
        rows, ends = self.run.history_rows, self.run.strokes["t"][: self.strokes]
        assert rows is not None
        x, v = rows["x"] / self.scales.length, rows["v"] / self.scales.velocity
        greatest, deviation = np.zeros(self.strokes), np.zeros(self.strokes)
        begin = 0.0
        for n, end in enumerate(ends):
            inside = (rows["t"] > begin) & (rows["t"] < end)
            wanted = self.history.strokes[n].kinetic_energy(x[inside])
            greatest[n] = wanted.max()
            deviation[n] = np.abs(0.5 * v[inside] ** 2 - wanted).max() / greatest[n]
            begin = end
        return greatest, deviation


@checked(system=a(System), start=SCALAR, strokes=whole(1), scales=a(Scales))
def verify(
    system: System,
    start: float = -0.8,
    strokes: int = 10,
    *,
    scales: Scales = BASE_CASE,
    rtol: float = 1e-11,
) -> Verification:
    """Run the numeric engine under the assumptions of a system, and march its closed form.

    Parameters
    ----------
    system : System
        What :func:`saleg.fundamental.to_engine` can express.
    start : float
        Left dead centre at which it starts at rest, x_l* [-].
    strokes : int
        How many at most.
    scales : Scales
        Those of the engine; the thesis' base case unless given.
    rtol : float
        Tolerance of the numeric engine [-].

    Returns
    -------
    Verification

    Raises
    ------
    OutsideModel
        If `start` is not between -1 and 0, or if no law does what the system does.

    Examples
    --------
    >>> from saleg.fundamental import ConstantLoad
    >>> system = System(pressure=0.17, heat=2.2, load=ConstantLoad(0.814))
    >>> verification = verify(system, -0.8, strokes=4)
    >>> verification.strokes, verification.worst < 1e-8
    (4, True)
    """
    from saleg.simulation.initial_state import prepare
    from saleg.simulation.integration import integrate
    from saleg.simulation.settings import Settings

    engine = to_engine(system, start, scales=scales)
    history = march(system, start, strokes)
    time = sum(float(stroke.duration) for stroke in history.strokes) + MARGIN
    duration = time * scales.time
    # Dimensionless systems may be of any size: no warning that theirs is unusual.
    settings = Settings(duration, rtol=rtol, history=1, stall_stroke=AT_REST)
    run = integrate(engine, prepare(engine), settings)
    return Verification(history, run, scales)


def _stored_at_end(stroke: Stroke) -> float:
    """Energy in springs and gas as a stroke ends, before anything burns or is rejected [-]."""
    end, gamma = stroke.end, stroke.system.gas.gamma
    left, right = stroke.pressures(end)
    return float((left * (1.0 + end) + right * (1.0 - end)) / (gamma - 1.0) + end**2)
