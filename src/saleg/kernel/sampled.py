"""Force a controller made of laws commands at a sample within the stroke.

Compiled apart from the engine, or run as Python.
"""

from saleg.kernel.jit import compiled
from saleg.kernel.slots import force_control_push, position_sensor_measured
from saleg.laws.arguments import Instant


@compiled
def sample(P, memory, true):
    """Force until the next sample, from the position that is measured."""
    seen = Instant(
        t=true.t,
        x=position_sensor_measured(P, memory[0], true.x),
        sample_time=true.sample_time,
        motoring=true.motoring,
        x_left=true.x_left,
        x_right=true.x_right,
        frequency=true.frequency,
        maximum_stroke=true.maximum_stroke,
    )
    return force_control_push(P, memory[1], seen)
