"""The slots as the kernel calls them, in plain Python: `P` is the engine itself.

In a composed module this file is replaced by the compiled laws and `P` is a record of their
numbers; the names and arguments are the same.
"""

from ctypes import CFUNCTYPE, c_void_p
from typing import Any

from saleg.kernel.logarithms import Logarithms
from saleg.laws.arguments import (
    Charge,
    Commands,
    Drive,
    ForceCommand,
    Gas,
    Instant,
    Motion,
    Parts,
    Signals,
    Stroke,
)


def _chamber(P: Any, side: int) -> Any:
    return P.left if side == 0 else P.right


def gas_properties_gamma(P: Any, side: int, T: float) -> float:
    """Ratio of specific heats."""
    return _chamber(P, side).gas_properties.gamma(T)


def gas_properties_internal_energy(P: Any, side: int, T: float) -> float:
    """Specific internal energy."""
    return _chamber(P, side).gas_properties.internal_energy(T)


def gas_properties_breakpoint(P: Any, side: int) -> float:
    """Temperature at which gamma is not smooth."""
    return _chamber(P, side).gas_properties.breakpoint()


def gas_properties_heat_capacity_of(P: Any, side: int, T: float, parts: Parts) -> float:
    """Heat capacity of parts of the gas."""
    return _chamber(P, side).gas_properties.heat_capacity_of(T, parts)


def gas_properties_energy_of(P: Any, side: int, T: float, parts: Parts) -> float:
    """Internal energy of parts of the gas, or its rate."""
    return _chamber(P, side).gas_properties.energy_of(T, parts)


def heat_transfer_coefficient(
    P: Any, side: int, gas: Gas, charge: Charge, logarithms: Logarithms | None = None
) -> float:
    """Heat-transfer coefficient."""
    return _chamber(P, side).heat_transfer.coefficient(gas, charge)


def heat_transfer_coefficient_constants(
    P: Any, side: int, gas: Gas, charge: Charge
) -> tuple[float, float, float]:
    """Constants of the reduced form of the law; the plain law needs none."""
    return 0.0, 0.0, 0.0


def heat_release_duration(P: Any, side: int, gas: Gas, charge: Charge) -> float:
    """Combustion duration."""
    return _chamber(P, side).heat_release.duration(gas, charge)


def heat_release_burn_rate(P: Any, side: int, u: float) -> float:
    """Burn rate."""
    return _chamber(P, side).heat_release.burn_rate(u)


def heat_release_burnt_fraction(P: Any, side: int, u: float) -> float:
    """Burnt fraction."""
    return _chamber(P, side).heat_release.burnt_fraction(u)


def heat_release_next_breakpoint(P: Any, side: int, u: float) -> float:
    """Next phase at which the burn rate is not smooth."""
    return _chamber(P, side).heat_release.next_breakpoint(u)


def ignition_rate(
    P: Any, side: int, gas: Gas, charge: Charge, logarithms: Logarithms | None = None
) -> float:
    """Rate of the ignition integral."""
    return _chamber(P, side).ignition.rate(gas, charge)


def ignition_rate_constants(
    P: Any, side: int, gas: Gas, charge: Charge
) -> tuple[float, float, float]:
    """Constants of the reduced form of the law; the plain law needs none."""
    return 0.0, 0.0, 0.0


def ignition_lights_at_dead_centre(P: Any, side: int, charge: Charge) -> float:
    """Whether the law lights a charge at dead centre."""
    return _chamber(P, side).ignition.lights_at_dead_centre(charge)


def misfires_happens(P: Any, side: int, charge_number: float) -> float:
    """Whether a charge fails to light."""
    return _chamber(P, side).misfires.happens(charge_number)


def completeness_share(P: Any, side: int, gas: Gas, charge: Charge) -> float:
    """Share of the fuel that burns."""
    return _chamber(P, side).completeness.share(gas, charge)


def gas_exchange_charge(
    P: Any,
    side: int,
    mass: float,
    fuel: float,
    air: float,
    burnt: float,
    equivalence_ratio: float,
    air_fuel_ratio: float,
) -> tuple[float, float, float, float]:
    """Composition of the charge at port closing."""
    law = _chamber(P, side).gas_exchange
    return law.charge(mass, fuel, air, burnt, equivalence_ratio, air_fuel_ratio)


def gas_exchange_areas(P: Any, side: int, opening: float) -> tuple[float, float]:
    """Effective areas of intake and exhaust."""
    return _chamber(P, side).gas_exchange.areas(opening)


def gas_exchange_exhaust(P: Any, side: int) -> tuple[float, float]:
    """Pressure and temperature beyond the exhaust."""
    return _chamber(P, side).gas_exchange.exhaust()


def gas_exchange_fresh_share(P: Any, side: int, share: float) -> float:
    """Share of fresh gas in what leaves through the ports."""
    return _chamber(P, side).gas_exchange.fresh_share(share)


def gas_exchange_next_breakpoint(P: Any, side: int, opening: float, direction: float) -> float:
    """Next opening at which an area is not smooth."""
    return _chamber(P, side).gas_exchange.next_breakpoint(opening, direction)


def injection_fuel_state(P: Any, side: int) -> tuple[float, float]:
    """Temperature and latent heat of the fuel injected."""
    return _chamber(P, side).injection.fuel_state()


def leak_area(P: Any, side: int, gas: Gas) -> float:
    """Effective area of a leak."""
    return _chamber(P, side).leak.area(gas)


def leak_beyond(P: Any, side: int) -> tuple[float, float]:
    """Pressure and temperature beyond a leak."""
    return _chamber(P, side).leak.beyond()


def supply_volume(P: Any, side: int, displacement: float) -> float:
    """Volume of the crankcase."""
    return _chamber(P, side).supply.volume(displacement)


def supply_piston_area(P: Any, side: int) -> float:
    """Area of the piston on the crankcase's side."""
    return _chamber(P, side).supply.piston_area()


def supply_inlet_area(P: Any, side: int, rise: float) -> float:
    """Effective area of the inlet of the crankcase."""
    return _chamber(P, side).supply.inlet_area(rise)


def wall_temperature_rate(P: Any, side: int, temperature: float, heat: float) -> float:
    """Rate of the temperature of the wall."""
    chamber = _chamber(P, side)  # an open end has no wall
    return chamber.wall.temperature_rate(temperature, heat) if hasattr(chamber, "wall") else 0.0


def springs_force(P: Any, motion: Motion) -> float:
    """Force of the springs."""
    return P.springs.force(motion)


def springs_energy(P: Any, motion: Motion) -> float:
    """Energy in the springs."""
    return P.springs.energy(motion)


def springs_next_breakpoint(P: Any, x: float, direction: float) -> float:
    """Next position at which the force of the springs has a corner."""
    return P.springs.next_breakpoint(x, direction)


def friction_at_dead_centre(P: Any, memory: float, stroke: Stroke) -> float:
    """Number the friction law remembers."""
    return P.friction.at_dead_centre(memory, stroke)


def friction_force(P: Any, memory: float, motion: Motion) -> float:
    """Friction force."""
    return P.friction.force(memory, motion)


def alternator_at_dead_centre(P: Any, load_weight: float, stroke: Stroke) -> float:
    """Load weight."""
    return P.alternator.at_dead_centre(load_weight, stroke)


def alternator_force(P: Any, load_weight: float, motion: Motion) -> float:
    """Alternator force."""
    return P.alternator.force(load_weight, motion)


def alternator_current_rate(P: Any, load_weight: float, motion: Motion) -> float:
    """Rate of the alternator's current."""
    return P.alternator.current_rate(load_weight, motion)


def alternator_electrical_power(P: Any, load_weight: float, motion: Motion) -> float:
    """Electrical power."""
    return P.alternator.electrical_power(load_weight, motion)


def alternator_next_breakpoint(P: Any, x: float, direction: float) -> float:
    """Next position at which the force of the alternator has a corner."""
    return P.alternator.next_breakpoint(x, direction)


def frame_acceleration(P: Any, force: float, x: float, v: float) -> float:
    """Acceleration of the frame."""
    return P.frame.acceleration(force, x, v)


def frame_transmitted(P: Any, force: float, x: float, v: float) -> float:
    """Force on what the frame stands on."""
    return P.frame.transmitted(force, x, v)


def frame_energy(P: Any, x: float, v: float) -> float:
    """Energy of the frame and in its mounts."""
    return P.frame.energy(x, v)


def frame_loss(P: Any, v: float) -> float:
    """Power that the mounts turn into heat."""
    return P.frame.loss(v)


def scatter_fuel_factor(P: Any, charge_number: float, side: float) -> float:
    """Fuel metered to a charge over that commanded."""
    return P.scatter.fuel_factor(charge_number, side)


def scatter_delay_factor(P: Any, charge_number: float, side: float) -> float:
    """Value that the ignition integral has to reach."""
    return P.scatter.delay_factor(charge_number, side)


def scatter_duration_factor(P: Any, charge_number: float, side: float) -> float:
    """Combustion duration over that of the burn law."""
    return P.scatter.duration_factor(charge_number, side)


def call_at(address: Any, numbers: int, memory: int, signals: int, commands: int) -> None:
    """Call a controller by its address; one of Python stands there itself."""
    entry = address if callable(address) else CFUNCTYPE(None, *[c_void_p] * 4)(address)
    entry(numbers, memory, signals, commands)


def state_logic_is_motor(P: Any, memory: Any, signals: Signals) -> float:
    """Whether the alternator is a motor."""
    return P.state_logic.is_motor(memory, signals)


def motor_control_drive(P: Any, memory: Any, signals: Signals) -> Drive:
    """Force of the motor."""
    return P.motor_control.drive(memory, signals)


def load_control_weight(P: Any, memory: Any, signals: Signals) -> float:
    """Load weight."""
    return P.load_control.weight(memory, signals)


def fuel_control_equivalence_ratio(P: Any, memory: Any, signals: Signals) -> float:
    """Equivalence ratio of the coming charge."""
    return P.fuel_control.equivalence_ratio(memory, signals)


def intake_control_temperature(P: Any, memory: Any, signals: Signals) -> float:
    """Intake temperature."""
    return P.intake_control.temperature(memory, signals)


def actuators_refused(P: Any, wanted: Commands) -> float:
    """Number of a command out of its limits."""
    return P.actuators.refused(wanted)


def actuators_follow(P: Any, actual: Commands, wanted: Commands, elapsed: float) -> Commands:
    """Where the actuators stand after some time."""
    return P.actuators.follow(actual, wanted, elapsed)


def actuators_motor_power(P: Any, mechanical: float) -> float:
    """Electrical power of the motor."""
    return P.actuators.motor_power(mechanical)


def converter_force(P: Any, wanted: float, v: float) -> float:
    """Force on the translator that comes of the one commanded."""
    return P.converter.force(wanted, v)


def converter_power(P: Any, force: float, v: float) -> float:
    """Power delivered to the DC bus."""
    return P.converter.power(force, v)


def position_sensor_measured(P: Any, memory: Any, x: float) -> float:
    """Position measured."""
    return P.position_sensor.measured(memory, x)


def force_control_push(P: Any, memory: Any, instant: Instant) -> ForceCommand:
    """Force until the next sample."""
    return P.force_control.push(memory, instant)
