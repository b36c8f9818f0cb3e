"""Compression that four fuels need to light themselves: the table of docs/fuels.md.

Run with ``python examples/chemistry/compression_of_fuels.py [intake temperature ...]``; needs
``pip install "saleg[chemistry]"`` and takes some minutes, most of them for the delays of dodecane.
"""

import sys

import cantera
import numpy as np

import saleg
from saleg import fuels, laws
from saleg.fuels.species import Atoms, Species, all_species

BASE = saleg.machines.thesis_base()
MECHANISM, PHASE = "nDodecane_Reitz.yaml", "nDodecane_IG"
NAMES = {
    "n-dodecane": "c12h26",
    "oxygen": "o2",
    "nitrogen": "n2",
    "carbon dioxide": "co2",
    "water": "h2o",
}
#: Loads at which engines are tried, and halvings between the last that runs and the next [N s/m].
LOADS = (10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 75.0, 90.0, 120.0)
HALVINGS = 6


def dodecane() -> fuels.RealFuel:
    """N-dodecane, which is no fuel of the package, with the caloric data of the mechanism."""
    gas = cantera.Solution(MECHANISM, PHASE)
    coefficients = gas.species(NAMES["n-dodecane"]).thermo.coeffs  # middle, high, low
    high, low = tuple(coefficients[1:8]), tuple(coefficients[8:15])
    all_species()["n-dodecane"] = Species("n-dodecane", Atoms(12, 26, 0, 0), low, high)
    return fuels.RealFuel("n-dodecane", {"n-dodecane": 1.0})


def diesel_like() -> laws.TabulatedDelay:
    """Delays of n-dodecane."""
    return fuels.compute_delays(
        dodecane(),
        MECHANISM,
        phase=PHASE,
        species=NAMES,
        pressures=np.geomspace(4e5, 200e5, 9),
        temperatures=1.0 / np.linspace(1.0 / 600.0, 1.0 / 1500.0, 19),
        equivalence_ratios=(0.3, 0.5, 0.7),
        burnt_shares=(0.0, 0.2),
    )


def compression_at(fuel, law, intake: float, load: float) -> float | None:
    """Compression ratio at a load; None where the engine does not run steadily."""
    engine = fuels.fill(BASE, fuel, equivalence_ratio=0.5).replace(
        ignition=law, **{"intake.temperature": intake, "alternator.load_constant": load}
    )
    state = saleg.steady_state(engine)
    return state.performance.compression_ratio if state.status is saleg.Status.STEADY else None


def least_compression(fuel, law, intake: float) -> float | None:
    """Compression ratio at the greatest load an engine runs with; None where it never does."""
    runs, stalls, ratio = None, 1.5 * LOADS[-1], None
    for load in LOADS:
        found = compression_at(fuel, law, intake, load)
        if found is None and runs is not None:
            stalls = load
            break
        if found is not None:
            runs, ratio = load, found
    for _ in range(HALVINGS if runs is not None else 0):
        load = 0.5 * (runs + stalls)
        found = compression_at(fuel, law, intake, load)
        if found is None:
            stalls = load
        else:
            runs, ratio = load, found
    return ratio


def main(intakes: list[float]) -> None:
    cases = {
        "diesel-like": (fuels.n_heptane, diesel_like()),
        "hydrogen": (fuels.hydrogen, fuels.ignition_delays(fuels.hydrogen)),
        "petrol-like": (fuels.iso_octane, laws.RCMIgnition()),
        "natural gas": (fuels.methane, fuels.ignition_delays(fuels.methane)),
    }
    print(f"| intake [K] | {' | '.join(cases)} |")
    for intake in intakes:
        found = [least_compression(fuel, law, intake) for fuel, law in cases.values()]
        told = ["does not run" if ratio is None else f"{ratio:.1f}" for ratio in found]
        print(f"| {intake:g} | {' | '.join(told)} |", flush=True)


if __name__ == "__main__":
    main([float(text) for text in sys.argv[1:]] or [325.0, 360.0, 400.0, 440.0, 480.0, 560.0])
