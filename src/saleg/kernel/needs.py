"""Parts of the state that the laws at hand need; in plain Python all there are.

A composed module has the answers for its laws in their place (:mod:`saleg.compiler.needs`), so that
what nobody asks for is neither computed nor stepped.
"""

from saleg.kernel.layout import N_ALL

MOTORED_PRESSURE_IS_WANTED = True
CURRENT_IS_WANTED = True
# Whether the gas of a chamber changes with its composition.
COMPOSITION_IS_WANTED = True
# Whether fuel is injected into a closed chamber.
INJECTION_IS_WANTED = True
CONTENTS_ARE_WANTED = True
WALL_TEMPERATURE_IS_WANTED = True
CRANKCASE_IS_WANTED = True
FRAME_IS_WANTED = True
# Whether the alternator may be a motor: a controller commands the engine.
MOTORING_IS_POSSIBLE = True
# Length of the state up to its last entry that is wanted.
N_WANTED = N_ALL
