"""Published machines, one module each."""

from saleg.machines.thesis import thesis_base, thesis_transient

__all__ = ["CATALOGUE", "thesis_base", "thesis_transient"]

#: Machines by the name the command line uses.
CATALOGUE = {"thesis-base": thesis_base, "thesis-transient": thesis_transient}
