"""Steady states: fixed points of the return map, their stability and their branches."""

from saleg.steady.solver import SteadyState, steady_state

__all__ = ["SteadyState", "steady_state"]
