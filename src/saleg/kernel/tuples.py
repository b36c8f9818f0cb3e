"""Arguments of the kernel's entry points, by name: numba takes named tuples as they are.

They are part of every composed module's text, so that a field renamed or moved makes another
module and never meets machine code compiled for the order before.
"""

from typing import Any, NamedTuple


class Tableau(NamedTuple):
    """Coefficients of an explicit Runge-Kutta method with s stages.

    Attributes
    ----------
    A : ndarray, shape (s, s)
        Stage matrix, strictly lower triangular.
    b, c : ndarray, shape (s,)
        Weights and nodes.
    e : ndarray, shape (s + 1,)
        Weights of the error estimate; zeros without an embedded method.
    """

    A: Any
    b: Any
    c: Any
    e: Any


class Tables(NamedTuple):
    """Tables a run is recorded in.

    Attributes
    ----------
    strokes, events, history : ndarray of STROKE_RECORD, EVENT_RECORD, HISTORY_RECORD
        Room for their rows.
    filled : ndarray of FILLED_RECORD, shape (1,)
        Number of rows filled in each.
    """

    strokes: Any
    events: Any
    history: Any
    filled: Any


class Snapshots(NamedTuple):
    """States at the last two left dead centres, the latest first.

    Attributes
    ----------
    engine : ndarray of ENGINE_RECORD, shape (2,)
    chambers : ndarray of CHAMBER_RECORD, shape (2, 2)
    y : ndarray, shape (2, N_ALL)
    """

    engine: Any
    chambers: Any
    y: Any


class Words(NamedTuple):
    """Records of a run and of its snapshots as whole numbers of 8 bytes, in the same memory.

    Attributes
    ----------
    engine : ndarray of int, shape (1, n)
    chambers : ndarray of int, shape (2, n)
    kept_engine : ndarray of int, shape (2, n)
    kept_chambers : ndarray of int, shape (2, 2, n)
    """

    engine: Any
    chambers: Any
    kept_engine: Any
    kept_chambers: Any


class Spare(NamedTuple):
    """Scratch arrays for a step within a step.

    Attributes
    ----------
    y, dy : ndarray, shape (N_ALL,)
        A state and its rates.
    rates : ndarray, shape (s + 1, N_ALL)
        Rates of the stages.
    y_new : ndarray, shape (N_ALL,)
        State at the end.
    trail : ndarray, shape (N_PEAKS + 1,)
        Watched quantities at the begin of the step before, and the length of that step.
    slopes : ndarray, shape (3, N_PEAKS + 1)
        Their time derivatives at the begin of a step, at its end and within, and which step it is
        by the count of steps.
    """

    y: Any
    dy: Any
    rates: Any
    y_new: Any
    trail: Any
    slopes: Any


class Scratch(NamedTuple):
    """Scratch arrays of the integrator.

    Attributes
    ----------
    rates : ndarray, shape (s + 1, N_ALL)
        Rates of the stages of a step, and at its end.
    y_new : ndarray, shape (N_ALL,)
        State at the end of a step.
    spare : Spare
    """

    rates: Any
    y_new: Any
    spare: Spare


class Sampling(NamedTuple):
    """Parts of a controller that act at samples, as the kernel calls them.

    Attributes
    ----------
    address : int
        Address of the compiled function, 0 for none; the function itself where nothing is compiled.
    numbers : ndarray
        Numbers of its laws.
    memory : ndarray, shape (SAMPLED_PARTS * SAMPLE_MEMORY,)
        Room for what they remember.
    instant : ndarray of INSTANT_RECORD, shape (1,)
        Room for what they are shown.
    wanted : ndarray of FORCE_RECORD, shape (1,)
        Room for what they ask for.
    """

    address: Any
    numbers: Any
    memory: Any
    instant: Any
    wanted: Any


class Control(NamedTuple):
    """Controller as the kernel calls it.

    Attributes
    ----------
    address : int
        Address of the compiled function, 0 for none; the function itself where nothing is compiled.
    numbers : ndarray
        Numbers of its laws.
    memory : ndarray, shape (CONTROL_PARTS * MEMORY,)
        Room for what its parts remember.
    signals : ndarray of SIGNALS_RECORD, shape (1,)
        Room for what it is shown.
    commands : ndarray of COMMANDS_RECORD, shape (2,)
        Room for what it asks for, and the NaN that stands there before.
    sampling : Sampling
        Its parts that act within the stroke.
    """

    address: Any
    numbers: Any
    memory: Any
    signals: Any
    commands: Any
    sampling: Sampling


class Integration(NamedTuple):
    """Arguments of the integrator; all its state is in them.

    Attributes
    ----------
    laws : ndarray, shape (1,)
        Numbers of the laws.
    engine : ndarray of ENGINE_RECORD, shape (1,)
    chambers : ndarray of CHAMBER_RECORD, shape (2,)
    y : ndarray, shape (N_ALL,)
        State vector and quadratures.
    peaks : ndarray, shape (N_PEAKS,)
        Greatest values of the present stroke.
    tableau : Tableau
    order : float
        Order of the method.
    options : ndarray of OPTIONS_RECORD, shape (1,)
    tables : Tables
    snapshots : Snapshots
    words : Words
    scratch : Scratch
    control : Control
    """

    laws: Any
    engine: Any
    chambers: Any
    y: Any
    peaks: Any
    tableau: Tableau
    order: float
    options: Any
    tables: Tables
    snapshots: Snapshots
    words: Words
    scratch: Scratch
    control: Control


class ReturnMapping(NamedTuple):
    """Arguments of the return map.

    Attributes
    ----------
    integration : Integration
    address : int
        Address of the compiled integrator.
    mirrored : bool
        Whether the map is that of half a cycle, its end seen in the mirror.
    """

    integration: Integration
    address: int
    mirrored: bool


class Iterates(NamedTuple):
    """Vectors of the search for a fixed point.

    Attributes
    ----------
    point, residual, image : ndarray, shape (N_VECTOR,)
        Present point, its image less itself, and its image.
    points, residuals : ndarray, shape (DEPTH, N_VECTOR)
        Points and residuals before, the latest first.
    gram : ndarray, shape (DEPTH, DEPTH + 2)
        Equations for the weights of an extrapolation.
    modes : ndarray of int, shape (2,)
        Modes of the chambers at the present point.
    counts : ndarray of int, shape (2,)
        Maps taken, and points before the present one in the same modes.
    """

    point: Any
    residual: Any
    image: Any
    points: Any
    residuals: Any
    gram: Any
    modes: Any
    counts: Any
