"""Control (Chapter 5): engines under controllers, and the experiments of the dissertation."""

from saleg.control.dead_centre import DeadCentreControl, MisfireGuard, PowerAtDeadCentre
from saleg.control.demand import Demand
from saleg.control.experiments import (
    fuel_cut,
    misfire,
    misfires,
    motored,
    overload,
    rapid_start,
    recovery_time,
    start_up,
)
from saleg.control.following import (
    demand_by_fuel,
    demand_by_intake,
    demand_by_load,
    demand_by_map,
    follow_demand,
)
from saleg.control.load_feedback import Feedback
from saleg.control.maps import OperatingMap, fuel_map, intake_map, operating_grid, operating_map
from saleg.control.margin import ignition_margins, misfire_warning
from saleg.control.moments import (
    BusEnergy,
    StepResponse,
    bus_energy,
    bus_energy_over_time,
    first_misfire,
    fuel_cuts,
    late_ignitions,
    motored_times,
    ports_opened_at,
    step_response,
)
from saleg.control.operating_line import NoOperatingLine, OperatingLine, operating_line
from saleg.control.part_load import PartLoadMap, part_load_map
from saleg.control.plant import Plant
from saleg.control.plants import Plants
from saleg.control.running import (
    fired_at,
    generator,
    motor,
    motor_returns,
    simulate,
    simulate_many,
)
from saleg.control.sensors import Sensors
from saleg.control.tracking import trajectory_tracking

__all__ = [
    "BusEnergy",
    "DeadCentreControl",
    "Demand",
    "Feedback",
    "MisfireGuard",
    "NoOperatingLine",
    "OperatingLine",
    "OperatingMap",
    "PartLoadMap",
    "Plant",
    "Plants",
    "PowerAtDeadCentre",
    "Sensors",
    "StepResponse",
    "bus_energy",
    "bus_energy_over_time",
    "demand_by_fuel",
    "demand_by_intake",
    "demand_by_load",
    "demand_by_map",
    "fired_at",
    "first_misfire",
    "follow_demand",
    "fuel_cut",
    "fuel_cuts",
    "fuel_map",
    "generator",
    "ignition_margins",
    "intake_map",
    "late_ignitions",
    "misfire",
    "misfire_warning",
    "misfires",
    "motor",
    "motor_returns",
    "motored",
    "motored_times",
    "operating_grid",
    "operating_line",
    "operating_map",
    "overload",
    "part_load_map",
    "ports_opened_at",
    "rapid_start",
    "recovery_time",
    "simulate",
    "simulate_many",
    "start_up",
    "step_response",
    "trajectory_tracking",
]
