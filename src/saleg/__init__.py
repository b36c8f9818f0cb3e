"""saleg: simulator of free-piston linear engine generators.

An engine is a translator between two chambers, with laws in slots; a kernel integrates it and
stops exactly at its events; results only read. All quantities are in SI units.
"""

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

from saleg import laws, machines
from saleg.batch.many import simulate_many, steady_states
from saleg.engine import (
    BounceChamber,
    Controller,
    Cylinder,
    Engine,
    Fuel,
    Intake,
    SealedCylinder,
    Translator,
)
from saleg.errors import (
    EngineFileError,
    InvalidEngine,
    LawError,
    SalegError,
    SalegWarning,
    UnknownPath,
)
from saleg.simulation.integration import simulate
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.run import Run
from saleg.status import Status
from saleg.steady.solver import Effort, SteadyState, steady_state
from saleg.version import __version__, show_versions

__all__ = [
    "BounceChamber",
    "Controller",
    "Cylinder",
    "Effort",
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
    "SalegWarning",
    "SealedCylinder",
    "Status",
    "SteadyState",
    "Translator",
    "UnknownPath",
    "__version__",
    "laws",
    "machines",
    "show_versions",
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
    "optimize",
    "plotting",
    "reference",
    "sensitivity",
    "studies",
    "sweep",
    "thesis",
)
#: Short names that documentation has given to modules, and where these live. Some of them are
#: names for good (``saleg.continuation``, ``saleg.sensitivity``, ``saleg.start``).
ALIASES = {
    "saleg.continuation": "saleg.steady.continuation",
    "saleg.sensitivity": "saleg.studies.sensitivity",
    "saleg.start": "saleg.engine.start",
    "saleg.paths": "saleg.engine.paths",
    "saleg.files": "saleg.engine.toml",
    "saleg.performance": "saleg.simulation.performance",
    "saleg.report": "saleg.simulation.report",
    "saleg.thesis_tables": "saleg.thesis.tables",
    "saleg.fundamental.plots": "saleg.plotting.fundamental",
    "saleg.fundamental.figures": "saleg.thesis.chapter_2",
}


class _AliasFinder(MetaPathFinder, Loader):
    """Imports a module under a name of :data:`ALIASES` as the module it stands for."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return ModuleSpec(name, self) if name in ALIASES else None

    def exec_module(self, module: ModuleType) -> None:
        # The import system takes what it finds here afterwards in place of the empty module.
        sys.modules[module.__name__] = import_module(ALIASES[module.__name__])


sys.meta_path.append(_AliasFinder())


def __getattr__(name: str) -> object:
    """Import the heavier parts on first use: ``saleg.plotting``, ``saleg.reference``..."""
    if name in LAZY or f"saleg.{name}" in ALIASES:
        return import_module(f"saleg.{name}")
    raise AttributeError(f"module 'saleg' has no attribute {name!r}")
