"""State of the reference solver's engine: between two events, and totals of a stroke."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from saleg.engine import (
    Chamber,
    CombustionChamber,
    Cylinder,
    Engine,
    GasChamber,
    OpenEnd,
    SealedCylinder,
)
from saleg.engine.start import Contents, Initial
from saleg.kernel import layout
from saleg.laws.arguments import Stroke


@dataclass
class EngineState:
    """State of the engine between two events, as the right-hand side reads it.

    Attributes
    ----------
    mass : float
        Moving mass [kg].
    back_force : float
        Of the constant pressures behind the pistons [N].
    motored : float
        1 to integrate the motored pressures as well.
    stroke, mean_piston_speed : float
        Of the latest stroke [m, m/s].
    load_weight, friction_held : float
        What the laws of alternator and friction hold.
    frame_moves : float
        1 if position and velocity of the frame are states, else 0.
    direction : float
        +1 on the way right, -1 on the way left, 0 before the first movement.
    """

    mass: float
    back_force: float
    motored: float
    stroke: float
    mean_piston_speed: float
    load_weight: float = 0.0
    friction_held: float = 0.0
    frame_moves: float = 0.0
    direction: float = 0.0


@dataclass
class ChamberState:
    """State of a chamber between two events, as the right-hand side reads it.

    Attributes
    ----------
    sign : float
        +1 if the chamber grows with x, else -1.
    bore, area, half_stroke : float
        Geometry [m, m^2, m].
    wall_temperature, gas_constant : float
        [K], [J/kg/K].
    mass, fuel, air, burnt, equivalence_ratio : float
        The charge [kg]; of all fuel to all air [-].
    p_closing, T_closing, V_closing : float
        Its state at port closing [Pa, K, m^3].
    time_to_dead_centre : float
        From there to the dead centre, as the stroke before would have it [s].
    mode : float
        Open, closed or burning.
    armed : float
        Whether the charge may ignite, as the layout has it.
    t_ignition, duration, heat : float
        Of the combustion: start and duration [s], heat if all that can burn does [J].
    first_phase, last_phase : float
        Breakpoints of the burn rate it lies between, over the duration [-].
    number : float
        How many charges have been composed.
    breathes, by_flow, crankcase, wall_follows : float
        1 if its masses are states, if gas flows through its ports, if a crankcase stands before
        them, if the temperature of its wall is a state; else 0.
    port, intake_pressure, intake_temperature : float
        Clearance at the ports [m], state of the intake [Pa, K].
    equivalence_ratio_wanted, air_fuel_ratio, lower_heating_value : float
        Of fresh gas and of the fuel [-, -, J/kg].
    fuel_factor : float
        Fuel metered to the coming charge over that commanded [-].
    mass_lit, fresh : float
        Mass of the charge when it was lit, and fresh gas in it when it was trapped [kg].
    injection_place, injection_due : float
        Clearance at which fuel is injected into the closed chamber [m], 0 for none; 1 if that is to
        come, else 0.
    trapped, trapped_temperature : float
        Mass and temperature as the ports closed, of a charge that had no fuel yet [kg, K].
    """

    sign: float
    bore: float
    area: float
    half_stroke: float
    wall_temperature: float
    gas_constant: float
    mass: float
    fuel: float
    air: float
    burnt: float
    equivalence_ratio: float
    p_closing: float
    T_closing: float
    V_closing: float
    mode: float
    armed: float
    time_to_dead_centre: float = math.inf
    t_ignition: float = 0.0
    duration: float = 1.0
    heat: float = 0.0
    first_phase: float = 0.0
    last_phase: float = 1.0
    number: float = 0.0
    breathes: float = 0.0
    by_flow: float = 0.0
    crankcase: float = 0.0
    wall_follows: float = 0.0
    port: float = math.inf
    intake_pressure: float = 0.0
    intake_temperature: float = 0.0
    equivalence_ratio_wanted: float = 0.0
    air_fuel_ratio: float = 1.0
    lower_heating_value: float = 0.0
    fuel_factor: float = 1.0
    mass_lit: float = 1.0
    fresh: float = 0.0
    follows: float = 0.0
    fuel_constant: float = 0.0
    air_constant: float = 0.0
    burnt_constant: float = 0.0
    injection_place: float = 0.0
    injection_due: float = 0.0
    trapped: float = 0.0
    trapped_temperature: float = 0.0

    @property
    def constant_now(self) -> float:
        """Specific gas constant of what stands in the chamber [J/kg/K]."""
        if self.follows == 0.0:
            return self.gas_constant
        fuel, air = self.fuel * self.fuel_constant, self.air * self.air_constant
        return (fuel + air + self.burnt * self.burnt_constant) / self.mass

    @property
    def mass_trapped(self) -> float:
        """Mass of the charge as its ports closed [kg]."""
        if self.follows > 0.0:  # none leaks
            return self.mass
        if self.injection_place > 0.0:
            return self.trapped
        return self.p_closing * self.V_closing / (self.gas_constant * self.T_closing)


@dataclass
class StrokeTotals:
    """Totals of a chamber from dead centre to dead centre.

    Attributes
    ----------
    fresh_fuel_energy, exhaust_energy, exhaust_fuel_energy : float
        [J].
    ignition_time, ignition_height, combustion_duration : float
        [s], [m], [s]; -1, 0 and 0 without ignition.
    """

    fresh_fuel_energy: float = 0.0
    exhaust_energy: float = 0.0
    exhaust_fuel_energy: float = 0.0
    ignition_time: float = -1.0
    ignition_height: float = 0.0
    combustion_duration: float = 0.0


def chamber_states(engine: Engine, start: Initial) -> list[ChamberState]:
    """Both chambers with the contents their start law gave them."""
    held = {"left": (start.left, 1.0), "right": (start.right, -1.0)}
    states = {
        side: _chamber_state(chamber, *held[side], start.x)
        for side, chamber in zip(held, engine.chambers, strict=True)
        if isinstance(chamber, GasChamber)
    }
    for side, chamber in zip(held, engine.chambers, strict=True):
        if isinstance(chamber, OpenEnd):
            states[side] = _open_end(chamber, max(engine.piston_areas), held[side][1])
    return [states["left"], states["right"]]


def _open_end(end: OpenEnd, area: float, sign: float) -> ChamberState:
    """The surroundings behind a piston: no gas to follow, its pressure is always the same."""
    state = ChamberState(**dict.fromkeys((field.name for field in fields(ChamberState)), 0.0))
    state.sign, state.area, state.half_stroke = sign, area, end.half_stroke
    state.mode, state.intake_pressure = layout.OPEN, end.pressure
    state.intake_temperature = end.reference_state.temperature
    state.p_closing, state.T_closing = end.pressure, state.intake_temperature
    state.wall_temperature = state.intake_temperature
    state.mass = state.mass_lit = state.gas_constant = state.V_closing = (
        1.0  # divided by, never used
    )
    return state


def _chamber_state(chamber: GasChamber, held: Contents, sign: float, x: float) -> ChamberState:
    """Chamber with the contents its start law gave it."""
    area = math.pi * chamber.bore**2 / 4.0
    p, T, full = chamber.reference_state
    if isinstance(chamber, SealedCylinder):  # its charge is closed where it stands
        p, full = held.pressure, chamber.half_stroke + sign * x
        T = p * area * full / (held.mass * chamber.gas_properties.gas_constant)
    ratio = 0.0
    if isinstance(chamber, CombustionChamber) and held.fuel > 0.0:
        ratio = chamber.fuel.air_fuel_ratio * held.fuel / held.air
    state = ChamberState(
        sign=sign,
        bore=chamber.bore,
        area=area,
        half_stroke=chamber.half_stroke,
        wall_temperature=chamber.wall_temperature,
        gas_constant=chamber.gas_properties.gas_constant,
        mass=held.mass,
        fuel=held.fuel,
        air=held.air,
        burnt=held.burnt,
        equivalence_ratio=ratio,
        p_closing=p,
        T_closing=T,
        V_closing=area * full,
        mode=layout.OPEN if held.is_open else layout.CLOSED,
        armed=float(held.armed and held.fuel > 0.0),
    )
    _let_breathe(state, chamber, x)
    closed = held.armed and not held.is_open and state.injection_place > 0.0
    beyond = chamber.half_stroke + sign * x - state.injection_place
    state.injection_due = float(closed and beyond > 0.0)
    return state


def _let_breathe(c: ChamberState, chamber: Chamber, x: float) -> None:
    """Note which states the laws of a chamber ask for, and what they need."""
    c.breathes = float("contents" in chamber.states)
    if isinstance(chamber, GasChamber):
        c.follows = float(chamber.gas_properties.follows_composition)
        c.fuel_constant, c.air_constant, c.burnt_constant = chamber.gas_properties.gas_constants
    c.crankcase = float("crankcase" in chamber.states)
    c.wall_follows = float("wall_temperature" in chamber.states)
    c.intake_pressure, c.intake_temperature, _ = chamber.reference_state
    if isinstance(chamber, Cylinder):
        c.port = chamber.port_closing
        c.by_flow = float("contents" in chamber.gas_exchange.states)
    if isinstance(chamber, CombustionChamber):
        c.equivalence_ratio_wanted = chamber.equivalence_ratio
        c.air_fuel_ratio = chamber.fuel.air_fuel_ratio
        c.lower_heating_value = chamber.fuel.lower_heating_value
        c.injection_place = chamber.injection.place
        c.trapped, c.trapped_temperature = c.mass - c.fuel, c.T_closing
    if c.by_flow and c.mode == layout.OPEN:  # filled at the intake's state as far as it is open
        filled = (c.half_stroke + c.sign * x) / c.port
        c.mass, c.fuel, c.burnt = c.mass * filled, c.fuel * filled, c.burnt * filled
    if c.breathes:
        c.air = c.mass - c.fuel - c.burnt


def stroke_before(engine: Engine, start: Initial, piston_area: float) -> Stroke:
    """The stroke a start law takes to have passed before time zero."""
    speed = start.mean_piston_speed
    return Stroke(
        length=start.stroke,
        duration=start.stroke / speed if speed > 0.0 else math.inf,
        maximum=engine.maximum_stroke,
        half_maximum=0.5 * engine.maximum_stroke,
        piston_area=piston_area,
        fuel_energy=0.0,
        speed_squared=0.0,
        x_left=-0.5 * start.stroke,
        x_right=0.5 * start.stroke,
    )
