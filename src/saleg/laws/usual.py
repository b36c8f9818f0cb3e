"""Ranges of what has been built, generously: of a tenth to five times the known size."""

LENGTH = 1e-4, 3.0  # [m]
GAP = 1e-7, 0.02  # [m]; what is left at a head
TIME = 1e-6, 1e3  # [s]; when something happens in a run
LAG = 1e-5, 10.0  # [s]
GAS_PRESSURE = 1e4, 2e8  # [Pa]; in a cylinder
COMMANDED_TEMPERATURE = 100.0, 1500.0  # [K]; limits of an intake's
GAS_CONSTANT = 10.0, 1e4  # [J/kg/K]
ACTIVATION_ENERGY = 2e3, 1e5  # [cal/mol]
SMALL_FORCE = 0.5, 1e7  # [N]; of a starting motor or friction
FORCE = 5.0, 1e7  # [N]; of springs and generators
FRICTION = 1e-3, 5e3  # [N s/m]
STIFFNESS = 100.0, 1e7  # [N/m]
STOP_STIFFNESS = 1e3, 1e11  # [N/m]
LOAD_CONSTANT = 0.1, 2e4  # [N s/m]
POWER = 50.0, 1e8  # [W]
FREQUENCY = 0.5, 1e3  # [Hz]
