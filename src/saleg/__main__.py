"""``python -m saleg``: the command line."""

import sys

from saleg.cli import main

if __name__ == "__main__":
    sys.exit(main())
