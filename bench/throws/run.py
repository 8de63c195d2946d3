#!/usr/bin/env python3
"""Random throws of elastic bodies into random obstacles under the default scheme: no throw may fail, gain energy, or
pass through an obstacle.

    ./dev bench throws [--cases 1000] [--first 1] [--keep FOLDER]

Runs on all processors (20 minutes for 1,000) and prints a line for every throw with a fault, then a table. A throw is
determined by its number, on every machine. Status 1: some throws have faults.
"""

import collections
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from random_throw import Throw

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from measurement import BUILD, Arguments, history, summary, table

PROGRAM = pathlib.Path(os.environ.get("RICOCHET_PROGRAM") or BUILD / "ricochet")
ENERGY, DEPTH = 1e-10, 1e-9  # of the largest energy; of the body, whose size is 1
# Relative to the largest energy; at finite strain a step may leave more (docs/finite-strain.md).
ACCOUNT = {"linear": 1e-10, "neo-hookean": 1e-8}
TIME_LIMIT = 900  # seconds


def judge(output, law):
    """Returns the errors of a run that has ended, as texts."""
    ended, columns = summary(output), history(output)
    largest = max(map(abs, columns["total_energy"] + columns["kinetic_energy"]))
    wrong = []
    created = ended["energy_budget"]["created_by_method"]
    if created > ENERGY:
        wrong.append(f"created {created:.1e} of the energy")
    residual = max(map(abs, columns["energy_residual"])) / largest
    if residual > ACCOUNT[law]:
        wrong.append(f"the energy account closes only to {residual:.1e}")
    depth = max(columns["max_penetration"])
    if depth > DEPTH:
        wrong.append(f"a node penetrates by {depth:.1e}")
    # All of the boundary is contact boundary; only a node inside the body that an edge reaches between its nodes is
    # exempt.
    if any("gone through" in warning for warning in ended["warnings"]):
        wrong.append("a node has passed through an obstacle in one step")
    return wrong, max(columns["active_contacts"]) > 0


def throw(seed, folder, keep):
    made = Throw(seed, folder)
    case, output = made.file(".toml"), made.file("_out")
    case.write_text(made.text)
    try:
        process = subprocess.run([PROGRAM, "run", case, "-o", output, "--quiet", "--force"], capture_output=True, text=True,
                                 timeout=TIME_LIMIT, check=False)
        if process.returncode == 0:
            wrong, touches = judge(output, made.law)
        else:
            lines = [line for line in process.stderr.splitlines() if line.startswith("ricochet: ")]
            wrong, touches = [f"status {process.returncode}: {lines[0] if lines else process.stderr[-300:]}"], False
    except subprocess.TimeoutExpired:
        wrong, touches = [f"not finished after {TIME_LIMIT} s"], False
    if not keep or not wrong:
        shutil.rmtree(output, ignore_errors=True)
    return made, wrong, touches


def main():
    parser = Arguments("throws", __doc__, build="")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="folder in which the files of the throws are kept")
    options = parser.parse()
    counts = collections.defaultdict(lambda: [0, 0, 0])
    bad = 0
    with tempfile.TemporaryDirectory(prefix="ricochet-throws-") as temporary:
        folder = options.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for made, wrong, touches in pool.map(lambda seed: throw(seed, folder, options.keep is not None),
                                                 range(options.first, options.first + options.cases)):
                for kind in {*made.kinds, made.law, f"{made.dimension}D", "all"}:
                    counts[kind][0] += 1
                    counts[kind][1] += touches
                    counts[kind][2] += bool(wrong)
                if wrong:
                    bad += 1
                    print(f"{made.seed}: {made.dimension}D {made.body}, {made.law}, friction {made.friction}, {' and '.join(made.kinds)}: "
                          f"{'; '.join(wrong)}", flush=True)
    print(table(["obstacle, law", "throws", "with contact", "with faults"],
                [[kind, *counts[kind]] for kind in sorted(counts, key=lambda name: (name == "all", name))]))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
