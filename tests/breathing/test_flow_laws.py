"""Laws of a user's for ports, leaks and crankcases that give what no gas can have."""

import math
from dataclasses import dataclass

import pytest

import saleg
from saleg import laws


@dataclass(frozen=True)
class NegativePorts(laws.PortFlow):
    """Ports whose exhaust turns negative where it is widest."""

    def areas(self, opening: float) -> tuple[float, float]:
        return 1e-4, 1e-3 * (0.05 - opening)


@dataclass(frozen=True)
class NanPorts(laws.PortFlow):
    def areas(self, opening: float) -> tuple[float, float]:
        return 1e-4, math.nan if opening > 0.01 else 1e-4


@dataclass(frozen=True)
class GreedyPorts(laws.PortFlow):
    def fresh_share(self, share: float) -> float:
        return 2.0 * share


@dataclass(frozen=True)
class VacuumPorts(laws.PortFlow):
    def exhaust(self) -> tuple[float, float]:
        return 0.0, 600.0


@dataclass(frozen=True)
class NegativeLeak(laws.RingLeak):
    def area(self, gas: laws.Gas) -> float:
        return 1e-7 * (1e6 - gas.p) / 1e6


@dataclass(frozen=True)
class EmptyCrankcase(laws.Supply):
    states = ("contents", "crankcase")

    def volume(self, displacement: float) -> float:
        return 1e-4 - 3e-3 * displacement


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (
            {"gas_exchange": NegativePorts()},
            r"NegativePorts.areas returned .* must not be negative",
        ),
        ({"gas_exchange": NanPorts()}, r"NanPorts.areas returned .*nan.* must not be negative"),
        ({"gas_exchange": GreedyPorts()}, r"fresh_share returned 1.5 at 0.75: .* 0 and 1"),
        ({"gas_exchange": VacuumPorts()}, r"VacuumPorts.exhaust returned \(0.0.*must be positive"),
        ({"left.leak": NegativeLeak()}, r"NegativeLeak.area returned -.* must not be negative"),
        (
            {"gas_exchange": laws.PortFlow(), "supply": EmptyCrankcase()},
            r"EmptyCrankcase.volume returned -.* must be positive",
        ),
    ],
)
def test_impossible_flows_are_refused_before_anything_is_compiled(base, changes, says):
    engine = base.replace(**changes)
    for run in (lambda: saleg.simulate(engine, 0.1), lambda: saleg.steady_state(engine)):
        with pytest.raises(saleg.LawError, match=says):
            run()
