"""Ranges of what has been built, generously: of a tenth to five times the known size."""

STIFFNESS = 100.0, 1e7  # [N/m]
LOAD_CONSTANT = 0.01, 2e4  # [N s/m]
POWER = 50.0, 1e8  # [W]
FREQUENCY = 0.5, 1e3  # [Hz]
