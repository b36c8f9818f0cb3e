"""Plugs: engines in the tools of others, each module of its own extra.

- :mod:`saleg.plugs.gymnasium`: environments for reinforcement learning, ``saleg[rl]``;
- :mod:`saleg.plugs.fmu`: export as a functional mock-up unit, ``saleg[fmu]``;
- :mod:`saleg.plugs.bench`: an alternator along a measured motion.
"""
