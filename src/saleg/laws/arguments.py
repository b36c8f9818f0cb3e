"""What a law is shown: plain named tuples, SI units throughout.

The kernel fills them from its own variables; a law never sees how the kernel integrates.
"""

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
    height : float
        Distance from piston crown to cylinder head [m].
    bore : float
        Bore of the chamber [m].
    mean_piston_speed : float
        Mean piston speed of the latest stroke [m/s].
    wall_temperature : float
        Temperature of head, liner and crown [K].
    burning : float
        1 while heat is being released, otherwise 0.
    height_rate : float
        Rate of the height [m/s], negative in compression.
    p_rate : float
        Rate of the pressure [Pa/s]; shown to ignition laws only, 0 elsewhere.
    """

    p: float
    T: float
    V: float
    p_motored: float
    height: float
    bore: float
    mean_piston_speed: float
    wall_temperature: float
    burning: float
    height_rate: float = 0.0
    p_rate: float = 0.0


class Charge(NamedTuple):
    """What the chamber holds since its ports closed.

    Attributes
    ----------
    mass, fuel, air, burnt : float
        Mass of the whole charge and of its parts [kg].
    equivalence_ratio : float
        Of all fuel to all air in the charge [-].
    p, T, V : float
        State at port closing [Pa, K, m^3].
    swept_volume : float
        Volume swept by the latest stroke [m^3].
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


class Motion(NamedTuple):
    """Where the translator is.

    Attributes
    ----------
    t, x, v : float
        Time [s], position from the midpoint [m], velocity [m/s]; right is positive.
    direction : float
        +1 on the way right, -1 on the way left, 0 before the first movement. Unlike the sign of
        `v` it does not flicker at a dead centre.
    current : float
        Current in the alternator [A]; 0 unless its law has one.
    """

    t: float
    x: float
    v: float
    direction: float
    current: float = 0.0


class Stroke(NamedTuple):
    """What is known at a dead centre about the stroke that ends there.

    Attributes
    ----------
    length, duration : float
        Distance [m] and time [s] between the last two dead centres.
    maximum : float
        Greatest geometrically possible stroke [m].
    half_maximum : float
        Half of it, the neutral clearance length L [m].
    piston_area : float
        Mean area of the two pistons [m^2].
    fuel_energy : float
        Lower heating value of the fresh fuel of the last two strokes [J].
    speed_squared : float
        Time integral of the velocity squared over the last two strokes [m^2/s].
    """

    length: float
    duration: float
    maximum: float
    half_maximum: float
    piston_area: float
    fuel_energy: float
    speed_squared: float
