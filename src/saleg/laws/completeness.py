"""Completeness of the combustion: how much of the fuel burns at all."""

from __future__ import annotations

from dataclasses import dataclass

from saleg.laws.arguments import Charge, Gas
from saleg.laws.base import Completeness
from saleg.laws.interpolation import linear
from saleg.quantities import series


@dataclass(frozen=True)
class CompleteCombustion(Completeness):
    """All fuel burns, but for what the `combustion_efficiency` of the chamber leaves."""

    def share(self, gas: Gas, charge: Charge) -> float:
        """Share of the fuel that burns [-]: 1."""
        return 1.0


@dataclass(frozen=True)
class CompletenessByRatio(Completeness):
    """Share of the fuel that burns as a curve over the equivalence ratio of the charge.

    Lean charges burn in part, very lean ones not at all. Where that begins belongs to the engine:
    the defaults are an example, from nowhere.

    Parameters
    ----------
    equivalence_ratios : tuple of float
        Equivalence ratios, rising [-].
    shares : tuple of float
        Shares of the fuel that burn there [-]; between them linear, beyond them as at the end.
    """

    equivalence_ratios: tuple[float, ...] = series(
        "-", default=(0.1, 0.3, 1.0, 1.5), low=0, rising=True
    )
    shares: tuple[float, ...] = series(
        "-", default=(0.0, 1.0, 1.0, 0.9), low=0, high=1, length="equivalence_ratios"
    )

    def share(self, gas: Gas, charge: Charge) -> float:
        """Share of the fuel that burns [-]."""
        return linear(charge.equivalence_ratio, self.equivalence_ratios, self.shares)
