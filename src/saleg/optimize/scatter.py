"""Robustness: scores of a design under scatter of constants that are not known well."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.design.subjects import Subject
from saleg.design.terms import is_known
from saleg.errors import Problem, SalegError
from saleg.quantities import as_float, is_whole

if TYPE_CHECKING:
    import pandas as pd

#: What is added to a row: mean and least score over the samples.
FIGURES = ("mean_score", "worst_score")


@dataclass(frozen=True)
class Scatter:
    """Scatter of constants: each sample multiplies them by normally distributed factors.

    The same samples for every design, so that two designs are compared under the same constants.

    Parameters
    ----------
    deviations : mapping
        Relative standard deviation by path, as ``{"heat_transfer.a": 0.1}``.
    samples : int
        Evaluations of each design beside that with the nominal constants.
    seed : int

    Examples
    --------
    >>> Scatter({"heat_transfer.a": 0.1}, samples=3).factors.shape
    (3, 1)
    """

    deviations: Mapping[str, float]
    samples: int = 8
    seed: int = 0

    @property
    def factors(self) -> np.ndarray:
        """Factors, a row per sample and a column per constant."""
        shape = self.samples, len(self.deviations)
        normal = np.random.default_rng(self.seed).standard_normal(shape)
        return np.exp(normal * np.array(list(self.deviations.values())))

    def wrong(self, subject: Subject) -> Iterator[Problem]:
        """All that is wrong with it."""
        for name, share in self.deviations.items():
            try:
                unit = subject.unit(name)
            except SalegError as error:
                yield Problem(f"scatter[{name!r}]", share, "-", str(error))
                continue
            number = as_float(share)
            if number is None or not 0.0 < number < math.inf:
                yield Problem(f"scatter[{name!r}]", share, unit, "must be a share > 0")
        if not self.deviations:
            yield Problem("scatter", self.deviations, "-", "must name at least one constant")
        if not is_whole(self.samples, 1) or not is_whole(self.seed, 0):
            both = (self.samples, self.seed)
            yield Problem("scatter", both, "-", "samples must be >= 1 and seed >= 0, both whole")

    def added(
        self,
        table: pd.DataFrame,
        points: pd.DataFrame,
        evaluated: Callable[[pd.DataFrame], pd.DataFrame],
        score: Callable[[Any], Any],
        nominal: Callable[[str], float],
    ) -> pd.DataFrame:
        """Rows with :data:`FIGURES`; what fails under a sample scores 0 there."""
        import pandas as pd

        known = np.flatnonzero(is_known(table))
        factors = self.factors
        again = points.iloc[np.repeat(known, len(factors))].reset_index(drop=True)
        for number, name in enumerate(self.deviations):
            held = again[name].to_numpy() if name in again else nominal(name)
            again[name] = held * np.tile(factors[:, number], len(known))
        scores = np.zeros((len(table), len(factors)))
        if len(known):
            rows = evaluated(again)
            found = np.where(is_known(rows), np.asarray(score(rows), dtype=float), 0.0)
            scores[known] = found.reshape(len(known), len(factors))
        added = pd.DataFrame({"mean_score": scores.mean(1), "worst_score": scores.min(1)})
        return pd.concat([table, added], axis=1)
