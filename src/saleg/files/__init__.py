"""Files of any kind: there whole or not at all, locked, and tables with units as CSV."""
