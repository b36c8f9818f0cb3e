"""Prototype of the University of Ulsan: two small spark-ignited cylinders, springs between them.

Source: M. C. Robinson's dissertation, Table 6, sections 1.3.1 (measurements with five springs) and
3.6.7. Its curves are pictures only. `MACHINE` says what is given, what is open, and what was found.

The table's 1.1 bar and 300 K are read as the charge under the piston at the end of its compression
there, from air of 1 bar; read as a supply of that pressure the windows would let through several
times the charge. The stiffness is that of one spring, with one of them to either side: of 0.8 kg at
35 Hz a pair of 14.7 kN/m makes 46.4 Hz, and 47 Hz are published.
"""

from __future__ import annotations

from saleg import fuels
from saleg.engine import Engine
from saleg.machines import assumed
from saleg.machines.published import OpenQuantity, Published, PublishedMachine

SOFT, STIFF = {"springs.stiffness": 0.0}, {"springs.stiffness": 14.7e3}


def ulsan(stiffness: float = 2.9e3) -> Engine:
    """Prototype of the University of Ulsan: 30 mm bore, 31 mm maximum stroke, propane.

    Parameters
    ----------
    stiffness : float
        Stiffness of one spring [N/m]; measured from 0 to 14.7 kN/m.

    Returns
    -------
    Engine
    """
    engine = assumed.small_two_stroke(
        "ulsan",
        bore=0.030,
        half_stroke=0.0155,
        port_closing=0.018,
        mass=0.8,
        stiffness=stiffness,
        combustion_duration=3e-3,
        pressure_ratio=1.1,
        temperature=300.0,
        load_constant=76.3,
    )
    return fuels.fill(engine, fuels.propane, equivalence_ratio=1.0)


MACHINE = PublishedMachine(
    name="ulsan",
    title="Prototype of the University of Ulsan",
    source="Robinson, dissertation (WVU 2015), Table 6, sections 1.3.1 and 3.6.7",
    is_measured=True,
    engine=ulsan,
    given=(
        "two cylinders, spark; bore 30 mm, maximum stroke 31 mm, ports at 18 mm",
        "moving mass 0.8 kg; springs 2.9 N/mm, measured from 0 to 14.7 kN/m",
        "propane (46.3 MJ/kg) at an equivalence ratio of 1; charge of 1.1 bar and 300 K",
        "heat release of 3 ms (in the dissertation's simulation)",
    ),
    open_quantities=(
        OpenQuantity("alternator.load_constant", 40.0, 120.0, "stroke of 0.9 of the maximum"),
        OpenQuantity("alternator.efficiency", 0.4, 0.95, "small machine with losses in its coils"),
        OpenQuantity("friction.coefficient", 3.0, 40.0, "9 to 15 N s/m in the dissertation"),
        OpenQuantity("ignition.clearance", 2e-3, 8e-3, "spark some 1.3 ms before dead centre"),
        OpenQuantity("heat_release.combustion_duration", 2e-3, 6e-3, "used in the dissertation"),
        OpenQuantity("combustion_efficiency", 0.5, 1.0, "as in the dissertation's engines"),
        OpenQuantity("heat_transfer.a", 65.0, 390.0, "Hohenberg's own constant"),
        OpenQuantity("wall_temperature", 350.0, 550.0, "air-cooled aluminium"),
        OpenQuantity("leak.gap", 0.0, 5e-7, "ring gaps of 0.2 mm by 0.05 mm"),
        OpenQuantity("gas_exchange.exhaust_width", 0.012, 0.047, "a quarter of the circumference"),
        OpenQuantity("gas_exchange.intake_width", 0.009, 0.038, "a fifth of the circumference"),
        OpenQuantity("gas_exchange.displacement", 0.0, 0.9, "between mixing and displacement"),
        OpenQuantity("supply.reed", 5e-6, 3.5e-4, "a fifth of the piston's area"),
        OpenQuantity("equivalence_ratio", 0.5, 1.2, "printed, for the mixture metered"),
    ),
    published=(
        Published("frequency", 35.0, at=SOFT),
        Published("frequency", 47.0, at=STIFF),
        Published("efficiency", 0.06, at=SOFT),
        Published("efficiency", 0.0722, at=STIFF),
        Published("frequency", 47.0 / 35.0, at=STIFF, over=SOFT),
        Published("efficiency", 7.22 / 6.0, at=STIFF, over=SOFT),
        Published("power", 1.25, at=STIFF, over=SOFT),
    ),
)
