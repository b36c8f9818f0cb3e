"""Eq. 60-67: dimensions and masses of the components, one function per equation (4.1).

Each takes numbers or arrays of them, and names every other argument in a
:class:`saleg.errors.WrongArguments`.
"""

from __future__ import annotations

import math

from saleg.checks import checked, numbers

#: What any length, mass or speed must be, and what something is divided by.
SOME = numbers(0.0)
MORE = numbers(0.0, open_low=True)
#: Specific thrust force of the alternator, f_xr [N/m^2] (Eq. 60).
SPECIFIC_THRUST = 1.32e4
#: Length of a bearing and the piston skirt next to it [m] (Eq. 63).
BEARING_LENGTH = 0.014
#: Length of the piston skirt [m] (Eq. 66).
SKIRT_LENGTH = 0.008
#: Cross-section of the connecting rod [m^2]; with 7800 kg/m^3 the 0.585 kg/m of Eq. 66.
ROD_AREA = 75e-6


@checked(
    power=SOME,
    pole_pitch=MORE,
    mean_speed=MORE,
    poles=MORE,
    specific_thrust=MORE,
    efficiency=MORE,
)
def alternator_diameter(
    power: float,
    pole_pitch: float,
    mean_speed: float,
    *,
    poles: float = 2.0,
    specific_thrust: float = SPECIFIC_THRUST,
    efficiency: float = 0.95,
) -> float:
    """Outer diameter D_o of the alternator mover [m] (Eq. 60).

    ``D_o = P / (pi m_r tau f_xr v eta)``.

    Parameters
    ----------
    power : float
        Electrical power P [W].
    pole_pitch : float
        Pole pitch tau [m]; the thesis sets it to the stroke.
    mean_speed : float
        Mean speed of the translator v [m/s].
    poles : float
        Number of poles m_r [-].
    specific_thrust : float
        Specific thrust force f_xr [N/m^2].
    efficiency : float
        Rated efficiency of the alternator eta [-].

    Returns
    -------
    float
        Diameter [m].

    Raises
    ------
    WrongArguments
        Naming every argument that is no number, or zero where something is divided by it.

    Examples
    --------
    >>> round(alternator_diameter(22.6e3, 0.1807, mean_speed(0.1807, 47.0)), 4)
    0.0935
    """
    return power / (math.pi * poles * pole_pitch * specific_thrust * mean_speed * efficiency)


@checked(stroke=SOME, frequency=SOME)
def mean_speed(stroke: float, frequency: float) -> float:
    """Mean speed of the translator [m/s] (Eq. 61): ``v = 2 S f``.

    Parameters
    ----------
    stroke : float
        Stroke S [m].
    frequency : float
        Cycles per second f [Hz].

    Returns
    -------
    float

    Examples
    --------
    >>> mean_speed(0.1, 50.0)
    10.0
    """
    return 2.0 * stroke * frequency


@checked(mover_half_length=SOME, half_stroke=SOME)
def bearing_position(mover_half_length: float, half_stroke: float) -> float:
    """Distance L_B from midpoint to inner rod bearing [m] (Eq. 62): ``L_B = L_A + L``.

    Parameters
    ----------
    mover_half_length : float
        Length L_A of the mover from the midpoint [m].
    half_stroke : float
        Neutral clearance length L [m].

    Returns
    -------
    float

    Examples
    --------
    >>> bearing_position(0.18, 0.1)
    0.28
    """
    return mover_half_length + half_stroke


@checked(bearing=SOME, crankcase=SOME)
def crown_position(bearing: float, crankcase: float = 0.0) -> float:
    """Distance L_P from midpoint to piston crown [m] (Eq. 63): ``L_P = L_B + 14 mm``.

    As printed the piston has no room before the bearing; the text asks for a clearance of L beneath
    it, and the masses of Table 9 say that it was there (docs/design.md).

    Parameters
    ----------
    bearing : float
        Distance L_B from midpoint to inner bearing [m].
    crankcase : float
        Clearance between bearing and piston [m]; 0 for the equation as printed.

    Returns
    -------
    float

    Examples
    --------
    >>> round(crown_position(0.28), 3)
    0.294
    """
    return bearing + crankcase + BEARING_LENGTH


@checked(port_location=SOME, half_stroke=SOME, crown=SOME)
def port_position(port_location: float, half_stroke: float, crown: float) -> float:
    """Distance L_po from midpoint to the opening edge of the ports [m] (Eq. 64).

    ``L_po = L_po% (2 L) + (L_P - L)``.

    Parameters
    ----------
    port_location : float
        Port location L_po% as a share of the maximum stroke, 0 at the greatest clearance, 1 at
        the head [-].
    half_stroke : float
        Neutral clearance length L [m].
    crown : float
        Distance L_P from midpoint to crown [m].

    Returns
    -------
    float

    Examples
    --------
    >>> port_position(0.5, 0.1, 0.294)
    0.294
    """
    return port_location * 2.0 * half_stroke + (crown - half_stroke)


@checked(port_location=SOME, half_stroke=SOME)
def port_clearance(port_location: float, half_stroke: float) -> float:
    """Clearance d_po between crown and head at which the ports close [m].

    ``d_po = 2 L (1 - L_po%)``, which is Eq. 64 seen from the head.

    Parameters
    ----------
    port_location : float
        Port location L_po% [-].
    half_stroke : float
        Neutral clearance length L [m].

    Returns
    -------
    float

    Examples
    --------
    >>> round(port_clearance(0.335, 0.1), 4)
    0.133
    """
    return 2.0 * half_stroke * (1.0 - port_location)


@checked(bore=SOME)
def piston_mass(bore: float) -> float:
    """Mass of both piston heads [kg] (Eq. 65): ``82.3 b^2 + 0.0136 b - 8.16e-5``.

    Counted once: it is both heads, as the masses of Table 9 show.

    Parameters
    ----------
    bore : float
        Bore b [m].

    Returns
    -------
    float

    Examples
    --------
    >>> round(piston_mass(0.064), 4)
    0.3379
    """
    return 82.3 * bore**2 + 0.0136 * bore - 8.16e-5


@checked(crown=SOME, per_length=SOME)
def rod_mass(crown: float, per_length: float = 0.585) -> float:
    """Mass of the connecting rod [kg] (Eq. 66): ``0.585 * 2 (L_P - 8 mm)``.

    Parameters
    ----------
    crown : float
        Distance L_P from midpoint to crown [m].
    per_length : float
        Mass per length [kg/m].

    Returns
    -------
    float

    Examples
    --------
    >>> round(rod_mass(0.294), 4)
    0.3346
    """
    return per_length * 2.0 * (crown - SKIRT_LENGTH)


@checked(stiffness=SOME, per_stiffness=SOME)
def spring_mass(stiffness: float, per_stiffness: float = 10.0 / 350e3) -> float:
    """Moving mass of the springs [kg] (Eq. 67): ``10 / 350000 k``.

    Parameters
    ----------
    stiffness : float
        Stiffness k of one spring [N/m].
    per_stiffness : float
        Mass per stiffness [kg m/N].

    Returns
    -------
    float

    Examples
    --------
    >>> spring_mass(35e3)
    1.0
    """
    return per_stiffness * stiffness
