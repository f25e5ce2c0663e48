"""``python -m bumpstop``: the same as the command ``bumpstop``."""

import sys

from bumpstop.cli import main

if __name__ == "__main__":
    sys.exit(main())
