"""Assumptions that machines share where their sources say nothing: ports, crankcase, losses."""

from __future__ import annotations

import math

from saleg.engine import Cylinder, Engine, Intake, Translator
from saleg.laws import (
    Crankcase,
    Hohenberg,
    LinearLoad,
    LinearSprings,
    PortFlow,
    RingLeak,
    SparkAtClearance,
    ViscousFriction,
    Wiebe,
)

#: Shares of the circumference that exhaust and intake windows take: of the half or so that ribs
#: between windows and guided rings leave, a little more for the exhaust, as two-strokes have it.
EXHAUST_SHARE, INTAKE_SHARE = 0.25, 0.20
#: Way of the piston beyond the exhaust's edge at which the intake opens, over that to the end of
#: the stroke: what a blowdown takes.
BLOWDOWN = 0.25
#: Effective area of a reed valve over that of the piston.
REED_SHARE = 0.2
#: Ratio of specific heats of air that a crankcase compresses.
GAMMA = 1.4


def ports(bore: float, port_closing: float, maximum_stroke: float) -> PortFlow:
    """Windows from a given edge to the end of the stroke.

    Parameters
    ----------
    bore, port_closing, maximum_stroke : float
        [m].

    Returns
    -------
    PortFlow
    """
    room = maximum_stroke - port_closing
    return PortFlow(
        exhaust_width=EXHAUST_SHARE * math.pi * bore,
        exhaust_height=room,
        intake_width=INTAKE_SHARE * math.pi * bore,
        intake_height=(1.0 - BLOWDOWN) * room,
        intake_delay=BLOWDOWN * room,
    )


def crankcase(bore: float, half_stroke: float, pressure_ratio: float) -> Crankcase:
    """Space under a piston that compresses air by a given ratio over the longest stroke.

    Parameters
    ----------
    bore, half_stroke : float
        [m].
    pressure_ratio : float
        Greatest over least pressure of an adiabatic compression [-].

    Returns
    -------
    Crankcase
    """
    area = math.pi * bore**2 / 4.0
    squeeze = pressure_ratio ** (1.0 / GAMMA)
    return Crankcase(
        volume_at_midpoint=area * half_stroke * (squeeze + 1.0) / (squeeze - 1.0),
        area=area,
        reed=REED_SHARE * area,
    )


def drawn_temperature(temperature: float, pressure_ratio: float) -> float:
    """Temperature of air before a crankcase compressed it [K].

    Parameters
    ----------
    temperature : float
        After compression [K].
    pressure_ratio : float
        [-].

    Returns
    -------
    float
    """
    return temperature * pressure_ratio ** (1.0 / GAMMA - 1.0)


def small_two_stroke(
    name: str,
    *,
    bore: float,
    half_stroke: float,
    port_closing: float,
    mass: float,
    stiffness: float,
    combustion_duration: float,
    pressure_ratio: float,
    temperature: float,
    load_constant: float,
) -> Engine:
    """Two small spark-ignited cylinders, scavenged from under their pistons; fuel is not filled in.

    Parameters
    ----------
    name : str
    bore, half_stroke, port_closing : float
        [m].
    mass : float
        Moving mass [kg].
    stiffness : float
        Of one spring [N/m].
    combustion_duration : float
        [s].
    pressure_ratio, temperature : float
        Of the charge compressed under a piston [-, K].
    load_constant : float
        [N s/m].

    Returns
    -------
    Engine
    """
    cylinder = Cylinder(
        bore=bore,
        half_stroke=half_stroke,
        port_closing=port_closing,
        wall_temperature=450.0,
        intake=Intake(1e5, drawn_temperature(temperature, pressure_ratio)),
        heat_transfer=Hohenberg(a=130.0),
        heat_release=Wiebe(combustion_duration=combustion_duration),
        ignition=SparkAtClearance(clearance=4e-3),
        gas_exchange=ports(bore, port_closing, 2.0 * half_stroke),
        supply=crankcase(bore, half_stroke, pressure_ratio),
        leak=RingLeak(gap=1e-8),
    )
    return Engine.mirrored(
        Translator(mass=mass),
        cylinder,
        springs=LinearSprings(stiffness=stiffness),
        friction=ViscousFriction(coefficient=12.0),
        alternator=LinearLoad(load_constant=load_constant, efficiency=0.9, regulator_gain=0.0),
        name=name,
    )
