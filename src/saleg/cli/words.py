"""What commands raise."""

from saleg.errors import SalegError


class CommandError(SalegError, ValueError):
    """Words on the command line that make no sense together."""
