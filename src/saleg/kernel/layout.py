"""Where each number of a run lives: state vector, quadratures, records and codes."""

import numpy as np

from saleg.laws.arguments import Commands, ForceCommand, Instant, Signals

# Sides. Whole numbers of numpy's: for Python's own numba compiles each function once per value.
LEFT = np.int64(0)
RIGHT = np.int64(1)

# Modes of a chamber; they belong to the kernel, no law ever sees or sets them.
OPEN = 0
CLOSED = 1
BURNING = 2

# Whether a charge may light: not before its ports open again, in compression, at any time as it
# missed its dead centre, or not though it should.
DISARMED = 0
ARMED = 1
LATE = 2
FAILING = -1

# State vector: position, velocity; per side theta = ln p + G0 ln(h/L) (smooth where p is steep),
# ignition integral, and theta of the motored pressure; the current in the alternator.
X = 0
V = 1
THETA = 2
IGNITION = 4
MOTORED = 6
CURRENT = 8
N_STATE = 9
G0 = 1.33

# Quadratures, integrated beside the state and reset at every dead centre.
ALTERNATOR_WORK = 0
ELECTRICAL_ENERGY = 1
ELECTRICAL_SQUARED = 2
ALTERNATOR_IMPULSE = 3
FRICTION_WORK = 4
SPEED_SQUARED = 5
HEAT_RELEASED = 6
HEAT_LOST = 8
GAS_WORK = 10
PORT_WORK = 12
N_QUADRATURES = 14
N_PLAIN = N_STATE + N_QUADRATURES

# States of the chambers that some laws ask for, left and right: masses of fuel, air and burnt gas
# and of what has flowed in since the ports opened [kg]; temperature of the wall [K]; in the
# crankcase ln p + G0 ln(V/V_midpoint), mass and burnt gas in it [kg].
FUEL = 23
AIR = 25
BURNT = 27
FRESH = 29
WALL = 31
CRANKCASE_THETA = 33
CRANKCASE_MASS = 35
CRANKCASE_BURNT = 37
# Position and velocity of the frame [m, m/s], where it moves.
FRAME_X = 39
FRAME_V = 40
# What has passed since the dead centre, left and right: mass and fuel in through the intake; mass,
# fuel and fresh gas out, back into the intake too [kg]; enthalpy out, less that in, and work of
# the crankcase [J]; and heat in the mounts of the frame [J].
SUPPLIED = 41
SUPPLIED_FUEL = 43
EXPELLED = 45
EXPELLED_FUEL = 47
EXPELLED_FRESH = 49
ENTHALPY_OUT = 51
CRANKCASE_WORK = 53
MOUNT_LOSS = 55
N_ALL = 56
#: Those states by the names laws ask for them, as the first entry and the one after the last.
CHAMBER_STATES = {
    "contents": (FUEL, WALL),
    "wall_temperature": (WALL, CRANKCASE_THETA),
    "crankcase": (CRANKCASE_THETA, FRAME_X),
}

# Length of the vector a state at a dead centre is written as (see kernel/vector.py).
VECTOR_PER_SIDE = 19
N_VECTOR = 10 + 2 * VECTOR_PER_SIDE + 1

# Quantities whose greatest value in a stroke is kept.
PEAK_PRESSURE = 0
PEAK_TEMPERATURE = 2
PEAK_PRESSURE_RISE = 4
PEAK_VELOCITY = 6
PEAK_ACCELERATION = 7
N_PEAKS = 8

# Why the integrator came back.
GOES_ON = -1
BUFFER_FULL = 0
END_OF_TIME = 1
STALLED = 2
HEAD_CONTACT = 3
STEP_FAILURE = 4
TOO_MANY_STEPS = 5
NO_DEAD_CENTRE = 6
NOT_FOUND = 7
CONTROLLER_FAULT = 8
# Steps of the adaptive method in one stroke beyond which an engine is too stiff for it.
MAX_STEPS = 1_000_000.0

# Parts of an integration: all of it, what comes before the first step, the end of one step.
WHOLE = 0
BEGIN = 1
END_OF_STEP = 2

# Events, in the order they are looked for; from PORT on one per side, even for the left.
DEAD_CENTRE = 0
CORNER = 1
PORT = 2
LIGHT = 4
BREAKPOINT = 6
HEAD = 8
N_EVENTS = 10
# Kinds in the event table.
EVENT_DEAD_CENTRE = 0
EVENT_PORT_CLOSING = 1
EVENT_PORT_OPENING = 2
EVENT_IGNITION = 3
EVENT_END_OF_COMBUSTION = 4
EVENT_MISFIRE = 5
EVENT_HEAD_CONTACT = 6
EVENT_CHARGE_RENEWAL = 7
EVENT_MOTOR_ON = 8
EVENT_MOTOR_OFF = 9
EVENT_INJECTION = 10
EVENT_NAMES = (
    "dead centre",
    "port closing",
    "port opening",
    "ignition",
    "end of combustion",
    "misfire",
    "head contact",
    "charge renewal",
    "motor on",
    "motor off",
    "injection",
)

# Who commands: nobody, the parts compiled into the kernel, an object of the caller's.
UNCONTROLLED = 0
COMPILED = 1
IN_PYTHON = 2
# Parts of a controller that hold numbers, and how many each.
CONTROL_PARTS = 5
MEMORY = 4
# Those that act at samples, and how many numbers each.
SAMPLED_PARTS = 2
SAMPLE_MEMORY = 20

#: State of the engine beside the state vector, with what it needs at every evaluation.
ENGINE_RECORD = np.dtype(
    [
        (name, np.float64)
        for name in (
            "mass",
            "per_mass",
            "length_scale",
            "speed_scale",
            "current_scale",
            "maximum_stroke",
            "t",
            "direction",
            "mean_piston_speed",
            "stroke",
            "load_weight",
            "friction_held",
            "x_breakpoint",
            "x_dead_centre",
            "t_dead_centre",
            "last_fuel_energy",
            "last_speed_squared",
            "next_step",
            "ln_last_error",
            "jerk",
            "grid",
            "strokes",
            "steps_at_dead_centre",
            "steps",
            "rejected",
            "evaluations",
            "mass_fixed",
            "mass_per_stroke",
            "mass_per_work",
            "back_force",
            # 1 where position and velocity of the frame act on its motion.
            "frame_is_held",
            "frame_is_slowed",
        )
    ]
    # What the stroke just ended showed, and what is commanded (kernel/control.py):
    # `controlled` is UNCONTROLLED, COMPILED or IN_PYTHON.
    + [
        (name, np.float64)
        for name in (
            "stroke_duration",
            "power",
            "regulated_weight",
            "rated_equivalence_ratio",
            "rated_intake_temperature",
            "controlled",
            "fault",
            "t_command",
            "motoring",
            "motor_amplitude",
            "motor_frequency",
            "motor_sweep",
            "motor_phase",
            "equivalence_ratio",
            "intake_temperature",
            "asked_load_weight",
            "asked_amplitude",
            "asked_equivalence_ratio",
            "asked_intake_temperature",
        )
    ]
    + [("memory", np.float64, (CONTROL_PARTS * MEMORY,))]
    # Whether motor or commanded force stand in the place of the load; what else is commanded, and
    # the samples within the stroke: time of the next, infinite for none, and time between two.
    + [
        (name, np.float64)
        for name in (
            "is_driven",
            "sets_force",
            "force",
            "spark_advance",
            "spring_pressure",
            "t_sample",
            "sample_time",
        )
    ]
    + [("sample_memory", np.float64, (SAMPLED_PARTS * SAMPLE_MEMORY,))]
)

#: One chamber: geometry and intake, then what stands in it, then what the stroke has seen so far.
CHAMBER_RECORD = np.dtype(
    [("mode", np.int64), ("armed", np.int64)]
    + [
        (name, np.float64)
        for name in (
            "sign",
            "bore",
            "area",
            "half_stroke",
            "port",
            "head_gap",
            "wall_temperature",
            "intake_pressure",
            "intake_temperature",
            "equivalence_ratio_wanted",
            "lower_heating_value",
            "air_fuel_ratio",
            "combustion_efficiency",
            "late_ignition",
            "gas_constant",
            "mass",
            "fuel",
            "air",
            "burnt",
            "equivalence_ratio",
            "p_closing",
            "T_closing",
            "V_closing",
            "time_to_dead_centre",
            "t_ignition",
            "t_end",
            "duration",
            "fuel_to_burn",
            "fresh_fuel_energy",
            "exhaust_energy",
            "exhaust_fuel_energy",
            "ignition_time",
            "ignition_height",
            "charge_number",
        )
    ]
    # What stays the same between two events, kept to save computing it at every step.
    + [
        (name, np.float64)
        for name in (
            "per_half_stroke",
            "ln_volume",
            "ln_mass_gas",
            "per_mass_gas",
            "ln_breakpoint",
            "beyond_breakpoint",
            "first_phase",
            "last_phase",
            "t_breakpoint",
            "heat_first",
            "heat_second",
            "heat_third",
            "ignition_first",
            "ignition_second",
            "ignition_third",
        )
    ]
    # Exponent of the curve fresh charges lie on, 0 in a chamber that does not renew its charge at
    # bottom dead centre; whether that is due.
    + [(name, np.float64) for name in ("curve_exponent", "renewal_due")]
    # Intake temperature less the engine's rated one; equivalence ratio over the rated one.
    + [(name, np.float64) for name in ("beside_rated_temperature", "over_rated_fuel")]
    # Whether its masses are states, and gas flows through its ports; mass when lit; of what
    # flowed in since the ports opened, what was left when they closed.
    + [(name, np.float64) for name in ("breathes", "by_flow", "mass_lit", "fresh")]
    # Way by which the spark comes earlier for the charge in it and for the next one; pressure at
    # the midpoint to which a bounce chamber is to be filled, 0 for none.
    + [(name, np.float64) for name in ("spark_advance", "next_spark_advance", "wanted_pressure")]
    # Whether its gas changes with its composition, and the specific gas constants of its parts.
    + [
        (name, np.float64)
        for name in ("follows", "fuel_constant", "air_constant", "burnt_constant")
    ]
    # Fuel metered to the coming charge over that commanded.
    + [("fuel_factor", np.float64)]
    # Clearance at which fuel is injected into the closed chamber, 0 for none; whether that is to
    # come; mass and temperature as the ports closed, of a charge that had none yet.
    + [
        (name, np.float64)
        for name in ("injection_place", "injection_due", "trapped_mass", "trapped_temperature")
    ]
)

#: One row per stroke, written at the dead centre that ends it. Values per side are left, right.
STROKE_RECORD = np.dtype(
    [
        (name, np.float64)
        for name in (
            "t",
            "duration",
            "x_start",
            "x_end",
            "direction",
            "load_weight",
            "friction_held",
            "alternator_work",
            "electrical_energy",
            "electrical_squared",
            "alternator_impulse",
            "friction_work",
            "speed_squared",
            "peak_acceleration",
            "peak_velocity",
            "spring_energy",
            "frame_energy",
            "mount_loss",
            "motoring",
            "motor_amplitude",
            "motor_frequency",
            "equivalence_ratio",
            "intake_temperature",
        )
    ]
    + [
        (name, np.float64, (2,))
        for name in (
            "heat_released",
            "heat_lost",
            "gas_work",
            "port_work",
            "peak_pressure",
            "peak_temperature",
            "peak_pressure_rise",
            "fresh_fuel_energy",
            "exhaust_energy",
            "exhaust_fuel_energy",
            "fuel_energy",
            "internal_energy",
            "charge_mass",
            "ignition_time",
            "ignition_height",
            "combustion_duration",
            "fresh_mass",
            "closing_mass",
            "closing_temperature",
            "supplied_mass",
            "expelled_mass",
            "expelled_fresh",
            "crankcase_work",
            "wall_temperature",
        )
    ]
)

#: One row per event.
EVENT_RECORD = np.dtype(
    [("t", np.float64), ("kind", np.int64), ("side", np.int64)]
    + [(name, np.float64) for name in ("x", "v", "p", "T")]
)

#: One row of the history; values per side are left, right.
HISTORY_RECORD = np.dtype(
    [(name, np.float64) for name in ("t", "x", "v", "a")]
    + [
        (name, np.float64, (2,))
        for name in (
            "p",
            "T",
            "V",
            "p_rate",
            "p_motored",
            "heat_release",
            "heat_loss",
            "ignition",
            "mode",
            "mass",
            "burnt",
            "wall_temperature",
        )
    ]
    + [
        (name, np.float64)
        for name in (
            "spring_force",
            "friction_force",
            "alternator_force",
            "electrical_power",
            "load_weight",
            "current",
            "shaking_force",
            "frame_x",
            "frame_v",
        )
    ]
)

#: Numbers of rows filled in the tables of a run.
FILLED_RECORD = np.dtype([(name, np.int64) for name in ("strokes", "events", "history")])

#: What a controller is shown and what it asks for.
SIGNALS_RECORD = np.dtype([(name, np.float64) for name in Signals._fields])
COMMANDS_RECORD = np.dtype([(name, np.float64) for name in Commands._fields])
#: The same of its parts that act at samples.
INSTANT_RECORD = np.dtype([(name, np.float64) for name in Instant._fields])
FORCE_RECORD = np.dtype([(name, np.float64) for name in ForceCommand._fields])

#: How the search for a fixed point went: maps taken, how far the last image is from its point, how
#: many times that the fixed point may be away, and how far a whole cycle misses its start.
SEARCH_RECORD = np.dtype(
    [(name, np.float64) for name in ("maps", "residual", "slowness", "missed")]
)

#: What the caller asks of the integrator.
OPTIONS_RECORD = np.dtype(
    [
        ("adaptive", np.int64),
        ("motored", np.int64),
        ("peaks", np.int64),
        ("history", np.int64),
        ("dense", np.int64),
        ("events", np.int64),
        ("max_steps", np.int64),
        ("part", np.int64),
        ("aim", np.int64),
        ("t_end", np.float64),
        ("step", np.float64),
        ("tolerance", np.float64),
        ("stall", np.float64),
        ("last_stroke", np.float64),
        ("longest", np.float64),
        # Length and end of the one step whose end alone is asked for.
        ("length", np.float64),
        ("end", np.float64),
    ]
)
