"""The integrator called by name; a composed module calls it by its address where numba can."""

from saleg.kernel.integrate import run_on
from saleg.kernel.jit import inline
from saleg.kernel.tuples import Integration


@inline
def run_at(address: int, run: Integration) -> int:
    """Call the integrator: by name there is but one, so the address says nothing."""
    return int(run_on(run))
