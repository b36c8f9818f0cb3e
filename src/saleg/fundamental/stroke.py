"""One stroke in closed form: pressures, acceleration, velocity, dead centre and time.

Inside, positions count along the motion (``s = direction x``), so that a stroke to the left is the
exact mirror image of one to the right.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.fundamental.checks import POSITION, require
from saleg.fundamental.gas import expansion_work
from saleg.fundamental.numerics import AT_HEAD, first_root, half_line

if TYPE_CHECKING:
    from saleg.fundamental.loads import Profile
    from saleg.fundamental.parameters import Parameters


@dataclass(frozen=True)
class Stroke:
    """A stroke from one dead centre to the next; :meth:`System.stroke` begins the first.

    Positions handed to its methods may be arrays; those not between the heads raise
    :class:`saleg.errors.OutsideModel`.

    Parameters
    ----------
    system : System
    start : float or ndarray
        Dead centre at which it begins, x* [-]; an array stands for as many strokes.
    direction : float
        1 to the right, -1 to the left [-].
    pressure : float or ndarray
        Pressure of the gas about to expand, at `start` [-].
    load : Profile
        Work force in this stroke.

    Examples
    --------
    >>> from saleg.fundamental import System
    >>> springs = System(pressure=0.0).stroke(-0.5)
    >>> round(float(springs.velocity(0.0)) ** 2 / 2.0, 12)  # the energy of both springs, k x^2
    0.25
    >>> round(float(springs.duration) / np.pi, 12)  # half a period: pi sqrt(m/2k)
    0.707106781187
    """

    system: Parameters
    start: Any
    direction: float
    pressure: Any
    load: Profile

    @cached_property
    def end(self) -> Any:
        """Dead centre at which the stroke ends [-]; within 1e-12 of 1 or -1 if at the head.

        If nothing drives the translator away from its start, it stays there.
        """
        return self.direction * self._arrive

    @property
    def depth(self) -> Any:
        """Distance of the end from the midpoint [-], negative if it is not passed."""
        return self._arrive

    @cached_property
    def impact(self) -> Any:
        """Kinetic energy with which the stroke ends at the head [-]; zero at a dead centre."""
        return np.where(self._arrive < AT_HEAD, 0.0, self._kinetic_energy(self._arrive))[()]

    @cached_property
    def duration(self) -> Any:
        """Time from dead centre to dead centre, in sqrt(m/k) [-]."""
        return self._since_start(self._knot) + self._until_end(self._knot)

    def pressures(self, x: Any) -> tuple[Any, Any]:
        """Pressures in the left and the right chamber at `x` [-] (Eq. 4, 23)."""
        s = self._along(x)
        both = self._behind(s), self._ahead(s)
        return both if self.direction > 0.0 else both[::-1]

    def acceleration(self, x: Any) -> Any:
        """Acceleration a* at `x` [-], positive to the right (Eq. 26, 29)."""
        return self.direction * self._acceleration(self._along(x))

    def kinetic_energy(self, x: Any) -> Any:
        """Half the square of the velocity at `x` [-], negative out of reach (Eq. 28, 30)."""
        return self._kinetic_energy(self._along(x))

    def velocity(self, x: Any) -> Any:
        """Velocity v* at `x` [-], positive to the right; zero out of reach."""
        return self.direction * np.sqrt(2.0 * np.maximum(self.kinetic_energy(x), 0.0))

    def time(self, x: Any) -> Any:
        """Time since the start at positions `x` within the stroke, in sqrt(m/k) [-]."""
        s = np.clip(self._along(x), self._depart, self._arrive)
        knot = self._knot
        late = self.duration - self._until_end(np.maximum(s, knot))
        return np.where(s <= knot, self._since_start(np.minimum(s, knot)), late)

    def positions(self, count: int = 201) -> np.ndarray:
        """Positions from start to end, closer together near the dead centres.

        Parameters
        ----------
        count : int
            How many; two more stand on either side of an ignition under way.

        Returns
        -------
        ndarray, shape (n,)
        """
        middle, half = 0.5 * (self._depart + self._arrive), 0.5 * (self._arrive - self._depart)
        s = middle - half * np.cos(np.linspace(0.0, np.pi, count))
        lit = self.system.ignition.position(self.system.gas)
        if self._depart < lit < self._arrive:
            s = np.sort(np.append(s, [np.nextafter(lit, -1.0), lit]))
        return self.direction * s

    def next(self) -> Stroke:
        """The stroke back: rejection on one side, fresh heat on the other."""
        depth, system = self._arrive, self.system
        return Stroke(
            system,
            self.end,
            -self.direction,
            system.ignition.pressure_at_dead_centre(system, depth),
            system.load.for_stroke(system, depth),
        )

    # ---- along the motion --------------------------------------------------------------------

    def _along(self, x: Any) -> Any:
        require(x=(x, POSITION))
        return self.direction * np.asarray(x)

    @property
    def _depart(self) -> Any:
        return self.direction * self.start

    @cached_property
    def _arrive(self) -> Any:
        return first_root(self._kinetic_energy, self._acceleration, self._depart)

    @property
    def _burns_under_way(self) -> Any:
        lit = self.system.ignition.position(self.system.gas)
        return (self._depart < lit) & (lit < self._arrive)

    @property
    def _knot(self) -> Any:
        """Where the quadratures from either dead centre meet: at an ignition under way."""
        lit = self.system.ignition.position(self.system.gas)
        return np.where(self._burns_under_way, lit, 0.5 * (self._depart + self._arrive))

    def _behind(self, s: Any) -> Any:
        """Pressure of the expanding gas (Eq. 23)."""
        return self.pressure * ((1.0 + self._depart) / (1.0 + s)) ** self.system.gas.expansion

    def _ahead(self, s: Any) -> Any:
        """Pressure of the charge being compressed."""
        system = self.system
        return system.motored_pressure(s) + system.ignition.added_pressure(system, s)

    def _acceleration(self, s: Any) -> Any:
        return self._behind(s) - self._ahead(s) - 2.0 * s - self.load.force(s)

    def _kinetic_energy(self, s: Any) -> Any:
        depart = self._depart
        unburnt = self._work(depart, s - depart, self.system.motored_pressure(depart))
        return unburnt + self.system.ignition.added_work(self.system, s)

    def _work(self, s: Any, way: Any, ahead: Any) -> Any:
        """Work of all forces from `s` to ``s + way``, to rounding even for tiny ways.

        `ahead` is the pressure of the charge being compressed at `s`; it must not burn between.
        """
        gas = self.system.gas
        behind = expansion_work(self._behind(s), 1.0 + s, way, gas.expansion)
        charge = expansion_work(ahead, 1.0 - s, -way, gas.compression)
        return behind + charge - (2.0 * s + way) * way - self.load.work(s, way)

    def _since_start(self, s: Any) -> Any:
        charge = self.system.motored_pressure(self._depart)
        return self._time_along(self._depart, s - self._depart, charge, 0.0)

    def _until_end(self, s: Any) -> Any:
        added = self.system.ignition.added_pressure(self.system, self._arrive)
        charge = self.system.motored_pressure(self._arrive) + self._burns_under_way * added
        return self._time_along(self._arrive, s - self._arrive, charge, self.impact)

    def _time_along(self, anchor: Any, way: Any, ahead: Any, energy: Any) -> Any:
        """Time spent within `way` of a dead centre, where the charge stands at `ahead`.

        Of a head, if `energy` is left there.

        The integrand ``1/v`` grows like ``1/sqrt(distance)`` there; the quadrature crowds its
        nodes at that end, and the work is reckoned from there, so nothing cancels.
        """
        nodes, weights = half_line(np.ndim(way))
        kinetic = energy + self._work(anchor, nodes * way, ahead)
        moving = kinetic > 0.0  # not so by rounding at the far end, if that is a dead centre too
        slowness = np.abs(way) / np.sqrt(2.0 * np.where(moving, kinetic, np.inf))
        return np.sum(weights * slowness, axis=0)
