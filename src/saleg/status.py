"""How a run ended."""

from __future__ import annotations

import enum


class Status(enum.Enum):
    """How a run ended; :attr:`Run.message` says when and what to try."""

    COMPLETED = "completed"
    STEADY = "steady"
    IDLING = "idling"
    UNSTEADY = "unsteady"
    NOT_FOUND = "not found"
    STALLED = "stalled"
    HEAD_CONTACT = "head contact"
    STEP_FAILURE = "step failure"
    CONTROLLER_FAULT = "controller fault"
    INVALID = "invalid"

    @property
    def ended_well(self) -> bool:
        """Whether the run went on to the end of its time with the engine doing its work."""
        return self in (Status.STEADY, Status.COMPLETED)

    def __str__(self) -> str:
        return self.value
