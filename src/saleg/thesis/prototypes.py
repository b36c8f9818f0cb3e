"""Prototypes of Table 6: two spark-ignited engines of others (3.6.7, Figures 60 and 61).

As in the dissertation a knock integral lights them. What Table 6 leaves open is chosen here: the
load constant so that the stroke is about nine tenths of the longest and the engine runs from its
usual start, the friction coefficient so that friction takes 6 % of the fuel energy, and walls of
450 K. What was measured is printed as curves alone, so nothing here is compared with it.

Examples
--------
>>> import saleg
>>> state = saleg.steady_state(ulsan())
>>> round(state.performance.frequency, 1)
62.7
"""

from __future__ import annotations

from saleg import Engine, Run, plotting, simulate
from saleg.laws import RCMIgnitionPascal
from saleg.machines import thesis_base
from saleg.thesis.figure import Figure
from saleg.thesis.tables import columns

#: Wall temperature of both [K]; not printed.
WALLS = 450.0
#: Equivalence ratio that releases the 25 J per stroke of Table 6's note [-].
RATIO_OF_25_J = 0.359


def ulsan() -> Engine:
    """Prototype of the University of Ulsan: 30 mm bore, 31 mm maximum stroke.

    Ignition by the RCM correlation, 30 % retained gas and a heat release of 3 ms, as the text says.

    Returns
    -------
    Engine
    """
    printed = columns(6)["ulsan"]
    return _prototype(printed).replace(
        ignition=RCMIgnitionPascal(),
        egr=0.3,
        equivalence_ratio=printed["equivalence_ratio"],
        **{
            "springs.stiffness": printed["spring_stiffness"],
            "fuel.lower_heating_value": printed["lower_heating_value"],
            "heat_release.combustion_duration": 3e-3,
            "alternator.load_constant": 65.0,
            "friction.coefficient": 14.8,
        },
    )


def west_virginia() -> Engine:
    """Prototype of West Virginia University: 36.4 mm bore, 50 mm maximum stroke, no springs.

    Ignition by the CFR correlation, as the text says, and fuel for 25 J per stroke.

    Returns
    -------
    Engine
    """
    printed = columns(6)["wvu"]
    return _prototype(printed).replace(
        egr=0.0,
        equivalence_ratio=RATIO_OF_25_J,
        **{
            "springs.stiffness": printed["spring_stiffness"],
            "heat_release.combustion_duration": printed["combustion_duration"],
            "alternator.load_constant": 73.4,
            "friction.coefficient": 13.4,
        },
    )


def run_ulsan() -> Run:
    """Prototype of Ulsan until it is steady (Figure 60)."""
    return simulate(ulsan(), 1.5)


def run_west_virginia() -> Run:
    """Prototype of West Virginia until it is steady (Figure 61)."""
    return simulate(west_virginia(), 1.5)


#: Figures by their number.
FIGURES = {
    60: Figure(run_ulsan, plotting.dynamics),
    61: Figure(run_west_virginia, plotting.dynamics),
}


def _prototype(printed: dict[str, float]) -> Engine:
    half_stroke = 0.5 * printed["maximum_stroke"]
    return thesis_base().replace(
        bore=printed["bore"],
        half_stroke=half_stroke,
        port_closing=printed["exhaust_port_location"],
        moving_mass=printed["mass"],
        wall_temperature=WALLS,
        **{
            "intake.pressure": printed["intake_pressure"],
            "intake.temperature": printed["intake_temperature"],
        },
    )
