"""Direct injection: hydrogen into the closed cylinder, beside hydrogen mixed before the ports.

Run with ``python examples/19_direct_injection.py``.
"""

import sys
from pathlib import Path

import numpy as np

import saleg
from saleg import fuels, laws

BASE = saleg.machines.thesis_base().replace(egr=0.0, combustion_efficiency=1.0)
RATIO = 0.5


def steady(injection):
    """Steady state on hydrogen; its gas follows the composition."""
    engine = BASE.replace(injection=injection)
    return saleg.steady_state(
        fuels.fill(engine, fuels.hydrogen, equivalence_ratio=RATIO, follows=True)
    )


def main(folder: Path) -> None:
    mixed, injected = steady(laws.PortMixing()), steady(laws.DirectInjection(clearance=0.06))
    for name, state in (("mixed", mixed), ("injected", injected)):
        p = state.performance
        print(
            f"{name}: {p.fuel_energy_per_cycle:.0f} J of fuel, {1e-3 * p.power:.2f} kW, "
            f"efficiency {100 * p.efficiency:.1f} %"
        )
    # All of the fuel burns and all of the gas is exchanged: mixed, fuel takes its part of the room.
    share = RATIO / (RATIO + fuels.hydrogen.oxygen * 4.76)
    more = injected.performance.fuel_energy_per_cycle / mixed.performance.fuel_energy_per_cycle
    assert np.isclose(more, 1.0 / (1.0 - share), rtol=1e-3)
    assert injected.performance.power > mixed.performance.power


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path())
