"""Steady states: fixed points of the return map, their stability and their branches."""

from saleg.steady import continuation
from saleg.steady.linear import LinearModel
from saleg.steady.linear_inputs import NoLinearModel
from saleg.steady.solver import Effort, steady_state
from saleg.steady.state import NoSteadyState, SteadyState

__all__ = [
    "Effort",
    "LinearModel",
    "NoLinearModel",
    "NoSteadyState",
    "SteadyState",
    "continuation",
    "steady_state",
]
