"""`python3 -m ricochet` is the program."""

import os
import sys

from .program import program

os.execv(program(), ["ricochet", *sys.argv[1:]])
