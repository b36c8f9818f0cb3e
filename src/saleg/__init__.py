"""saleg: simulator of free-piston linear engine generators.

An engine is a translator between two chambers, with laws in slots; a kernel integrates it and
stops exactly at its events; results only read. All quantities are in SI units.
"""

from saleg import laws, machines
from saleg.batches import simulate_many, steady_states
from saleg.controller import Controller
from saleg.engine import (
    BounceChamber,
    Cylinder,
    Engine,
    Fuel,
    Intake,
    SealedCylinder,
    Translator,
)
from saleg.errors import EngineFileError, InvalidEngine, LawError, SalegError, UnknownPath
from saleg.performance import EnergyBalance, Performance
from saleg.results import Run
from saleg.simulate import simulate
from saleg.status import Status
from saleg.steady import SteadyState, steady_state
from saleg.version import __version__

__all__ = [
    "BounceChamber",
    "Controller",
    "Cylinder",
    "EnergyBalance",
    "Engine",
    "EngineFileError",
    "Fuel",
    "Intake",
    "InvalidEngine",
    "LawError",
    "Performance",
    "Run",
    "SalegError",
    "SealedCylinder",
    "Status",
    "SteadyState",
    "Translator",
    "UnknownPath",
    "__version__",
    "laws",
    "machines",
    "simulate",
    "simulate_many",
    "steady_state",
    "steady_states",
]


#: Parts that are imported on first use.
LAZY = (
    "continuation",
    "control",
    "design",
    "export",
    "fundamental",
    "plotting",
    "reference",
    "sensitivity",
    "studies",
    "sweep",
)


def __getattr__(name: str) -> object:
    """Import the heavier parts on first use: ``saleg.plotting``, ``saleg.reference``..."""
    if name in LAZY:
        import importlib

        return importlib.import_module(f"saleg.{name}")
    raise AttributeError(f"module 'saleg' has no attribute {name!r}")
