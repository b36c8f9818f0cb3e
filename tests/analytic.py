"""A closed form in place of an engine, for what searches with it: no kernel, and known optima."""

import math
from dataclasses import dataclass, field, replace

from saleg.errors import UnknownPath

UNITS = {
    "status": "-",
    "message": "-",
    "efficiency": "-",
    "power": "W",
    "weight": "kg",
    "stability": "-",
    "stable": "-",
    "kind": "-",
    "largest_multiplier": "-",
    "beat_period": "s",
    "score": "-",
}
NAMES = ("a", "b", "c", "d", "slope")


@dataclass(frozen=True)
class Hill:
    """Designs of four parameters, 0 to 1: a hill of efficiency 0.5 at (0.3, 0.6, 0.5, 0.4).

    The power is 8 kW times the mean of the parameters, the weight 1 + a + b. Nothing is found where
    d > 0.9, and orbits are unstable where a > `unstable_from`.
    """

    slope: float = 1.0
    unstable_from: float = 2.0
    top: tuple[float, ...] = (0.3, 0.6, 0.5, 0.4)
    units: dict[str, str] = field(default_factory=lambda: dict(UNITS), repr=False)

    def unit(self, name):
        if name not in NAMES:
            raise UnknownPath(f"no '{name}' in a hill")
        return "-"

    def refuse_clash(self, names):
        pass

    def describe(self):
        return {"kind": "hill", "slope": self.slope, "unstable_from": self.unstable_from}

    def get(self, name):
        return self.slope if name == "slope" else 0.5

    def replace(self, **values):
        return replace(self, **{name: values[name] for name in values if name == "slope"})

    def solver(self, rtol, multipliers, warm, effort):
        def row(values):
            if values.get("d", 0.0) > 0.9:
                return {"status": "not found", "message": "d is too great"}
            at = [values.get(name, top) for name, top in zip("abcd", self.top, strict=True)]
            off = sum((x - top) ** 2 for x, top in zip(at, self.top, strict=True))
            found = {
                "status": "steady",
                "message": "closed form, found at once",
                "efficiency": 0.5 * math.exp(-values.get("slope", self.slope) * off),
                "power": 8e3 * sum(at) / 4.0,
                "weight": 1.0 + at[0] + at[1],
                "stability": 0.0,
            }
            if multipliers:
                largest = 1.5 if at[0] > self.unstable_from else 0.5
                found |= {"largest_multiplier": largest, "stable": largest < 1.0, "kind": "node"}
            return found

        return row
