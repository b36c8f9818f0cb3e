"""Where the heat goes: the energy balance of strokes and cycles (2.7, Figure 19)."""

from __future__ import annotations

from dataclasses import dataclass, fields

from saleg.checks import a, checked
from saleg.fundamental.gas import expansion_work
from saleg.fundamental.history import History
from saleg.fundamental.stroke import Stroke


@dataclass(frozen=True)
class EnergyBalance:
    """First law over strokes, in k L^2; no term is a difference.

    Attributes
    ----------
    heat : float
        Heat of the charges that burnt [-].
    work : float
        Work of the load, friction included [-].
    heat_transfer : float
        Heat lost to the walls along the polytropes [-].
    rejected : float
        Heat rejected at bottom dead centre [-].
    stored : float
        Gain of energy in springs and gas [-]; zero at equilibrium.
    adverse_work : float
        Work of the inverted part of the p-V loops around top dead centre [-]. No term of its own:
        what the translator pays there leaves through the walls, within `heat_transfer`.
    """

    heat: float
    work: float
    heat_transfer: float
    rejected: float
    stored: float
    adverse_work: float

    @property
    def residual(self) -> float:
        """Heat that is not accounted for [-]: rounding, or the impact on a head."""
        return self.heat - self.work - self.heat_transfer - self.rejected - self.stored

    @property
    def efficiency(self) -> float:
        """Work over heat [-]."""
        return self.work / self.heat

    def __add__(self, other: EnergyBalance) -> EnergyBalance:
        """Balance of both together."""
        return EnergyBalance(
            *(getattr(self, item.name) + getattr(other, item.name) for item in fields(self))
        )


@checked(stroke=a(Stroke))
def stroke_balance(stroke: Stroke) -> EnergyBalance:
    """Energy balance of a stroke, from the first moment of its motion to that of the next one.

    Parameters
    ----------
    stroke : Stroke

    Returns
    -------
    EnergyBalance

    Examples
    --------
    >>> from saleg.fundamental import System, at_equilibrium
    >>> balance = stroke_balance(at_equilibrium(System(pressure=0.5, heat=1.0), -0.8).stroke(-0.8))
    >>> round(balance.efficiency, 6), abs(balance.residual) < 1e-12
    (0.584756, True)
    """
    system, following = stroke.system, stroke.next()
    gas, depth = system.gas, float(stroke.depth)
    start = stroke.direction * stroke.start
    way = depth - start
    expanded = expansion_work(stroke.pressure, 1.0 + start, way, gas.expansion)
    charge = system.motored_pressure(start)
    compressed = expansion_work(charge, 1.0 - start, -way, gas.compression)
    compressed += system.ignition.added_work(system, depth)
    loss = (gas.expansion - gas.gamma) * expanded + (gas.compression - gas.gamma) * compressed
    spent = stroke.pressure * ((1.0 + start) / (1.0 + depth)) ** gas.expansion
    fresh = system.motored_pressure(-depth)
    return EnergyBalance(
        heat=system.heat * float(system.ignition.fires(system, depth)),
        work=float(stroke.load.work(start, way)),
        heat_transfer=float(loss) / (gas.gamma - 1.0),
        rejected=float(spent - fresh) * (1.0 + depth) / (gas.gamma - 1.0),
        stored=_stored(following) - _stored(stroke),
        adverse_work=system.ignition.adverse_work(system, depth),
    )


@checked(history=a(History))
def cycle_balance(history: History) -> EnergyBalance:
    """Energy balance of the last full cycle, both strokes of it.

    Parameters
    ----------
    history : History
        Of at least two strokes.

    Returns
    -------
    EnergyBalance
    """
    return stroke_balance(history.strokes[-2]) + stroke_balance(history.strokes[-1])


def _stored(stroke: Stroke) -> float:
    """Energy in springs and gas at the first moment of a stroke."""
    start = stroke.direction * stroke.start
    gas = stroke.pressure * (1.0 + start) + stroke.system.motored_pressure(start) * (1.0 - start)
    return float(gas / (stroke.system.gas.gamma - 1.0) + start**2)
