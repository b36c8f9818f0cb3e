"""Engines as trees of frozen dataclasses, with paths, starts, controllers and TOML files."""

from saleg.engine.chambers import (
    BounceChamber,
    Chamber,
    CombustionChamber,
    Cylinder,
    Filling,
    Fuel,
    Intake,
    SealedCylinder,
    Translator,
)
from saleg.engine.controller import Controller, check_controller
from saleg.engine.engine import Engine, check_engine, warn_of_unusual

__all__ = [
    "BounceChamber",
    "Chamber",
    "CombustionChamber",
    "Controller",
    "Cylinder",
    "Engine",
    "Filling",
    "Fuel",
    "Intake",
    "SealedCylinder",
    "Translator",
    "check_controller",
    "check_engine",
    "warn_of_unusual",
]
