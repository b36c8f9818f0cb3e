"""Ranges of what has been built, generously: of a tenth to five times the known size."""

LENGTH = 1e-4, 3.0  # [m]
FORCE = 5.0, 1e7  # [N]
FRICTION = 1e-3, 5e3  # [N s/m]
STIFFNESS = 100.0, 1e7  # [N/m]
STOP_STIFFNESS = 1e3, 1e11  # [N/m]
LOAD_CONSTANT = 0.1, 2e4  # [N s/m]
POWER = 50.0, 1e8  # [W]
FREQUENCY = 0.5, 1e3  # [Hz]
