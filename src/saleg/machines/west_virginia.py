"""First prototype of West Virginia University: two cylinders built of bought parts, no springs.

Source: M. C. Robinson's dissertation, Table 6 and sections 1.3.1 and 3.6.7. `MACHINE` says what is
given, what is open, and what was found.

As for Ulsan the table's 1.35 bar and 341 K are read as the charge compressed under the piston.
The equivalence ratio is that which releases the 25 J a stroke that the table gives.
"""

from __future__ import annotations

from saleg import fuels
from saleg.engine import Engine
from saleg.machines import assumed
from saleg.machines.published import OpenQuantity, Published, PublishedMachine

#: Equivalence ratio that releases 25 J a stroke [-].
RATIO_OF_25_J = 0.55


def wvu() -> Engine:
    """First prototype of West Virginia University: 36.4 mm bore, 50 mm maximum stroke, petrol.

    Returns
    -------
    Engine
    """
    engine = assumed.small_two_stroke(
        "wvu",
        bore=0.0364,
        half_stroke=0.025,
        port_closing=0.019,
        mass=2.5,
        stiffness=0.0,
        combustion_duration=2.85e-3,
        pressure_ratio=1.35,
        temperature=341.0,
        load_constant=65.3,
    )
    return fuels.fill(engine, fuels.iso_octane, equivalence_ratio=RATIO_OF_25_J)


MACHINE = PublishedMachine(
    name="wvu",
    title="First prototype of West Virginia University",
    source="Robinson, dissertation (WVU 2015), Table 6, sections 1.3.1 and 3.6.7",
    is_measured=True,
    engine=wvu,
    given=(
        "two cylinders, spark; bore 36.4 mm, maximum stroke 50 mm, ports at 19 mm",
        "moving mass 2.5 kg; no springs",
        "petrol; 25 J of heat a stroke in 2.85 ms; charge of 1.35 bar and 341 K",
    ),
    open_quantities=(
        OpenQuantity("alternator.load_constant", 30.0, 80.0, "stroke of 0.9 of the maximum"),
        OpenQuantity("alternator.efficiency", 0.5, 0.95, "small machine with losses in its coils"),
        OpenQuantity("friction.coefficient", 3.0, 40.0, "9 to 15 N s/m in the dissertation"),
        OpenQuantity("ignition.clearance", 2.9e-3, 8e-3, "spark some 2 ms before dead centre"),
        OpenQuantity("heat_transfer.a", 65.0, 260.0, "Hohenberg's own constant"),
        OpenQuantity("wall_temperature", 350.0, 550.0, "air-cooled aluminium"),
        OpenQuantity("leak.gap", 0.0, 5e-7, "ring gaps of 0.2 mm by 0.05 mm"),
        OpenQuantity("gas_exchange.exhaust_width", 0.014, 0.057, "a quarter of the circumference"),
        OpenQuantity("gas_exchange.intake_width", 0.011, 0.046, "a fifth of the circumference"),
        OpenQuantity("gas_exchange.displacement", 0.0, 0.9, "between mixing and displacement"),
        OpenQuantity("port_closing", 0.019, 0.031, "printed; 31 mm if measured from the far end"),
        OpenQuantity("equivalence_ratio", 0.5, 0.6, "releases the 25 J a stroke that are given"),
    ),
    published=(Published("power", 309.0),),
)
