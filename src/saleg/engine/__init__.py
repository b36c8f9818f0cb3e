"""Engines as trees of frozen dataclasses, with paths, starts, controllers and TOML files."""

from saleg.engine.chambers import (
    BounceChamber,
    Chamber,
    CombustionChamber,
    Cylinder,
    Fuel,
    GasChamber,
    Intake,
    OpenEnd,
    ReferenceState,
    SealedCylinder,
    Translator,
)
from saleg.engine.controller import Controller, check_controller
from saleg.engine.engine import Engine, check_engine, engine_problems, warn_of_unusual

__all__ = [
    "BounceChamber",
    "Chamber",
    "CombustionChamber",
    "Controller",
    "Cylinder",
    "Engine",
    "Fuel",
    "GasChamber",
    "Intake",
    "OpenEnd",
    "ReferenceState",
    "SealedCylinder",
    "Translator",
    "check_controller",
    "check_engine",
    "engine_problems",
    "warn_of_unusual",
]
