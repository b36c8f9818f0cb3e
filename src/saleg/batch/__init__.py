"""One engine, or many, for many rows: workers, chunks, and columns with units in order."""
