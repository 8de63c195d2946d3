#!/usr/bin/env python3
"""Every time scheme on every benchmark.

    ./dev bench scorecard [--output out/scorecard] [--jobs N]

Runs `ricochet benchmark --scheme all` and writes the table of docs/scorecard.md.
"""

import argparse
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from page import write_parts

# Some values do not hold, or some runs fail: the scorecard reports this.
STATUSES = (0, 3, 5)


def main():
    parser = argparse.ArgumentParser(prog="./dev bench scorecard", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "out" / "scorecard", help="directory of the runs (default: %(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="number of runs at a time (default: %(default)s)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="folder of the program")
    parser.add_argument("--check", action="store_true", help="only check the arguments")
    arguments = parser.parse_args()
    if arguments.jobs < 1:
        parser.error("--jobs must be at least 1")
    if arguments.check:
        return 0
    command = [arguments.build / "ricochet", "benchmark", "--scheme", "all", "-o", arguments.output, "--jobs", str(arguments.jobs), "--force"]
    if subprocess.run(list(map(str, command)), cwd=ROOT, check=False).returncode not in STATUSES:
        raise SystemExit("the benchmarks could not be run")
    card = (arguments.output / "scorecard.md").read_text(encoding="utf-8").split("\n\n", 1)[1]
    write_parts(ROOT / "docs" / "scorecard.md", {"scorecard": card.rstrip("\n")})
    return 0


if __name__ == "__main__":
    sys.exit(main())
