"""An engine that breathes through its ports: one cycle, and scavenging over the charge pressure.

Run with ``python examples/11_breathing.py [FOLDER]``; without a folder the picture is thrown
away. With docs/images it makes that of docs/breathing.md.
"""

import dataclasses
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import saleg
from saleg import laws
from saleg.plotting import new_figure


def engine_at(pressure):
    """Base case with ports in place of the instantaneous exchange, at an intake pressure [Pa]."""
    ports = laws.PortFlow(
        exhaust_width=0.1,
        exhaust_height=0.03,
        intake_width=0.05,
        intake_height=0.015,
        intake_delay=0.01,
        displacement=0.5,
    )
    return saleg.machines.thesis_base().replace(
        gas_exchange=ports, **{"intake.pressure": pressure, "equivalence_ratio": 0.4}
    )


def scavenging_at(pressure):
    """Gas exchange of the left cylinder and the steady state, one dictionary."""
    steady = saleg.steady_state(engine_at(pressure))
    assert steady.found, steady.message
    left, _ = steady.scavenging
    return dataclasses.asdict(left) | {"pressure": pressure, "power": steady.performance.power}


def main(folder: Path) -> None:
    rows = [scavenging_at(pressure) for pressure in np.linspace(1.1e5, 1.6e5, 11)]
    for row in rows[::5]:
        print({name: float(f"{value:.4g}") for name, value in row.items()})
    # Higher charge pressure delivers more, scavenges better and wastes more.
    for name, sign in (("delivery_ratio", 1.0), ("residual_fraction", -1.0)):
        assert (sign * np.diff([row[name] for row in rows]) > 0.0).all(), name

    steady = saleg.steady_state(engine_at(1.4e5))
    history = steady.orbit.history
    gas_constant = steady.engine.left.gas_properties.gas_constant
    mass = history["p_left"] * history["V_left"] / (gas_constant * history["T_left"])

    figure = new_figure(width=11.0, height=4.3)
    left, right = figure.subplots(1, 2)
    x = 1e3 * (steady.engine.left.half_stroke + history["x"])
    left.plot(x, 1e-5 * history["p_left"], color="C0")
    left.set_yscale("log")
    left.set_xlabel("clearance on the left [mm]")
    left.set_ylabel("pressure on the left [bar]", color="C0")
    port = 1e3 * steady.engine.left.port_closing
    left.axvline(port, color="0.6", linewidth=0.8)
    left.text(port - 2.0, 9.0, "exhaust opens", rotation=90, ha="right", va="center", color="0.4")
    masses = left.twinx()
    masses.plot(x, 1e3 * mass, color="C1")
    masses.set_ylabel("mass on the left [g]", color="C1")
    masses.set_ylim(0.0)
    left.set_title("One cycle at an intake pressure of 1.4 bar")

    pressures = [1e-5 * row["pressure"] for row in rows]
    for name, label in (
        ("delivery_ratio", "delivery ratio"),
        ("charging_efficiency", "charging efficiency"),
        ("trapping_efficiency", "trapping efficiency"),
        ("residual_fraction", "residual fraction"),
    ):
        right.plot(pressures, [row[name] for row in rows], marker=".", label=label)
    right.set_xlabel("intake pressure [bar], exhaust at 1 bar")
    right.set_ylabel("share [-]")
    right.set_ylim(0.0, 2.3)
    right.legend()
    right.set_title("Gas exchange of a steady state")
    figure.savefig(folder / "breathing.png")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with TemporaryDirectory() as scratch:
            main(Path(scratch))
