"""Parameters of a system of Chapter 2, checked as a whole."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from saleg.errors import OutsideModel
from saleg.fundamental.charge import Charge
from saleg.fundamental.gas import Gas
from saleg.fundamental.ignition import AtDeadCentre, Ignition
from saleg.fundamental.loads import ConstantLoad, Load, OttoLoad, Profile
from saleg.quantities import Problem, problems


@dataclass(frozen=True, kw_only=True)
class Parameters(Charge):
    """What :class:`saleg.fundamental.System` is made of; see there.

    Parameters
    ----------
    load : Load
        Work force; none unless given.
    ignition : Ignition
        When the charge burns; at dead centre unless given.
    """

    load: Load = field(default_factory=ConstantLoad)
    ignition: Ignition = field(default_factory=AtDeadCentre)

    def __post_init__(self) -> None:
        """Check the whole tree."""
        super().__post_init__()
        kinds = {"load": Load, "gas": Gas, "ignition": Ignition}
        found = problems(self)
        for item in fields(self):
            found += _kind_problem(getattr(self, item.name), kinds.get(item.name), item.name)
        if isinstance(self.load, OttoLoad):
            found += _kind_problem(self.load.profile, Profile, "load.profile")
        if found:
            raise OutsideModel(found)


def _kind_problem(value: Any, kind: type | None, path: str) -> list[Problem]:
    if kind is None or isinstance(value, kind):
        return []
    return [Problem(path, value, "-", f"must be a {kind.__name__}")]
