"""saleg: simulator of free-piston linear engine generators.

An engine is a translator between two chambers, with laws in slots; a kernel integrates it and
stops exactly at its events; results only read. All quantities are in SI units.
"""

from typing import TYPE_CHECKING

from saleg import aliases, laws, machines, quantities
from saleg.batch.many import simulate_many, steady_states
from saleg.engine import (
    BounceChamber,
    Controller,
    Cylinder,
    Engine,
    Fuel,
    Intake,
    OpenEnd,
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
from saleg.simulation.nearest import NearestMachine
from saleg.simulation.net_output import Auxiliaries, NetOutput
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.plausibility import Implausible
from saleg.simulation.run import Run
from saleg.simulation.scavenging import Scavenging
from saleg.simulation.shaking import Shaking
from saleg.simulation.validity import ValidityReport
from saleg.status import Status
from saleg.steady.solver import Effort, steady_state
from saleg.steady.state import SteadyState
from saleg.version import __version__, show_versions

if TYPE_CHECKING:  # imported on first use
    from saleg import calibration as calibration
    from saleg import control as control
    from saleg import design as design
    from saleg import export as export
    from saleg import fuels as fuels
    from saleg import fundamental as fundamental
    from saleg import optimize as optimize
    from saleg import plotting as plotting
    from saleg import plugs as plugs
    from saleg import reference as reference
    from saleg import studies as studies
    from saleg import sweep as sweep
    from saleg import thesis as thesis
    from saleg.calibration.fit import calibrate as calibrate
    from saleg.reporting.document import report as report
    from saleg.steady import continuation as continuation
    from saleg.studies import sensitivity as sensitivity
    from saleg.studies.comparison import compare as compare

__all__ = [
    "Auxiliaries",
    "BounceChamber",
    "Controller",
    "Cylinder",
    "Effort",
    "EnergyBalance",
    "Engine",
    "EngineFileError",
    "Fuel",
    "Implausible",
    "Intake",
    "InvalidEngine",
    "LawError",
    "NearestMachine",
    "NetOutput",
    "OpenEnd",
    "Performance",
    "Run",
    "SalegError",
    "SalegWarning",
    "Scavenging",
    "SealedCylinder",
    "Shaking",
    "Status",
    "SteadyState",
    "Translator",
    "UnknownPath",
    "ValidityReport",
    "__version__",
    "laws",
    "machines",
    "quantities",
    "show_versions",
    "simulate",
    "simulate_many",
    "steady_state",
    "steady_states",
]

aliases.install()


def __getattr__(name: str) -> object:
    """Import the heavier parts on first use: ``saleg.plotting``, ``saleg.reference``..."""
    return aliases.part(name)


def __dir__() -> list[str]:
    """List what is public."""
    return sorted({*__all__, *aliases.LAZY, *aliases.FUNCTIONS})
