"""`python3 -m ricochet` is the program."""

import os
import sys

from .program import program


def main():
    os.execv(program(), ["ricochet", *sys.argv[1:]])


if __name__ == "__main__":
    main()
