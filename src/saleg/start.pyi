from saleg.engine.start import *
