"""Chapter 2 of the thesis in closed form: the free-piston engine before any number is integrated.

Everything is dimensionless (:class:`Scales` leads to SI and back): positions in half strokes, the
midpoint at 0, heads at -1 and 1. A :class:`System` says what an engine is made of, ``stroke`` and
:func:`march` follow it, :func:`equilibria` says where that ends. The printed equations are
functions of their own: :func:`acceleration`, :func:`kinetic_energy`, :func:`equilibrium_force`.
:func:`from_engine` leads here from the numeric engine, :func:`to_engine` back to it, and
:func:`verify` runs it beside the closed form.

:mod:`saleg.plotting.fundamental` draws; :mod:`saleg.thesis.chapter_2` has the thesis' figures.

Examples
--------
>>> from saleg import fundamental as fm
>>> system = fm.System(pressure=0.5, heat=1.0, load=fm.ConstantLoad(0.36))
>>> history = fm.march(system, start=-0.2, strokes=1000)
>>> print(history.outcome, round(float(history.compression_ratios[-1]), 2))
equilibrium 2.26
"""

from saleg.fundamental.assumptions import to_engine
from saleg.fundamental.balance import at_equilibrium, indicated_work, multiplier
from saleg.fundamental.band import ToleranceBand, equilibrium_branch, tolerance_band
from saleg.fundamental.bridge import Groups, from_engine
from saleg.fundamental.energy import EnergyBalance, cycle_balance, stroke_balance
from saleg.fundamental.equilibrium import Equilibrium, Fold, equilibria, folds
from saleg.fundamental.formulas import acceleration, kinetic_energy
from saleg.fundamental.gas import Gas, Isentropic, Polytropic
from saleg.fundamental.history import History, Outcome, Path, march, return_map
from saleg.fundamental.ignition import AtDeadCentre, AtPressure, Ignition
from saleg.fundamental.loads import ConstantLoad, CosineLoad, Load, OttoLoad, Profile
from saleg.fundamental.otto import (
    compression_ratio,
    cosine_amplitude,
    equilibrium_force,
    otto_efficiency,
)
from saleg.fundamental.scales import Scales
from saleg.fundamental.stroke import Stroke
from saleg.fundamental.system import System
from saleg.fundamental.verification import Verification, verify

__all__ = [
    "AtDeadCentre",
    "AtPressure",
    "ConstantLoad",
    "CosineLoad",
    "EnergyBalance",
    "Equilibrium",
    "Fold",
    "Gas",
    "Groups",
    "History",
    "Ignition",
    "Isentropic",
    "Load",
    "OttoLoad",
    "Outcome",
    "Path",
    "Polytropic",
    "Profile",
    "Scales",
    "Stroke",
    "System",
    "ToleranceBand",
    "Verification",
    "acceleration",
    "at_equilibrium",
    "compression_ratio",
    "cosine_amplitude",
    "cycle_balance",
    "equilibria",
    "equilibrium_branch",
    "equilibrium_force",
    "folds",
    "from_engine",
    "indicated_work",
    "kinetic_energy",
    "march",
    "multiplier",
    "otto_efficiency",
    "return_map",
    "stroke_balance",
    "to_engine",
    "tolerance_band",
    "verify",
]
