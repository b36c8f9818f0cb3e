"""Sensitivity studies: change one thing of an engine, settle, compare (3.6.3 to 3.6.6).

:func:`vary` gives one row per value of any number or law of any engine; the studies of the thesis'
Chapter 3 are built on it, with the thesis' ranges as defaults. A run that does not settle is a row
with its status. Figures are in :mod:`saleg.plotting.sensitivity`.
"""

from saleg.studies.sensitivity.friction import friction_laws
from saleg.studies.sensitivity.heat_release import (
    double_wiebe_early,
    double_wiebe_late,
    release_durations,
    release_profiles,
)
from saleg.studies.sensitivity.heat_transfer import heat_transfer_laws, hohenberg_parameters
from saleg.studies.sensitivity.ignition import (
    cfr_parameters,
    equivalence_ratios,
    ignition_laws,
    retained_gas,
)
from saleg.studies.sensitivity.load import flux_ripples, regulator_gains, target_strokes
from saleg.studies.sensitivity.parameter_study import Case, Study, study, vary, vary_each
from saleg.studies.sensitivity.settle import is_stable, settle
from saleg.studies.sensitivity.tuning import (
    TuningError,
    fix_load,
    friction_work,
    heat_transfer_share,
    tune,
)

__all__ = [
    "Case",
    "Study",
    "TuningError",
    "cfr_parameters",
    "double_wiebe_early",
    "double_wiebe_late",
    "equivalence_ratios",
    "fix_load",
    "flux_ripples",
    "friction_laws",
    "friction_work",
    "heat_transfer_laws",
    "heat_transfer_share",
    "hohenberg_parameters",
    "ignition_laws",
    "is_stable",
    "regulator_gains",
    "release_durations",
    "release_profiles",
    "retained_gas",
    "settle",
    "study",
    "target_strokes",
    "tune",
    "vary",
    "vary_each",
]
