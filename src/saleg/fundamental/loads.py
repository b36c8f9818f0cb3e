"""The work force: constant, along a cosine, or tied to the Otto cycle (2.3, 2.4, 2.7)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.errors import OutsideModel
from saleg.fundamental.otto import cosine_amplitude, otto_efficiency
from saleg.quantities import Problem, Quantities, quantity

if TYPE_CHECKING:
    from saleg.fundamental.charge import Charge


class Load(Quantities):
    """Base of all loads: what resists the motion in a stroke."""

    def for_stroke(self, system: Charge, depth: Any) -> Profile:
        """Profile of the force in a stroke that begins `depth` [-] from the midpoint."""
        raise NotImplementedError

    def balanced(self, system: Charge, depth: float, work: float) -> Load:
        """Load of the same kind that takes `work` [-] in a stroke from -`depth` to `depth`."""
        raise NotImplementedError


class Profile(Load):
    """Base of loads that are the same in every stroke: a force over position.

    The position counts along the motion, from -1 to 1, whichever way the translator goes.
    """

    def force(self, s: Any) -> Any:
        """Force against the motion [-]."""
        raise NotImplementedError

    def work(self, s: Any, way: Any) -> Any:
        """Work taken between `s` and ``s + way`` [-]."""
        raise NotImplementedError

    def with_work(self, work: Any, depth: Any) -> Profile:
        """Profile of this shape that takes `work` [-] between -`depth` and `depth`."""
        raise NotImplementedError

    def for_stroke(self, system: Charge, depth: Any) -> Profile:
        """Profile of the force in a stroke: always this one."""
        return self

    def balanced(self, system: Charge, depth: float, work: float) -> Profile:
        """Load of the same shape that takes `work` [-] in a stroke from -`depth` to `depth`."""
        return self.with_work(work, depth)


@dataclass(frozen=True)
class ConstantLoad(Profile):
    """A constant work force (2.3).

    Parameters
    ----------
    amplitude : float
        Work force F_W* [-] (Eq. 27).

    Examples
    --------
    >>> float(ConstantLoad(0.4).work(-0.5, 1.0))
    0.4
    """

    amplitude: float = quantity("-", default=0.0, low=0)

    def force(self, s: Any) -> Any:
        """Force against the motion [-]."""
        return self.amplitude + 0.0 * s

    def work(self, s: Any, way: Any) -> Any:
        """Work taken between `s` and ``s + way`` [-]."""
        return self.amplitude * way

    def with_work(self, work: Any, depth: Any) -> ConstantLoad:
        """Constant force that takes `work` [-] between -`depth` and `depth`."""
        return ConstantLoad(0.5 * work / depth)


@dataclass(frozen=True)
class CosineLoad(Profile):
    """A work force that is greatest at the midpoint, ``A cos(pi x*/2)`` (Eq. 33).

    Parameters
    ----------
    amplitude : float
        Amplitude A [-].

    Examples
    --------
    >>> load = CosineLoad().with_work(0.8, 1.0 - 1e-12)  # Eq. 34
    >>> round(float(load.amplitude / ConstantLoad(0.4).amplitude), 6)  # pi/2
    1.570796
    """

    amplitude: float = quantity("-", default=0.0, low=0)

    def force(self, s: Any) -> Any:
        """Force against the motion [-], Eq. 33."""
        return self.amplitude * np.cos(0.5 * np.pi * s)

    def work(self, s: Any, way: Any) -> Any:
        """Work taken between `s` and ``s + way`` [-]."""
        # A difference of sines as a product: exact for the shortest ways too.
        mean = np.cos(0.5 * np.pi * (s + 0.5 * way))
        return self.amplitude * 4.0 / np.pi * mean * np.sin(0.25 * np.pi * way)

    def with_work(self, work: Any, depth: Any) -> CosineLoad:
        """Cosine that takes `work` [-] between -`depth` and `depth` (Eq. 34)."""
        return CosineLoad(cosine_amplitude(0.5 * work / depth, -depth, depth))


@dataclass(frozen=True)
class OttoLoad(Load):
    """A load that takes in every stroke what the Otto cycle between its dead centres would gain.

    The thesis constrains its work force so from Figure 13 on (Eq. 31), with both dead centres
    equally far out (Eq. 32). In 2.7 a second-law efficiency leaves room for losses.

    Parameters
    ----------
    profile : Profile
        Shape of the force; its amplitude does not matter.
    second_law : float
        Share of the work of the Otto cycle that is taken [-].

    Examples
    --------
    >>> from saleg.fundamental import System
    >>> load = OttoLoad()
    >>> system = System(pressure=1.0, heat=1.0, load=load)
    >>> round(float(load.for_stroke(system, 0.8).amplitude), 6)  # Eq. 32
    0.365473
    """

    profile: Profile = field(default_factory=ConstantLoad)
    second_law: float = quantity("-", default=1.0, low=0)

    def for_stroke(self, system: Charge, depth: Any) -> Profile:
        """Profile of the force in a stroke that begins `depth` [-] from the midpoint."""
        work = self.second_law * _otto_work(system, depth)
        return self.profile.with_work(work, depth)

    def balanced(self, system: Charge, depth: float, work: float) -> OttoLoad:
        """Load with the second-law efficiency that takes `work` [-] between mirrored centres."""
        if system.heat == 0.0:
            allowed = "must be > 0 for a load tied to it"
            raise OutsideModel([Problem("heat", system.heat, "-", allowed)])
        return replace(self, second_law=float(work / _otto_work(system, depth)))


def _otto_work(system: Charge, depth: Any) -> Any:
    return system.heat * otto_efficiency(-depth, depth, gamma=system.gas.gamma)
