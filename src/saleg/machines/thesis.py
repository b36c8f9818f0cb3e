"""The two engines of Robinson's dissertation.

Table values are in SI. Constants the dissertation leaves open (friction and load constants,
combustion duration, degrees of the knock integral) are inferred from its tables; the
documentation says how.
"""

from __future__ import annotations

from saleg.engine import Cylinder, Engine, Intake, Translator
from saleg.laws import InstantExchange, LinearLoad, LinearSprings, ViscousFriction


def thesis_base() -> Engine:
    """Return the base case of Chapter 3 (Table 1): 64 mm bore, 200 mm maximum stroke, 22 kW.

    Returns
    -------
    Engine

    Examples
    --------
    >>> thesis_base().get("spring.stiffness")
    30000.0
    """
    cylinder = Cylinder(
        bore=0.064,
        half_stroke=0.100,
        port_closing=0.133,
        wall_temperature=550.0,
        equivalence_ratio=0.6,
        intake=Intake(pressure=1.05e5, temperature=325.05),
        gas_exchange=InstantExchange(egr=0.12),
    )
    return Engine.mirrored(
        Translator(mass=2.39),
        cylinder,
        springs=LinearSprings(stiffness=30e3),
        friction=ViscousFriction(coefficient=12.4),
        alternator=LinearLoad(load_constant=70.6),
        name="thesis-base",
    )


def thesis_transient() -> Engine:
    """Return the engine of Chapter 5 (Table 13): 34.5 mm bore, 93.4 mm maximum stroke, 3.8 kW.

    Returns
    -------
    Engine

    Examples
    --------
    >>> thesis_transient().get("moving_mass")
    4.93
    """
    cylinder = Cylinder(
        bore=0.0345,
        half_stroke=0.0467,
        port_closing=0.0576,
        wall_temperature=550.0,
        equivalence_ratio=0.655,
        intake=Intake(pressure=1.20e5, temperature=263.0),
        gas_exchange=InstantExchange(egr=0.307),
    )
    return Engine.mirrored(
        Translator(mass=4.93),
        cylinder,
        springs=LinearSprings(stiffness=151.7e3),
        friction=ViscousFriction(coefficient=9.15),
        alternator=LinearLoad(load_constant=67.2, maximum_weight=1.1),
        name="thesis-transient",
    )
