"""Engines that breathe, for tests of the integrator and of the reference."""

import dataclasses

import saleg
from saleg import laws

PORTS = laws.PortFlow(
    exhaust_width=0.1,
    exhaust_height=0.04,
    intake_width=0.12,
    intake_height=0.03,
    intake_delay=0.01,
    displacement=0.6,
)


def single_piston(base, ports):
    """Cylinder with crankcase, leaking rings and a wall that follows; a leaking gas spring."""
    cylinder = dataclasses.replace(
        base.left,
        gas_exchange=ports,
        supply=laws.Crankcase(volume_at_midpoint=6e-4, area=4e-3, reed=6e-4),
        leak=laws.RingLeak(gap=3e-7),
        wall=laws.LumpedWall(heat_capacity=2.0, conductance=20.0),
    )
    bounce = saleg.BounceChamber(
        bore=0.064,
        half_stroke=0.1,
        pressure=2.5e5,
        leak=laws.MakeUpValve(valve=2e-6, gap=1e-7, pressure=2e5),
    )
    return saleg.Engine(
        translator=saleg.Translator(mass=2.4),
        left=cylinder,
        right=bounce,
        springs=laws.LinearSprings(stiffness=20e3),
        alternator=laws.LinearLoad(load_constant=12.0),
    )
