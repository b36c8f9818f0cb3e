"""Milan replica of a Japanese single-piston prototype: spark-ignited petrol, a gas spring.

Source: Facheris and Fasana, Politecnico di Milano, 2021; simulated. `MACHINE` says what is given,
what is open, and what was found.

The midpoint is that of the nominal stroke, the gas spring adiabatic. Nothing presses on the step
between its annulus and the bore: over the nominal stroke inward the spring gives 284 J, while
compression, load and friction take some 277 J, so the 44 J of an atmosphere there have no place in
the source's numbers. The charge holds the fuel that its results imply, 767 J: power over frequency
and efficiency.
"""

from __future__ import annotations

import math

from saleg import fuels
from saleg.engine import BounceChamber, Cylinder, Engine, Intake, Translator
from saleg.laws import (
    ConstantGamma,
    Hohenberg,
    InstantExchange,
    LinearLoad,
    LinearSprings,
    SparkAtClearance,
    ViscousFriction,
    Wiebe,
)
from saleg.machines.published import OpenQuantity, Published, PublishedMachine

BORE, STROKE, LEAST_CLEARANCE, PORT_HEIGHT = 0.068, 0.100, 0.01104, 0.025
POWER, FREQUENCY, EFFICIENCY = 9996.0, 28.32, 0.46
#: Annular gas spring at bottom dead centre.
SPRING_AREA, SPRING_VOLUME, SPRING_PRESSURE, SPRING_GAMMA = 0.808e-2, 0.2696e-3, 0.99e6, 1.4
#: Resistances of load and coils [ohm].
LOAD, COILS = 6.0, 0.16


def polimi() -> Engine:
    """Milan replica of a Japanese single-piston prototype: 68 mm bore, 100 mm stroke, gas spring.

    Returns
    -------
    Engine
    """
    area = math.pi * BORE**2 / 4.0
    cylinder = Cylinder(
        bore=BORE,
        half_stroke=LEAST_CLEARANCE + 0.5 * STROKE,
        port_closing=LEAST_CLEARANCE + STROKE - PORT_HEIGHT,
        wall_temperature=450.0,
        combustion_efficiency=1.0,
        intake=Intake(1e5, 300.0),
        heat_transfer=Hohenberg(a=130.0),
        heat_release=Wiebe(combustion_duration=3e-3, a=6.908, b=2.0),
        ignition=SparkAtClearance(clearance=0.015),
        gas_exchange=InstantExchange(egr=0.0),
    )
    least = SPRING_VOLUME / SPRING_AREA
    length = least + 0.5 * STROKE
    spring = BounceChamber(
        bore=math.sqrt(4.0 * SPRING_AREA / math.pi),
        half_stroke=length,
        pressure=SPRING_PRESSURE * (least / length) ** SPRING_GAMMA,
        gas_properties=ConstantGamma(value=SPRING_GAMMA),
        back_area=SPRING_AREA - area,
        back_pressure=0.0,
    )
    engine = Engine(
        Translator(mass=4.8),
        cylinder,
        spring,
        springs=LinearSprings(stiffness=0.0),
        friction=ViscousFriction(coefficient=12.0),
        alternator=LinearLoad(
            load_constant=250.0, efficiency=LOAD / (LOAD + COILS), regulator_gain=0.0
        ),
        name="polimi",
    )
    return fuels.fill(engine, fuels.iso_octane, heat=POWER / FREQUENCY / EFFICIENCY)


MACHINE = PublishedMachine(
    name="polimi",
    title="Milan replica of a Japanese single-piston prototype",
    source="Facheris and Fasana, Politecnico di Milano, 2021",
    is_measured=False,
    engine=polimi,
    given=(
        "one cylinder, spark 15 mm from the head; bore 68 mm, stroke 100 mm, clearance 11.04 mm at "
        "top dead centre, ports 25 mm high, uniflow",
        "moving mass 4.8 kg; friction 12 N s/m; load 250 N s/m; 6 ohm behind coils of 0.16 ohm",
        "petrol, Wiebe function of 3 ms (a 6.908, m 2), complete",
        "annular gas spring: 0.808 dm2, at bottom dead centre 0.2696 dm3 and 0.99 MPa, gamma 1.4",
    ),
    open_quantities=(
        OpenQuantity("equivalence_ratio", 0.6, 1.1, "fuel that the published results imply"),
        OpenQuantity("heat_transfer.a", 0.0, 260.0, "Hohenberg's own constant"),
        OpenQuantity("wall_temperature", 380.0, 550.0, "water-cooled"),
        OpenQuantity("intake.pressure", 0.9e5, 1.3e5, "not boosted"),
        OpenQuantity("intake.temperature", 290.0, 360.0, "surroundings"),
        OpenQuantity("gas_exchange.egr", 0.0, 0.2, "uniflow, which displaces well"),
        OpenQuantity("right.back_pressure", 0.0, 1e5, "energy of the inward stroke"),
    ),
    published=(
        Published("frequency", FREQUENCY),
        Published("power", POWER),
        Published("efficiency", EFFICIENCY),
        Published("compression_ratio", 10.19),
    ),
)
