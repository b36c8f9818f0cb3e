"""A design: eight parameters, the laws of the engine, and models of the masses."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from saleg.design.formulas import port_clearance
from saleg.design.masses import MassModel
from saleg.design.parameters import Parameters
from saleg.engine import BounceChamber, Cylinder, Engine, OpenEnd
from saleg.engine.paths import claimed, exists, known_paths, unit_of, with_value
from saleg.engine.paths import get as get_path
from saleg.errors import UnknownPath, WrongFields, nearest
from saleg.laws import BlairViscousFriction
from saleg.machines import thesis_base
from saleg.quantities import Problem, as_float, is_number, problems

MASSES = "masses"
NAMES = tuple(item.name for item in fields(Parameters))


class InvalidDesign(WrongFields):
    """A design with fields out of range; `problems` lists them all."""

    whole = "design"


def thesis_laws() -> Engine:
    """Laws behind the designs of Chapter 4; its dimensions are those of the base case.

    The friction of Eq. 40 with 13.7 kg/m^2/s and a load constant of 70 N s/m, for every design:
    both are inferred (docs/physics.md).

    Returns
    -------
    Engine

    Examples
    --------
    >>> thesis_laws().get("friction.factor")
    13.7
    """
    base = thesis_base()
    return base.replace(
        friction=BlairViscousFriction(factor=13.7),
        name="design",
        **{"alternator.load_constant": 70.0},
    )


@dataclass(frozen=True)
class Design:
    """A design before its steady state, hence its moving mass, is known.

    Parameters
    ----------
    parameters : Parameters
        The eight of Table 8.
    laws : Engine
        Everything else: laws and empirical constants. What the eight parameters say, and the
        moving mass, is replaced. It must be mirrored, or have a cylinder on the left and on the
        right a gas spring, which stays as it is, or an open end with a spring that pushes it back.
        Where gas flows through ports these stay as they are, and `egr` must be 0: what is retained
        follows from the flow.
    masses : MassModel
        How heavy the components are.

    Examples
    --------
    >>> design = Design().replace({"bore": 0.07, "heat_transfer.a": 90.0})
    >>> design.parameters.bore, design.get("heat_transfer.a")
    (0.07, 90.0)
    """

    parameters: Parameters = field(default_factory=Parameters)
    laws: Engine = field(default_factory=thesis_laws)
    masses: MassModel = field(default_factory=MassModel)

    def __post_init__(self) -> None:
        """Refuse what is of another kind.

        Raises
        ------
        InvalidDesign
        """
        kinds = {"parameters": Parameters, "laws": Engine, "masses": MassModel}
        wrong = [
            Problem(name, getattr(self, name), "-", f"must be a {kind.__name__}")
            for name, kind in kinds.items()
            if not isinstance(getattr(self, name), kind)
        ]
        if wrong:
            raise InvalidDesign(wrong)

    def engine(self, moving_mass: float) -> Engine:
        """The engine of this design with a given moving mass [kg]."""
        p, laws = self.parameters, self.laws
        side: Any = laws.left
        springs, exchange = laws.springs, side.gas_exchange
        cylinder: Any = dataclasses.replace(
            side,
            bore=p.bore,
            half_stroke=p.half_stroke,
            port_closing=port_clearance(p.port_location, p.half_stroke),
            equivalence_ratio=p.equivalence_ratio,
            intake=dataclasses.replace(
                side.intake, pressure=p.intake_pressure, temperature=p.intake_temperature
            ),
            gas_exchange=_with(exchange, **({} if _flows(exchange) else {"egr": p.egr})),
        )
        return dataclasses.replace(
            laws,
            translator=dataclasses.replace(laws.translator, mass=moving_mass),
            left=cylinder,
            right=cylinder if laws.is_mirrored else laws.right,
            springs=_with(springs, **{_stiffness_of(laws): p.spring_stiffness}),
        )

    def get(self, path: str) -> Any:
        """Value of a parameter, of ``masses...``, or at a path of the engine (SI)."""
        node, chain = self._place(path)
        if chain is None:
            return get_path(self.laws, path)
        for name in chain:
            node = getattr(node, name)
        return node

    def unit(self, path: str) -> str:
        """Unit of the number at a path, "-" if it has none."""
        node, chain = self._place(path)
        if chain is None:
            return unit_of(self.laws, path)
        for name in chain[:-1]:
            node = getattr(node, name)
        item = next(item for item in fields(node) if item.name == chain[-1])
        limits = item.metadata.get("limits")
        return "-" if limits is None else str(limits.unit)

    def replace(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> Design:
        """Copy with some values replaced.

        Parameters
        ----------
        values, **more
            By name: one of the eight parameters, a path of the engine such as
            ``"heat_transfer.a"``, or of the mass models such as ``"masses.alternator.density"``.

        Returns
        -------
        Design

        Raises
        ------
        UnknownPath
            With the nearest existing names; or if the eight parameters decide about that path.
        PathsClash
            If two names stand for one number.
        """
        changes = {**(values or {}), **more}
        own = {name: value for name, value in changes.items() if name in NAMES}
        design = dataclasses.replace(self, parameters=dataclasses.replace(self.parameters, **own))
        named: dict[tuple[str, ...], str] = {}
        for path, value in changes.items():
            if path not in NAMES:
                design = design._with(path, value, named)
        return design

    def _with(self, path: str, value: Any, named: dict[tuple[str, ...], str]) -> Design:
        """Copy with one value replaced; `named` has the paths of the engine replaced before."""
        _, chain = self._place(path)
        number = as_float(value)
        value = value if number is None else number
        if chain is not None:
            return dataclasses.replace(self, masses=with_value(self.masses, chain, value))
        claimed(named, self.laws, path)
        changed = dataclasses.replace(self, laws=self.laws.replace(**{path: value}))
        if is_number(value) and get_path(changed.engine(math.nan), path) is not value:
            raise UnknownPath(
                f"'{path}' follows from the eight parameters ({', '.join(NAMES)}) and the loop"
            )
        return changed

    def _place(self, path: str) -> tuple[Any, tuple[str, ...] | None]:
        """Where a path leads in parameters or masses; no chain if it is one of the engine's."""
        if not isinstance(path, str):
            raise UnknownPath(f"a path is text, not {type(path).__name__}")
        if path in NAMES:
            return self.parameters, (path,)
        first, _, rest = path.partition(".")
        if first == MASSES:
            chain = tuple(rest.split("."))
            if not exists(self.masses, chain):
                raise UnknownPath(f"no '{path}' in the mass models")
            return self.masses, chain
        if path not in known_paths(self.laws):
            hint = nearest(path, [*NAMES, *known_paths(self.laws)])
            raise UnknownPath(f"no '{path}' in a design{hint}")
        return self.laws, None

    def __repr__(self) -> str:
        return f"<Design of {self.laws.name!r}: {self.parameters}>"

    def _repr_html_(self) -> str:
        from saleg.display import design_card

        return design_card(self)

    def validate(self) -> None:
        """Raise one error naming every wrong field of parameters, masses and laws.

        Raises
        ------
        InvalidDesign
        InvalidEngine
        """
        found = [_hinted(problem) for problem in problems(self.parameters)]
        found += problems(self.masses, MASSES)
        for slot in fields(self.masses):
            model = getattr(self.masses, slot.name)
            if isinstance(model, type) or not callable(getattr(model, "mass", None)):
                need = "must be an object (not a class) and must have a method mass"
                found.append(Problem(f"masses.{slot.name}", model, "-", need))
        found += self._problems_of_laws()
        if found:
            raise InvalidDesign(found)
        self.engine(1.0).validate()

    def _problems_of_laws(self) -> list[Problem]:
        """What keeps the eight parameters from being put into the engine."""
        laws, wrong = self.laws, []
        if not laws.is_mirrored and not isinstance(laws.right, BounceChamber | OpenEnd):
            wrong.append("must be mirrored, or have a gas spring or an open end on the right")
        elif not isinstance(laws.left, Cylinder):
            wrong.append("must have cylinders with ports, on both sides or on the left")
        elif not (_flows(laws.left.gas_exchange) or _has(laws.left.gas_exchange, "egr")):
            wrong.append("must have a gas exchange with a share of exhaust gas retained, egr")
        if not _has(laws.springs, _stiffness_of(laws)):
            wrong.append(f"must have springs with a {_stiffness_of(laws)}")
        found = [Problem("laws", laws.name, "-", why) for why in wrong]
        if _flows(getattr(laws.left, "gas_exchange", None)) and self.parameters.egr != 0.0:
            allowed = "must be 0: gas flows through the ports, what is retained follows"
            found.append(Problem("egr", self.parameters.egr, "-", allowed))
        return found


def _flows(exchange: Any) -> bool:
    """Whether gas flows through the ports of a law of gas exchange."""
    return "contents" in getattr(exchange, "states", ())


def _stiffness_of(laws: Engine) -> str:
    """Number of the springs that the parameter `spring_stiffness` is."""
    return "right_stiffness" if isinstance(laws.right, OpenEnd) else "stiffness"


def _has(law: Any, name: str) -> bool:
    """Whether a law has a number of that name."""
    return name in {item.name for item in fields(law)}


def _with(law: Any, **numbers: float) -> Any:
    """A law with some numbers replaced."""
    return dataclasses.replace(law, **numbers)


#: What people write a parameter in by mistake.
READ_IN = {
    "bore": "mm",
    "half_stroke": "mm",
    "intake_pressure": "bar",
    "intake_temperature": "degrees Celsius",
    "port_location": "%",
    "egr": "%",
}


def _hinted(problem: Problem) -> Problem:
    """A problem that asks whether the number was given in another unit."""
    likely = READ_IN.get(problem.path)
    if likely is None or not is_number(problem.value) or not 0.0 < problem.value < math.inf:
        return problem
    return problem._replace(allowed=f"{problem.allowed}; given in {likely}?")
