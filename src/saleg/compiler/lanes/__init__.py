"""Many engines side by side: the kernel compiled for a number of several engines at once.

:mod:`~saleg.compiler.lanes.values` is that number, :mod:`~saleg.compiler.lanes.functions` are the
elementary functions of it, :mod:`~saleg.compiler.lanes.storage` is how records of it lie in memory.
:mod:`~saleg.compiler.lanes.advance` is the text that steps lanes with the kernel's own functions;
:mod:`~saleg.compiler.lanes.group` makes the room for them.
"""
