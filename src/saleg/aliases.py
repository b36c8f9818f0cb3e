"""Names of parts that are imported on first use, and short names that stand for modules."""

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

#: Parts that are imported on first use.
LAZY = (
    "calibration",
    "continuation",
    "control",
    "design",
    "export",
    "fuels",
    "fundamental",
    "optimize",
    "plotting",
    "plugs",
    "reference",
    "sensitivity",
    "studies",
    "sweep",
    "thesis",
)
#: Functions that are imported on first use, and the modules they stand in.
FUNCTIONS = {
    "calibrate": "saleg.calibration.fit",
    "compare": "saleg.studies.comparison",
    "report": "saleg.reporting.document",
}
#: Short names that documentation has given to modules, and where these live. Some of them are
#: names for good (``saleg.continuation``, ``saleg.sensitivity``, ``saleg.start``).
ALIASES = {
    "saleg.continuation": "saleg.steady.continuation",
    "saleg.sensitivity": "saleg.studies.sensitivity",
    "saleg.start": "saleg.engine.start",
    "saleg.paths": "saleg.engine.paths",
    "saleg.files": "saleg.engine.toml",
    "saleg.performance": "saleg.simulation.performance",
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


def install() -> None:
    """Let the import system know the names of :data:`ALIASES`."""
    sys.meta_path.append(_AliasFinder())


def part(name: str) -> Any:
    """Import a part of the package, a function, or what a name stands for.

    Raises
    ------
    AttributeError
        If there is none of that name.
    """
    if name in LAZY or f"saleg.{name}" in ALIASES:
        return import_module(f"saleg.{name}")
    if name in FUNCTIONS:
        return getattr(import_module(FUNCTIONS[name]), name)
    raise AttributeError(f"module 'saleg' has no attribute {name!r}")
