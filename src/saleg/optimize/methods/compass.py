"""Local polishing: a compass search along the parameters."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from saleg.optimize.methods.base import Method, Search, Start, mean_of
from saleg.optimize.problem import Told
from saleg.quantities import quantity


@dataclass(frozen=True, kw_only=True)
class CompassSearch(Method):
    """Compass search: a step up and down in every parameter, halved where none is better.

    It begins at the best of the designs given, or in the middle of the box.

    Parameters
    ----------
    step, least_step : float
        First and last step over the range of each parameter [-].

    References
    ----------
    .. [1] T. G. Kolda, R. M. Lewis and V. Torczon, SIAM Review 45, 385-482, 2003,
       https://doi.org/10.1137/S003614450242889
    """

    step: float = quantity("-", default=0.02, low=0, high=1, open_low=True)
    least_step: float = quantity("-", default=1e-4, low=0, high=1, open_low=True)

    def begin(self, start: Start) -> Search:
        """Begin at the best of the start."""
        return _Search(self, start)


class _Search:
    def __init__(self, settings: CompassSearch, start: Start):
        self._settings, self._step = settings, settings.step
        middle = np.full((1, start.dimension), 0.5)
        self._asked = start.given if len(start.given) else middle
        self._at: np.ndarray | None = None
        self._best = -np.inf
        self.finished = False

    def ask(self) -> np.ndarray:
        """The start; then all neighbours of the best."""
        if self._at is not None:
            steps = self._step * np.eye(len(self._at))
            self._asked = np.clip(self._at + np.vstack([steps, -steps]), 0.0, 1.0)
        return self._asked

    def tell(self, told: Told) -> float:
        """Go to the best neighbour, or halve the step."""
        best = int(np.argmax(told.guide))
        if self._at is None or told.guide[best] > self._best:
            self._at, self._best = self._asked[best], float(told.guide[best])
        else:
            self._step *= 0.5
            self.finished = self._step < self._settings.least_step
        return mean_of(told.fitness)
