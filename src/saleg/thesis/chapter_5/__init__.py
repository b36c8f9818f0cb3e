"""Chapter 5: transient operation and control, experiment by experiment."""

from saleg.thesis.chapter_5 import demand, misfire, resonance, start_up
from saleg.thesis.experiment import Experiment, Line

#: All experiments by the name the command line gives them, in the order of the chapter.
EXPERIMENTS: dict[str, Experiment] = {
    **resonance.EXPERIMENTS,
    **start_up.EXPERIMENTS,
    **demand.EXPERIMENTS,
    **misfire.EXPERIMENTS,
}

__all__ = ["EXPERIMENTS", "Experiment", "Line"]
