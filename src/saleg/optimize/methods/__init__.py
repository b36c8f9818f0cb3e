"""Methods of optimisation, one module each: settings that begin a search."""

from __future__ import annotations

import importlib.util

from saleg.optimize.methods.archive import Archive, Axis
from saleg.optimize.methods.base import Method, Search, Start
from saleg.optimize.methods.cmaes import CMAES
from saleg.optimize.methods.compass import CompassSearch
from saleg.optimize.methods.differential import DifferentialEvolution
from saleg.optimize.methods.genetic import GeneticAlgorithm
from saleg.optimize.methods.nsga2 import NSGA2

__all__ = [
    "CMAES",
    "METHODS",
    "NSGA2",
    "Archive",
    "Axis",
    "CompassSearch",
    "DifferentialEvolution",
    "GeneticAlgorithm",
    "Method",
    "Search",
    "Start",
    "default_method",
]

#: Methods by the short names files and command lines call them by.
METHODS: dict[str, Method] = {
    "ga": GeneticAlgorithm(),
    "cma": CMAES(),
    "de": DifferentialEvolution(),
    "nsga2": NSGA2(),
    "archive": Archive(),
    "compass": CompassSearch(),
}


def default_method(objectives: int) -> Method:
    """CMA-ES where it is installed, differential evolution where not; NSGA-II for fronts."""
    if objectives > 1:
        return NSGA2()
    return CMAES() if importlib.util.find_spec(CMAES.package) else DifferentialEvolution()
