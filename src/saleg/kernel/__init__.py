"""The numeric core: right-hand side, events, Runge-Kutta steps, and the composer.

The modules here are ordinary Python that runs as it stands; the composer joins them with the
laws of an engine into one compiled module.
"""
