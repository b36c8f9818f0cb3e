"""Arguments of the laws: plain named tuples, SI units throughout.

The kernel fills them from its own variables; a law never sees how the kernel integrates.
"""

import math
from typing import NamedTuple


class Gas(NamedTuple):
    """State of the gas in one chamber at one instant.

    Attributes
    ----------
    p, T, V : float
        Pressure [Pa], temperature [K], volume [m^3].
    p_motored : float
        Pressure the charge would have without combustion [Pa]; equals `p` unless the run
        integrates the motored pressure.
    clearance : float
        Distance from piston crown to cylinder head [m].
    bore : float
        Bore of the chamber [m].
    mean_piston_speed : float
        Mean piston speed of the latest stroke [m/s].
    wall_temperature : float
        Temperature of head, liner and crown [K].
    burning : float
        1 while heat is being released, otherwise 0 [-].
    clearance_rate : float
        Rate of the clearance [m/s], negative in compression.
    p_rate : float
        Rate of the pressure [Pa/s]; shown to ignition laws only, 0 elsewhere.
    """

    p: float
    T: float
    V: float
    p_motored: float
    clearance: float
    bore: float
    mean_piston_speed: float
    wall_temperature: float
    burning: float
    clearance_rate: float = 0.0
    p_rate: float = 0.0


class Charge(NamedTuple):
    """Charge in a chamber since its ports closed.

    Attributes
    ----------
    mass, fuel, air, burnt : float
        Mass of the whole charge and of its parts [kg].
    equivalence_ratio : float
        Of all fuel to all air in the charge [-].
    p, T, V : float
        State at port closing; with direct injection, right after the injection [Pa, K, m^3].
    swept_volume : float
        Volume swept by the latest stroke [m^3].
    spark_advance : float
        Way by which a controller has the spark come earlier [m].
    time_to_dead_centre : float
        Time from there to the dead centre, if the present stroke lasts as long as the one before it
        did [s]; infinite while none has been.
    """

    mass: float
    fuel: float
    air: float
    burnt: float
    equivalence_ratio: float
    p: float
    T: float
    V: float
    swept_volume: float
    spark_advance: float = 0.0
    time_to_dead_centre: float = math.inf


class Parts(NamedTuple):
    """Parts of a gas, or their changes.

    Attributes
    ----------
    fuel, air, burnt : float
        Masses of fuel, air and stoichiometric burnt gas [kg], or their rates [kg/s].
    """

    fuel: float
    air: float
    burnt: float


class Motion(NamedTuple):
    """State of motion of the translator at one instant.

    Attributes
    ----------
    t, x, v : float
        Time [s], position from the midpoint [m], velocity [m/s]; right is positive.
    direction : float
        +1 on the way right, -1 on the way left, 0 before the first movement [-]. Unlike the sign
        of `v` it does not flicker at a dead centre.
    current : float
        Current in the alternator [A]; 0 unless its law has one.
    """

    t: float
    x: float
    v: float
    direction: float
    current: float = 0.0


class Stroke(NamedTuple):
    """Stroke that ends at a dead centre, as the regulating laws see it.

    Attributes
    ----------
    length, duration : float
        Distance [m] and time [s] between the last two dead centres.
    maximum : float
        Greatest geometrically possible stroke [m], see :attr:`saleg.Engine.maximum_stroke`.
    half_maximum : float
        Half of it, the neutral clearance length L [m].
    piston_area : float
        Mean area of the two pistons [m^2].
    fuel_energy : float
        Lower heating value of the fresh fuel of the last two strokes [J].
    speed_squared : float
        Time integral of the velocity squared over the last two strokes [m^2/s].
    x_left, x_right : float
        Positions of its two ends [m]; negative on the left of the midpoint.
    """

    length: float
    duration: float
    maximum: float
    half_maximum: float
    piston_area: float
    fuel_energy: float
    speed_squared: float
    x_left: float = math.nan
    x_right: float = math.nan


class Signals(NamedTuple):
    """Signals of a controller: measurements of the stroke just ended, and ratings.

    Attributes
    ----------
    t : float
        Time [s].
    x : float
        Position of the latest dead centre [m].
    direction : float
        +1 if the coming stroke goes right, -1 if left, 0 before the first movement [-].
    stroke : float
        Distance between the last two dead centres S [m].
    compression_ratio : float
        Geometric, between the last two dead centres: greatest over least volume of the cylinders
        together, ``(L + S/2) / (L - S/2)`` where they are alike [-].
    frequency : float
        ``1 / (2 x duration of the stroke)`` [Hz]; 0 before the first.
    power : float
        Mean electrical power over the stroke [W], negative where the motor drives.
    regulated_weight : float
        Load weight the alternator's own regulator (Eq. 59) asks for [-].
    motoring : float
        1 if the alternator is to be a motor in the coming stroke, else 0 [-]. The state logic
        itself is shown what it was so far.
    was_motoring : float
        1 if it was a motor in the stroke just ended, else 0 [-].
    maximum_stroke : float
        Greatest geometrically possible stroke [m], see :attr:`saleg.Engine.maximum_stroke`.
    rated_equivalence_ratio : float
        Equivalence ratio the engine is built with, the mean of the cylinders with fuel [-].
    rated_intake_temperature : float
        Intake temperature the engine is built with, the mean of theirs [K].
    x_left, x_right : float
        Positions of the last two dead centres [m]; negative on the left of the midpoint.
    compression_ratio_left, compression_ratio_right : float
        Geometric compression ratio between them of each chamber alone, by its own clearance [-].
    position : float
        Position of the translator now [m]: at a dead centre `x`, at a sample within the stroke
        where it has come to.
    """

    t: float
    x: float
    direction: float
    stroke: float
    compression_ratio: float
    frequency: float
    power: float
    regulated_weight: float
    motoring: float
    was_motoring: float
    maximum_stroke: float
    rated_equivalence_ratio: float
    rated_intake_temperature: float
    x_left: float = math.nan
    x_right: float = math.nan
    compression_ratio_left: float = math.nan
    compression_ratio_right: float = math.nan
    position: float = math.nan


class Drive(NamedTuple):
    """Force of the alternator as a motor: ``amplitude sin(angle)``, positive to the right.

    The angle is ``phase + 2 pi (frequency s + sweep s^2 / 2)``, s the time since the command.

    Attributes
    ----------
    amplitude : float
        Amplitude of the force [N].
    frequency : float
        Frequency at the time of the command [Hz].
    sweep : float
        Rate of the frequency [Hz/s].
    sets_phase : float
        1 to begin with `phase`, 0 to go on from the angle reached [-].
    phase : float
        Phase to begin with [rad].
    """

    amplitude: float
    frequency: float
    sweep: float
    sets_phase: float
    phase: float


class Commands(NamedTuple):
    """Commands of a controller, in force until its next ones.

    Attributes
    ----------
    motoring : float
        1 to drive the alternator as a motor, 0 to draw power [-].
    load_weight : float
        Load weight W [-], where it draws power.
    amplitude, frequency, sweep, sets_phase, phase : float
        See :class:`Drive` [N, Hz, Hz/s, -, rad].
    equivalence_ratio : float
        Of the charges composed from now on [-]; 0 cuts the fuel.
    intake_temperature : float
        Intake temperature [K].
    sets_force : float
        1 for `force` in the place of load and motor, whatever `motoring` says, else 0 [-].
    force : float
        Force of the alternator on the translator [N], positive to the right; its converter limits
        what comes of it.
    spark_advance : float
        Way by which a spark comes earlier than its law has it, later if negative [m].
    spring_pressure : float
        Pressure at the midpoint [Pa] to which bounce chambers are filled, or emptied; 0 leaves
        their gas in them.
    """

    motoring: float
    load_weight: float
    amplitude: float
    frequency: float
    sweep: float
    sets_phase: float
    phase: float
    equivalence_ratio: float
    intake_temperature: float
    sets_force: float = 0.0
    force: float = 0.0
    spark_advance: float = 0.0
    spring_pressure: float = 0.0


class Instant(NamedTuple):
    """Signals of a controller at a sample within the stroke.

    Attributes
    ----------
    t : float
        Time [s].
    x : float
        Position from the midpoint [m], as its sensor measures it; right is positive.
    sample_time : float
        Time since the sample before [s].
    motoring : float
        1 if the state logic has decided on a motor at the latest dead centre, else 0 [-].
    x_left, x_right : float
        Positions of the last two dead centres [m].
    frequency : float
        ``1 / (2 x duration of the latest stroke)`` [Hz]; 0 before the first.
    maximum_stroke : float
        Greatest geometrically possible stroke [m], see :attr:`saleg.Engine.maximum_stroke`.
    """

    t: float
    x: float
    sample_time: float
    motoring: float
    x_left: float
    x_right: float
    frequency: float
    maximum_stroke: float


class ForceCommand(NamedTuple):
    """Force of the alternator from one sample to the next.

    Attributes
    ----------
    sets_force : float
        1 for `force` in the place of load and motor, 0 to leave the alternator to what is
        commanded at dead centres [-].
    force : float
        Force on the translator [N], positive to the right.
    """

    sets_force: float
    force: float
