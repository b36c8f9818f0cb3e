"""Simulation of an engine: from its start to results that only read."""

from saleg.simulation.integration import simulate
from saleg.simulation.performance import EnergyBalance, Performance
from saleg.simulation.run import Run
from saleg.simulation.scavenging import Scavenging
from saleg.simulation.shaking import Shaking

__all__ = ["EnergyBalance", "Performance", "Run", "Scavenging", "Shaking", "simulate"]
