"""Laws of a controller, one module per slot."""
