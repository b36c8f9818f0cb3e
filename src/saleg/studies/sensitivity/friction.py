"""What the friction law does (3.1)."""

from __future__ import annotations

from collections.abc import Mapping

from saleg.checks import POSITIVE, a, checked
from saleg.design import Design
from saleg.engine import Engine
from saleg.laws import ConstantFriction, Friction, ViscousFriction
from saleg.studies.sensitivity.parameter_study import Study, study
from saleg.studies.sensitivity.settle import settle
from saleg.studies.sensitivity.tuning import Subject, friction_work, tune

#: Friction that grows with the speed and friction that does not, each with what scales it.
LAWS: Mapping[str, tuple[Friction, str]] = {
    "viscous": (ViscousFriction(12.4), "coefficient"),
    "constant": (ConstantFriction(), "factor"),
}


@checked(engine=a(Engine, Design), laws=a(Mapping), work=POSITIVE.optional)
def friction_laws(
    engine: Subject,
    laws: Mapping[str, tuple[Friction, str]] = LAWS,
    *,
    work: float | None = None,
) -> Study:
    """Steady runs under several friction laws that take the same energy in a cycle.

    The stroke regulator masks the difference; study ``fix_load(engine)`` to see it.

    Parameters
    ----------
    engine : Engine or Design
    laws : mapping of str to (Friction, str)
        Laws by name, each with the field that scales it.
    work : float, optional
        Work of friction in a cycle [J]; that of the engine unless given.

    Returns
    -------
    Study

    Raises
    ------
    TuningError
        If a law cannot be scaled so, as in an engine without friction.
    """
    wanted = friction_work(settle(engine)) if work is None else work
    scaled = {
        name: tune(engine.replace(friction=law), f"friction.{field}", friction_work, wanted)
        for name, (law, field) in laws.items()
    }
    return study(engine, "friction", {name: one.get("friction") for name, one in scaled.items()})
