"""The integrator called as Python; in a composed module it is called by its address."""

from saleg.kernel.integrate import run_on
from saleg.kernel.tuples import Integration


def run_at(address: int, run: Integration) -> int:
    """Call the integrator: in plain Python there is but one, so the address says nothing."""
    return int(run_on(run))
