"""`python -m zerorate_tools.runtimes ...` is `zerorate runtimes ...`."""

import sys

from zerorate_tools.cli import main

if __name__ == "__main__":
    sys.exit(main(["runtimes", *sys.argv[1:]]))
