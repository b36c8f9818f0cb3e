"""Plugs: engines in the tools of others.

- :mod:`saleg.plugs.gymnasium`: environments for reinforcement learning, with ``saleg[rl]``;
- :func:`to_fmu`: export as a functional mock-up unit, with ``saleg[fmu]``;
- :func:`prescribed_motion`: an alternator along a measured motion.
"""

from saleg.plugs.bench import MotionError, prescribed_motion
from saleg.plugs.fmu import to_fmu
from saleg.plugs.task import PowerAndStroke, Task, TaskError

__all__ = [
    "MotionError",
    "PowerAndStroke",
    "Task",
    "TaskError",
    "prescribed_motion",
    "to_fmu",
]
