"""Engines as trees of frozen dataclasses, with paths, starts, controllers and TOML files."""

from saleg.engine.chambers import (
    BounceChamber,
    Chamber,
    CombustionChamber,
    Cylinder,
    Fuel,
    Intake,
    ReferenceState,
    SealedCylinder,
    Translator,
)
from saleg.engine.controller import Controller
from saleg.engine.engine import Engine

__all__ = [
    "BounceChamber",
    "Chamber",
    "CombustionChamber",
    "Controller",
    "Cylinder",
    "Engine",
    "Fuel",
    "Intake",
    "ReferenceState",
    "SealedCylinder",
    "Translator",
]
