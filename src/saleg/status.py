"""How a run ended."""

from __future__ import annotations

import enum


class Status(enum.Enum):
    """How a run ended; :attr:`Run.message` says when and what to try."""

    COMPLETED = "completed"
    STEADY = "steady"
    IDLING = "idling"
    STALLED = "stalled"
    HEAD_CONTACT = "head contact"
    STEP_FAILURE = "step failure"
    INVALID = "invalid"

    def __str__(self) -> str:
        return self.value
