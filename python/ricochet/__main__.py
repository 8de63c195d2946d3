"""Runs the program `ricochet`, for `python3 -m ricochet`."""

import os
import sys

from .program import program


def main():
    os.execv(program(), ["ricochet", *sys.argv[1:]])


if __name__ == "__main__":
    main()
