"""Running engine of the reference solver: what stands in the chambers, what happens at an event.

Written in terms of energies and masses, independently of the integrator's own switching.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from saleg.engine import CombustionChamber, Cylinder, Engine, GasChamber, SealedCylinder
from saleg.kernel import layout
from saleg.kernel.plain_breathing import CRANKCASE_ENERGY, ENERGY, is_held_open
from saleg.kernel.plain_rhs import (
    INTEGRAL,
    MOTORED_PRESSURE,
    POSITION,
    PRESSURE,
    QUADRATURES,
    VELOCITY,
    charge_in,
    gas_in,
    pressure_in,
    rates,
)
from saleg.laws.arguments import Charge, Gas, Motion, Stroke
from saleg.reference.contents import (
    energy_held,
    fill,
    put_masses,
    put_state,
    specific_enthalpy_of_fuel,
    supplied_energy,
    take_contents,
    write_passed,
)
from saleg.reference.states import (
    ChamberState,
    EngineState,
    StrokeTotals,
    chamber_states,
    stroke_before,
)
from saleg.simulation.initial_state import ratings

#: Distance from a port at which it counts as reached, over the half stroke [-].
SLACK = 1e-13
#: The same for a corner of the area of a port.
CORNER_SLACK = 1e-9
#: The same for a breakpoint of the burn rate, over the duration of the combustion [-].
PHASE_SLACK = 1e-9
_TOTALS = (
    "alternator_work",
    "electrical_energy",
    "electrical_squared",
    "alternator_impulse",
    "friction_work",
    "speed_squared",
)
_TOTALS_PER_SIDE = ("heat_released", "heat_lost", "gas_work", "port_work")


@dataclass
class RunningEngine:
    """Engine under way: state, modes, charges and totals of the stroke.

    Attributes
    ----------
    engine : Engine
    t : float
        Time [s].
    y : ndarray
        State and quadratures, as :mod:`saleg.kernel.plain_rhs` has them.
    machine : EngineState
    chambers : list of ChamberState
    totals : list of StrokeTotals
    x_dead_centre, t_dead_centre : float
        The last dead centre [m, s]; NaN before the first.
    earlier_fuel, earlier_speed_squared : float
        Of the stroke before the present one [J, m^2/s].
    renewal_due : set of int
        Sides whose charge is to be renewed, having come to its bottom dead centre.
    peaks : ndarray
        Greatest values of the stroke, in the order of the layout.
    strokes, events : list of tuple
        Rows of the results.
    """

    engine: Engine
    t: float
    y: np.ndarray
    machine: EngineState
    chambers: list[ChamberState]
    totals: list[StrokeTotals]
    x_dead_centre: float
    t_dead_centre: float = 0.0
    earlier_fuel: float = 0.0
    earlier_speed_squared: float = 0.0
    renewal_due: set[int] = field(default_factory=set)
    peaks: np.ndarray = field(default_factory=lambda: np.zeros(layout.N_PEAKS))
    strokes: list[np.ndarray] = field(default_factory=list)
    events: list[tuple[Any, ...]] = field(default_factory=list)

    @classmethod
    def started(cls, engine: Engine, motored: bool = False) -> RunningEngine:
        """Engine at time zero, as its start law has it."""
        start = engine.start.initial(engine)
        contents = (start.left, start.right)
        frame_moves = "frame" in engine.frame.states
        has_states = frame_moves or any(chamber.states for chamber in engine.chambers)
        y = np.zeros(layout.N_ALL if has_states else QUADRATURES + layout.N_QUADRATURES)
        y[POSITION], y[VELOCITY] = start.x, start.v
        y[PRESSURE : PRESSURE + 2] = [held.pressure for held in contents]
        y[MOTORED_PRESSURE : MOTORED_PRESSURE + 2] = y[PRESSURE : PRESSURE + 2]
        chambers = chamber_states(engine, start)
        mass = float(engine.translator.mass)
        speed = start.mean_piston_speed
        machine = EngineState(mass, engine.back_force, float(motored), start.stroke, speed)
        machine.frame_moves = float(frame_moves)
        totals = [StrokeTotals(), StrokeTotals()]
        x = start.x if start.at_dead_centre else math.nan
        self = cls(engine, 0.0, y, machine, chambers, totals, x)
        for side in (0, 1):
            fill(engine, chambers, y, side)
        before = stroke_before(engine, start, self.piston_area)
        self._hold(before)
        for side, held in enumerate(contents):
            chambers[side].time_to_dead_centre = before.duration
            if held.burning and held.fuel > 0.0:
                self.ignite(side)
        acceleration = self.rates()[VELOCITY]
        machine.direction = float(np.sign(start.v) or np.sign(acceleration))
        return self

    @property
    def piston_area(self) -> float:
        """Mean area of the two pistons [m^2]."""
        return 0.5 * (self.chambers[0].area + self.chambers[1].area)

    def rates(self) -> list[float]:
        """Rates of the present state and of all quadratures."""
        dy = [0.0] * len(self.y)
        rates(self.engine, self.machine, self.chambers, self.t, self.y.tolist(), dy)
        return dy

    def pressure(self, side: int) -> float:
        """Pressure in a chamber [Pa], now."""
        return pressure_in(self.engine, self.chambers, side, self.y.tolist())

    def gas(self, side: int) -> Gas:
        """Gas in a closed chamber, now."""
        p = self.pressure(side)
        return gas_in(self.machine, self.chambers, side, self.y.tolist(), p)

    def charge(self, side: int) -> Charge:
        """Charge in a chamber, now."""
        return charge_in(self.machine, self.chambers, side, self.y.tolist())

    def clearance(self, side: int) -> float:
        """Clearance between crown and head [m]."""
        c = self.chambers[side]
        return c.half_stroke + c.sign * float(self.y[POSITION])

    def beyond_port(self, side: int) -> float:
        """Distance of the crown beyond its ports [m]; minus infinity without ports."""
        return self.clearance(side) - self.chambers[side].port

    def next_corner(self, side: int) -> float:
        """Clearance at which an area of the ports next has a corner [m]; infinite if none has."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        if not c.by_flow or self.machine.direction == 0.0:
            return math.inf
        assert isinstance(chamber, Cylinder)
        outward = 1.0 if self.is_expanding(side) else -1.0
        beyond = self.beyond_port(side) + outward * CORNER_SLACK * c.half_stroke
        return c.port + chamber.gas_exchange.next_breakpoint(beyond, outward)

    def temperature(self, side: int) -> float:
        """Temperature [K]; that of the intake while open ports hold it there."""
        if is_held_open(self.chambers, side):
            return self.chambers[side].intake_temperature
        return self.gas(side).T

    def internal_energy(self, side: int) -> float:
        """Internal energy of the charge [J], and of the gas in its crankcase."""
        if self.chambers[side].breathes:
            return float(self.y[ENERGY + side] + self.y[CRANKCASE_ENERGY + side])
        chamber = self.engine.chambers[side]
        if not isinstance(chamber, GasChamber):
            return 0.0
        law = chamber.gas_properties
        return float(self.chambers[side].mass * law.internal_energy(self.temperature(side)))

    def burnt_so_far(self, side: int) -> float:
        """Fuel burnt since ignition that the masses do not show yet [kg]."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        if c.mode != layout.BURNING or (c.breathes and c.duration > 0.0):
            return 0.0
        assert isinstance(chamber, CombustionChamber)
        u = min((self.t - c.t_ignition) / c.duration, 1.0) if c.duration > 0.0 else 1.0
        share = chamber.heat_release.burnt_fraction(u)
        return share * c.heat / chamber.fuel.lower_heating_value

    def record(self, kind: int, side: int) -> None:
        """Append a row to the table of events."""
        x, v = float(self.y[POSITION]), float(self.y[VELOCITY])
        self.events.append((self.t, kind, side, x, v, self.pressure(side), self.temperature(side)))

    # Changes of a chamber.

    def change_chambers(self) -> None:
        """Carry out all changes that are due, one after the other."""
        take_contents(self.chambers, self.y)
        for side in (0, 1):
            while self._change(side):
                pass

    def _change(self, side: int) -> bool:
        """Carry out one change that is due; whether there was one."""
        due = {
            layout.EVENT_END_OF_COMBUSTION: (self._has_burnt, self.end_combustion),
            layout.EVENT_CHARGE_RENEWAL: (self.renewal_due.__contains__, self.renew_charge),
            layout.EVENT_INJECTION: (self._is_injecting, self.inject),
            layout.EVENT_IGNITION: (self._is_lit, self.ignite),
            layout.EVENT_MISFIRE: (self._has_misfired, self.misfire),
            layout.EVENT_PORT_CLOSING: (self._is_closing, self.close_ports),
            layout.EVENT_PORT_OPENING: (self._is_opening, self.open_ports),
        }
        for kind, (is_due, change) in due.items():
            if is_due(side):
                self.record(kind, side)
                change(side)
                return True
        return False

    def is_expanding(self, side: int) -> bool:
        """Whether a chamber grows in the present stroke."""
        return self.chambers[side].sign * self.machine.direction > 0.0

    def _has_burnt(self, side: int) -> bool:
        c = self.chambers[side]
        return c.mode == layout.BURNING and self.t >= c.t_ignition + c.duration

    def _has_misfired(self, side: int) -> bool:
        due = self.chambers[side].armed in (layout.ARMED, layout.FAILING)
        return due and self.is_expanding(side)

    def _is_lit(self, side: int) -> bool:
        armed, chamber = self.chambers[side].armed, self.engine.chambers[side]
        if armed == layout.ARMED and self.is_expanding(side):  # a dead centre has been passed
            assert isinstance(chamber, CombustionChamber)
            return chamber.ignition.lights_at_dead_centre(self.charge(side)) > 0.0
        return armed > layout.DISARMED and bool(self.y[INTEGRAL + side] >= 1.0)

    def _is_closing(self, side: int) -> bool:
        reached = self.beyond_port(side) <= SLACK * self.chambers[side].half_stroke
        inward = self.machine.direction != 0.0 and not self.is_expanding(side)
        return self.chambers[side].mode == layout.OPEN and inward and reached

    def _is_opening(self, side: int) -> bool:
        reached = self.beyond_port(side) >= -SLACK * self.chambers[side].half_stroke
        return self.chambers[side].mode != layout.OPEN and self.is_expanding(side) and reached

    def injection_comes(self, side: int) -> bool:
        """Whether fuel is injected into a chamber on its way in."""
        c = self.chambers[side]
        inward = self.machine.direction != 0.0 and not self.is_expanding(side)
        return c.injection_due > 0.0 and c.mode == layout.CLOSED and inward

    def _is_injecting(self, side: int) -> bool:
        c = self.chambers[side]
        reached = self.clearance(side) - c.injection_place <= CORNER_SLACK * c.half_stroke
        return self.injection_comes(side) and reached

    def misfire(self, side: int) -> None:
        """The piston has turned before the charge lit: it no longer may, or only late."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        if c.armed == layout.ARMED and chamber.late_ignition > 0.0:
            c.armed = layout.LATE
        else:
            c.armed = layout.DISARMED
            self.y[INTEGRAL + side] = 0.0

    def ignite(self, side: int) -> None:
        """Begin to release the heat of what fuel and air can burn."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        gas, charge = self.gas(side), self.charge(side)
        c.duration = chamber.heat_release.duration(gas, charge)
        c.duration *= self.engine.scatter.duration_factor(c.number, float(side))
        burnable = min(c.fuel, c.air / chamber.fuel.air_fuel_ratio)
        burnable *= chamber.completeness.share(gas, charge)
        c.heat = chamber.combustion_efficiency * burnable * chamber.fuel.lower_heating_value
        c.mode, c.armed, c.t_ignition, c.mass_lit = layout.BURNING, 0.0, self.t, c.mass
        self.totals[side].ignition_time = self.t
        self.totals[side].ignition_height = self.clearance(side)
        self.totals[side].combustion_duration = c.duration
        if c.duration <= 0.0:
            self.burn_at_once(side)
            self.end_combustion(side)

    def bound_phase(self, side: int) -> None:
        """Find the breakpoints of the burn rate that the present phase lies between."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        law, u = chamber.heat_release, (self.t - c.t_ignition) / c.duration
        reached, ahead = law.next_breakpoint(u - PHASE_SLACK), law.next_breakpoint(u + PHASE_SLACK)
        c.first_phase = math.nextafter(reached, 1.0) if reached <= u + PHASE_SLACK else 0.0
        c.last_phase = math.nextafter(ahead, 0.0) if ahead < 1.0 else 1.0

    def burn_at_once(self, side: int) -> None:
        """Release all heat at constant volume: the temperature rises by as much as it takes."""
        from scipy.optimize import brentq

        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        heat = c.heat * chamber.heat_release.burnt_fraction(1.0)
        self.y[QUADRATURES + layout.HEAT_RELEASED + side] += heat
        if c.breathes:
            self.y[ENERGY + side] += heat
            return
        energy, T = chamber.gas_properties.internal_energy, self.gas(side).T
        wanted = energy(T) + heat / c.mass
        max_temperature = T + (wanted - energy(T)) / c.gas_constant
        self.y[PRESSURE + side] *= brentq(lambda hot: energy(hot) - wanted, T, max_temperature) / T

    def end_combustion(self, side: int) -> None:
        """Turn fuel and stoichiometric air into burnt gas, as far as they have burnt."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        fuel = self.burnt_so_far(side)
        air = chamber.fuel.air_fuel_ratio * fuel
        c.fuel, c.air, c.burnt = c.fuel - fuel, c.air - air, c.burnt + fuel + air
        c.mode = layout.CLOSED
        if c.breathes:
            put_masses(c, self.y, side)

    def open_ports(self, side: int) -> None:
        """Pressure and temperature become those of the intake, or gas begins to flow."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, Cylinder)
        before = self.internal_energy(side)
        if c.mode == layout.BURNING:
            self.end_combustion(side)
        c.mode, c.armed, c.injection_due = layout.OPEN, 0.0, 0.0
        self.y[INTEGRAL + side] = 0.0
        c.fuel_factor = self.engine.scatter.fuel_factor(c.number + 1.0, float(side))
        if c.by_flow:
            self.y[layout.FRESH + side] = 0.0
            return
        put_state(chamber, c, self.y, side, chamber.intake.pressure, chamber.intake.temperature)
        self.totals[side].exhaust_energy += before - self.internal_energy(side)

    def close_ports(self, side: int) -> None:
        """Compose the fresh charge at the state of the intake, or trap what is there."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, Cylinder)
        if c.by_flow:
            gas = self.gas(side)
            c.fresh = float(self.y[layout.FRESH + side])
            self.y[MOTORED_PRESSURE + side] = gas.p
            self._trap(side, gas.p, gas.T)
            return
        p, T = chamber.intake.pressure, chamber.intake.temperature
        before = self.internal_energy(side)
        c.mass = self.mass_that_fits(side, p, T)
        self._compose(side, p, T)
        self.totals[side].exhaust_energy += before - self.internal_energy(side)

    def renew_charge(self, side: int) -> None:
        """Put a fresh charge of the same mass on the curve through the midpoint state."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, SealedCylinder)
        if c.mode == layout.BURNING:
            self.end_combustion(side)
        self.renewal_due.discard(side)
        before = self.internal_energy(side)
        p = chamber.pressure * (self.clearance(side) / c.half_stroke) ** -chamber.curve_exponent
        if c.breathes:  # what has leaked is made good
            c.mass = c.mass_trapped
        T = p * c.area * self.clearance(side) / (c.mass * c.gas_constant)
        if c.follows:
            T = chamber.temperature * (p / chamber.pressure) ** (1.0 - 1.0 / chamber.curve_exponent)
            c.mass = self.mass_that_fits(side, p, T)
        self._compose(side, p, T)
        self.totals[side].exhaust_energy += before - self.internal_energy(side)

    def mass_that_fits(self, side: int, p: float, T: float) -> float:
        """Mass of a fresh charge at a pressure and a temperature [kg]."""
        from scipy.optimize import brentq

        c = self.chambers[side]
        wanted = p * c.area * self.clearance(side) / T
        if not c.follows:
            return wanted / c.gas_constant

        def lacking(mass: float) -> float:
            fuel, air, burnt, _ = self._metered(side, mass)
            held = fuel * c.fuel_constant + air * c.air_constant + burnt * c.burnt_constant
            return held - wanted

        return float(brentq(lacking, 0.0, 2.0 * wanted / c.gas_constant, xtol=1e-19, rtol=1e-14))

    def _metered(self, side: int, mass: float) -> tuple[float, float, float, float]:
        """Fuel, air, burnt gas and fresh fuel of the coming charge [kg], of a mass."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        wanted = chamber.equivalence_ratio
        wanted *= self.engine.scatter.fuel_factor(c.number + 1.0, float(side))
        if c.injection_place > 0.0:
            wanted = 0.0
        return chamber.gas_exchange.charge(
            mass, c.fuel, c.air, c.burnt, wanted, chamber.fuel.air_fuel_ratio
        )

    def _compose(self, side: int, p: float, T: float) -> None:
        """Make the charge of what was retained and what is metered now."""
        c, chamber, totals = self.chambers[side], self.engine.chambers[side], self.totals[side]
        assert isinstance(chamber, CombustionChamber)
        fuel_before = c.fuel
        c.fuel, c.air, c.burnt, fresh = self._metered(side, c.mass)
        put_state(chamber, c, self.y, side, p, T)
        self._trap(side, p, T)
        exhausted = fuel_before + fresh - c.fuel
        totals.fresh_fuel_energy += fresh * chamber.fuel.lower_heating_value
        totals.exhaust_fuel_energy += exhausted * chamber.fuel.lower_heating_value

    def _trap(self, side: int, p: float, T: float) -> None:
        """Take what stands in a chamber for its charge from now on."""
        c = self.chambers[side]
        c.mode, c.number = layout.CLOSED, c.number + 1.0
        self._note(side, p, T)
        if c.injection_place > 0.0:
            c.trapped, c.trapped_temperature = p * c.V_closing / (c.gas_constant * T), T
            c.injection_due, c.armed, self.y[INTEGRAL + side] = 1.0, layout.DISARMED, 0.0
        else:
            self._arm(side)

    def inject(self, side: int) -> None:
        """Add the fuel that the air is to have: masses and energies before and after are equal."""
        from scipy.optimize import brentq

        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        T, pressure = self.temperature(side), self.pressure(side)
        ratio = chamber.equivalence_ratio * self.engine.scatter.fuel_factor(c.number, float(side))
        fuel = max(ratio * c.air / chamber.fuel.air_fuel_ratio - c.fuel, 0.0)
        before, moles = energy_held(chamber, c, T), c.mass * c.constant_now
        brought = fuel * specific_enthalpy_of_fuel(chamber)
        c.fuel, c.mass, c.injection_due = c.fuel + fuel, c.mass + fuel, 0.0
        mixed = brentq(
            lambda mixed: energy_held(chamber, c, mixed) - before - brought,
            0.2 * T,
            2.0 * T,
            xtol=1e-12,
            rtol=1e-15,
        )
        p = pressure * c.mass * c.constant_now * mixed / (moles * T)
        put_state(chamber, c, self.y, side, p, mixed)
        totals = self.totals[side]
        totals.fresh_fuel_energy += fuel * chamber.fuel.lower_heating_value
        totals.exhaust_energy -= brought
        self._note(side, p, mixed)
        self._arm(side)

    def _note(self, side: int, p: float, T: float) -> None:
        """Note the state a charge has as its ports close, or as its fuel is injected."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        ratio = chamber.fuel.air_fuel_ratio
        c.equivalence_ratio = ratio * c.fuel / c.air if c.fuel > 0.0 else 0.0
        c.p_closing, c.T_closing, c.V_closing = p, T, c.area * self.clearance(side)
        speed = self.machine.mean_piston_speed
        lasts = self.machine.stroke / speed if speed > 0.0 else math.inf
        c.time_to_dead_centre = self.t_dead_centre + lasts - self.t

    def _arm(self, side: int) -> None:
        """Let a charge light from now on."""
        c, chamber = self.chambers[side], self.engine.chambers[side]
        assert isinstance(chamber, CombustionChamber)
        c.armed = layout.ARMED if c.fuel > 0.0 else layout.DISARMED
        if c.armed == layout.ARMED and chamber.misfires.happens(c.number) > 0.0:
            c.armed = layout.FAILING
        factor = self.engine.scatter.delay_factor(c.number, float(side))
        self.y[INTEGRAL + side] = 1.0 - factor

    # Dead centres.

    def turn(self) -> None:
        """Dead centre: write the row of the stroke, let the regulators act, turn around."""
        take_contents(self.chambers, self.y)
        if math.isfinite(self.x_dead_centre) and self.t > self.t_dead_centre:
            self.strokes.append(self._stroke_row())
            self._regulate()
        elif math.isfinite(self.x_dead_centre):  # two at one instant: the translator is held
            self.machine.stroke = 0.0
        self.machine.direction = -self.machine.direction
        self.renewal_due = {
            side
            for side, chamber in enumerate(self.engine.chambers)
            if isinstance(chamber, SealedCylinder) and not self.is_expanding(side)
        }
        self.y[QUADRATURES : layout.FUEL] = self.y[layout.SUPPLIED :] = 0.0
        self.peaks[:] = 0.0
        self.totals = [StrokeTotals(), StrokeTotals()]
        self.x_dead_centre, self.t_dead_centre = float(self.y[POSITION]), self.t
        self.record(layout.EVENT_DEAD_CENTRE, 0 if self.machine.direction > 0.0 else 1)

    def _regulate(self) -> None:
        """Hand the finished stroke to the laws that act at a dead centre."""
        fuel = sum(totals.fresh_fuel_energy for totals in self.totals)
        fuel += sum(supplied_energy(c, self.y, side) for side, c in enumerate(self.chambers))
        squared = float(self.y[QUADRATURES + layout.SPEED_SQUARED])
        stroke = Stroke(
            length=abs(float(self.y[POSITION]) - self.x_dead_centre),
            duration=self.t - self.t_dead_centre,
            maximum=self.engine.maximum_stroke,
            half_maximum=0.5 * self.engine.maximum_stroke,
            piston_area=self.piston_area,
            fuel_energy=fuel + self.earlier_fuel,
            speed_squared=squared + self.earlier_speed_squared,
            x_left=min(float(self.y[POSITION]), self.x_dead_centre),
            x_right=max(float(self.y[POSITION]), self.x_dead_centre),
        )
        self.earlier_fuel, self.earlier_speed_squared = fuel, squared
        self.machine.stroke = stroke.length
        self.machine.mean_piston_speed = stroke.length / stroke.duration
        self._hold(stroke, self.machine.load_weight, self.machine.friction_held)

    def _hold(self, stroke: Stroke, load: float = -1.0, friction: float = -1.0) -> None:
        """Hand a stroke to alternator and friction, which act at dead centres."""
        self.machine.load_weight = self.engine.alternator.at_dead_centre(load, stroke)
        self.machine.friction_held = self.engine.friction.at_dead_centre(friction, stroke)

    def _stroke_row(self) -> np.ndarray:
        """Row of the stroke that ends here."""
        row = np.zeros(1, layout.STROKE_RECORD)
        x = float(self.y[POSITION])
        motion = Motion(self.t, x, 0.0, self.machine.direction)
        row["t"], row["duration"] = self.t, self.t - self.t_dead_centre
        row["x_start"], row["x_end"] = self.x_dead_centre, x
        for name in ("direction", "load_weight", "friction_held"):
            row[name] = getattr(self.machine, name)
        for name in _TOTALS:
            row[name] = self.y[QUADRATURES + getattr(layout, name.upper())]
        for name in _TOTALS_PER_SIDE:
            first = QUADRATURES + getattr(layout, name.upper())
            row[name] = self.y[first : first + 2]
        for name in ("pressure", "temperature", "pressure_rise"):
            first = getattr(layout, f"PEAK_{name.upper()}")
            row[f"peak_{name}"] = self.peaks[first : first + 2]
        row["peak_velocity"] = self.peaks[layout.PEAK_VELOCITY]
        row["peak_acceleration"] = self.peaks[layout.PEAK_ACCELERATION]
        behind = self.machine.back_force * x
        row["spring_energy"] = self.engine.springs.energy(motion) - behind
        if self.machine.frame_moves:
            row["frame_energy"], row["mount_loss"] = self._energy_of_frame()
        row["equivalence_ratio"], row["intake_temperature"] = ratings(self.engine)
        for side in (0, 1):
            for name, value in vars(self.totals[side]).items():
                row[name][0, side] = value
            c = self.chambers[side]
            row["charge_mass"][0, side] = c.mass
            row["wall_temperature"][0, side] = c.wall_temperature
            row["internal_energy"][0, side] = self.internal_energy(side)
            row["fuel_energy"][0, side] = self._fuel_energy(side)
            if c.breathes:
                write_passed(c, self.y, side, row[0])
        return row

    def _energy_of_frame(self) -> tuple[float, float]:
        """Energy of the frame, its mounts and what it carries, and heat in the mounts [J]."""
        x, v = (float(self.y[n]) for n in (layout.FRAME_X, layout.FRAME_V))
        carried = 0.5 * self.machine.mass * v**2
        return self.engine.frame.energy(x, v) + carried, float(self.y[layout.MOUNT_LOSS])

    def _fuel_energy(self, side: int) -> float:
        """Lower heating value of the unburnt fuel in a chamber [J]."""
        chamber = self.engine.chambers[side]
        if not isinstance(chamber, CombustionChamber):
            return 0.0
        left = self.chambers[side].fuel - self.burnt_so_far(side)
        return left * chamber.fuel.lower_heating_value
