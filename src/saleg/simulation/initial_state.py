"""From an engine to the numbers a run begins with."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from saleg.columns import log, sqrt
from saleg.compiler.compiled_engine import check_methods
from saleg.engine import CombustionChamber, Cylinder, GasChamber, OpenEnd, SealedCylinder
from saleg.engine.start import Contents
from saleg.errors import LawError, SalegError, StartError
from saleg.kernel import layout
from saleg.kernel.charges import ignite
from saleg.kernel.rhs import gas_of, rates_of_motion, refresh, rhs
from saleg.laws.arguments import Motion, Stroke
from saleg.laws.base import Alternator, Supply
from saleg.simulation.faulty_law import Fault, asked

if TYPE_CHECKING:
    from saleg.engine import Chamber, Engine


#: What of the kernel sets up a run.
KERNEL = SimpleNamespace(
    refresh=refresh, ignite=ignite, gas_of=gas_of, rates_of_motion=rates_of_motion
)


@dataclass
class State:
    """Everything that changes during a run.

    Attributes
    ----------
    engine, chambers : ndarray
        Records of :mod:`saleg.kernel.layout`, shapes (1,) and (2,).
    y : ndarray, shape (N_ALL,)
        State vector and quadratures.
    peaks : ndarray, shape (N_PEAKS,)
        Greatest values of the present stroke.
    """

    engine: Any
    chambers: Any
    y: np.ndarray
    peaks: np.ndarray

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return float(self.engine["t"][0])

    @property
    def records(self) -> tuple[Any, Any]:
        """Records of engine and chambers as the kernel's plain functions read and write them."""
        return self.engine.view(np.recarray)[0], self.chambers.view(np.recarray)

    def copy(self) -> State:
        """Another state of the same numbers, peaks forgotten."""
        parts = (self.engine.copy(), self.chambers.copy(), self.y.copy())
        return State(*parts, np.zeros(layout.N_PEAKS))


def prepare(engine: Engine) -> State:
    """State of an engine at the beginning of a run, as its start law has it.

    Raises
    ------
    LawError
        If a law cannot become part of a kernel, or gives no number.
    StartError
        If a law overflows or divides by zero there.
    """
    engine.check_laws()
    check_methods(engine.laws.values())
    try:
        return _prepare(engine)
    except SalegError:
        raise
    except Exception as error:
        fault = _fault_of(engine)
        if isinstance(error, (ArithmeticError, ValueError)):
            raise StartError(
                f"a law cannot be evaluated at the start ({fault or error}): check its "
                "parameters, or begin with another start"
            ) from error
        if fault:
            raise LawError(fault) from error
        raise


def _fault_of(engine: Engine) -> str:
    """Method of a law that keeps an engine from starting; empty if none does."""
    try:
        _prepare(asked(engine))
    except Fault as fault:
        return str(fault)
    except (ArithmeticError, ValueError):  # not a law's
        return ""
    return ""


def _prepare(engine: Engine) -> State:
    """Numbers a run begins with, packed as the kernel takes them."""
    E, C, y = initial_numbers(engine, KERNEL)
    rhs(engine, E, C, 0.0, y, [0.0] * layout.N_ALL, 0)  # asks all laws, so that one may fail here
    return State(
        np.array([tuple(vars(E).values())], layout.ENGINE_RECORD),
        np.array([tuple(vars(c).values()) for c in C], layout.CHAMBER_RECORD),
        np.array(y),
        np.zeros(layout.N_PEAKS),
    )


def initial_numbers(engine: Engine, kernel: Any) -> tuple[Any, list[Any], list[Any]]:
    """Fill plain objects and let the kernel's own functions work on them.

    Parameters
    ----------
    engine : Engine
    kernel : namespace
        Its functions, as in :data:`KERNEL`.

    Returns
    -------
    Engine, chambers and state vector.
    """
    start = engine.start.initial(engine)
    E = SimpleNamespace(**dict.fromkeys(layout.ENGINE_RECORD.names or (), 0.0))
    C = [SimpleNamespace(**dict.fromkeys(layout.CHAMBER_RECORD.names or (), 0.0)) for _ in "lr"]
    y = [0.0] * layout.N_ALL
    y[layout.X], y[layout.V] = start.x, start.v
    for side, contents in enumerate((start.left, start.right)):
        _fill_chamber(C[side], engine.chambers[side], engine.piston_areas[side], 1.0 - 2.0 * side)
        _fill_contents(C[side], contents, y, side)
        supply = getattr(engine.chambers[side], "supply", None)
        if supply is not None and "crankcase" in supply.states:
            _fill_crankcase(C[side], supply, y, side)
    _fill_engine(E, engine, start, C)
    kernel.refresh(engine, E, C, y)
    for side, contents in enumerate((start.left, start.right)):
        if contents.burning and contents.fuel > 0.0:
            kernel.ignite(engine, E, C, side, y, 0)
    E.direction = sign(y[layout.V]) or sign(_acceleration(engine, E, C, y, kernel))
    return E, C, y


def _acceleration(engine: Engine, E: Any, C: list[Any], y: list[Any], kernel: Any) -> Any:
    """Acceleration of the translator [m/s^2]."""
    gas_force = 0.0
    for side, c in enumerate(C):
        is_open = c.mode == layout.OPEN
        p = c.intake_pressure if is_open else kernel.gas_of(E, C, side, y, 0).p
        gas_force = gas_force + c.sign * c.area * p
    dy = [0.0] * layout.N_ALL
    kernel.rates_of_motion(engine, E, 0.0, y, dy, gas_force + E.back_force)
    return dy[layout.V]


def natural_period(engine: Engine) -> float:
    """Period of a small oscillation about the midpoint [s], for scales only."""
    stiffness = _stiffness(engine, 0.5 * engine.maximum_stroke)
    return 2.0 * math.pi * math.sqrt(engine.translator.mass / stiffness)


def sign(value: float) -> float:
    """-1, 0 or 1 [-]."""
    if value == 0.0:
        return 0.0
    return -1.0 if value < 0.0 else 1.0


def _fill_engine(E: Any, engine: Engine, start: Any, C: Any) -> None:
    length = 0.5 * engine.maximum_stroke
    E.mass = engine.translator.mass
    E.back_force = engine.back_force
    E.length_scale = length
    E.speed_scale = length * sqrt(_stiffness(engine, length) / E.mass)
    E.maximum_stroke = engine.maximum_stroke
    E.stroke = start.stroke
    E.mean_piston_speed = start.mean_piston_speed
    E.x_dead_centre = start.x if start.at_dead_centre else math.nan
    E.next_step = 1e-3 * length / E.speed_scale
    E.ln_last_error = -9.21
    moving = start.mean_piston_speed > 0.0
    guess = Stroke(
        length=start.stroke,
        duration=start.stroke / start.mean_piston_speed if moving else math.inf,
        maximum=engine.maximum_stroke,
        half_maximum=length,
        piston_area=0.5 * (C[0].area + C[1].area),
        fuel_energy=0.0,
        speed_squared=0.0,
        x_left=-0.5 * start.stroke,
        x_right=0.5 * start.stroke,
    )
    E.t_sample = math.inf
    for c in C:
        c.time_to_dead_centre = guess.duration
    E.load_weight = engine.alternator.at_dead_centre(-1.0, guess)
    E.friction_held = engine.friction.at_dead_centre(-1.0, guess)
    E.current_scale = current_scale(engine.alternator, E.load_weight, E.speed_scale)
    E.regulated_weight = E.load_weight
    held = engine.frame.acceleration(0.0, 1.0, 0.0) != 0.0
    E.frame_is_held = 1.0 if held else 0.0
    slowed = engine.frame.acceleration(0.0, 0.0, 1.0) != 0.0
    E.frame_is_slowed = 1.0 if held or slowed else 0.0
    _rate(E, C, engine)


def _rate(E: Any, C: Any, engine: Engine) -> None:
    """Note fuel and intake temperature the engine is built with, and how each side differs."""
    rated, temperature = ratings(engine)
    E.rated_equivalence_ratio = E.equivalence_ratio = rated
    E.rated_intake_temperature = E.intake_temperature = temperature
    for c in C:
        c.beside_rated_temperature = c.intake_temperature - temperature
        c.over_rated_fuel = c.equivalence_ratio_wanted / rated if rated > 0.0 else 1.0


def ratings(engine: Engine) -> tuple[float, float]:
    """Equivalence ratio [-] and intake temperature [K] an engine is built with.

    Means of the cylinders with fuel, so that they do not depend on the side; without any, of all
    cylinders, and without a cylinder of both chambers.
    """
    cylinders = [chamber for chamber in engine.chambers if isinstance(chamber, CombustionChamber)]
    fuelled = [cylinder for cylinder in cylinders if cylinder.equivalence_ratio > 0.0]
    counted: Sequence[Chamber] = fuelled or cylinders or engine.chambers
    ratio = sum(cylinder.equivalence_ratio for cylinder in fuelled) / len(counted)
    temperature = sum(chamber.reference_state.temperature for chamber in counted) / len(counted)
    return ratio, temperature


def current_scale(alternator: Alternator, load_weight: float, speed: float) -> float:
    """Current at which the alternator balances at some speed [m/s], in A; 1 if it has none."""
    weight = max(load_weight, 1.0)
    idle, loaded = (
        alternator.current_rate(weight, Motion(0.0, 0.0, speed, 1.0, current))
        for current in (0.0, 1.0)
    )
    return abs(idle / (idle - loaded)) if idle != 0.0 and idle != loaded else 1.0


def _stiffness(engine: Engine, length: float) -> float:
    """Stiffness around the midpoint [N/m], springs and gas, for scales only."""
    dx = 0.01 * length
    ahead, behind = (engine.springs.force(Motion(0.0, x, 0.0, 0.0)) for x in (dx, -dx))
    total = max(-(ahead - behind) / (2.0 * dx), 0.0)
    for chamber in engine.chambers:
        total += 1.35 * chamber.reference_state.pressure * chamber.area / chamber.half_stroke
    return total


def _fill_chamber(c: Any, chamber: Chamber, area: float, sign: float) -> None:
    c.sign = sign
    c.area = area
    c.half_stroke = chamber.half_stroke
    c.head_gap = chamber.head_gap
    c.ignition_time = -1.0
    if isinstance(chamber, GasChamber):
        c.bore = chamber.bore
        c.wall_temperature = chamber.wall_temperature
        gas = chamber.gas_properties
        c.gas_constant = gas.gas_constant
        c.follows = float(gas.follows_composition)
        c.fuel_constant, c.air_constant, c.burnt_constant = gas.gas_constants
    full = chamber.reference_state
    c.p_closing = c.intake_pressure = full.pressure
    c.T_closing = c.intake_temperature = full.temperature
    c.V_closing = c.area * full.clearance
    c.port = full.clearance if isinstance(chamber, Cylinder) else math.inf
    if isinstance(chamber, OpenEnd):
        c.port = 0.0  # it never closes
        c.wall_temperature = full.temperature  # by which a state nobody looks at is scaled
    c.breathes = float("contents" in chamber.states)
    if isinstance(chamber, Cylinder):
        c.by_flow = float("contents" in chamber.gas_exchange.states)
    c.air_fuel_ratio = c.fuel_factor = 1.0
    if isinstance(chamber, SealedCylinder):
        c.curve_exponent = chamber.curve_exponent
    if isinstance(chamber, CombustionChamber):
        c.equivalence_ratio_wanted = chamber.equivalence_ratio
        c.lower_heating_value = chamber.fuel.lower_heating_value
        c.air_fuel_ratio = chamber.fuel.air_fuel_ratio
        c.combustion_efficiency = chamber.combustion_efficiency
        c.late_ignition = chamber.late_ignition
        c.injection_place = chamber.injection.place


def _fill_contents(c: Any, contents: Contents, y: list[float], side: int) -> None:
    c.mode = layout.OPEN if contents.is_open else layout.CLOSED
    c.armed = layout.ARMED if contents.armed and contents.fuel > 0.0 else layout.DISARMED
    c.mass, c.fuel, c.air, c.burnt = contents.mass, contents.fuel, contents.air, contents.burnt
    c.equivalence_ratio = contents.fuel * c.air_fuel_ratio / max(contents.air, 1e-300)
    clearance = c.half_stroke + c.sign * y[layout.X]
    if c.curve_exponent > 0.0:  # its charge is closed where it stands
        c.p_closing, c.V_closing = contents.pressure, c.area * clearance
        c.T_closing = c.p_closing * c.V_closing / (c.mass * c.gas_constant)
    if c.injection_place > 0.0:
        closed = contents.armed and not contents.is_open
        c.injection_due = float(closed and clearance > c.injection_place)
        c.trapped_mass, c.trapped_temperature = contents.mass - contents.fuel, c.T_closing
    if c.by_flow and contents.is_open:  # at the state of the intake, as far as the piston is out
        share = clearance / c.port
        c.mass, c.fuel, c.air, c.burnt = (part * share for part in (c.mass, c.fuel, c.air, c.burnt))
    theta = log(contents.pressure) + layout.G0 * log(clearance / c.half_stroke)
    y[layout.THETA + side] = y[layout.MOTORED + side] = theta
    y[layout.WALL + side] = c.wall_temperature
    if c.breathes:
        c.air = c.mass - c.fuel - c.burnt  # all of it in a chamber that burns nothing
        y[layout.FUEL + side], y[layout.AIR + side], y[layout.BURNT + side] = c.fuel, c.air, c.burnt


def _fill_crankcase(c: Any, supply: Supply, y: list[Any], side: int) -> None:
    """Fill a crankcase at the state of the intake, wherever its piston is."""
    midpoint, volume = supply.volume(0.0), supply.volume(c.sign * y[layout.X])
    gas_constant, temperature = c.gas_constant, c.intake_temperature
    theta = log(c.intake_pressure) + layout.G0 * log(volume / midpoint)
    y[layout.CRANKCASE_THETA + side] = theta
    y[layout.CRANKCASE_MASS + side] = c.intake_pressure * volume / (gas_constant * temperature)
