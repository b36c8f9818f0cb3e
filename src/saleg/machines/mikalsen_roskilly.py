"""Diesel engine with a bounce chamber by Mikalsen and Roskilly, Newcastle University.

Source: R. Mikalsen and A. P. Roskilly, Newcastle University; simulated, never built. `MACHINE` says
what is given, what is open, and what was found.

The source controls stroke and compression ratio; here load and bounce pressure are set so that both
are met, and the charge holds the fuel that its results imply: power over frequency and
efficiency, 3.5 kJ. The start of combustion stands at a clearance; n-heptane stands for diesel fuel.
"""

from __future__ import annotations

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

BORE, STROKE, RATIO = 0.131, 0.150, 15.0
POWER, FREQUENCY, EFFICIENCY = 44.4e3, 30.0, 0.42
LEAST_CLEARANCE = STROKE / (RATIO - 1.0)


def newcastle() -> Engine:
    """Diesel engine of Mikalsen and Roskilly: 131 mm bore, 150 mm stroke, bounce chamber.

    Returns
    -------
    Engine
    """
    half_stroke = LEAST_CLEARANCE + 0.5 * STROKE
    cylinder = Cylinder(
        bore=BORE,
        half_stroke=half_stroke,
        port_closing=0.110,
        wall_temperature=450.0,
        combustion_efficiency=1.0,
        intake=Intake(1.5e5, 320.0),
        heat_transfer=Hohenberg(a=130.0),
        heat_release=Wiebe(combustion_duration=4e-3, a=6.908, b=2.0),
        ignition=SparkAtClearance(clearance=0.012),
        gas_exchange=InstantExchange(egr=0.0),
    )
    bounce = BounceChamber(
        bore=BORE,
        half_stroke=half_stroke,
        pressure=3.646e5,
        gas_properties=ConstantGamma(value=1.4),
    )
    engine = Engine(
        Translator(mass=22.0),
        cylinder,
        bounce,
        springs=LinearSprings(stiffness=0.0),
        friction=ViscousFriction(coefficient=50.0),
        alternator=LinearLoad(load_constant=549.0, efficiency=0.95, regulator_gain=0.0),
        name="newcastle",
    )
    return fuels.fill(engine, fuels.n_heptane, heat=POWER / FREQUENCY / EFFICIENCY)


MACHINE = PublishedMachine(
    name="newcastle",
    title="Diesel engine of Mikalsen and Roskilly, Newcastle",
    source="Mikalsen and Roskilly, Newcastle University",
    is_measured=False,
    engine=newcastle,
    given=(
        "one cylinder, diesel, bounce chamber; bore 131 mm, stroke 150 mm",
        "moving mass 22 kg; boosted to 1.5 bar",
    ),
    open_quantities=(
        OpenQuantity("right.half_stroke", 0.080, 0.12, "as long as the cylinder"),
        OpenQuantity("right.bore", 0.115, 0.15, "as wide as the cylinder"),
        OpenQuantity("alternator.efficiency", 0.9, 1.0, "as in the dissertation's engines"),
        OpenQuantity("friction.coefficient", 0.0, 150.0, "some 2 % of the fuel energy"),
        OpenQuantity("ignition.clearance", 0.0108, 0.02, "heat release from 1 ms before its end"),
        OpenQuantity("heat_release.combustion_duration", 2e-3, 8e-3, "40 degrees of its cycle"),
        OpenQuantity("heat_transfer.a", 0.0, 260.0, "Hohenberg's own constant"),
        OpenQuantity("wall_temperature", 400.0, 600.0, "water-cooled"),
        OpenQuantity("port_closing", 0.09, 0.14, "ports of a third of the stroke"),
        OpenQuantity("intake.temperature", 300.0, 370.0, "behind an intercooler"),
        OpenQuantity("equivalence_ratio", 0.35, 0.8, "fuel that the published results imply"),
    ),
    published=(
        Published("stroke", STROKE, held_by="alternator.load_constant"),
        Published("compression_ratio", RATIO, held_by="right.pressure"),
        Published("frequency", FREQUENCY),
        Published("power", POWER),
        Published("efficiency", EFFICIENCY),
    ),
)
