"""Course of the heat release after the start of combustion."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import HeatRelease
from saleg.laws.choice import any_of, where
from saleg.laws.interpolation import interval, monotone, monotone_slope
from saleg.quantities import quantity, series


@dataclass(frozen=True)
class BurnDuration(HeatRelease):
    """What all heat releases of finite duration have in common: that duration.

    ``C_d (c_m / 10 m/s)^i phi^j (T / 1000 K)^k``, with the mean piston speed c_m of the latest
    stroke, the equivalence ratio phi of the charge and its temperature T at the start of
    combustion. All exponents are zero unless given, which leaves the duration constant as in the
    thesis; no values are published for free-piston engines.

    Parameters
    ----------
    combustion_duration : float
        Combustion duration C_d, at 10 m/s, an equivalence ratio of 1 and 1000 K [s].
    speed_exponent, equivalence_ratio_exponent, temperature_exponent : float
        The exponents i, j, k [-].
    """

    combustion_duration: float = quantity(
        "s", default=1.25e-3, low=0, open_low=True, usual=(1e-6, 0.1)
    )
    speed_exponent: float = quantity("-", default=0.0)
    equivalence_ratio_exponent: float = quantity("-", default=0.0)
    temperature_exponent: float = quantity("-", default=0.0)

    def duration(self, gas: Gas, charge: Charge) -> float:
        """Combustion duration [s]."""
        speed = (gas.mean_piston_speed / 10.0) ** self.speed_exponent
        ratio = charge.equivalence_ratio**self.equivalence_ratio_exponent
        heat = (gas.T / 1000.0) ** self.temperature_exponent
        return self.combustion_duration * speed * ratio * heat


@dataclass(frozen=True)
class Wiebe(BurnDuration):
    """Single Wiebe function of time (Eq. 52-53): ``chi = 1 - exp(-a u^(b+1))``.

    The release ends at u = 1; the share ``exp(-a)`` not released by then stays unburned.

    Parameters
    ----------
    combustion_duration, speed_exponent, equivalence_ratio_exponent, temperature_exponent : float
        Duration [s] and its exponents [-], see :class:`BurnDuration`.
    a : float
        Efficiency parameter [-].
    b : float
        Shape parameter [-].

    Examples
    --------
    >>> round(Wiebe().burnt_fraction(1.0), 6)
    0.993262
    """

    a: float = quantity("-", default=5.0, low=0, open_low=True)
    b: float = quantity("-", default=2.0, low=0)

    def burn_rate(self, u: float) -> float:
        """Rate of the burnt fraction [-], Eq. 53."""
        return wiebe_rate(u, self.a, self.b)

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-], Eq. 52."""
        return wiebe_fraction(u, self.a, self.b)


def wiebe_rate(u: float, a: float, b: float) -> float:
    """Derivative of :func:`wiebe_fraction` [-]."""
    power = u * u  # of the usual exponent, at a fifth of the cost
    if any_of(b != 2.0):
        power = where(b == 2.0, power, u**b)
    return a * (b + 1.0) * power * math.exp(-a * power * u)


def wiebe_fraction(u: float, a: float, b: float) -> float:
    """Wiebe function [-] of u from 0 to 1."""
    return -math.expm1(-a * u ** (b + 1.0))


@dataclass(frozen=True)
class DoubleWiebe(BurnDuration):
    """A premixed and a diffusive phase, each a normalised Wiebe function (Eq. 58).

    The premixed phase lasts from the start of combustion to `premixed_end`, the diffusive one from
    `diffusion_start` to the end. Printed, both phases start together, are not normalised, and with
    a = 1.2 leave 30 % of the heat unreleased; the text has their durations add up to the whole,
    which means one after the other, as it is here by default.

    Parameters
    ----------
    combustion_duration, speed_exponent, equivalence_ratio_exponent, temperature_exponent : float
        Duration [s] and its exponents [-], see :class:`BurnDuration`.
    premixed_share : float
        Share of the heat released in the premixed phase [-].
    premixed_end : float
        Duration of the premixed phase over that of the combustion [-].
    diffusion_start : float
        When the diffusive phase begins, over the duration of the combustion [-].
    a : float
        Efficiency parameter of both phases [-].
    premixed_shape, diffusion_shape : float
        Shape parameters M_p and M_d [-].
    """

    premixed_share: float = quantity("-", default=0.3, low=0, high=1)
    premixed_end: float = quantity("-", default=0.3, low=0, high=1, open_low=True)
    diffusion_start: float = quantity("-", default=0.3, low=0, high=1, open_high=True)
    a: float = quantity("-", default=1.2, low=0, open_low=True)
    premixed_shape: float = quantity("-", default=3.0, low=0)
    diffusion_shape: float = quantity("-", default=0.5, low=0)

    def burn_rate(self, u: float) -> float:
        """Rate of the burnt fraction [-], Eq. 58 normalised."""
        rate, early, late = 0.0, u < self.premixed_end, u > self.diffusion_start
        if any_of(early):
            premixed = wiebe_rate(u / self.premixed_end, self.a, self.premixed_shape)
            rate = where(early, self.premixed_share * premixed / self.premixed_end, 0.0)
        if any_of(late):
            length = 1.0 - self.diffusion_start
            since = max(u - self.diffusion_start, 0.0)
            diffusive = wiebe_rate(since / length, self.a, self.diffusion_shape)
            rate += where(late, (1.0 - self.premixed_share) * diffusive / length, 0.0)
        return rate / wiebe_fraction(1.0, self.a, 0.0)

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-]; 1 at the end."""
        early = min(u / self.premixed_end, 1.0)
        late = max((u - self.diffusion_start) / (1.0 - self.diffusion_start), 0.0)
        premixed = wiebe_fraction(early, self.a, self.premixed_shape)
        diffusive = wiebe_fraction(late, self.a, self.diffusion_shape)
        total = self.premixed_share * premixed + (1.0 - self.premixed_share) * diffusive
        return total / wiebe_fraction(1.0, self.a, 0.0)

    def next_breakpoint(self, u: float) -> float:
        """Least phase above `u` at which one of the two begins or ends [-]."""
        first = min(self.premixed_end, self.diffusion_start)
        second = max(self.premixed_end, self.diffusion_start)
        return first if u < first else second if u < second else 1.0


@dataclass(frozen=True)
class BurnProfile(BurnDuration):
    """A tabulated burn profile, such as a measured one, joined by a monotone cubic.

    Parameters
    ----------
    combustion_duration, speed_exponent, equivalence_ratio_exponent, temperature_exponent : float
        Duration [s] and its exponents [-], see :class:`BurnDuration`.
    times : tuple of float
        Times since the start of combustion over its duration, rising from 0 to 1 [-].
    fractions : tuple of float
        Burnt fractions there, never falling [-].
    """

    times: tuple[float, ...] = series(
        "-",
        default=(0.0, 0.25, 0.5, 0.75, 1.0),
        rising=True,
        ends=(0.0, 1.0),
        at_least=2,
    )
    fractions: tuple[float, ...] = series(
        "-", default=(0.0, 0.1, 0.5, 0.9, 1.0), low=0, high=1, never_falling=True, length="times"
    )

    def burn_rate(self, u: float) -> float:
        """Rate of the burnt fraction [-]."""
        return monotone_slope(u, self.times, self.fractions)

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-] since the start of combustion."""
        return monotone(u, self.times, self.fractions) - self.fractions[0]

    def next_breakpoint(self, u: float) -> float:
        """Least time of the table above `u`, where the rate has a corner [-]."""
        if u < self.times[0]:
            return self.times[0]
        return self.times[interval(u, self.times) + 1]


@dataclass(frozen=True)
class InstantRelease(HeatRelease):
    """All heat at once, at constant volume: the ideal of Chapter 2."""

    def duration(self, gas: Gas, charge: Charge) -> float:
        """Combustion duration [s]: zero."""
        return 0.0

    def burn_rate(self, u: float) -> float:
        """Rate of the burnt fraction [-]; never asked for."""
        return 0.0

    def burnt_fraction(self, u: float) -> float:
        """Burnt fraction [-]: all, from the start."""
        return 1.0
