"""Studies: what changes with a numerical setting, or with one number or law of an engine."""

from saleg.engine.paths import MAIN_INPUTS
from saleg.studies import sensitivity
from saleg.studies.comparison import compare
from saleg.studies.convergence import (
    DELAYED,
    TABLE_2_STEPS,
    TABLE_4_TIMES,
    UNITS,
    WARM_UP,
    StudyError,
    delay_study,
    delayed,
    solver_study,
    step_size_study,
    stop_time_study,
    tolerance_study,
    work_precision,
)
from saleg.studies.elasticities import MAIN_FIGURES, elasticities
from saleg.studies.printed import beside_thesis
from saleg.studies.published_machines import (
    Cause,
    Compared,
    Explanation,
    compare_published,
    explain_published,
)
from saleg.studies.variability import VARIABILITY_UNITS, variability

__all__ = [
    "DELAYED",
    "MAIN_FIGURES",
    "MAIN_INPUTS",
    "TABLE_2_STEPS",
    "TABLE_4_TIMES",
    "UNITS",
    "VARIABILITY_UNITS",
    "WARM_UP",
    "Cause",
    "Compared",
    "Explanation",
    "StudyError",
    "beside_thesis",
    "compare",
    "compare_published",
    "delay_study",
    "delayed",
    "elasticities",
    "explain_published",
    "sensitivity",
    "solver_study",
    "step_size_study",
    "stop_time_study",
    "tolerance_study",
    "variability",
    "work_precision",
]
