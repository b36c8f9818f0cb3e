"""From an engine's laws and the kernel's modules to compiled code."""
