#!/usr/bin/env python3
"""Every time scheme on every benchmark.

    ./dev bench scorecard [--output out/scorecard] [--jobs N]

Runs `ricochet benchmark --scheme all` and writes the table of docs/scorecard.md.
"""

import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import ROOT, Arguments, positive, write_parts

# Some values do not hold, or some runs fail: the scorecard reports this.
STATUSES = (0, 3, 5)


def main():
    parser = Arguments("scorecard", __doc__, build="the program")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "out" / "scorecard", help="directory of the runs (default: %(default)s)")
    parser.add_argument("--jobs", type=positive, default=os.cpu_count(), help="number of runs at a time (default: %(default)s)")
    arguments = parser.parse()
    command = [arguments.build / "ricochet", "benchmark", "--scheme", "all", "-o", arguments.output, "--jobs", str(arguments.jobs), "--force"]
    if subprocess.run(list(map(str, command)), cwd=ROOT, check=False).returncode not in STATUSES:
        raise SystemExit("the benchmarks could not be run")
    card = (arguments.output / "scorecard.md").read_text(encoding="utf-8").split("\n\n", 1)[1]
    write_parts("scorecard.md", {"scorecard": card.rstrip("\n")})


if __name__ == "__main__":
    main()
